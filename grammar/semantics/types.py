"""The types of KRL as values.

There are four scalar types, arrays of them, structures and enumerations. Three more types occur
only in expressions: a text and an enumeration constant, whose types follow from where they are
used, and an aggregate, whose type follows from its target. `Unknown` is the type of everything that
comes from missing packages. It fits everywhere, so a missing package makes a check weaker, never
wrong.

Types are compared structurally, with letter case of names ignored [TYP-05].
`grammar.semantics.assignability` decides what can be assigned to what, and
`grammar.semantics.operations` the result types of operators. This module does not depend on syntax
trees.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field

from grammar.semantics.rules import is_confirmed
from support.lazy_dataclass import dataclass

#: What an INT holds [TYP-01].
INT_MIN, INT_MAX = -(2**31), 2**31 - 1

#: Names of the predefined structures for poses, and of those for axis positions.
CARTESIAN = frozenset({"FRAME", "POS", "E3POS", "E6POS"})
AXES = frozenset({"AXIS", "E3AXIS", "E6AXIS"})


@dataclass(frozen=True, slots=True)
class Unknown:
    """The unknown type: it fits everywhere and has every component and index."""

    def __str__(self) -> str:
        return "an unknown type"

    def __reduce__(self) -> str:
        """Pickle by name, so that there is one instance in every process."""
        return "UNKNOWN"


@dataclass(frozen=True, slots=True)
class Scalar:
    """INT, REAL, BOOL or CHAR [TYP-01 to TYP-03]."""

    name: str

    def __str__(self) -> str:
        return self.name

    def __reduce__(self) -> str:
        """Pickle by name, so that there is one instance of each in every process."""
        return self.name


@dataclass(frozen=True, slots=True)
class Text:
    """A text literal of ``length`` characters; with one character it is a CHAR as well [TYP-11]."""

    length: int

    def __str__(self) -> str:
        return "a text" if self.length != 1 else "a letter"


@dataclass(frozen=True, slots=True)
class Constant:
    """``#NAME``; its enumeration follows from where it is used [TYP-16]."""

    name: str

    def __str__(self) -> str:
        return f"#{self.name}"


@dataclass(frozen=True, slots=True)
class Aggregate:
    """``{X 1,Y 2}``: the names of its components, and its structure if it names one [TYP-19]."""

    names: tuple[str, ...]
    structure: Structure | None = None

    def __str__(self) -> str:
        return str(self.structure) if self.structure else "an aggregate"


@dataclass(frozen=True, slots=True)
class Array:
    """An array with one to three sizes; a size is ``None`` if it is unknown [TYP-08].

    ``element`` is never an array. The parameter ``X[,]`` is an array of two unknown sizes.
    """

    element: Type
    sizes: tuple[int | None, ...]

    def __str__(self) -> str:
        sizes = ",".join("" if size is None else str(size) for size in self.sizes)
        return f"{self.element}[{sizes}]"

    @property
    def is_text(self) -> bool:
        """Whether it can hold a text: a one-dimensional array of CHAR [TYP-11]."""
        return self.element in (CHAR, UNKNOWN) and len(self.sizes) == 1


@dataclass(frozen=True, slots=True)
class Member:
    """A component of a structure."""

    name: str
    type: Type


@dataclass(frozen=True, slots=True, eq=False)
class Structure:
    """A structure with its components in order; an open one may have others.

    ``places`` has the index of each component, counted from 0, by its name in upper case.
    """

    name: str
    members: tuple[Member, ...]
    is_open: bool = False
    places: Mapping[str, int] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        places: dict[str, int] = {}
        for place, member in enumerate(self.members):
            places.setdefault(member.name.upper(), place)
        object.__setattr__(self, "places", places)

    def __str__(self) -> str:
        return self.name

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Structure):
            return NotImplemented
        return self is other or _is_equal(self, other)

    def __hash__(self) -> int:
        return hash(self.name.upper())

    def __contains__(self, name: str) -> bool:
        return self.is_open or name.upper() in self.places

    def member(self, name: str) -> Type | None:
        """Return the type of a component, or ``None`` if there is none with that name."""
        place = self.places.get(name.upper())
        if place is None:
            return UNKNOWN if self.is_open else None
        return self.members[place].type


