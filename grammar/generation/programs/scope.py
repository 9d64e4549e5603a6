"""What a place in a generated program can name: variables, their parts, routines."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from grammar.generation.programs.kinds import Piece, parts
from grammar.semantics.types import CHAR, Array, Type

__all__ = ["Parameter", "Place", "Routine", "Scope", "Variable"]


@dataclass(frozen=True, slots=True, eq=False)
class Variable:
    """A variable; ``has_value`` tells that nearly all of it was given one before it is used."""

    name: str
    type: Type
    is_writable: bool = True
    is_local: bool = True
    has_value: bool = True


@dataclass(frozen=True, slots=True, eq=False)
class Place:
    """A variable or a part of one: what stands behind the name, numbers are sizes of dimensions."""

    variable: Variable
    type: Type
    pieces: tuple[Piece, ...]

    @property
    def is_letter_of_text(self) -> bool:
        """Whether it is one letter of a text, which may be shorter."""
        return self.type == CHAR and self.pieces[-1:] == ("]",)


@dataclass(frozen=True, slots=True)
class Parameter:
    """A formal parameter; an array has open sizes."""

    name: str
    type: Type
    is_out: bool
    is_explicit: bool = True


@dataclass(frozen=True, slots=True, eq=False)
class Routine:
    """A routine that can be called; ``cost`` is how many statements it executes at most.

    ``deepest`` is, where it calls itself, how often it may; the first parameter tells it how often.
    """

    name: str
    parameters: tuple[Parameter, ...]
    result: Type | None
    cost: int
    is_for_interrupts: bool = False
    deepest: int = 0


@dataclass(slots=True, eq=False)
class Scope:
    """Variables by what can be done with them."""

    routines: list[Routine] = field(default_factory=list)
    _places: dict[Type, list[Place]] = field(default_factory=dict)
    _variables: dict[str, Variable] = field(default_factory=dict)

    def inner(self) -> Scope:
        """A scope within this one."""
        copy = Scope(list(self.routines))
        for variable in self._variables.values():
            copy.add(variable)
        return copy

    def add(self, variable: Variable) -> None:
        """Make a variable known; one of the same name is hidden."""
        if variable.name in self._variables:
            hidden = self._variables[variable.name]
            for places in self._places.values():
                places[:] = [one for one in places if one.variable is not hidden]
        self._variables[variable.name] = variable
        for type_, pieces in parts(variable.type):
            self._places.setdefault(type_, []).append(Place(variable, type_, pieces))

    def places(
        self, type_: Type, *, is_written: bool = False, is_bare: bool = False, is_local: bool = True
    ) -> list[Place]:
        """Places of a type; those without value only where they are written or may be bare."""
        return [
            one
            for one in self._places.get(type_, ())
            if (one.variable.is_writable or not is_written)
            and (one.variable.has_value or is_written or is_bare)
            and (is_local or not one.variable.is_local)
        ]

    def arrays(self, element: Type, dimensions: int, *, is_written: bool = False) -> list[Place]:
        """Whole arrays of elements of a type."""
        return [
            place
            for type_ in self._places
            if isinstance(type_, Array)
            and type_.element == element
            and len(type_.sizes) == dimensions
            for place in self.places(type_, is_written=is_written)
        ]

    def variables(self) -> Iterator[Variable]:
        """All of them."""
        yield from self._variables.values()

    def callable(self, result: Type | None, most: int) -> list[Routine]:
        """Routines with this result that cost at most so much."""
        return [
            one
            for one in self.routines
            if one.cost <= most and not one.is_for_interrupts and _is(one.result, result)
        ]


def _is(one: Type | None, other: Type | None) -> bool:
    if isinstance(one, Array) and isinstance(other, Array):
        return one.element == other.element and len(one.sizes) == len(other.sizes)
    return one == other
