"""Values of a running program: their representation in Python, conversion, copying and assignment.

======================  =======================================================================
INT                     ``int`` in 32 bits with sign [TYP-01]
REAL                    ``float`` that is exactly an IEEE single, finite [TYP-02]
BOOL                    ``bool``
CHAR                    ``str`` of length 1 whose code point is the byte, 0 to 255 [TYP-03]
text constant           ``str``; of length 1 it is a CHAR as well [TYP-11]
enumeration constant    `EnumValue`
structure               `StructureValue`
array                   `ArrayValue`
no value yet            ``None`` [TYP-13]
======================  =======================================================================

A member or element without a value is ``None``; `known` faults if the program needs its value. A
structure or array itself is never ``None``: after its declaration, no part of it has a value.
Structures and arrays are mutable but have value semantics: assignment uses `fill`, which copies
part by part, and so keeps references (OUT parameters, rows of arrays) intact. Parts without a value
are copied as such, without a fault.

The used part of a text ends before its first element that has no value or the code 0.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import field
from functools import cache
from typing import Any, Final

from grammar.semantics.numbers import nearest_integer
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

# A store to a C float and a load from it is the fastest exact rounding among those measured: 0.11
# µs, against 0.22 with struct, 0.17 with ctypes and 0.36 with numpy (docs/adr/0013-numbers.md).
_cell = memoryview(bytearray(4)).cast("f")


def single(number: float) -> float:
    """Return ``number`` rounded to the nearest IEEE single, ties to even.

    A number that is too small becomes subnormal or zero. Faults ``overflow`` if the number is too
    large, infinite or NaN.
    """
    _cell[0] = number
    result = _cell[0]
    if -REAL_MAX <= result <= REAL_MAX:
        return result
    raise fault("overflow")


def integer(number: int) -> int:
    """Return ``number``; faults ``overflow`` if it does not fit into an INT [ARI-12]."""
    if INT_MIN <= number <= INT_MAX:
        return number
    raise fault("overflow")


def rounded(number: float) -> int:
    """Return the nearest INT, halves away from zero; faults ``overflow`` [ARI-03, CON-02]."""
    return integer(nearest_integer(number))


# -------------------------------------------------------------------------------- compound values


@dataclass(frozen=True, slots=True)
class EnumValue:
    """A constant of an enumeration, by its index in the declaration, counted from 0 [TYP-16]."""

    type: Enumeration
    index: int

    @property
    def name(self) -> str:
        """The name of the constant without ``#``, as declared."""
        return self.type.constants[self.index]

    def __repr__(self) -> str:
        return f"#{self.name}"


@dataclass(slots=True)
class StructureValue:
    """A structure: its members, in the order of the type."""

    type: Structure
    members: list[Any]

    def get(self, name: str) -> Value | None:
        """Return the member of that name; raise `KeyError` if there is none."""
        found: Value | None = self.members[self.type.places[name.upper()]]
        return found

    def set(self, name: str, value: Value | None) -> None:
        """Set a member, without converting or copying the value."""
        self.members[self.type.places[name.upper()]] = value


@dataclass(slots=True, eq=False)
class ArrayValue:  # noqa: PLW1641  # it changes, so it has no hash, as StructureValue has none
    """An array, or a part of one: elements in row-major order, from index ``base`` on.

    ``type`` has all its sizes (else `LinkError`), and ``sizes`` repeats them. A part shares
    ``elements`` with its array.
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
        """Return the index of an element in ``elements``; faults ``index`` [TYP-09].

        The array indices count from 1, one for each dimension. With fewer indices, the result is
        the index of the first element of the part that they select.
        """
        place = 0
        sizes = self.sizes
        for wanted, size in zip(indices, sizes, strict=False):
            if not 1 <= wanted <= size:
                raise fault("index")
            place = place * size + wanted - 1
        return self.base + place * math.prod(sizes[len(indices) :])

    def get(self, *indices: int) -> Value | None:
        """Return an element; faults ``index``."""
        found: Value | None = self.elements[self.place(indices)]
        return found

    def set(self, value: Value | None, *indices: int) -> None:
        """Set an element, without converting or copying the value; faults ``index``."""
        self.elements[self.place(indices)] = value

    def part(self, *indices: int) -> ArrayValue:
        """Return the part that indices of the first dimensions select: ``NAMES[3,]`` [TYP-11].

        The part shares its elements with the array. Faults ``index``.
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


def member_place(type_: Structure, name: str) -> int:
    """Return the index of a member, counted from 0; raise `LinkError` if there is none."""
    try:
        return type_.places[name.upper()]
    except KeyError:
        raise LinkError(f"{type_} has no component {name} that is known") from None