def _is_equal(one: Structure, other: Structure) -> bool:
    """Return whether two structures are equal; each inner pair is compared only once."""
    todo: list[tuple[Type, Type]] = [(one, other)]
    seen: set[tuple[int, int]] = set()
    while todo:
        left, right = todo.pop()
        if isinstance(left, Array) and isinstance(right, Array) and left.sizes == right.sizes:
            left, right = left.element, right.element
        if isinstance(left, Structure) and isinstance(right, Structure):
            pair = id(left), id(right)
            if left is right or pair in seen:
                continue
            seen.add(pair)
            if _names(left) != _names(right):
                return False
            members = zip(left.members, right.members, strict=True)
            todo += ((member.type, other.type) for member, other in members)
        elif left != right:
            return False
    return True


def _names(type_: Structure) -> list[str]:
    return [name.upper() for name in (type_.name, *(member.name for member in type_.members))]


@dataclass(frozen=True, slots=True, eq=False)
class Enumeration:
    """An enumeration and its constants in order; an open one may have others."""

    name: str
    constants: tuple[str, ...]
    is_open: bool = False
    _keys: Mapping[str, None] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        keys = dict.fromkeys(constant.upper() for constant in self.constants)
        object.__setattr__(self, "_keys", keys)

    def __str__(self) -> str:
        return self.name

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Enumeration):
            return NotImplemented
        return self is other or (
            self.name.upper() == other.name.upper() and list(self._keys) == list(other._keys)
        )

    def __hash__(self) -> int:
        return hash(self.name.upper())

    def __contains__(self, name: str) -> bool:
        return self.is_open or name.upper() in self._keys


Type = Scalar | Array | Structure | Enumeration | Text | Constant | Aggregate | Unknown

INT, REAL, BOOL, CHAR = Scalar("INT"), Scalar("REAL"), Scalar("BOOL"), Scalar("CHAR")
SCALARS = {scalar.name: scalar for scalar in (INT, REAL, BOOL, CHAR)}
UNKNOWN = Unknown()


def is_number(type_: Type) -> bool:
    """Return whether a type is INT or REAL."""
    return type_ in (INT, REAL)


def is_cartesian(type_: Type) -> bool:
    """Return whether a type is a pose: FRAME, POS, E3POS or E6POS."""
    return isinstance(type_, Structure) and type_.name.upper() in CARTESIAN


def is_axes(type_: Type) -> bool:
    """Return whether a type is an axis position: AXIS, E3AXIS or E6AXIS."""
    return isinstance(type_, Structure) and type_.name.upper() in AXES


def is_position(type_: Type) -> bool:
    """Return whether a motion can go to a value of this type: a pose or axis positions."""
    return is_cartesian(type_) or is_axes(type_)


def is_same(one: Type, other: Type) -> bool:
    """Return whether two types are the same as far as is known; array sizes may differ."""
    match one, other:
        case Array(), Array():
            return len(one.sizes) == len(other.sizes) and is_same(one.element, other.element)
        case Structure(), Structure() if one.is_open or other.is_open:
            return one.name.upper() == other.name.upper()
        case Enumeration(), Enumeration() if one.is_open or other.is_open:
            return one.name.upper() == other.name.upper()
    return UNKNOWN in (one, other) or one == other


@dataclass(frozen=True, slots=True)
class Verdict:
    """Whether something is allowed, and the rules that say so.

    ``reason`` is a sentence without a full stop, empty if none is needed; ``message`` is the number
    of the controller's own message, if there is one. If something is allowed but not
    ``is_lossless``, the value changes: a REAL is rounded, a component dropped. ``is_misfit`` says
    that the two types alone are the reason. A verdict is true if it ``is_fine``.
    """

    is_fine: bool
    rules: tuple[str, ...] = ()
    reason: str = ""
    message: int | None = None
    is_lossless: bool = True
    is_misfit: bool = False

    def __bool__(self) -> bool:
        return self.is_fine

    @property
    def is_unconfirmed(self) -> bool:
        """Whether it rests on unconfirmed rules only, which cannot support an error."""
        return not is_confirmed(self.rules)


#: Allowed, without a remark.
FINE = Verdict(True)


def without_index(array: Array) -> Verdict:
    """Return the verdict on an array where one of its elements is needed [TYP-20]."""
    return Verdict(
        False, ("TYP-20", "MSG-21"), f"the index is missing: this is an array, {array}", 2052
    )


@dataclass(frozen=True, slots=True)
class Typed:
    """The type of an expression; `UNKNOWN` if the verdict is bad, to avoid follow-up errors."""

    type: Type
    verdict: Verdict = FINE
