"""Values of a running program: what they are made of, how they are converted, copied and written.

======================  =======================================================================
INT                     ``int`` of 32 bits with sign [TYP-01]
REAL                    ``float`` that is exactly an IEEE single, finite [TYP-02]
BOOL                    ``bool``
CHAR                    ``str`` of length 1 whose code point is the byte, 0 to 255 [TYP-03]
a text in a program     ``str``; of length 1 it is a CHAR as well [TYP-11]
enumeration constant    `EnumValue`
structure               `StructureValue`
array                   `ArrayValue`
no value yet            ``None`` [TYP-13]
======================  =======================================================================

A member or element without a value is ``None``, and `known` faults where it is needed. Structures
and arrays are themselves never ``None``: one that was declared and not filled has no value in any
part. They are mutable and have the semantics of values: assignment goes through `fill`, which
copies part by part and so keeps references (OUT parameters, rows of arrays) intact. Parts without a
value are copied as such, without a fault.

The used part of a text ends before its first element that has no value or the code 0.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import field
from functools import cache
from typing import Any, Final

from grammar.semantics.predefined import System
from grammar.semantics.types import (
    AXES,
    BOOL,
    CARTESIAN,
    CHAR,
    INT,
    INT_MAX,
    INT_MIN,
    REAL,
    Array,
    Enumeration,
    Scalar,
    Structure,
    Text,
    Type,
    is_same,
)
from interp.values.faults import LinkError, fault
from support.lazy_dataclass import dataclass

#: The largest REAL [TYP-02].
REAL_MAX: Final = 3.4028234663852886e38


# --------------------------------------------------------------------------------------- numbers

# Storing a float as a C float and reading it back is the fastest exact rounding of those tried:
# 0.11 µs, where struct takes 0.22, ctypes 0.17 and numpy 0.36 (docs/adr/0013-numbers.md).
_cell = memoryview(bytearray(4)).cast("f")


def single(number: float) -> float:
    """``number`` rounded to the nearest IEEE single, ties to even; faults ``overflow``.

    What is too small becomes subnormal or zero. Infinity and NaN are ``overflow`` too.
    """
    _cell[0] = number
    result = _cell[0]
    if -REAL_MAX <= result <= REAL_MAX:
        return result
    raise fault("overflow")


def integer(number: int) -> int:
    """``number`` itself; faults ``overflow`` when it does not fit into an INT [ARI-12]."""
    if INT_MIN <= number <= INT_MAX:
        return number
    raise fault("overflow")


def rounded(number: float) -> int:
    """A REAL as INT: the nearest, halves away from zero; faults ``overflow`` [ARI-03, CON-02]."""
    whole = math.floor(number + 0.5) if number >= 0 else -math.floor(0.5 - number)
    return integer(whole)


# -------------------------------------------------------------------------------- compound values


@dataclass(frozen=True, slots=True)
class EnumValue:
    """A constant of an enumeration, by its place in it, counted from 0 [TYP-16]."""

    type: Enumeration
    index: int

    @property
    def name(self) -> str:
        """The constant without ``#``, as declared."""
        return self.type.constants[self.index]

    def __repr__(self) -> str:
        return f"#{self.name}"


@dataclass(slots=True)
class StructureValue:
    """A structure: its members in the order of the type."""

    type: Structure
    members: list[Any]

    def get(self, name: str) -> Value | None:
        """The member of a name; `KeyError` where the structure has none."""
        found: Value | None = self.members[_places(self.type)[name.upper()]]
        return found

    def set(self, name: str, value: Value | None) -> None:
        """Give a member a value, which is neither converted nor copied."""
        self.members[_places(self.type)[name.upper()]] = value


@dataclass(slots=True, eq=False)
class ArrayValue:  # noqa: PLW1641  # it changes, so it has no hash, as StructureValue has none
    """An array, or a part of one: elements in row-major order from ``base`` on.

    ``type`` has all its sizes (else `LinkError`), which ``sizes`` repeats. A part shares
    ``elements`` with the array it is a part of.
    """

    type: Array
    elements: list[Any]
    base: int = 0
    sizes: tuple[int, ...] = field(init=False)

    def __post_init__(self) -> None:
        self.sizes = _sizes(self.type)

    def __len__(self) -> int:
        return math.prod(self.sizes)

    def __iter__(self) -> Iterator[Value | None]:
        return iter(self.elements[self.base : self.base + len(self)])

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, ArrayValue):
            return NotImplemented
        return self.type == other.type and list(self) == list(other)

    def place(self, indices: Sequence[int]) -> int:
        """Where in ``elements`` an element is; faults ``index`` [TYP-09].

        The indices count from 1. There is one for each dimension, or fewer: then it is the place
        of the first element of that part.
        """
        place = 0
        sizes = self.sizes
        for wanted, size in zip(indices, sizes, strict=False):
            if not 1 <= wanted <= size:
                raise fault("index")
            place = place * size + wanted - 1
        return self.base + place * math.prod(sizes[len(indices) :])

    def get(self, *indices: int) -> Value | None:
        """An element; faults ``index``."""
        found: Value | None = self.elements[self.place(indices)]
        return found

    def set(self, value: Value | None, *indices: int) -> None:
        """Give an element a value, which is neither converted nor copied; faults ``index``."""
        self.elements[self.place(indices)] = value

    def part(self, *indices: int) -> ArrayValue:
        """What is left when the first dimensions have these indices: ``NAMES[3,]`` [TYP-11].

        No copy. Faults ``index``.
        """
        left = self.type.sizes[len(indices) :]
        return ArrayValue(Array(self.type.element, left), self.elements, self.place(indices))


