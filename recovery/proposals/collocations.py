"""Collocations: which rule a grammar usually has after a word or sign.

With only a few examples, the narrowest rule that reads them all is often too narrow. A grammar that
has ``CA expression`` in one place hardly means ``CA number`` in another, and if an expression
follows every ``word =``, it will follow a new one too. A token that only one rule contains, and
that is a sentence of this rule by itself, is written by the name of that rule: ``name``, not
``NAME``.
"""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from collections.abc import Iterable
from functools import cached_property

from grammar.notation.model import Alternative, Element, Group, Literal, Reference, Repeat, walk
from grammar.parser.recognizer import Recognizer
from recovery.tuning import USUAL_PART, WORD_LIST_PART

#: The two symbols before a place, the nearer one last; empty at the begin of a rule.
Before = tuple[str, str]

_BEGINNING: Before = ("", "")
_A_WORD = "a word"
_SYMBOLS = re.compile(r"('(?:[^'\\]|\\.)*'|\w+)([?*]?)")


def symbols_in(texts: Iterable[str]) -> list[tuple[Before, str]]:
    """Return the tokens and rules of texts in sequence, each with the two symbols before it."""
    out = []
    before = _BEGINNING
    for symbol, suffix in _SYMBOLS.findall(" ".join(texts)):
        out.append((before, symbol))
        if not suffix:  # optional parts are skipped
            before = (before[1], symbol)
    return out


def last_two(texts: Iterable[str]) -> Before:
    """Return the two symbols before whatever follows the texts."""
    return symbols_in((*texts, "NEXT"))[-1][0]


class Collocations:
    """Statistics of one grammar on which symbols follow which."""

    def __init__(self, recognizer: Recognizer) -> None:
        self.grammar = recognizer.grammar
        self._lexer = recognizer.lexer
        self._behind: dict[Before, Counter[str]] = defaultdict(Counter)
        self._seen: set[tuple[Before, int, str, int]] = set()
        for number, rule in enumerate(self.grammar.parser_rules):
            for alternative in rule.alternatives:
                self._sequence(number, alternative, frozenset([_BEGINNING]))

    def usual(self, before: Before) -> dict[str, int]:
        """Return the rules and value tokens that are usual at such places, with their counts."""
        for place in self._places(before):
            found = self._behind.get(place)
            if found:
                many = found.total() / USUAL_PART
                return {symbol: count for symbol, count in found.items() if count >= many}
        return {}

    def _places(self, before: Before) -> list[Before]:
        """Return the kinds of place, the nearest first.

        A place is after this word, or after this sign and this or any word.
        """
        further, nearer = before
        if self._is_word(nearer):
            return [("", nearer)]
        if self._is_word(further):
            return [before, (_A_WORD, nearer)]
        return [before] if further else []

    def _is_word(self, symbol: str) -> bool:
        """Return whether a symbol is a keyword, present or new."""
        kind = self._lexer.kind_of.get(symbol)
        is_word = kind is None or self._lexer.is_keyword(kind)
        return symbol[:1].isupper() and is_word

    # ---------------------------------------------------------------------- reading the grammar

    def _sequence(
        self, rule: int, sequence: Alternative, before: frozenset[Before]
    ) -> frozenset[Before]:
        for element in sequence.elements:
            before = self._element(rule, element, before)
        return before

    def _element(self, rule: int, element: Element, before: frozenset[Before]) -> frozenset[Before]:
        """Return what can precede the symbol after the element."""
        match element:
            case Repeat(item=item, operator=operator):
                after = self._element(rule, item, before)
                if operator != "?":
                    after |= self._element(rule, item, before | after)
                return after if operator == "+" else before | after
            case Group(alternatives=alternatives):
                return frozenset[Before]().union(
                    *(self._sequence(rule, a, before) for a in alternatives)
                )
            case Reference(name=name, span=span):
                return self._noted(rule, name, span[0], before)
            case Literal(text=text, span=span):
                return self._noted(rule, f"'{text}'", span[0], before)
            case _:
                return before

    def _noted(
        self, rule: int, symbol: str, offset: int, before: frozenset[Before]
    ) -> frozenset[Before]:
        places = {place for pair in before for place in self._places(pair)}
        for place in () if symbol[0] == "'" or self._is_word(symbol) else places:
            if (place, rule, symbol, offset) not in self._seen:
                self._seen.add((place, rule, symbol, offset))
                self._behind[place][symbol] += 1
        return frozenset((nearer, symbol) for _, nearer in before)

    # ------------------------------------------------------------------------------- tokens

    @cached_property
    def written_by(self) -> dict[str, str]:
        """The rules for tokens that are a sentence by themselves and that no other rule contains.

        A list of keywords is not such a rule, nor is a rule with several keywords, because only one
        of them may be meant.
        """
        users: dict[str, set[str]] = defaultdict(set)
        alone: set[tuple[str, str]] = set()
        words = sum(map(self._lexer.is_keyword, self._lexer.kind_of.values()))
        for rule in self.grammar.parser_rules:
            if WORD_LIST_PART * len(rule.alternatives) > words:
                continue
            for alternative in rule.alternatives:
                tokens = [e for e in walk(alternative) if isinstance(e, Reference) and e.is_token]
                for token in tokens:
                    users[token.name].add(rule.name)
                first, *others = alternative.elements or (None,)
                left_out = all(isinstance(e, Repeat) and e.operator != "+" for e in others)
                if (
                    isinstance(first, Reference)
                    and (first in tokens and left_out)
                    and (len(rule.alternatives) == 1 or not self._is_word(first.name))
                ):
                    alone.add((first.name, rule.name))
        return {
            token: next(iter(rules))
            for token, rules in users.items()
            if len(rules) == 1 and (token, *rules) in alone
        }
