"""The names that are visible at a place of a generated program: variables, parts, routines."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field

from grammar.generation.literals import Path, parts
from grammar.semantics.types import Array, Type


@dataclass(frozen=True, slots=True, eq=False)
class Variable:
    """A variable; ``has_value`` says that nearly all of it is initialised before it is used."""

    name: str
    type: Type
    is_writable: bool = True
    is_local: bool = True
    has_value: bool = True


@dataclass(frozen=True, slots=True, eq=False)
class Place:
    """A variable or a part of it."""

    variable: Variable
    type: Type
    path: Path


#: A variable and the paths to its parts of a type.
_Holder = tuple[Variable, Sequence[Path]]


class Places:
    """The places of one type, grouped by variable."""

    __slots__ = ("_all", "_type", "holders")

    def __init__(self, type_: Type, holders: Sequence[_Holder]) -> None:
        self._type = type_
        self._all: list[Place] | None = None
        self.holders = holders

    @property
    def all(self) -> Sequence[Place]:
        """All places, those of a variable together."""
        if self._all is None:
            self._all = [
                Place(variable, self._type, path)
                for variable, paths in self.holders
                for path in paths
            ]
        return self._all


@dataclass(frozen=True, slots=True)
class Parameter:
    """A formal parameter; the sizes of an array are open."""

    name: str
    type: Type
    is_out: bool
    is_explicit: bool = True


@dataclass(frozen=True, slots=True, eq=False)
class Routine:
    """A routine that can be called; ``cost`` is the greatest number of statements it executes.

    ``deepest`` is the greatest depth of a recursive routine, whose first parameter is the depth.
    ``is_action`` says that it is called by interrupts and triggers only.
    """

    name: str
    parameters: tuple[Parameter, ...] = ()
    result: Type | None = None
    cost: int = 0
    is_action: bool = False
    deepest: int = 0


@dataclass(slots=True, eq=False)
class Scope:
    """The visible variables and routines, indexed by type."""

    _routines: list[Routine] = field(default_factory=list)
    _variables: dict[str, Variable] = field(default_factory=dict)
    #: By type, the variables that have this type or have parts of it.
    _holders: dict[Type, list[_Holder]] = field(default_factory=dict)
    #: Caches of `places` and `arrays`, cleared when a variable is added.
    _places: dict[tuple[Type, bool, bool, bool, bool], Places] = field(default_factory=dict)
    _arrays: dict[tuple[Type, int, bool], list[Place]] = field(default_factory=dict)
    _callable: dict[Type | None, list[Routine]] = field(default_factory=dict)

    def inner(self) -> Scope:
        """Return a copy of this scope for an inner one."""
        holders = {type_: list(found) for type_, found in self._holders.items()}
        return Scope(list(self._routines), dict(self._variables), holders)

    def add(self, variable: Variable) -> None:
        """Add a variable; it hides one with the same name."""
        self._places.clear()
        self._arrays.clear()
        hidden = self._variables.get(variable.name)
        if hidden is not None:
            for type_, paths in parts(hidden.type).items():
                self._holders[type_].remove((hidden, paths))
        self._variables[variable.name] = variable
        for type_, paths in parts(variable.type).items():
            self._holders.setdefault(type_, []).append((variable, paths))

    def extend(self, variables: Iterable[Variable]) -> None:
        """Add variables."""
        for one in variables:
            self.add(one)

    def places(
        self,
        type_: Type,
        *,
        is_written: bool = False,
        is_bare: bool = False,
        is_local: bool = True,
        has_letters: bool = True,
    ) -> Places:
        """Return the places of a type.

        Those without a value are included if they are to be written (``is_written``) or may have
        none (``is_bare``). ``has_letters`` includes single letters of texts.
        """
        key = (type_, is_written, is_bare, is_local, has_letters)
        found = self._places.get(key)
        if found is None:
            holders: list[_Holder] = [
                (one, paths)
                for one, paths in self._holders.get(type_, ())
                if (one.is_writable or not is_written)
                and (one.has_value or is_written or is_bare)
                and (is_local or not one.is_local)
            ]
            if not has_letters:
                apart = [
                    (one, [way for way in ways if way[-1:] != ("]",)]) for one, ways in holders
                ]
                holders = [(one, ways) for one, ways in apart if ways]
            found = self._places[key] = Places(type_, holders)
        return found

    def arrays(self, element: Type, dimensions: int, *, is_written: bool = False) -> list[Place]:
        """Return the whole arrays with this element type and number of dimensions."""
        key = (element, dimensions, is_written)
        found = self._arrays.get(key)
        if found is None:
            found = self._arrays[key] = [
                place
                for type_ in self._holders
                if isinstance(type_, Array)
                and type_.element == element
                and len(type_.sizes) == dimensions
                for place in self.places(type_, is_written=is_written).all
            ]
        return found

    def variables(self) -> Iterator[Variable]:
        """Yield the visible variables."""
        yield from self._variables.values()

    # ----------------------------------------------------------------------- routines

    def add_routine(self, routine: Routine) -> None:
        """Add a routine."""
        self._callable.clear()
        self._routines.append(routine)

    def routines(self) -> Sequence[Routine]:
        """Return the visible routines in the order of their creation."""
        return self._routines

    def callable(self, result: Type | None, most: int) -> list[Routine]:
        """Return the routines with this result whose cost is at most ``most``."""
        found = self._callable.get(result)
        if found is None:
            found = self._callable[result] = [
                one for one in self._routines if not one.is_action and _is(one.result, result)
            ]
        return [one for one in found if one.cost <= most]

    def actions(self) -> list[Routine]:
        """Return the routines that interrupts and triggers can call."""
        return [one for one in self._routines if one.is_action]


def _is(one: Type | None, other: Type | None) -> bool:
    if isinstance(one, Array) and isinstance(other, Array):
        return one.element == other.element and len(one.sizes) == len(other.sizes)
    return one == other
