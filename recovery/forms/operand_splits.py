"""Operands that are divided because other lines show them to be more than an operand."""

from __future__ import annotations

from collections.abc import Iterator, Sequence, Set
from itertools import pairwise

from recovery.forms.operand_rules import OperandRules
from recovery.forms.symbol_reader import SymbolReader
from recovery.forms.symbols import Operand, Symbol


def split_operands(
    reader: SymbolReader, lines: Sequence[tuple[Symbol, ...]]
) -> list[tuple[Symbol, ...]]:
    """Return the lines with operands divided that are a call, or a name with an index.

    That is done if other lines show that the brackets are none of an operand: ``F(X)`` in
    ``DEFFCT INT F(X)`` is no call if another line is ``DEFFCT INT F(X:IN)``, and an index may also
    follow a type in ``EXT F(NAMED[]:IN, INT[]:IN)``.
    """
    rules = reader.rules
    behind = [right for line in lines for left, right in pairwise(line) if left.is_operand]
    indices = {s.text for s in behind} & {*rules.following.values()}
    brackets = {s.text for s in behind if s.inside is not None}
    brackets.update(f"'{b}'" for line in lines for s in line for b in _no_calls(rules, s))
    if not indices and not brackets:
        return list(lines)
    return [tuple(p for s in line for p in _parts(reader, s, brackets, indices)) for line in lines]


def _no_calls(rules: OperandRules, symbol: Symbol) -> Iterator[str]:
    """Yield the brackets of an operand that have a word in them that is no operand."""
    kinds = symbol.operand.kinds if symbol.operand else ()
    for start, kind in enumerate(kinds):
        if not rules.words_in_brackets.get(kind, frozenset()).isdisjoint(kinds[start + 1 :]):
            yield rules.lexer.display[kind]


def _parts(
    reader: SymbolReader, symbol: Symbol, brackets: Set[str], indices: Set[str]
) -> tuple[Symbol, ...]:
    rules = reader.rules
    kinds = symbol.operand.kinds if symbol.operand else ()
    index = rules.following.get(kinds[1], "") if len(kinds) > 1 else ""
    if index in indices and index in rules.matcher.rules_for(kinds[1:]):
        return Symbol("", Operand(kinds[:1])), Symbol(index)
    tokens = [(kind, None) for kind in kinds]
    for start in range(1, len(kinds)):
        opening = reader.text(kinds[start])
        if opening in brackets and reader.closer(tokens, start) == len(kinds) - 1:
            inside = reader.symbols(tokens[start + 1 : -1], atoms=True)
            return Symbol("", Operand(kinds[:start])), Symbol(opening, None, inside)
    return (symbol,)
