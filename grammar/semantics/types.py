"""The types of KRL as values.

Four scalar types, arrays of them, structures and enumerations; then what only a literal has: a text
and an enumeration constant take their type from where they are used, an aggregate from what it is
assigned to. `Unknown` is the type of all that comes from packages not at hand. It fits everywhere,
so that a missing package makes a check weaker and never wrong.

Types are equal when they say the same; letter case does not tell names apart [TYP-05]. What may be
assigned to what is decided by `grammar.semantics.assignability`, what operators make of operands by
`grammar.semantics.operations`. Nothing here knows of syntax trees.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field

from grammar.semantics.rules import is_confirmed
from support.lazy_dataclass import dataclass

#: What an INT holds [TYP-01].
INT_MIN, INT_MAX = -(2**31), 2**31 - 1

#: The names of the predefined structures that are a pose, and of those that are axis positions.
CARTESIAN = frozenset({"FRAME", "POS", "E3POS", "E6POS"})
AXES = frozenset({"AXIS", "E3AXIS", "E6AXIS"})


@dataclass(frozen=True, slots=True)
class Unknown:
    """Nothing is known: fits everywhere, has every component and index."""

    def __str__(self) -> str:
        return "an unknown type"

    def __reduce__(self) -> str:
        """There is one, in every process and in what is read from a file."""
        return "UNKNOWN"


@dataclass(frozen=True, slots=True)
class Scalar:
    """INT, REAL, BOOL or CHAR [TYP-01 to TYP-03]."""

    name: str

    def __str__(self) -> str:
        return self.name

    def __reduce__(self) -> str:
        """There is one of each, as there is one `UNKNOWN`."""
        return self.name


@dataclass(frozen=True, slots=True)
class Text:
    """A text in quotation marks, of ``length`` characters; of one it is a CHAR as well [TYP-11]."""

    length: int

    def __str__(self) -> str:
        return "a text" if self.length != 1 else "a letter"


@dataclass(frozen=True, slots=True)
class Constant:
    """``#NAME``; which enumeration it belongs to follows from where it is used [TYP-16]."""

    name: str

    def __str__(self) -> str:
        return f"#{self.name}"


@dataclass(frozen=True, slots=True)
class Aggregate:
    """``{X 1,Y 2}``: the names of its components, and the structure where it names one [TYP-19]."""

    names: tuple[str, ...]
    structure: Structure | None = None

    def __str__(self) -> str:
        return str(self.structure) if self.structure else "an aggregate"


@dataclass(frozen=True, slots=True)
class Array:
    """An array: one to three sizes, ``None`` where a size is not known [TYP-08].

    ``element`` is no array itself. The parameter ``X[,]`` is an array of two unknown sizes.
    """

    element: Type
    sizes: tuple[int | None, ...]

    def __str__(self) -> str:
        sizes = ",".join("" if size is None else str(size) for size in self.sizes)
        return f"{self.element}[{sizes}]"

    @property
    def is_text(self) -> bool:
        """Whether a text in quotation marks can be its value: a row of CHAR [TYP-11]."""
        return self.element in (CHAR, UNKNOWN) and len(self.sizes) == 1


@dataclass(frozen=True, slots=True)
class Member:
    """A component of a structure."""

    name: str
    type: Type


@dataclass(frozen=True, slots=True, eq=False)
class Structure:
    """A structure and its components in order; an open one may have others that are not known."""

    name: str
    members: tuple[Member, ...]
    is_open: bool = False
    _types: Mapping[str, Type] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        types = {member.name.upper(): member.type for member in reversed(self.members)}
        object.__setattr__(self, "_types", types)

    def __str__(self) -> str:
        return self.name

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Structure):
            return NotImplemented
        return self is other or _is_equal(self, other)

    def __hash__(self) -> int:
        return hash(self.name.upper())

    def __contains__(self, name: str) -> bool:
        return self.is_open or name.upper() in self._types

    def member(self, name: str) -> Type | None:
        """The type of a component; ``None`` where there is none of that name."""
        found = self._types.get(name.upper())
        return UNKNOWN if found is None and self.is_open else found


def _is_equal(one: Structure, other: Structure) -> bool:
    """Whether two structures say the same; each pair of structures within them is compared once."""
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
            if left.name.upper() != right.name.upper() or list(left._types) != list(right._types):
                return False
            todo += zip(left._types.values(), right._types.values(), strict=True)
        elif left != right:
            return False
    return True


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
    """INT or REAL."""
    return type_ in (INT, REAL)


def is_cartesian(type_: Type) -> bool:
    """FRAME, POS, E3POS or E6POS."""
    return isinstance(type_, Structure) and type_.name.upper() in CARTESIAN


def is_axes(type_: Type) -> bool:
    """AXIS, E3AXIS or E6AXIS."""
    return isinstance(type_, Structure) and type_.name.upper() in AXES


def is_position(type_: Type) -> bool:
    """What a motion can go to: a pose or axis positions."""
    return is_cartesian(type_) or is_axes(type_)


def is_same(one: Type, other: Type) -> bool:
    """Whether two types are the same as far as is known; sizes of arrays may differ."""
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

    ``reason`` is a sentence without an end, empty where all is plain; ``message`` the number of the
    controller's own message where one fits. What is allowed and not ``is_lossless`` changes the
    value: a REAL is rounded, a component dropped. It ``is_misfit`` where nothing but the two types
    is the reason. A verdict is true when it ``is_fine``.
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
        """Whether it rests on nothing but recollection: no reason for an error."""
        return not is_confirmed(self.rules)


#: Allowed, and nothing to say about it.
FINE = Verdict(True)


def without_index(array: Array) -> Verdict:
    """The refusal of an array where one of its elements is needed [TYP-20]."""
    return Verdict(False, ("TYP-20", "MSG-21"), f"{array} needs an index here", 2052)


@dataclass(frozen=True, slots=True)
class Typed:
    """The type of an expression; `UNKNOWN` where the verdict is bad, so that nothing follows."""

    type: Type
    verdict: Verdict = FINE
