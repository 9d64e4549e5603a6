"""What can be named at a place of a program, by type: programs are made from this, and so fit.

Types are written as in KRL. ``CHAR`` is a single letter; texts, arrays, enumerations and structures
have collections of their own.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field, fields
from typing import TypeVar

from grammar.generation.cells.chance import Chance

__all__ = ["Enumeration", "Parameter", "Routine", "Scope", "Structure"]


@dataclass(frozen=True, slots=True)
class Enumeration:
    """An enumeration and its constants, without the hash."""

    name: str
    constants: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Structure:
    """A structure: its members by type, and those that are texts with their sizes."""

    name: str
    members: tuple[tuple[str, str], ...]
    texts: tuple[tuple[str, int], ...]


@dataclass(frozen=True, slots=True)
class Parameter:
    """A parameter; ``kind`` is its type, ``TEXT`` or the type of an array with ``[]`` behind it."""

    name: str
    kind: str
    is_in: bool = True


@dataclass(frozen=True, slots=True)
class Routine:
    """A routine that can be called, and what a function returns.

    A trigger can call it when ``is_quick``: it takes no arguments, neither moves nor waits.
    """

    name: str
    parameters: tuple[Parameter, ...] = ()
    returns: str | None = None
    is_quick: bool = False


T = TypeVar("T")


def _by_kind() -> defaultdict[str, list[T]]:
    return defaultdict(list)


@dataclass(slots=True)
class Scope:
    """The names seen at a place.

    ``reads`` are all of a type that have a value, ``writes`` the variables among them, which can
    also be passed to an OUT parameter, and ``lasting`` those that outlive the routine, which
    triggers and interrupts may use. Signals have lists of their own: inputs cannot be written and
    no signal is passed to an OUT parameter.
    """

    reads: defaultdict[str, list[str]] = field(default_factory=_by_kind)
    writes: defaultdict[str, list[str]] = field(default_factory=_by_kind)
    lasting: defaultdict[str, list[str]] = field(default_factory=_by_kind)
    arrays: defaultdict[str, list[tuple[str, int]]] = field(default_factory=_by_kind)
    matrices: list[tuple[str, int, int]] = field(default_factory=list)
    counters: list[tuple[str, int]] = field(default_factory=list)
    texts: list[tuple[str, int]] = field(default_factory=list)
    enumerations: list[tuple[str, Enumeration]] = field(default_factory=list)
    records: list[tuple[str, Structure]] = field(default_factory=list)
    tables: list[tuple[str, int, Structure]] = field(default_factory=list)
    inputs: list[str] = field(default_factory=list)
    outputs: list[str] = field(default_factory=list)
    codes_in: list[str] = field(default_factory=list)
    codes_out: list[str] = field(default_factory=list)
    routines: list[Routine] = field(default_factory=list)
    functions: defaultdict[str, list[Routine]] = field(default_factory=_by_kind)

    def inner(self) -> Scope:
        """The scope of a routine within: it sees all of this, and adds to it unseen from here."""
        scope = Scope()
        for one in fields(Scope):
            seen = getattr(self, one.name)
            if isinstance(seen, defaultdict):
                getattr(scope, one.name).update((kind, list(names)) for kind, names in seen.items())
            else:
                getattr(scope, one.name).extend(seen)
        return scope

    def some(self, chance: Chance, most: int = 8) -> Scope:
        """A scope with a few of the names of each kind: a program does not use all it could."""
        scope = Scope()
        for one in fields(Scope):
            seen = getattr(self, one.name)
            if isinstance(seen, defaultdict):
                found = ((kind, chance.few(names, most)) for kind, names in seen.items())
                getattr(scope, one.name).update(found)
            else:
                getattr(scope, one.name).extend(chance.few(seen, most))
        return scope

    def add_variable(self, kind: str, name: str, *, lasting: bool = False) -> None:
        """A variable of a type that has a value from now on."""
        self.reads[kind].append(name)
        self.writes[kind].append(name)
        if lasting:
            self.lasting[kind].append(name)

    def add_routine(self, routine: Routine) -> None:
        """A routine that can be called from now on."""
        if routine.returns is None:
            self.routines.append(routine)
        else:
            self.functions[routine.returns].append(routine)
