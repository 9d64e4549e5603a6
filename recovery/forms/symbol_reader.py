"""Reads tokens as symbols (`recovery.forms.symbols`).

An operand is the longest sequence that a rule of operands reads; the grammar determines which rules
these are. Everything that no rule reads yet remains words, signs and groups in brackets.
"""

from __future__ import annotations

from collections.abc import Sequence

from recovery.brackets import closer_of
from recovery.forms.operand_rules import OperandRules
from recovery.forms.symbols import UNKNOWN, Operand, Symbol, Token

# Signs behind a name at the head of a line.
_BEHIND_NAMES = frozenset({"=", ".", "[", "(", ":"})


class SymbolReader:
    """Reads tokens as symbols under one grammar."""

    def __init__(self, rules: OperandRules) -> None:
        self.rules = rules
        self.lexer = rules.recognizer.lexer
        recognizer = rules.recognizer
        names = [rules.widest] if rules.widest else []
        # what only follows an operand, as an index does, is none by itself
        names += [n for n in rules.bracketed.values() if n not in rules.recursive]
        self._starts = [recognizer.at_rule(name) for name in names]
        # operands without operators: the lowest levels, what gathers nothing but these and tokens,
        # and what is in brackets of its own
        lowest = [n for n in rules.ladder if not {*rules.alone(n)} - {rules.names}]
        lowest += [n for n in rules.ladder if n not in lowest and rules.gathers(n, lowest)]
        self._atoms = [recognizer.at_rule(n) for n in (*lowest, *names[1:])]
        self._longest: dict[tuple[bool, tuple[int, ...]], int] = {}
        self._type_kinds = frozenset(filter(self.lexer.is_keyword, rules.type_kinds))

    def symbols(self, tokens: Sequence[Token], *, atoms: bool = False) -> tuple[Symbol, ...]:
        """Return the symbols of the tokens of a line or of a part of one.

        With ``atoms``, operands have no operators: ``X -1`` is two operands then.
        """
        out: list[Symbol] = []
        at = 0
        while at < len(tokens):
            kind, word = tokens[at]
            if kind == self.rules.recognizer.line_kind:
                break
            is_first = not (at or atoms)  # what is in brackets begins no line
            if not (is_first or word) and kind in self._type_kinds:
                length = 1
            else:
                length = 0 if word else self._operand(tokens, at, out, atoms=atoms)
            if length:
                out.append(Symbol("", Operand(tuple(k for k, _ in tokens[at : at + length]))))
                at += length
                continue
            text = word or self.text(kind)
            close = self.closer(tokens, at)
            if close is not None:
                out.append(self._group(text, tokens[at : close + 1]))
                at = close + 1
                continue
            out.append(Symbol(text))
            at += 1
        return tuple(out)

    def _group(self, text: str, tokens: Sequence[Token]) -> Symbol:
        """Return a group in brackets, with the rule that reads it if it only follows operands."""
        rule = self.rules.bracketed.get(self.lexer.display[tokens[0][0]])
        kinds = tuple(kind for kind, _ in tokens)
        if rule and rule not in self.rules.ladder and rule in self.rules.matcher.rules_for(kinds):
            return Symbol(rule) if rule in self.rules.recursive else Symbol("", Operand((), rule))
        # what no rule reads as an operand has operands of its own, a sign between them or not
        return Symbol(text, None, self.symbols(tokens[1:-1], atoms=True))

    def text(self, kind: int) -> str:
        """Return what a rule writes for a token."""
        return self.lexer.spelled(kind) if kind > 0 else UNKNOWN

    def _operand(
        self, tokens: Sequence[Token], at: int, before: Sequence[Symbol], *, atoms: bool
    ) -> int:
        """Return how many tokens from an index are an operand; 0 if none begins there."""
        kind = tokens[at][0]
        if kind <= 0:
            return 0
        if self.lexer.is_keyword(kind):
            # a word that may be a name is one where a name can be
            behind = self.lexer.display[max(tokens[at + 1][0], 0)] if at + 1 < len(tokens) else ""
            is_name = self.rules.matcher.may_be_a_name(kind) and (
                (atoms or behind in _BEHIND_NAMES)
                if not before
                else not before[-1].is_operand
                and (before[-1].text.strip("'"), self.lexer.names[kind]) not in self.rules.beside
            )
            if not is_name and not self.is_value(kind):
                return 0
        end = next((i for i in range(at, len(tokens)) if tokens[i][1]), len(tokens))
        return self._longest_of(tuple(k for k, _ in tokens[at:end]), atoms=atoms)

    def is_value(self, kind: int) -> bool:
        """Return whether a word is a value or begins one, as TRUE and NOT do, and is no name."""
        rule, matcher = self.rules.widest, self.rules.matcher
        if self.rules.names and self.rules.names in matcher.rules_for((kind,)):
            return False
        return rule is not None and rule in matcher.begun_by((kind,))

    def _longest_of(self, kinds: tuple[int, ...], *, atoms: bool) -> int:
        known = self._longest.get((atoms, kinds))
        if known is None:
            step, ends = self.rules.recognizer.step, self.rules.recognizer.ends
            known = 0
            for start in self._atoms if atoms else self._starts:
                state = start
                for count, kind in enumerate(kinds, 1):
                    following = step(state, kind)
                    if following is None:
                        break
                    state = following
                    if ends(state):
                        known = max(known, count)
            self._longest[atoms, kinds] = known
        return known

    def closer(self, tokens: Sequence[Token], at: int) -> int | None:
        """Return the index of the closing bracket for the one at an index, if there is one."""
        display = self.lexer.display
        shown = (display[kind] if kind > 0 else "" for kind, _ in tokens[at:])
        length = closer_of(shown)
        return None if length is None else at + length
