"""Which rules read given tokens: as a whole sentence, or as the beginning of one."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from functools import cached_property

from grammar.parser.recognizer import Recognizer, State
from recovery.forms.symbols import Token
from recovery.tuning import LONGEST_BEGINNING_KEPT, MOST_ANSWERS_KEPT, WORD_LIST_PART


class RuleMatcher:
    """Matches tokens against the rules of one grammar."""

    def __init__(self, recognizer: Recognizer) -> None:
        self.recognizer = recognizer
        self._begun: dict[tuple[int, ...], Mapping[str, State]] = {}
        self._spans: dict[tuple[int, ...], frozenset[str]] = {}
        self._a_name = (recognizer.lexer.name_kind,)

    @cached_property
    def _entries(self) -> dict[str, State]:
        """The state at the start of each rule, except the start rule."""
        network = self.recognizer.network
        return {
            rule: self.recognizer.at_rule(rule)
            for rule in network.entry
            if rule != self.recognizer.grammar.start
        }

    def multi_line_rules(self, kinds: Sequence[int]) -> list[str]:
        """Return the rules that begin with this line and continue after it."""
        ends = self.recognizer.ends
        return [rule for rule, state in self._read(tuple(kinds)).items() if not ends(state)]

    def rules_for(self, kinds: tuple[int, ...]) -> frozenset[str]:
        """Return the rules of which these tokens are a whole sentence."""
        found = self._spans.get(kinds)
        if found is None:
            if len(self._spans) >= MOST_ANSWERS_KEPT:
                self._spans.clear()
            ends = self.recognizer.ends
            read = self._read(kinds).items()
            found = self._spans[kinds] = frozenset(rule for rule, state in read if ends(state))
        return found

    def begun_by(self, kinds: tuple[int, ...]) -> frozenset[str]:
        """Return the rules of which these tokens begin a sentence."""
        return frozenset(self._read(kinds))

    def _read(self, kinds: tuple[int, ...]) -> Mapping[str, State]:
        """Return the rules that can begin with these tokens, with the state after them.

        Results for prefixes are cached, so a phrase is read one token further than the last.
        """
        known = len(kinds)
        while known and kinds[:known] not in self._begun:
            known -= 1
        states = self._begun[kinds[:known]] if known else self._entries
        for count in range(known, len(kinds)):
            following = {rule: self.recognizer.step(s, kinds[count]) for rule, s in states.items()}
            states = {rule: state for rule, state in following.items() if state is not None}
            if count < LONGEST_BEGINNING_KEPT:
                if len(self._begun) >= MOST_ANSWERS_KEPT:
                    self._begun.clear()
                self._begun[kinds[: count + 1]] = states
        return states

    def is_more_than_a_name(self, kinds: tuple[int, ...]) -> bool:
        """Return whether some rule reads the tokens, but not with a name as their first."""
        rules = self.rules_for(kinds) - self.keyword_lists
        lexer = self.recognizer.lexer
        if rules and lexer.is_keyword(kinds[0]):
            rules -= self.rules_for((*self._a_name, *kinds[1:]))
        return bool(rules)

    @cached_property
    def keyword_lists(self) -> frozenset[str]:
        """Rules that read many keywords alone, and so tell little about any of them."""
        lexer = self.recognizer.lexer
        keywords = [kind for kind in lexer.kind_of.values() if lexer.is_keyword(kind)]
        counts = Counter(rule for kind in keywords for rule in self.rules_for((kind,)))
        return frozenset(
            rule for rule, count in counts.items() if WORD_LIST_PART * count > len(keywords)
        )

    @cached_property
    def value_rules(self) -> frozenset[str]:
        """Rules that read a name as well as values of other kinds."""
        lexer = self.recognizer.lexer
        kinds = [(k,) for k in lexer.kind_of.values() if lexer.has_value(k)]
        others = frozenset[str]().union(*(self.rules_for(k) for k in kinds if k != self._a_name))
        return self.rules_for(self._a_name) & others

    def may_be_a_name(self, kind: int) -> bool:
        """Return whether a token is a keyword that some rules read like a name."""
        is_word = self.recognizer.lexer.is_keyword(kind)
        return is_word and bool(self.rules_for((kind,)) - self.keyword_lists)

    def sign(self, token: Token) -> str | None:
        """Return what a rule writes for a keyword or sign; ``None`` for a token with a value."""
        kind, word = token
        return None if word is None and self.recognizer.lexer.has_value(kind) else self.text(token)

    def text(self, token: Token) -> str | None:
        """Return what a rule writes for a token; ``None`` for what is no token."""
        kind, word = token
        return word or (self.recognizer.lexer.spelled(kind) if kind >= 0 else None)
