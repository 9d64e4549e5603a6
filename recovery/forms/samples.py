"""Samples of a rule: lines of symbols that it reads, with and without each optional part.

With them a form is learnt from a rule and from lines that it does not read.
"""

from __future__ import annotations

from collections.abc import Sequence

from grammar.notation.model import Element, Group, Literal, Reference, Repeat, walk
from recovery.brackets import closer_of
from recovery.forms.lists import LONG_LIST
from recovery.forms.operand_rules import OperandRules
from recovery.forms.symbols import CLOSERS, Operand, Symbol
from recovery.tuning import MOST_SAMPLES


def samples_of(rules: OperandRules, elements: Sequence[Element]) -> list[tuple[Symbol, ...]]:
    """Return samples of consecutive elements of a rule."""
    return [_with_groups(rules, line, is_line=True) for line in _sequences(rules, elements)]


def _sequences(
    rules: OperandRules, elements: Sequence[Element], within: frozenset[str] = frozenset()
) -> list[tuple[Symbol, ...]]:
    """Return samples without groups; the rules in ``within`` are not expanded again."""
    lines: list[tuple[Symbol, ...]] = [()]
    for element in elements:
        lines = [(*line, *more) for line in lines for more in _samples(rules, element, within)]
        # an odd step takes both of what comes in pairs
        lines = lines[:: len(lines) // MOST_SAMPLES | 1]
    return lines


def _samples(
    rules: OperandRules, element: Element, within: frozenset[str]
) -> list[tuple[Symbol, ...]]:
    match element:
        case Group(alternatives=alternatives):
            return [s for a in alternatives for s in _sequences(rules, a.elements, within)]
        case Repeat(item=item, operator=operator):
            once = _samples(rules, item, within)
            # more often than in a short list, so that it stays a list of any length
            more = [s * LONG_LIST for s in once] if operator != "?" else []
            return [*(() if operator == "+" else [()]), *once, *more]
        case Reference(name=name, is_token=False):
            if not _is_expanded(rules, name, within):
                return [(Symbol("", Operand((), name)),)]
            group = Group(rules.grammar.by_name[name].alternatives, element.span)
            return _samples(rules, group, within | {name})
        case Reference() | Literal():
            token = rules.grammar.token_of(element)
            kind = rules.lexer.kind_of[token]
            if rules.lexer.has_value(kind):
                return [(Symbol("", Operand((kind,))),)]
            return [(Symbol(rules.lexer.spelled(kind)),)]
    return []


def _is_expanded(rules: OperandRules, name: str, within: frozenset[str]) -> bool:
    """Return whether a rule is written out: one that only one rule uses, or that has a list."""
    is_level = name in rules.ladder and name in rules.reaches[name]
    if is_level or name in within or name in rules.bracketed.values():
        return False
    inner = walk(rules.grammar.by_name[name])
    return rules.is_part(name) or any(isinstance(e, Literal) and e.text == "," for e in inner)


def _with_groups(
    rules: OperandRules, symbols: Sequence[Symbol], *, is_line: bool
) -> tuple[Symbol, ...]:
    """Return the symbols as they would be read: groups in brackets, types, names with an index."""
    out: list[Symbol] = []
    names = {Operand((rules.lexer.name_kind,)), Operand((), rules.names or "")}
    place = 0
    while place < len(symbols):
        symbol = symbols[place]
        length = closer_of((s.text for s in symbols[place:]), CLOSERS)
        if length is not None:
            inside = _with_groups(rules, symbols[place + 1 : place + length], is_line=False)
            symbol = Symbol(symbol.text, None, inside)
            place += length
        elif symbol.text in rules.type_words and (place or not is_line):
            symbol = Symbol("", Operand((rules.lexer.kind_of[symbol.text],)))
        rule = symbol.operand.rule if symbol.operand else symbol.text
        if out and out[-1].operand in names and rule in rules.followed:
            out[-1] = Symbol("", rules.followed[rule])
        else:
            out.append(Symbol(rule) if rule in rules.following.values() else symbol)
        place += 1
    return tuple(out)