@cache
def constant(type_: Enumeration, name: str) -> EnumValue:
    """Return the constant ``#NAME``; raise `LinkError` if the enumeration does not have it."""
    wanted = name.upper()
    for place, one in enumerate(type_.constants):
        if one.upper() == wanted:
            return EnumValue(type_, place)
    raise LinkError(f"{type_} has no constant #{name} that is known")


@cache
def position_type(names: frozenset[str]) -> Structure | None:
    """Return the smallest pose type, else the smallest axis type, with all these components.

    This is the type of ``{X 1,Y 2}`` if the context gives none. The names are in upper case. Return
    ``None`` if no type fits.
    """
    types = System.load().types
    for name in ("FRAME", "POS", "E3POS", "E6POS", "AXIS", "E3AXIS", "E6AXIS"):
        type_ = types[name]
        assert isinstance(type_, Structure), "as all positions"
        if names <= type_.places.keys():
            return type_
    return None


# ---------------------------------------------------------------------------- making and copying


def empty(type_: Type) -> Value | None:
    """Return the content of a variable after its declaration, in which no part has a value."""
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
    """Return a value whose parts are all zero, FALSE, code 0 or the first constant.

    It serves as the value of a system variable about which nothing is known.
    """
    match type_:
        case Structure():
            return StructureValue(type_, [zero(member.type) for member in type_.members])
        case Array():
            return ArrayValue(type_, [zero(type_.element) for _ in range(math.prod(_sizes(type_)))])
        case Enumeration() if type_.constants:
            return EnumValue(type_, 0)
        case Scalar():
            return _ZEROS[type_]
    raise LinkError(f"nothing can be of {type_}")


def copied(value: Any) -> Any:
    """Return a deep copy of a value; a part of an array becomes an array of its own."""
    match value:
        case StructureValue():
            return StructureValue(value.type, [copied(member) for member in value.members])
        case ArrayValue():
            return ArrayValue(value.type, [copied(element) for element in value])
    return value


def known(value: Value | None) -> Value:
    """Return the value; faults ``uninitialised`` if it is ``None`` [TYP-13, SCO-08]."""
    if value is None:
        raise fault("uninitialised")
    return value


def has_value(value: Value | None) -> bool:
    """Return whether any part of a value is set."""
    match value:
        case StructureValue():
            return any(map(has_value, value.members))
        case ArrayValue():
            return any(map(has_value, value))
    return value is not None


# ---------------------------------------------------------------------------------- conversion


def type_of(value: Value) -> Type:
    """Return the type of a value; a ``str`` that is no CHAR has the type `Text`, not an array."""
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
    """Return a value as an array index: a REAL is rounded, a CHAR stands for its code."""
    found = converted(value, INT)
    assert isinstance(found, int)
    return found


def converted(value: Value, to: Type) -> Value:
    """Return a value converted to the type ``to``, as in an assignment, sharing no part with it.

    Faults ``inadmissible`` if the conversion does not exist, ``overflow`` if a REAL is too large
    for an INT [ARI-03, ARI-11, TYP-12]. `grammar.semantics.assignability.assignable` defines the
    conversions.
    """
    if isinstance(to, Structure | Array):
        target = empty(to)
        assert isinstance(target, StructureValue | ArrayValue)
        fill(target, value)
        return target
    match to, value:
        case (Enumeration(), EnumValue()) if is_same(value.type, to):
            return value
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
    """Assign a structure or array to a structure or array, or a text to an array, part by part.

    Between two pose types, or two axis types, the common components are copied, and the others
    lose their value. An array of one dimension receives as many elements as it can hold, and the
    rest of its elements lose their value; with more dimensions the sizes must be equal. Faults
    ``inadmissible``. Twins: ``interp/bytecode/vm/arrays.py`` and ``array_operations.h`` in C.
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
        places = value.type.places
        found = (places.get(member.name.upper()) for member in target.type.members)
        parts = [None if place is None else value.members[place] for place in found]
    for place, (member, part) in enumerate(zip(target.type.members, parts, strict=True)):
        _fill_parts(target.members, place, 1, member.type, [part])


def _fill_parts(
    parts: list[Any], base: int, length: int, type_: Type, values: Sequence[Value | None]
) -> None:
    """Store ``values`` into ``parts`` from ``base`` on; clear the parts beyond their end."""
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
    """Return a text of a source file as KRL characters, one for each byte of cp1252.

    Characters that cp1252 does not have become question marks.
    """
    return text.encode("cp1252", errors="replace").decode("latin-1")


def text_of(value: Value) -> str:
    """Return the used part of a CHAR array, or of a text; faults ``argument`` for other values."""
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
    """Assign a text to a CHAR array: cut it to the size, clear the other elements [TYP-11]."""
    length = len(target)
    given: list[str | None] = list(text[:length])
    target.elements[target.base : target.base + length] = given + [None] * (length - len(given))
