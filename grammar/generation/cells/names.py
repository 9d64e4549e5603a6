"""Plausible names, at most 24 characters long and unique, and comments."""

from __future__ import annotations

import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from functools import cache
from importlib import resources

from grammar.generation.choices import Choices
from grammar.semantics.types import BOOL, CHAR, INT, REAL, Array, Enumeration, Structure, Type

LONGEST = 24
"""Characters of a name [TYP-05]."""


@dataclass(frozen=True, slots=True)
class Vocabulary:
    """The words of a language from which names and comments are made."""

    trades: tuple[str, ...]
    stations: tuple[str, ...]
    verbs: tuple[str, ...]
    things: tuple[str, ...]
    integers: tuple[str, ...]
    reals: tuple[str, ...]
    truths: tuple[str, ...]
    texts: tuple[str, ...]
    states: tuple[str, ...]
    remarks: tuple[str, ...]
    messages: tuple[str, ...]


@cache
def vocabulary(language: str) -> Vocabulary:
    """Return the words of a language: ``en`` or ``de``."""
    text = (resources.files(__package__) / "texts" / "words.toml").read_text("utf-8")
    return Vocabulary(
        **{kind: tuple(words) for kind, words in tomllib.loads(text)[language].items()}
    )


class Writing(Enum):
    """How a name is composed from words."""

    UPPER = "PART_COUNT"
    TYPED = "nPartCount"
    PLAIN = "PartCount"


_PREFIXES = {"INT": "n", "REAL": "r", "BOOL": "b", "CHAR": "s"}
_PREFIXES |= {"FRAME": "f", "E6POS": "x", "E6AXIS": "a"}


def _prefix(type_: Type) -> str:
    if isinstance(type_, Enumeration):
        return "e"
    return _PREFIXES.get(str(type_), "st" if isinstance(type_, Structure) else "")


class Names:
    """Makes unique names; ``outer`` are the names of the enclosing scope.

    A name consists of two words or more, so none is a keyword.
    """

    __slots__ = ("_outer", "_taken", "choices", "vocabulary", "writing")

    def __init__(
        self, choices: Choices, vocabulary: Vocabulary, writing: Writing, outer: Names | None = None
    ) -> None:
        self.choices = choices
        self.vocabulary = vocabulary
        self.writing = writing
        self._outer = outer
        self._taken: set[str] = set()

    def inner(self, choices: Choices | None = None) -> Names:
        """Return names for an inner scope, which sees the names of this one."""
        return Names(choices or self.choices, self.vocabulary, self.writing, self)

    def is_taken(self, name: str) -> bool:
        """Return whether a name is used here or further out, in any letter case."""
        upper = name.upper()
        names: Names | None = self
        while names is not None:
            if upper in names._taken:
                return True
            names = names._outer
        return False

    def take(self, name: str) -> str:
        """Return the name, with a number appended if it is taken, and mark it as used."""
        found, number = name[:LONGEST], 1
        while self.is_taken(found):
            number += 1
            suffix = f"_{number}" if name[-1].isdigit() else str(number)
            found = name[: LONGEST - len(suffix)] + suffix
        self._taken.add(found.upper())
        return found

    def joined(self, words: Sequence[str], type_: Type | None = None) -> str:
        """Return a name composed of the words in the cell's style."""
        if self.writing is Writing.UPPER:
            return "_".join(words).upper()
        name = "".join(word.capitalize() for word in words)
        is_typed = self.writing is Writing.TYPED and type_ is not None
        return f"{_prefix(type_)}{name}" if is_typed and type_ else name

    def variable(self, type_: Type, _letter: str = "V") -> str:
        """Return a new name for a variable of a type."""
        element = type_.element if isinstance(type_, Array) else type_
        words = self._words(element, self.vocabulary.stations)
        thing = self.choices.pick(self.vocabulary.things)
        return self.take(self.joined((thing, self.choices.pick(words)), element))

    def _words(self, type_: Type | None, others: Sequence[str]) -> Sequence[str]:
        """Return the words for values of a type; ``others`` if it has none of its own."""
        words = self.vocabulary
        if type_ in (INT, REAL):
            return words.integers if type_ == INT else words.reals
        if type_ in (BOOL, CHAR):
            return words.truths if type_ == BOOL else words.texts
        return others

    def routine(self, station: str) -> str:
        """Return a new name for a routine: a verb and the station."""
        words = self.vocabulary
        return self.take(self.joined((self.choices.pick(words.verbs), station)))

    def function(self, result: Type) -> str:
        """Return a new name for a function with this result type."""
        words = self.vocabulary
        thing, station = self.choices.pick(words.things), self.choices.pick(words.stations)
        last = self.choices.pick(self._words(result, (station,)))
        return self.take(self.joined((thing, last, "of")))

    def label(self) -> str:
        """Return a new name for a label."""
        words = ("again", "next", "retry", "cycle", "ready", "once_more")
        return self.take(
            self.joined((self.choices.pick(words), self.choices.pick(("part", "loop"))))
        )

    def remark(self) -> str:
        """Return a comment, without its semicolon."""
        return self._filled(self.choices.pick(self.vocabulary.remarks))

    def message(self) -> str:
        """Return a text for the operator, with its quotation marks."""
        return f'"{self._filled(self.choices.pick(self.vocabulary.messages))}"'

    def _filled(self, text: str) -> str:
        words = self.vocabulary
        return text.replace("{station}", self.choices.pick(words.stations)).replace(
            "{thing}", self.choices.pick(words.things)
        )
