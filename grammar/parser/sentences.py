"""Sentences of a grammar: the shortest ones through a given rule, and random ones.

A sentence is a list of token names; `Speller` turns it into text. The shortest sentences surround
the failing lines of reproducers and show in which states lines can begin. The random ones are used
to compare the recogniser with ANTLR.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cached_property
from random import Random

from grammar.notation.model import (
    Alternative,
    CharSet,
    Element,
    Grammar,
    Group,
    Literal,
    Reference,
    Repeat,
)
from grammar.notation.wellformed import shortest_length, shortest_lengths
from grammar.parser.lexer import lexer_of


class Sentences:
    """Derives sentences from the parser rules of a grammar."""

    def __init__(self, grammar: Grammar) -> None:
        self.grammar = grammar
        self._rules = {r.name: r for r in grammar.parser_rules}

    @cached_property
    def _costs(self) -> Mapping[str, float]:
        return shortest_lengths(self.grammar)

    def shortest(self, rule: str) -> list[str]:
        """Return the token names of the shortest sentence of ``rule``, without ``EOF``."""
        return list(self._shortest(Reference(rule, (0, 0))))

    def _shortest(self, element: Element) -> Iterator[str]:
        match element:
            case Reference(name=name) if name in self._rules:
                yield from self._shortest_of(self._rules[name].alternatives)
            case Reference(name="EOF"):
                return
            case Reference() | Literal():
                yield self.grammar.token_of(element)
            case Group(alternatives=alternatives):
                yield from self._shortest_of(alternatives)
            case Repeat(item=item, operator=operator):
                if operator == "+":
                    yield from self._shortest(item)

    def _shortest_of(self, alternatives: tuple[Alternative, ...]) -> Iterator[str]:
        best = min(
            alternatives, key=lambda a: sum(shortest_length(e, self._costs) for e in a.elements)
        )
        for element in best.elements:
            yield from self._shortest(element)

    # ----------------------------------------------------------------- through a place

    @cached_property
    def _frames(self) -> dict[str, tuple[list[str], list[str]]]:
        """For each reachable rule the shortest tokens before and after it in a program.

        Found by a search like Dijkstra's over the calls between rules.
        """
        frames: dict[str, tuple[list[str], list[str]]] = {self.grammar.start: ([], [])}
        todo = [self.grammar.start]
        while todo:
            todo.sort(key=lambda n: sum(map(len, frames[n])))
            outer = todo.pop(0)
            before, after = frames[outer]
            for alternative in self._rules[outer].alternatives:
                for left, name, right in self._calls(alternative):
                    candidate = (before + left, right + after)
                    if name not in frames or sum(map(len, candidate)) < sum(map(len, frames[name])):
                        frames[name] = candidate
                        if name not in todo:
                            todo.append(name)
        return frames

    def _calls(self, alternative: Alternative) -> Iterator[tuple[list[str], str, list[str]]]:
        """Yield the rules an alternative calls, with the shortest tokens before and after each."""
        parts = [list(self._shortest(e)) for e in alternative.elements]
        for i, element in enumerate(alternative.elements):
            if isinstance(element, Group | Repeat) or self._is_rule(element):
                left = [t for part in parts[:i] for t in part]
                right = [t for part in parts[i + 1 :] for t in part]
                yield from self._calls_in(element, left, right)

    def _is_rule(self, element: Element) -> bool:
        return isinstance(element, Reference) and element.name in self._rules

    def _calls_in(
        self, element: Element, left: list[str], right: list[str]
    ) -> Iterator[tuple[list[str], str, list[str]]]:
        match element:
            case Reference(name=name) if name in self._rules:
                yield left, name, right
            case Group(alternatives=alternatives):
                for alternative in alternatives:
                    for inner_left, name, inner_right in self._calls(alternative):
                        yield left + inner_left, name, inner_right + right
            case Repeat(item=item):
                yield from self._calls_in(item, left, right)

    @property
    def reachable(self) -> list[str]:
        """Names of the rules that can occur in a program, those nearest to the start rule first."""
        return sorted(self._frames, key=lambda n: sum(map(len, self._frames[n])))

    def frame(self, rule: str) -> tuple[list[str], list[str]]:
        """Return the shortest tokens before and after ``rule`` in a program that uses it."""
        before, after = self._frames[rule]
        return list(before), list(after)

    def through(self, rule: str) -> Iterator[list[str]]:
        """Yield a program for every alternative and every optional part of ``rule``."""
        before, after = self._frames[rule]
        for alternative in self._rules[rule].alternatives:
            for body in self._variants(alternative):
                yield before + body + after

    def _variants(self, alternative: Alternative) -> Iterator[list[str]]:
        parts = [list(self._shortest(e)) for e in alternative.elements]
        yield [t for part in parts for t in part]
        for i, element in enumerate(alternative.elements):
            if not isinstance(element, Group | Repeat):
                continue
            left = [t for part in parts[:i] for t in part]
            right = [t for part in parts[i + 1 :] for t in part]
            for inner in self._element_variants(element):
                if inner != parts[i]:
                    yield left + inner + right

    def _element_variants(self, element: Element) -> Iterator[list[str]]:
        match element:
            case Group(alternatives=alternatives):
                for alternative in alternatives:
                    yield from self._variants(alternative)
            case Repeat(item=item, operator=operator):
                yield list(self._shortest(item))
                yield from self._element_variants(item)
                if operator != "?":
                    yield list(self._shortest(item)) * 2
            case _:
                return

    # --------------------------------------------------------------------------- random

    def random(self, chance: Random, size: int = 60) -> list[str]:
        """Return the token names of a random program of about ``size`` tokens."""
        budget = [size]
        out: list[str] = []
        self._random(Reference(self.grammar.start, (0, 0)), chance, budget, out)
        return out

    def _random(self, element: Element, chance: Random, budget: list[int], out: list[str]) -> None:
        if budget[0] <= 0:
            tokens = list(self._shortest(element))
            out += tokens
            budget[0] -= len(tokens)
            return
        match element:
            case Reference(name=name) if name in self._rules:
                self._random_of(self._rules[name].alternatives, chance, budget, out)
            case Reference(name="EOF"):
                return
            case Reference() | Literal():
                budget[0] -= 1
                out.append(self.grammar.token_of(element))
            case Group(alternatives=alternatives):
                self._random_of(alternatives, chance, budget, out)
            case Repeat(item=item, operator=operator):
                times = int(operator == "+") + int(chance.random() < 0.5)
                while operator != "?" and chance.random() < 0.5 and budget[0] > 0:
                    times += 1
                for _ in range(times):
                    self._random(item, chance, budget, out)

    def _random_of(
        self,
        alternatives: tuple[Alternative, ...],
        chance: Random,
        budget: list[int],
        out: list[str],
    ) -> None:
        for element in chance.choice(alternatives).elements:
            self._random(element, chance, budget, out)


class Speller:
    """Spells tokens: a literal token as its text, any other as its shortest text."""

    def __init__(self, grammar: Grammar) -> None:
        self.grammar = grammar
        self.lexer = lexer_of(grammar)
        texts = {name: text for text, name in grammar.literal_tokens.items()}
        self.samples = {
            rule.name: texts.get(rule.name) or self._sample(rule.name)
            for rule in grammar.rules
            if rule.is_lexer and not rule.is_fragment and not rule.is_skipped
        }

    def _sample(self, name: str) -> str:
        text = "".join(self._spell(Reference(name, (0, 0))))
        kind = self.lexer.kind_of[name]
        chance = Random(name)
        for _ in range(200):  # the shortest text may be a keyword, or match an earlier rule
            if self.lexer.kinds[text] == kind:
                break
            text = "".join(self._spell(Reference(name, (0, 0)), chance))
        return text

    def _spell(self, element: Element, chance: Random | None = None) -> Iterator[str]:
        match element:
            case Reference(name=name):
                yield from self._spell_any(self.grammar.by_name[name].alternatives, chance)
            case Literal(text=text):
                yield text
            case CharSet(ranges=ranges):
                # a letter rather than one of few signs: of [$A-Z] the target may want more than $
                low, high = max(ranges, key=_width) if chance is None else chance.choice(ranges)
                if high - low > 0x1000:  # a negated set: anything plain will do
                    low, high = max(low, ord(" ")), ord("~")
                yield chr(low if chance is None else chance.randint(low, high))
            case Group(alternatives=alternatives):
                yield from self._spell_any(alternatives, chance)
            case Repeat(item=item, operator=operator):
                times = int(operator == "+")
                if chance is not None:
                    times += chance.randint(0, 1 if operator == "?" else 3)
                for _ in range(times):
                    yield from self._spell(item, chance)

    def _spell_any(
        self, alternatives: tuple[Alternative, ...], chance: Random | None
    ) -> Iterator[str]:
        alternative = alternatives[0] if chance is None else chance.choice(alternatives)
        for element in alternative.elements:
            yield from self._spell(element, chance)

    def text(self, tokens: list[str]) -> str:
        """Return the program with these tokens, with one blank between two on a line."""
        out: list[str] = []
        for token in tokens:
            sample = self.samples[token]
            if out and not out[-1].endswith("\n") and not sample.startswith(("\n", "\r")):
                out.append(" ")
            out.append("\n" if sample.strip() == "" else sample)
        return "".join(out)


def _width(characters: tuple[int, int]) -> int:
    return characters[1] - characters[0]
