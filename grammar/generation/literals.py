"""Literals: constants of each type, aggregates, and initial values."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache
from itertools import product
from typing import Final

from grammar.generation.choices import Choices
from grammar.semantics.predefined import System
from grammar.semantics.types import BOOL, CHAR, INT, REAL, Array, Enumeration, Structure, Type

#: A text of any length.
TEXT: Final = Array(CHAR, (None,))

#: The path to a part: literal text, or the size of a dimension for which to draw an index.
Path = tuple[str | int, ...]


def predefined(name: str) -> Type:
    """Return a predefined type."""
    return System.load().types[name]


def structure(name: str) -> Structure:
    """Return a predefined structure."""
    found = predefined(name)
    assert isinstance(found, Structure)
    return found


POSES: Final = tuple(structure(name) for name in ("FRAME", "POS", "E3POS", "E6POS"))
AXIS_TYPES: Final = tuple(structure(name) for name in ("AXIS", "E3AXIS", "E6AXIS"))


@cache
def parts(type_: Type) -> Mapping[Type, tuple[Path, ...]]:
    """Return the paths to the parts of a type, by the type of the part; itself included.

    An array of open size is taken to have two elements in each dimension, which every array that is
    passed has.
    """
    found: dict[Type, list[Path]] = {type_: [()]}
    ways: list[tuple[Path, Type]] = []
    if isinstance(type_, Structure):
        ways = [((f".{member.name}",), member.type) for member in type_.members]
    elif isinstance(type_, Array):
        way: Path = ("[",)
        for place, size in enumerate(type_.sizes):
            way += (",",) * (place > 0) + (2 if size is None else size,)
        ways = [((*way, "]"), type_.element)]
    for way, inner in ways:
        for part, paths in parts(inner).items():
            found.setdefault(part, []).extend(way + path for path in paths)
    return {part: tuple(paths) for part, paths in found.items()}


def elements(type_: Array) -> Iterator[str]:
    """Yield the indices of all elements, as written, in ascending order."""
    for place in product(*(range(1, (size or 0) + 1) for size in type_.sizes)):
        yield ",".join(map(str, place))


def type_name(type_: Type) -> str:
    """Return the name of a type in a declaration; for an array that of its elements."""
    return type_name(type_.element) if isinstance(type_, Array) else str(type_)


def declarator(type_: Type, name: str, *, is_open: bool = False) -> str:
    """Return a name with its array sizes: ``A[2,3]``, or ``A[,]`` if they are open."""
    if not isinstance(type_, Array):
        return name
    return f"{name}[{','.join('' if is_open or n is None else str(n) for n in type_.sizes)}]"


@dataclass(frozen=True, slots=True)
class Literals:
    """Constants to choose from, and how often they take one form or another, in percent.

    ``large`` are integers that are rarely drawn; ``negative_integers`` and ``negative_reals`` are
    the shares with a sign. ``named`` is the share of aggregates with a type prefix, ``incomplete``
    the share of components that are left out. ``makers`` generate the values of some types, by type
    name.
    """

    integers: tuple[str, ...]
    reals: tuple[str, ...]
    texts: tuple[str, ...]
    letters: str
    large: tuple[str, ...] = ()
    negative_integers: int = 15
    negative_reals: int = 20
    named: int = 25
    incomplete: int = 0
    comma: str = ","
    makers: Mapping[str, Callable[[Choices], str]] = field(default_factory=dict)

    def constant(self, choices: Choices, type_: Type, *, is_signed: bool = True) -> str:
        """Return a constant; ``is_signed`` says that a sign may precede it."""
        if type_ == INT:
            pool = self.large if self.large and choices.chance(3) else self.integers
            text = choices.pick(pool)
            is_negative = is_signed and text.isdigit() and choices.chance(self.negative_integers)
            return f"-{text}" if is_negative else text
        if type_ == REAL:
            text = choices.pick(self.reals)
            return f"-{text}" if is_signed and choices.chance(self.negative_reals) else text
        if type_ == BOOL:
            return choices.pick(("TRUE", "FALSE"))
        if type_ == CHAR:
            return f'"{choices.pick(self.letters)}"'
        if isinstance(type_, Enumeration):
            return f"#{choices.pick(type_.constants)}"
        if isinstance(type_, Structure):
            return self.aggregate(choices, type_)
        assert isinstance(type_, Array), type_
        return f'"{choices.pick(self.texts)}"'

    def aggregate(self, choices: Choices, type_: Structure, *, is_full: bool = False) -> str:
        """Return an aggregate; its first component is always present, the others nearly always."""
        maker = self.makers.get(type_.name)
        if maker is not None:
            return maker(choices)
        written: list[str] = []
        for place, member in enumerate(type_.members):
            if place and not is_full and self.incomplete and choices.chance(self.incomplete):
                continue
            if isinstance(member.type, Array):
                written += self._elements(choices, member.name, member.type)
            elif isinstance(member.type, Structure):
                value = self.aggregate(choices, member.type, is_full=is_full)
                written.append(f"{member.name} {value}")
            else:
                written.append(f"{member.name} {self.constant(choices, member.type)}")
        prefix = f"{type_.name}: " if choices.chance(self.named) else ""
        return f"{{{prefix}{self.comma.join(written)}}}"

    def _elements(self, choices: Choices, name: str, type_: Array) -> list[str]:
        if type_.is_text:
            return [f"{name}[] {self.constant(choices, type_)}"]
        return [
            f"{name}[{index}] {self.constant(choices, type_.element)}" for index in elements(type_)
        ]

    def initialisation(self, choices: Choices, type_: Type, name: str) -> list[tuple[str, str]]:
        """Return targets and constants that together initialise all of a variable [TYP-10]."""
        if isinstance(type_, Structure):
            return [(name, self.aggregate(choices, type_, is_full=True))]
        if not isinstance(type_, Array):
            return [(name, self.constant(choices, type_))]
        if type_.is_text:
            return [(f"{name}[]", self.constant(choices, type_))]
        if type_.element == CHAR:
            rows = elements(Array(CHAR, type_.sizes[:-1]))
            return [(f"{name}[{row},]", self.constant(choices, TEXT)) for row in rows]
        return [
            found
            for index in elements(type_)
            for found in self.initialisation(choices, type_.element, f"{name}[{index}]")
        ]
