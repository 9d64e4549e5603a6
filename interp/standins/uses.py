"""Facts about undeclared names, from all their uses in a project.

``X=3.5`` implies that X is a number, ``WAIT FOR X`` that it is a truth value, ``PTP X`` that it is
a position, ``X[2].NR`` that it is an array of structures. `Uses` keeps such facts, which
`interp.standins.use_reader` collects file by file; it does not guess.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import field

from grammar.semantics.types import (
    Aggregate,
    Array,
    Constant,
    Enumeration,
    Scalar,
    Structure,
    Text,
    Type,
)
from grammar.syntax import ast
from support.lazy_dataclass import dataclass

#: The folder of stand-ins in paths. No file of a backup has such a path.
FOLDER = "<stand-in>"

#: The largest depth of nested members that is examined.
_DEEPEST = 4


@dataclass(slots=True, eq=False)
class DataUse:
    """The uses of a variable, a member of a structure, or the result of a function."""

    #: The types that it is assigned, compared or combined with, in the order of the text, and the
    #: enumeration constants among them.
    types: list[Type] = field(default_factory=list)
    constants: dict[str, str] = field(default_factory=dict)
    #: The uses of its members by name in upper case.
    members: dict[str, DataUse] = field(default_factory=dict)
    #: The kinds of the motions that go to it.
    motions: set[str] = field(default_factory=set)
    #: The largest number of indices in one use, 0 for a scalar, and the largest known index in each
    #: dimension.
    indices: int = 0
    largest: list[int] = field(default_factory=lambda: [0, 0, 0])
    #: Whether it is a CHAR array, an index of an array, or a member of a structure.
    is_text: bool = False
    is_index: bool = False
    is_part: bool = False
    #: Whether an assignment or PULSE sets it, and whether a WAIT FOR reads it.
    is_assigned: bool = False
    is_pulsed: bool = False
    is_waited_for: bool = False
    #: The value with which it ends a loop.
    left_by: bool | None = None
    #: Whether it is compared with ``==`` or ``<>``, the first number that it is compared with, also
    #: by a SWITCH, and all numbers that a SWITCH compares it with.
    is_compared: bool = False
    asked_for: str = ""
    cases: set[str] = field(default_factory=set)
    #: Whether everything that is passed for it is a variable of a known type, which a call can
    #: change.
    is_variable: bool = True

    def member(self, name: ast.Name) -> DataUse:
        """Return the use of a member."""
        return self.members.setdefault(name.key, DataUse(is_part=True))

    def record(self, type_: Type) -> None:
        """Add a type that it is assigned, compared or combined with."""
        match type_:
            case Constant(name=name):
                self.constants.setdefault(name.upper(), name)
            case Text() | Array(element=Scalar(name="CHAR")):
                self.is_text = True
            case Array(element=element, sizes=sizes):
                self.indices = max(self.indices, len(sizes))
                self.types.append(element)
            case Aggregate(structure=structure, names=names):
                self.types += [structure] if structure is not None else ()
                for name in names:
                    self.members.setdefault(name.upper(), DataUse())
            case Scalar() | Structure() | Enumeration():
                self.types.append(type_)


@dataclass(slots=True, eq=False)
class RoutineUse:
    """The result of a routine, and for each parameter what its calls pass to it."""

    result: DataUse = field(default_factory=DataUse)
    is_function: bool = False
    arguments: list[DataUse] = field(default_factory=list)


class _TypeClasses:
    """Equivalence classes of uses that have the same type; a union-find structure.

    If two uses have the same type, so have their members of the same name.
    """

    def __init__(self) -> None:
        self._class: dict[int, list[DataUse]] = {}

    def members(self, use: DataUse) -> list[DataUse]:
        """Return the uses in the class of a use."""
        return self._class.setdefault(id(use), [use])

    def unite(self, one: DataUse, other: DataUse) -> None:
        """Merge the classes of two uses, and those of their members."""
        todo = [(one, other)]
        while todo:
            larger, smaller = sorted(map(self.members, todo.pop()), key=len, reverse=True)
            if larger is smaller:
                continue
            members = {name: use for each in larger for name, use in each.members.items()}
            for each in smaller:
                self._class[id(each)] = larger
                shared = each.members.keys() & members.keys()
                todo += [(members[name], each.members[name]) for name in sorted(shared)]
                members = {**each.members, **members}
            larger += smaller

    def collect(self, use: DataUse, depth: int = 0) -> None:
        """Add what is known of all uses in the class of a use to that use."""
        for other in self.members(use):
            use.constants.update(other.constants)
            use.types += [one for one in other.types if one not in use.types]
            use.is_compared |= other.is_compared
            use.is_text |= other.is_text
            for name, member in other.members.items() if depth < _DEEPEST else ():
                self.unite(use.members.setdefault(name, DataUse(is_part=True)), member)
        for member in use.members.values() if depth < _DEEPEST else ():
            self.collect(member, depth + 1)


class Uses:
    """The uses of some undeclared names: ``data``, ``routines`` and ``types`` by name.

    ``apart`` are the uses of variables that a file has of its own, by path and name. ``same_type``
    are pairs of uses of one type, because one is assigned to or compared with the other.
    """

    def __init__(self, data: Iterable[str], routines: Iterable[str], types: Iterable[str]) -> None:
        self.data: Mapping[str, DataUse] = {name: DataUse() for name in data}
        self.routines: Mapping[str, RoutineUse] = {name: RoutineUse() for name in routines}
        self.types: Mapping[str, DataUse] = {name: DataUse() for name in types}
        self.apart: dict[tuple[str, str], DataUse] = {}
        self.same_type: list[tuple[DataUse, DataUse]] = []

    def settle(self) -> None:
        """Add the uses of all variables of a type to that type, once all files have been read."""
        classes = _TypeClasses()
        for one, other in self.same_type:
            classes.unite(one, other)
        for use in self.types.values():
            classes.collect(use)