Value = int | float | bool | str | EnumValue | StructureValue | ArrayValue


@cache
def _sizes(type_: Array) -> tuple[int, ...]:
    known_sizes = tuple(size for size in type_.sizes if size is not None)
    if len(known_sizes) != len(type_.sizes):
        raise LinkError(f"the size of an array of {type_.element} is not known")
    return known_sizes


@cache
def _places(type_: Structure) -> Mapping[str, int]:
    return {member.name.upper(): place for place, member in enumerate(type_.members)}


def member_place(type_: Structure, name: str) -> int:
    """Which member it is, counted from 0; raises `LinkError` where there is none of that name."""
    try:
        return _places(type_)[name.upper()]
    except KeyError:
        raise LinkError(f"{type_} has no component {name} that is known") from None


@cache
def constant(type_: Enumeration, name: str) -> EnumValue:
    """``#NAME``; raises `LinkError` where the constant is not known."""
    wanted = name.upper()
    for place, one in enumerate(type_.constants):
        if one.upper() == wanted:
            return EnumValue(type_, place)
    raise LinkError(f"{type_} has no constant #{name} that is known")


@cache
def position_type(names: frozenset[str]) -> Structure | None:
    """The smallest pose, else the smallest axis position, that has all these components.

    It is what ``{X 1,Y 2}`` is where nothing else says it; ``None`` where no type fits.
    """
    types = System.load().types
    for name in ("FRAME", "POS", "E3POS", "E6POS", "AXIS", "E3AXIS", "E6AXIS"):
        type_ = types[name]
        if isinstance(type_, Structure) and {one.upper() for one in names} <= set(_places(type_)):
            return type_
    return None


# ---------------------------------------------------------------------------- making and copying


def empty(type_: Type) -> Value | None:
    """What a variable has after its declaration: no value, or a structure or array of such."""
    match type_:
        case Structure():
            return StructureValue(type_, [empty(member.type) for member in type_.members])
        case Array(element=Scalar() | Enumeration()):
            return ArrayValue(type_, [None] * math.prod(_sizes(type_)))
        case Array():
            return ArrayValue(
                type_, [empty(type_.element) for _ in range(math.prod(_sizes(type_)))]
            )
        case Scalar() | Enumeration():
            return None
    raise LinkError(f"nothing can be of {type_}")


_ZEROS: Mapping[Type, Value] = {INT: 0, REAL: 0.0, BOOL: False, CHAR: "\0"}


def zero(type_: Type) -> Value:
    """Zero, FALSE, code 0 or the first constant, in every part: for worlds that know no better."""
    match type_:
        case Structure():
            return StructureValue(type_, [zero(member.type) for member in type_.members])
        case Array(element=Scalar() | Enumeration() as element):
            return ArrayValue(type_, [zero(element)] * math.prod(_sizes(type_)))
        case Array():
            return ArrayValue(type_, [zero(type_.element) for _ in range(math.prod(_sizes(type_)))])
        case Enumeration() if type_.constants:
            return EnumValue(type_, 0)
        case Scalar():
            return _ZEROS[type_]
    raise LinkError(f"nothing can be of {type_}")


def copied(value: Any) -> Any:
    """A value that shares no part with ``value``; a part of an array becomes an array."""
    match value:
        case StructureValue():
            return StructureValue(value.type, [copied(member) for member in value.members])
        case ArrayValue():
            return ArrayValue(value.type, [copied(element) for element in value])
    return value


def known(value: Value | None) -> Value:
    """The value; faults ``uninitialised`` where there is none [TYP-13, SCO-08]."""
    if value is None:
        raise fault("uninitialised")
    return value


def has_value(value: Value | None) -> bool:
    """Whether it has a value in any part."""
    match value:
        case StructureValue():
            return any(map(has_value, value.members))
        case ArrayValue():
            return any(map(has_value, value))
    return value is not None


# ---------------------------------------------------------------------------------- conversion


