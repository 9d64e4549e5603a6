"""The grammar as data: rules, alternatives and elements, each with the text it was parsed from.

Every rule keeps its exact text, and a grammar keeps the text between its rules. Printing is
therefore concatenation, comments and layout survive, and an edit (`grammar.notation.edits`) changes
the text of one rule only. For the same reason spans are offsets into the text of the rule.
"""

from __future__ import annotations

import hashlib
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import field, replace
from functools import cached_property
from typing import Literal as OneOf

from support.input_error import InputError
from support.lazy_dataclass import dataclass

__all__ = [
    "MAX_CODE_POINT",
    "Alternative",
    "CharRange",
    "CharSet",
    "Element",
    "Grammar",
    "GrammarError",
    "Group",
    "Literal",
    "Reference",
    "Repeat",
    "Rule",
    "Span",
    "characters_of",
    "complement",
    "normalised_ranges",
    "reached",
    "referred",
    "walk",
]

Span = tuple[int, int]
#: Code points, both ends included.
CharRange = tuple[int, int]
MAX_CODE_POINT = 0x10FFFF


class GrammarError(InputError):
    """The text is not a grammar of the supported dialect; the message names the line."""


@dataclass(frozen=True, slots=True)
class Reference:
    """A reference to a rule or token by its name; token names begin with a capital letter."""

    name: str
    span: Span = field(compare=False)

    @property
    def is_token(self) -> bool:
        """Whether the name is that of a token."""
        return self.name[0].isupper()


@dataclass(frozen=True, slots=True)
class Literal:
    """A quoted text, without its quotes and with escapes resolved."""

    text: str
    span: Span = field(compare=False)


@dataclass(frozen=True, slots=True)
class CharSet:
    """One character from sorted, disjoint ranges: ``[a-z]``, ``~["]``, ``'a'..'z'``, ``.``."""

    ranges: tuple[CharRange, ...]
    span: Span = field(compare=False)


@dataclass(frozen=True, slots=True)
class Group:
    """Alternatives in parentheses."""

    alternatives: tuple[Alternative, ...]
    span: Span = field(compare=False)


@dataclass(frozen=True, slots=True)
class Repeat:
    """An element with a suffix: ``?``, ``*`` or ``+``."""

    item: Element
    operator: OneOf["?", "*", "+"]
    span: Span = field(compare=False)


Element = Reference | Literal | CharSet | Group | Repeat


@dataclass(frozen=True, slots=True)
class Alternative:
    """A sequence of elements, possibly empty, with its label (after ``#``) if it has one."""

    elements: tuple[Element, ...]
    label: str | None
    span: Span = field(compare=False)


@dataclass(frozen=True, slots=True)
class Rule:
    """One parser or lexer rule with its exact text, from the name to ``;``."""

    name: str
    alternatives: tuple[Alternative, ...]
    is_fragment: bool = False
    commands: tuple[str, ...] = ()
    text: str = field(default="", compare=False)

    @property
    def is_lexer(self) -> bool:
        """Whether this is a lexer rule."""
        return self.name[0].isupper()

    @property
    def is_skipped(self) -> bool:
        """Whether the parser never sees the token, because of ``skip`` or a channel."""
        return any(c == "skip" or c.startswith("channel(") for c in self.commands)

    def source_of(self, node: Element | Alternative) -> str:
        """Return the text of a part of this rule, as written."""
        return self.text[node.span[0] : node.span[1]]

    def in_line(self, node: Element | Alternative) -> str:
        """Return the text of a part with single blanks between its words."""
        return " ".join(self.source_of(node).split())


