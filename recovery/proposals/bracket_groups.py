"""Groups in brackets that one rule of the grammar reads: ``[…]`` is an index, ``{…}`` an aggregate.

What such a group may hold is the affair of its rule. So where a line fails ahead of one, an edit
calls the rule, whether it reads this group already or not.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property

from grammar.notation.model import Element, Literal, walk
from grammar.parser.sentences import Sentences
from recovery.brackets import BRACKETS, closer_of
from recovery.forms.rule_matcher import RuleMatcher
from recovery.forms.symbols import Token


class BracketGroups:
    """The brackets that belong to one rule of a grammar each."""

    def __init__(self, matcher: RuleMatcher) -> None:
        self._matcher = matcher
        self._lexer = matcher.recognizer.lexer

    def as_read(self, words: Sequence[Token], first: int) -> list[Token]:
        """Return the words; groups that their rules do not read become the shortest that they read.

        Only groups that begin at the index ``first`` or behind it are replaced.
        """
        out = list(words[:first])
        place = first
        while place < len(words):
            rule = self.rule_of(words[place])
            texts = (self._lexer.display[kind] for kind, _ in words[place:])
            length = (closer_of(texts) or 0) + 1 if rule else 1
            group = words[place : place + length]
            if length > 1 and rule not in self._matcher.rules_for(tuple(k for k, _ in group)):
                group = self._shortest(rule)
            out += group
            place += length
        return out

    def are_torn(self, rule: str, symbols: Sequence[str]) -> bool:
        """Return whether symbols, written in a rule, have a bracket that belongs to another one."""
        text = " ".join(symbols)
        return any(f"'{sign}'" in text for sign, owner in self.rules.items() if owner != rule)

    def rule_of(self, token: Token) -> str:
        """Return the rule to which an opening bracket belongs; empty for any other token."""
        kind = token[0]
        return self.rules.get(self._lexer.display[kind], "") if kind > 0 else ""

    def _shortest(self, rule: str) -> list[Token]:
        recognizer = self._matcher.recognizer
        names = Sentences(recognizer.grammar).shortest(rule)
        return [(recognizer.lexer.kind_of[name], None) for name in names]

    @cached_property
    def rules(self) -> Mapping[str, str]:
        """For each bracket that only one rule writes, around all that it reads, this rule."""
        grammar = self._matcher.recognizer.grammar
        found = {}
        for opening, closing in BRACKETS.items():
            writers = [
                rule
                for rule in grammar.parser_rules
                if any(_text(e) == opening for e in walk(rule))
            ]
            if len(writers) == 1 and all(
                a.elements and (_text(a.elements[0]), _text(a.elements[-1])) == (opening, closing)
                for a in writers[0].alternatives
            ):
                found[opening] = writers[0].name
        return found


def _text(element: Element) -> str:
    return element.text if isinstance(element, Literal) else ""
