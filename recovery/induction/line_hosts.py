"""The lines that a grammar contains, and the rules to which a failing line could belong."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from functools import cached_property

from grammar.notation.addresses import Address, sequences
from grammar.notation.model import Element, Group, Reference, Repeat, walk
from recovery.induction.line_symbols import LineSymbols


class LineHosts:
    """The rules of a grammar in which some failing lines could be alternatives."""

    def __init__(self, at: LineSymbols) -> None:
        self.at = at

    @cached_property
    def leading(self) -> dict[str, int]:
        """The words with which alternatives begin, and of how many; word lists are left out."""
        found: dict[str, int] = defaultdict(int)
        for _, _, first in self._alternatives():
            for word in self.words_of(first[0]):
                found[word] += 1
        return found

    def _alternatives(self) -> Iterator[tuple[str, int, tuple[Element, ...]]]:
        """Alternatives that may be a line: rule, number, and the elements of the first line."""
        end = self.at.profile.line_end
        for rule in self.at.grammar.parser_rules:
            if rule.name in self.at.rules.recursive:
                continue
            is_choice = len(rule.alternatives) > 1
            if is_choice and self.at.profile.vocabulary.is_set_of_words(rule.name):
                continue
            for number, alternative in enumerate(rule.alternatives, 1):
                elements = alternative.elements
                ends = [i for i, e in enumerate(elements) if rule.source_of(e) == end]
                first = elements[: ends[0]] if ends else elements
                if len(first) > 1 or (first and len(rule.alternatives) == 1):
                    yield rule.name, number, first

    @cached_property
    def all_lines(self) -> list[tuple[str, Address, tuple[Element, ...]]]:
        """Alternatives that may be a line, then the lines within blocks, with their places."""
        outer = ((rule, (number, 1), first) for rule, number, first in self._alternatives())
        return [*outer, *self._inner_lines()]

    def _inner_lines(self) -> Iterator[tuple[str, Address, tuple[Element, ...]]]:
        """Yield the lines within blocks and at their end: rule, first index, elements."""
        end = self.at.profile.line_end
        for rule in self.at.grammar.parser_rules:
            for address, sequence in sequences(rule):
                elements = sequence.elements
                ends = [i for i, e in enumerate(elements) if rule.source_of(e) == end]
                starts = [0] * (len(address) > 1) + [i + 1 for i in ends]
                for begin in starts if ends else ():
                    start = begin
                    stop = next((i for i in ends if i >= start), len(elements))
                    while start < stop and not self.is_within_line(elements[start]):
                        start += 1  # the lines of a body come first
                    if start < stop:
                        yield rule.name, (*address, start + 1), elements[start:stop]

    def is_within_line(self, element: Element) -> bool:
        """Return whether an element reads nothing that contains a line end."""
        called = {e.name for e in walk(element) if isinstance(e, Reference) and not e.is_token}
        return called <= self.at.rules.within_lines

    def of(self, number: int) -> tuple[str, ...]:
        """Return rules that a line could be where it begins, those that end with a line end last.

        Where all alternatives of a rule are blocks, no line alone is another one.
        """
        before = self.at.lines[number].form.before
        if before not in self._hosts_of:
            entered = self.entered(number) - self.at.profile.choices_of_blocks
            lines = sorted(entered & self.at.profile.choices_of_lines)
            self._hosts_of[before] = tuple(sorted(entered & self._whole_lines) + lines)
        return self._hosts_of[before]

    def ending(self, host: str) -> str:
        """Return the end of an alternative of a rule: a line end, if its alternatives have one."""
        profile = self.at.profile
        return f" {profile.line_end}" if profile.closing(host) else ""

    def entered(self, number: int) -> frozenset[str]:
        """Return rules that may begin where a line does."""
        recognizer = self.at.recognizer
        return recognizer.entered(recognizer.restore(self.at.lines[number].form.before))

    @cached_property
    def _hosts_of(self) -> dict[object, tuple[str, ...]]:
        return {}

    @cached_property
    def _whole_lines(self) -> frozenset[str]:
        """Rules that are all of a line but its end, in a loop or as they gather alternatives."""
        ends = {*self.at.profile.line_ends, self.at.lexer.line_end}
        found: set[str] = set()
        for rule in self.at.grammar.parser_rules:
            for _, sequence in sequences(rule):
                called = [
                    inner.name if isinstance(inner, Reference) else ""
                    for e in sequence.elements
                    for inner in [e.item if isinstance(e, Repeat) else e]
                ]
                found.update(
                    name
                    for before, name, behind in zip(["", *called], called, called[1:], strict=False)
                    if behind in ends and (not before or before in ends)
                )
        looped = {
            e.name for *_, line, _ in self.looped for e in walk(line) if isinstance(e, Reference)
        }
        found &= self.at.rules.reaches.keys()
        return frozenset(n for n in found if n in looped or self.at.profile.is_hub(n))

    @cached_property
    def looped(self) -> list[tuple[str, Address, Element, str]]:
        """Loops ``(x NEWLINE)*``: the rule that has one, its place, ``x``, and the line end."""
        end = self.at.profile.line_end
        return [
            (rule.name, (*address, place), element.item.alternatives[0].elements[0], text)
            for rule in self.at.grammar.parser_rules
            for address, sequence in sequences(rule)
            for place, element in enumerate(sequence.elements, 1)
            if isinstance(element, Repeat) and isinstance(element.item, Group)
            if element.operator != "?" and len(element.item.alternatives) == 1
            if len(element.item.alternatives[0].elements) == 2
            if (text := rule.source_of(element.item.alternatives[0].elements[1]))
            in (end, f"{end}+")
        ]

    @cached_property
    def written_out(self) -> frozenset[str]:
        """Rules that are all of a line but its end in a choice that no rule of its own gathers."""
        found = set()
        for rule in self.at.grammar.parser_rules:
            for address, sequence in sequences(rule):
                first, *others = sequence.elements or (None,)
                ends = [rule.source_of(e) for e in others]
                if len(address) > 1 and ends == [self.at.profile.line_end]:
                    found.update([first.name] if isinstance(first, Reference) else [])
        return frozenset(found & self.at.rules.reaches.keys())

    def words_of(self, element: Element) -> frozenset[str]:
        """Return the words of an element that is one word or a choice of words, without names."""
        match element:
            case Reference(name=name, is_token=True) if name.isupper():
                return frozenset({name})
            case Reference(name=name, is_token=False):
                words = self.at.profile.vocabulary.words_of(name)
                kind_of, is_keyword = self.at.lexer.kind_of, self.at.lexer.is_keyword
                return words if all(is_keyword(kind_of[w]) for w in words) else frozenset()
            case Group(alternatives=alternatives):
                return frozenset(
                    w
                    for a in alternatives
                    if len(a.elements) == 1
                    for w in self.words_of(a.elements[0])
                )
            case Repeat(item=item):
                return self.words_of(item)
            case _:
                return frozenset()
