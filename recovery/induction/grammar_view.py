"""The view of a grammar for folds: which alternatives are whole lines, and their elements.

Some reserved words are of one kind, as ``INT`` and ``REAL`` are: those in a rule together with
names, as in the rule of types.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from functools import cached_property
from itertools import zip_longest
from typing import NamedTuple

from grammar.notation.addresses import Address, sequences
from grammar.notation.edits import Insert, Replace
from grammar.notation.model import Alternative, Element, Group, Literal, Reference, Repeat, Rule
from grammar.parser.recognizer import Recognizer
from recovery.forms.loose import is_loose
from recovery.forms.operand_rules import OperandRules, is_optional
from recovery.forms.samples import samples_of
from recovery.forms.symbol_reader import SymbolReader
from recovery.forms.symbols import Symbol
from recovery.forms.writer import FormWriter
from recovery.induction.steps import InferredStep
from recovery.proposals.grammar_profile import GrammarProfile
from recovery.tuning import RULE_SYMBOLS


class Place(NamedTuple):
    """Elements side by side in a rule, with the address of the first one."""

    rule: str
    at: Address
    elements: Sequence[Element]


class GrammarView:
    """The lines of one grammar.

    ``types`` are the words of a kind, ``kind`` is the name of the rule of these words, which may
    not exist yet.
    """

    def __init__(self, recognizer: Recognizer, operands: Iterable[tuple[int, ...]]) -> None:
        """Look at a grammar; ``operands`` of the corpus define what is narrow."""
        self.grammar = recognizer.grammar
        self.lexer = recognizer.lexer
        self.rules = OperandRules(recognizer)
        self.profile = GrammarProfile(recognizer)
        self.writer = FormWriter(SymbolReader(self.rules), operands)
        self.types = (self.rules.type_words | self.rules.named_words) - {self.lexer.name}
        self.kind = f"{next(iter(self.rules.type_rules), '')}Word"

    @cached_property
    def line_rules(self) -> Sequence[Rule]:
        """The parser rules except those of expressions."""
        return [r for r in self.grammar.parser_rules if r.name not in self.rules.recursive]

    @cached_property
    def reserved(self) -> frozenset[str]:
        """The reserved words that are neither names nor words of a kind."""
        words = {w for w, kind in self.lexer.kind_of.items() if self.lexer.is_keyword(kind)}
        return frozenset(words - self.types)

    def source(self, rule: str, elements: Sequence[Element]) -> str:
        """Return elements as a rule writes them."""
        return " ".join(map(self.grammar.by_name[rule].source_of, elements))

    def is_ending(self, element: Element) -> bool:
        """Return whether an element is a word, or a choice of words, that may be missing."""
        return bool(self.ending_words(element))

    def ending_words(self, element: Element) -> frozenset[str]:
        """Return the words of such an element; empty if it is none."""
        words = frozenset[str]()
        if isinstance(element, Repeat) and is_optional(element):
            words = self.words(element.item)
        return frozenset() if self.lexer.name in words else words  # any name is no word

    def alternative(self, rule: str, number: int) -> Alternative:
        """Return an alternative of a rule by its number, counted from 1."""
        return self.grammar.by_name[rule].alternatives[number - 1]

    @cached_property
    def families(self) -> Sequence[tuple[str, str, list[int]]]:
        """Rules and words, with the numbers of the alternatives that the word begins.

        Those with most alternatives come first; each has at least one. For a word of a kind
        `kind` stands.
        """
        return sorted(self._families(), key=lambda f: (-len(f[2]), f[:2]))

    def _families(self) -> Iterator[tuple[str, str, list[int]]]:
        for rule in self.line_rules:
            if all(len(a.elements) == 1 for a in rule.alternatives):
                continue
            found: dict[str, list[int]] = defaultdict(list)
            for number in range(1, len(rule.alternatives) + 1):
                head = self.head(self.line(rule.name, number))
                if head:
                    found[head].append(number)
            yield from ((rule.name, head, numbers) for head, numbers in found.items())

    def lines(self) -> Iterator[tuple[Rule, int, Sequence[Element]]]:
        """Yield the alternatives that are one line of several elements: rule, number, elements."""
        for rule in self.grammar.parser_rules:
            for number in range(1, 1 + len(rule.alternatives)):
                elements = self.line(rule.name, number)
                if len(elements) > 1:
                    yield rule, number, elements

    def line(self, rule: str, number: int) -> Sequence[Element]:
        """Return the elements of an alternative without its line end; none if it has more lines."""
        elements = self.alternative(rule, number).elements
        source = self.grammar.by_name[rule].source_of
        if elements and source(elements[-1]) == self.profile.line_end:
            elements = elements[:-1]
        called = {e.name for e in elements if isinstance(e, Reference)}
        return () if called & {self.profile.line_end, self.lexer.line_end} else elements

    def head(self, elements: Sequence[Element]) -> str:
        """Return the first word of a line, `kind` if it is of that kind; empty if there is none."""
        for element, following in zip_longest(elements, elements[1:]):
            if is_optional(element):
                continue
            words = self.words(element)
            if words and words <= self.types and self.is_name(following):
                return self.kind
            is_word = len(words) == 1 and len(elements) > 1 and self.lexer.name not in words
            return min(words) if is_word else ""
        return ""

    def is_name(self, element: Element | None) -> bool:
        """Return whether an element is a name."""
        names = {self.lexer.name, self.rules.names}
        return isinstance(element, Reference) and element.name in names

    def is_kind(self, element: Element) -> bool:
        """Return whether an element is the type in front of a declared name, or ends with one."""
        words = self.words(element)
        if isinstance(element, Group) and not words:
            return all(self.is_kind(e) for a in element.alternatives for e in a.elements[-1:])
        is_choice = isinstance(element, Reference) and element.name in self.rules.type_rules
        return is_choice or bool(words and words <= self.types)

    def words(self, element: Element) -> frozenset[str]:
        """Return the tokens of which an element is a choice; empty if it reads anything else."""
        match element:
            case Reference(name=name, is_token=True):
                return frozenset({name})
            case Reference(name=name) if self.profile.vocabulary.is_set_of_words(name):
                return self.profile.vocabulary.words_of(name)
            case Group(alternatives=alternatives):
                firsts = [self.words(a.elements[0]) for a in alternatives if len(a.elements) == 1]
                is_all = len(firsts) == len(alternatives) and all(firsts)
                return frozenset[str]().union(*firsts) if is_all else frozenset()
            case _:
                return frozenset()

    def elements(self) -> Iterator[tuple[Rule, Address, Element, Sequence[Element]]]:
        """Yield all elements of the line rules: rule, address, element, and those ahead of it."""
        for rule in self.line_rules:
            for address, sequence in sequences(rule):
                for place, element in enumerate(sequence.elements):
                    yield rule, (*address, place + 1), element, sequence.elements[:place]

    def alike(
        self, places: Sequence[Place], title: str, form: str | None = None
    ) -> Iterator[InferredStep]:
        """Yield the same text for places that are alike: ``form``, or what reads all they have."""
        sources = [self.source(rule, elements) for rule, _, elements in places]
        if form is None and len({*sources}) > 1:
            shapes = (s for _, _, elements in places for s in samples_of(self.rules, elements))
            form = self.form(dict.fromkeys(shapes))
        edits = tuple(
            Replace(rule, at, form, len(elements)) if elements else Insert(rule, at, form)
            for (rule, at, elements), source in zip(places, sources, strict=True)
            if form and source != form
        )
        if edits:
            yield InferredStep(title, edits, (), breadth=RULE_SYMBOLS * len(edits))

    def form(self, shapes: Iterable[tuple[Symbol, ...]]) -> str | None:
        """Return the form of distinct shapes; ``None`` if there is none, or only a loose one.

        No line needs a fold, so it must not read a line that is shorter than all shapes.
        """
        some = list(shapes)
        form = self.writer.form(some)
        return None if form and is_loose(form, some, counts_words=True) else form


def item_of(element: Element) -> tuple[Element, str]:
    """Return what an element repeats, or itself, and how often."""
    return (element.item, element.operator) if isinstance(element, Repeat) else (element, "")


def sign_of(element: Element | None) -> str:
    """Return what a rule writes for an element that is one sign; empty for any other element."""
    return f"'{element.text}'" if isinstance(element, Literal) else ""
