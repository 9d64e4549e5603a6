"""Failing lines as symbols, with the state of the grammar at each failure."""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import cached_property
from itertools import pairwise

from grammar.notation.model import Reference
from grammar.parser.failures import FailureContext
from grammar.parser.recognizer import Recognizer, State
from recovery.brackets import BRACKETS, CLOSING, left_open
from recovery.forms.lists import split_at_commas
from recovery.forms.operand_rules import OperandRules, bracket_pairs
from recovery.forms.symbol_reader import SymbolReader
from recovery.forms.symbols import Operand, Symbol, Token
from recovery.proposals.edit_site import LinePattern
from recovery.proposals.grammar_profile import GrammarProfile

#: What is written as a keyword is.
WORD = re.compile(r"\b[A-Z_][A-Z0-9_]*\b")
#: Signs that may stand ahead of an operand.
PREFIXES = frozenset({"+", "-", "NOT"})


class LineSymbols:
    """The failing lines of one grammar: ``tokens[n]`` and ``symbols[n]`` of ``lines[n]``."""

    def __init__(
        self,
        recognizer: Recognizer,
        lines: Sequence[LinePattern],
        contexts: Sequence[FailureContext],
    ) -> None:
        """``contexts[n]`` is what the grammar was doing where line ``n`` fails."""
        self.recognizer = recognizer
        self.grammar = recognizer.grammar
        self.lexer = recognizer.lexer
        self.lines = lines
        self.contexts = contexts
        self.rules = OperandRules(recognizer)
        self.reader = SymbolReader(self.rules)
        self.profile = GrammarProfile(recognizer)
        self.tokens = [tuple(line.words()) for line in lines]
        #: The number and the tokens of each line, and the index of the one at which it fails.
        self.failures = [(n, self.tokens[n], line.form.index) for n, line in enumerate(lines)]
        self.symbols = [self._listed(self.reader.symbols(tokens)) for tokens in self.tokens]

    def _listed(self, symbols: tuple[Symbol, ...]) -> tuple[Symbol, ...]:
        """Return the symbols with reserved words as operands if they are in a list of names."""
        name = Symbol("", Operand((self.lexer.name_kind,)))
        ends = [i for i, symbol in enumerate(symbols) if symbol.text == "','"] + [len(symbols)]
        items = {right - 1 for left, right in pairwise(ends) if right == left + 2}
        if len(items) < len(ends) - 1 or not any(symbols[i] == name for i in items):
            return symbols
        # the first item stands behind the name of what the list belongs to, or behind its type
        first = ends[0] - 1
        ahead = symbols[first - 1].operand if first > 0 else None
        is_named = ahead is not None and (
            ahead == name.operand or not self.rules.type_kinds.isdisjoint(ahead.kinds)
        )
        items |= {first} if is_named else set()
        # a word that the grammar does not reserve yet is one of the names
        kinds = {
            i: self.lexer.kind_of.get(symbols[i].text, self.lexer.name_kind)
            for i in items
            if WORD.fullmatch(symbols[i].text)
        }
        return tuple(
            Symbol("", Operand((kinds[i],))) if i in kinds else symbol
            for i, symbol in enumerate(symbols)
        )

    def known_groups(self, symbols: Sequence[Symbol]) -> tuple[Symbol, ...]:
        """Return the symbols with each group that a rule reads as an operand of that rule.

        That is so of a call too, if only an operand is missing between its commas.
        """
        out: list[Symbol] = []
        for symbol in symbols:
            rule = self.rules.bracketed.get(symbol.text.strip("'"))
            call = self._calls.get(symbol.text)
            if symbol.inside is not None and call and self._is_called(out, symbol.inside):
                out[-1] = Symbol("", Operand((), call))
            elif symbol.inside is not None and rule:
                # what only follows operands, as an index, is written as its rule
                follows = rule in self.rules.recursive and rule not in self.rules.ladder
                out.append(Symbol(rule) if follows else Symbol("", Operand((), rule)))
            else:
                out.append(symbol)
        return tuple(out)

    def _is_called(self, ahead: Sequence[Symbol], inside: Sequence[Symbol]) -> bool:
        """Return whether a name is ahead of operands with commas between, of which some lack."""
        is_named = ahead and ahead[-1].operand == Operand((self.lexer.name_kind,))
        items = split_at_commas(inside)
        return bool(is_named) and all(
            len(item) < 2 and all(s.is_operand for s in item) for item in items
        )

    @cached_property
    def _calls(self) -> dict[str, str]:
        """The rules of operands that are a name ahead of something in brackets, by its opening."""
        names = {self.rules.names, self.lexer.name}
        return {
            f"'{opening}'": rule
            for rule in self.rules.ladder
            for alternative in self.grammar.by_name[rule].alternatives
            for first in alternative.elements[:1]
            for opening, start, end in bracket_pairs(alternative)
            if isinstance(first, Reference) and first.name in names
            if start == 1 and end == len(alternative.elements) - 1
        }

    def shown(self, token: Token) -> str:
        """Return the text of a sign or word, or the name of another kind; empty for no token."""
        return self.lexer.display[token[0]] if token[0] > 0 else ""

    def ends_operand(self, tokens: Sequence[Token], at: int) -> bool:
        """Return whether an operand may end before an index."""
        kind, word = tokens[at - 1]
        return not word and (
            (kind > 0 and self.lexer.has_value(kind)) or self.shown(tokens[at - 1]) in CLOSING
        )

    def begins_operand(self, tokens: Sequence[Token], at: int) -> bool:
        """Return whether an operand may begin at an index."""
        kind, word = tokens[at]
        if word or kind <= 0:
            return False
        shown = self.shown(tokens[at])
        return (
            (self.lexer.has_value(kind) and kind != self.lexer.line_kind)
            or shown in BRACKETS
            or self.rules.widest in self.rules.matcher.rules_for((kind,))
            or shown in PREFIXES
        )

    def state(self, number: int) -> State:
        """Return the state of the recogniser at the failure of a line."""
        form = self.lines[number].form
        before = self.recognizer.restore(form.before)
        return self.recognizer.run(before, form.kinds[: form.index])[0]

    def expected(self, number: int) -> frozenset[int]:
        """Return the kinds of token that are expected where a line fails."""
        return self.recognizer.expected(self.state(number))

    def opened(self, tokens: Sequence[Token], index: int) -> int | None:
        """Return the index of the innermost bracket that is open at a token."""
        return left_open(list(map(self.shown, tokens[:index])))

    def writing(self, number: int, sign: str) -> str | None:
        """Return the innermost active rule that writes the bracket."""
        for rule in reversed(self.contexts[number].rules):
            for alternative in self.grammar.by_name[rule].alternatives:
                if any(opening == sign for opening, _, _ in bracket_pairs(alternative)):
                    return rule
        return None