@dataclass(frozen=True)
class Grammar:
    """A grammar file: rules in order, and the text around them.

    ``gaps[i]`` is the text before rule ``i``; the last one follows the last rule.
    """

    name: str
    options: tuple[tuple[str, str], ...]
    rules: tuple[Rule, ...]
    gaps: tuple[str, ...]

    @cached_property
    def by_name(self) -> dict[str, Rule]:
        """The rules by their names."""
        return {rule.name: rule for rule in self.rules}

    @cached_property
    def parser_rules(self) -> tuple[Rule, ...]:
        """The rules that are no lexer rules, in order."""
        return tuple(rule for rule in self.rules if not rule.is_lexer)

    @property
    def start(self) -> str:
        """Name of the start rule, which is the first parser rule."""
        return self.parser_rules[0].name

    @property
    def case_insensitive(self) -> bool:
        """Whether letters match in either case."""
        return ("caseInsensitive", "true") in self.options

    @cached_property
    def text(self) -> str:
        """The text of the file, byte for byte if nothing was edited."""
        pieces = [self.gaps[0]]
        for rule, gap in zip(self.rules, self.gaps[1:], strict=True):
            pieces += (rule.text, gap)
        return "".join(pieces)

    @cached_property
    def sha256(self) -> str:
        """SHA-256 of the text, the key of cached results."""
        return hashlib.sha256(self.text.encode()).hexdigest()

    @cached_property
    def literal_tokens(self) -> dict[str, str]:
        """Token names by their literal, for tokens that are one literal.

        The literal is in upper case if the grammar ignores case.
        """
        found: dict[str, str] = {}
        for rule in self.rules:
            if rule.is_lexer and not rule.is_fragment and len(rule.alternatives) == 1:
                elements = rule.alternatives[0].elements
                if len(elements) == 1 and isinstance(elements[0], Literal):
                    found.setdefault(self.fold(elements[0].text), rule.name)
        return found

    def fold(self, text: str) -> str:
        """Return ``text`` as the lexer compares it: in upper case if the grammar ignores case."""
        return text.upper() if self.case_insensitive else text

    def token_of(self, element: Reference | Literal) -> str:
        """Return the name of the token that a reference or literal in a parser rule stands for."""
        if isinstance(element, Reference):
            return element.name
        return self.literal_tokens[self.fold(element.text)]

    def with_rule(self, rule: Rule) -> Grammar:
        """Return the same grammar with the rule of that name replaced."""
        index = next(i for i, old in enumerate(self.rules) if old.name == rule.name)
        changed = replace(self, rules=(*self.rules[:index], rule, *self.rules[index + 1 :]))
        if not rule.is_lexer:  # the tokens are the same: no need to gather them again
            changed.__dict__["literal_tokens"] = self.literal_tokens
        return changed


def walk(node: Element | Alternative | Rule) -> Iterator[Element]:
    """Yield every element inside a node, the outermost first; the node too if it is one."""
    match node:
        case Rule(alternatives=alternatives):
            for alternative in alternatives:
                yield from walk(alternative)
        case Alternative(elements=elements):
            for element in elements:
                yield from walk(element)
        case Group(alternatives=alternatives):
            yield node
            for alternative in alternatives:
                yield from walk(alternative)
        case Repeat(item=item):
            yield node
            yield from walk(item)
        case _:
            yield node


def referred(node: Alternative | Rule) -> set[str]:
    """Return the names of the rules and tokens to which a rule or an alternative refers."""
    return {element.name for element in walk(node) if isinstance(element, Reference)}


def reached(calls: Mapping[str, Collection[str]], name: str) -> set[str]:
    """Return all names that can be reached from ``name`` by one call or more."""
    seen: set[str] = set()
    todo = [name]
    while todo:
        fresh = set(calls.get(todo.pop(), ())) - seen
        seen |= fresh
        todo += fresh
    return seen


def characters_of(element: Element) -> tuple[CharRange, ...] | None:
    """Return the characters of which an element accepts one; ``None`` if it is no such element."""
    match element:
        case Literal(text=text) if len(text) == 1:
            return ((ord(text), ord(text)),)
        case CharSet(ranges=ranges):
            return ranges
        case Group(alternatives=alternatives):
            found = [characters_of(a.elements[0]) for a in alternatives if len(a.elements) == 1]
            if len(found) == len(alternatives) and None not in found:
                return normalised_ranges([pair for ranges in found for pair in ranges or ()])
    return None


def normalised_ranges(ranges: Sequence[CharRange]) -> tuple[CharRange, ...]:
    """Return the same characters as sorted, disjoint, non-touching ranges."""
    merged: list[CharRange] = []
    for low, high in sorted(ranges):
        if merged and low <= merged[-1][1] + 1:
            merged[-1] = (merged[-1][0], max(merged[-1][1], high))
        else:
            merged.append((low, high))
    return tuple(merged)


def complement(ranges: Sequence[CharRange]) -> tuple[CharRange, ...]:
    """Return the ranges of all other characters; ``ranges`` are `normalised_ranges`."""
    found: list[CharRange] = []
    start = 0
    for low, high in ranges:
        if start < low:
            found.append((start, low - 1))
        start = high + 1
    if start <= MAX_CODE_POINT:
        found.append((start, MAX_CODE_POINT))
    return tuple(found)
