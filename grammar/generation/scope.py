"""Names visible at a place in a generated program: variables, their parts, routines."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import cache

from grammar.generation.choices import Choices
from grammar.generation.literals import Path, parts
from grammar.semantics.types import BOOL, Array, Enumeration, Structure, Type, is_position


@dataclass(frozen=True, slots=True, eq=False)
class Variable:
    """A variable; ``has_value`` says that nearly all of it was given one before it is used."""

    name: str
    type: Type
    is_writable: bool = True
    is_local: bool = True
    has_value: bool = True
    is_signal: bool = False


@dataclass(frozen=True, slots=True, eq=False)
class Place:
    """A variable or a part of one."""

    variable: Variable
    type: Type
    path: Path


#: A variable and the paths to its parts of a type.
_Holder = tuple[Variable, Sequence[Path]]


class Places:
    """Places of one type: by their variables, and those that are a variable as a whole."""

    __slots__ = ("_all", "_type", "holders", "whole")

    def __init__(self, type_: Type, holders: Sequence[_Holder]) -> None:
        self._type = type_
        self._all: list[Place] | None = None
        self.holders = holders
        self.whole = [variable for variable, paths in holders if not paths[0]]

    @property
    def all(self) -> Sequence[Place]:
        """All of them, those of a variable together."""
        if self._all is None:
            self._all = [
                Place(variable, self._type, path)
                for variable, paths in self.holders
                for path in paths
            ]
        return self._all


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

    ``deepest`` is, where it calls itself, how often it may; the first parameter says how often.
    One that ``is_action`` is called by interrupts and triggers, one that ``is_quick`` by both and
    by programs.
    """

    name: str
    parameters: tuple[Parameter, ...] = ()
    result: Type | None = None
    cost: int = 0
    is_action: bool = False
    is_quick: bool = False
    deepest: int = 0


@dataclass(slots=True, eq=False)
class Scope:
    """Variables by what can be done with them."""

    _routines: list[Routine] = field(default_factory=list)
    _variables: dict[str, Variable] = field(default_factory=dict)
    #: Variables that are, or have parts, of a type.
    _holders: dict[Type, list[_Holder]] = field(default_factory=dict)
    #: What `places` and `arrays` answered since something was added.
    _places: dict[tuple[Type, bool, bool, bool, bool], Places] = field(default_factory=dict)
    _arrays: dict[tuple[Type, int, bool], list[Place]] = field(default_factory=dict)
    _signals: dict[tuple[Type, bool], list[str]] = field(default_factory=dict)
    _callable: dict[Type | None, list[Routine]] = field(default_factory=dict)

    def inner(self) -> Scope:
        """A scope within this one."""
        holders = {type_: list(found) for type_, found in self._holders.items()}
        return Scope(list(self._routines), dict(self._variables), holders)

    def some(self, choices: Choices, most: int) -> Scope:
        """A scope with a few variables of each kind of type, and a few routines of each result."""
        variables: dict[Hashable, list[Variable]] = {}
        for variable in self._variables.values():
            key = (_kind(variable.type), variable.is_signal, variable.is_writable)
            variables.setdefault(key, []).append(variable)
        routines: dict[Type | None, list[Routine]] = {}
        for routine in self._routines:
            routines.setdefault(routine.result, []).append(routine)
        chosen = {one for some in variables.values() for one in choices.few(some, most)}
        return Scope(
            [one for some in routines.values() for one in choices.few(some, most)],
            {name: one for name, one in self._variables.items() if one in chosen},
            {
                type_: found
                for type_, holders in self._holders.items()
                if (found := [one for one in holders if one[0] in chosen])
            },
        )

    def add(self, variable: Variable) -> None:
        """Make a variable known; one of the same name is hidden."""
        self._places.clear()
        self._arrays.clear()
        self._signals.clear()
        hidden = self._variables.get(variable.name)
        if hidden is not None:
            for type_, paths in parts(hidden.type).items():
                self._holders[type_].remove((hidden, paths))
        self._variables[variable.name] = variable
        for type_, paths in parts(variable.type).items():
            self._holders.setdefault(type_, []).append((variable, paths))

    def extend(self, variables: Iterable[Variable]) -> None:
        """Make variables known."""
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
        """Places of a type; those without value only where they are written or may be bare.

        ``has_letters``: letters of texts are among them.
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
        """Whole arrays of elements of a type."""
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

    def signals(self, type_: Type = BOOL, *, is_output: bool) -> list[str]:
        """The names of signals of a type."""
        key = (type_, is_output)
        found = self._signals.get(key)
        if found is None:
            found = self._signals[key] = [
                one.name
                for one in self.places(type_, is_written=is_output).whole
                if one.is_signal and one.is_writable is is_output
            ]
        return found

    def enumerations(self) -> list[Enumeration]:
        """The types of enumerations of which something has a value."""
        return [type_ for type_ in self._holders if isinstance(type_, Enumeration)]

    def variables(self) -> Iterator[Variable]:
        """All of them."""
        yield from self._variables.values()

    # ----------------------------------------------------------------------- routines

    def add_routine(self, routine: Routine) -> None:
        """Make a routine known."""
        self._callable.clear()
        self._routines.append(routine)

    def forget_routines(self) -> None:
        """No routine is known any more."""
        self._callable.clear()
        self._routines.clear()

    def routines(self) -> Sequence[Routine]:
        """All of them, in the order they were made."""
        return self._routines

    def callable(self, result: Type | None, most: int) -> list[Routine]:
        """Routines with this result that cost at most so much."""
        found = self._callable.get(result)
        if found is None:
            found = self._callable[result] = [
                one for one in self._routines if not one.is_action and _is(one.result, result)
            ]
        return [one for one in found if one.cost <= most]

    def actions(self) -> list[Routine]:
        """Routines that interrupts and triggers can call."""
        return [one for one in self._routines if one.is_action or one.is_quick]


@cache
def _kind(type_: Type) -> Hashable:
    """What types have in common of which a program uses a few."""
    if isinstance(type_, Array):
        return (len(type_.sizes), _kind(type_.element))
    if isinstance(type_, Structure) and not is_position(type_):
        return Structure
    return Enumeration if isinstance(type_, Enumeration) else type_


def _is(one: Type | None, other: Type | None) -> bool:
    if isinstance(one, Array) and isinstance(other, Array):
        return one.element == other.element and len(one.sizes) == len(other.sizes)
    return one == other