def type_of(value: Value) -> Type:
    """The type of a value; a text that is no letter is no array but a `Text`."""
    match value:
        case bool():
            return BOOL
        case int():
            return INT
        case float():
            return REAL
        case str():
            return CHAR if len(value) == 1 else Text(len(value))
    return value.type


def index(value: Value) -> int:
    """A value as an index of an array: a REAL is rounded, a CHAR has its code."""
    found = converted(value, INT)
    assert isinstance(found, int)
    return found


def converted(value: Value, to: Type) -> Value:
    """A value as a variable of type ``to`` receives it; shares no part with ``value``.

    Faults ``inadmissible`` where that cannot be, ``overflow`` where a REAL is no INT [ARI-03,
    ARI-11, TYP-12]. What may be converted is defined by
    `grammar.semantics.assignability.assignable`.
    """
    if isinstance(to, Structure | Array):
        target = empty(to)
        assert isinstance(target, StructureValue | ArrayValue)
        fill(target, value)
        return target
    if isinstance(to, Enumeration):
        if isinstance(value, EnumValue) and is_same(value.type, to):
            return value
        raise fault("inadmissible")
    match to, value:
        case (Scalar("BOOL"), bool()):
            return value
        case (_, bool()):
            raise fault("inadmissible")
        case (Scalar("INT"), int()) | (Scalar("REAL"), float()):
            return value
        case (Scalar("REAL"), int()):
            return single(value)
        case (Scalar("INT"), float()):
            return rounded(value)
        case (Scalar("CHAR"), str()) if len(value) == 1:
            return value
        case (Scalar("INT"), str()) if len(value) == 1:
            return ord(value)
        case (Scalar("CHAR"), int()) if 0 <= value <= 255:
            return chr(value)
    raise fault("inadmissible")


def fill(target: StructureValue | ArrayValue, value: Value) -> None:
    """Give a structure or array the value of another, or an array a text; all parts are copied.

    Poses take from poses, and axis positions from axis positions, what both have; the rest then has
    no value. An array of one dimension takes as many elements as it can hold, the rest then has
    no value; with more dimensions the sizes must be equal. Faults ``inadmissible``.
    """
    match target, value:
        case StructureValue(), StructureValue():
            _fill_structure(target, value)
        case ArrayValue(), ArrayValue():
            if target.sizes != value.sizes and not len(target.sizes) == len(value.sizes) == 1:
                raise fault("inadmissible")
            _fill_parts(target.elements, target.base, len(target), target.type.element, list(value))
        case ArrayValue(), str() if target.type.element == CHAR and len(target.sizes) == 1:
            set_text(target, value)
        case _:
            raise fault("inadmissible")


def _fill_structure(target: StructureValue, value: StructureValue) -> None:
    if target.type == value.type:
        parts = list(value.members)
    else:
        names = {target.type.name.upper(), value.type.name.upper()}
        if not (names.issubset(CARTESIAN) or names.issubset(AXES)):
            raise fault("inadmissible")
        places = _places(value.type)
        found = (places.get(member.name.upper()) for member in target.type.members)
        parts = [None if place is None else value.members[place] for place in found]
    for place, (member, part) in enumerate(zip(target.type.members, parts, strict=True)):
        _fill_parts(target.members, place, 1, member.type, [part])


def _fill_parts(
    parts: list[Any], base: int, length: int, type_: Type, values: Sequence[Value | None]
) -> None:
    """Put values, and no value where these end, into ``parts`` from ``base`` on."""
    for place in range(length):
        value = values[place] if place < len(values) else None
        old = parts[base + place]
        if isinstance(old, StructureValue | ArrayValue):
            fresh = empty(type_) if value is None else value
            assert fresh is not None
            fill(old, fresh)
        else:
            parts[base + place] = None if value is None else converted(value, type_)


# -------------------------------------------------------------------------------------- texts


def letters(text: str) -> str:
    """A text of a source file as values have it, one character a byte of the controller's cp1252.

    What cp1252 has not becomes a question mark.
    """
    return text.encode("cp1252", errors="replace").decode("latin-1")


def text_of(value: Value) -> str:
    """The used part of a CHAR array, or a text itself; faults ``argument`` for all else."""
    if isinstance(value, str):
        return value.partition("\0")[0]
    if not (isinstance(value, ArrayValue) and value.type.element == CHAR):
        raise fault("argument")
    found: list[str] = []
    for letter in value:
        if not isinstance(letter, str) or letter == "\0":
            break
        found.append(letter)
    return "".join(found)


def set_text(target: ArrayValue, text: str) -> None:
    """Give a CHAR array a text: what does not fit is cut off, the rest has no value [TYP-11]."""
    length = len(target)
    given: list[str | None] = list(text[:length])
    target.elements[target.base : target.base + length] = given + [None] * (length - len(given))
