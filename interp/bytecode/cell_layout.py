"""The layout of values in cells: sizes, offsets of parts, conversion between values and cells.

A cell holds one scalar, or nothing. Structures and arrays are flattened: members in order, elements
row by row. The contents of a cell are *raw*: an ``int`` for INT, a ``float`` for REAL, a ``bool``
for BOOL, the code of a CHAR, the place of a constant in its enumeration; the type says which. A
word of an image holds the same, but a REAL as its bits.
"""

from __future__ import annotations

import math
import struct
from bisect import bisect_right
from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import Any

from grammar.semantics.types import (
    BOOL,
    CHAR,
    INT,
    INT_MAX,
    INT_MIN,
    REAL,
    Array,
    Enumeration,
    Member,
    Scalar,
    Structure,
    Type,
    is_axes,
    is_cartesian,
)
from interp.bytecode.instruction_set.table import MAX_CELLS
from interp.port.requests import Path
from interp.program.variables import cells, is_complete
from interp.values.faults import LinkError
from interp.values.values import ArrayValue, EnumValue, StructureValue, Value, converted

#: The contents of a cell that has a value.
Raw = int | float | bool
#: The types whose values fit into one cell.
Plain = Scalar | Enumeration

#: The number of types whose layout is cached.
_REMEMBERED = 1 << 14

_SINGLE = struct.Struct("<f")
_WORD = struct.Struct("<i")


def bits_of(number: float) -> int:
    """Return the bits of a single-precision number as a signed word."""
    found: int = _WORD.unpack(_SINGLE.pack(number))[0]
    return found


def real_of(bits: int) -> float:
    """Return the single-precision number with these bits; it may be infinite or NaN."""
    found: float = _SINGLE.unpack(_WORD.pack(bits))[0]
    return found


# ------------------------------------------------------------------------------------ sizes


def array_sizes(type_: Array) -> tuple[int, ...]:
    """Return the sizes of an array; raises `LinkError` if one is unknown or not positive."""
    sizes = tuple(size for size in type_.sizes if size is not None)
    if len(sizes) != len(type_.sizes) or not 1 <= len(sizes) <= 3 or min(sizes) < 1:
        raise LinkError(f"{type_} has no size")
    return sizes


def elements(type_: Array) -> int:
    """Return the number of elements of an array."""
    return math.prod(array_sizes(type_))


@lru_cache(_REMEMBERED)
def size(type_: Type) -> int:
    """Return the size of a type in cells; raises `LinkError` if it has none or is too large."""
    if not is_complete(type_):
        raise LinkError(f"no variable can be of {type_}")
    found = cells(type_)
    if found > MAX_CELLS:
        raise LinkError(f"{type_} has {found:,} cells, more than {MAX_CELLS:,}")
    return found


# ------------------------------------------------------------------------------------ parts


@lru_cache(_REMEMBERED)
def _places(type_: Structure) -> tuple[int, ...]:
    """Return the offset of each member."""
    places = [0]
    for member in type_.members:
        places.append(places[-1] + size(member.type))
    return tuple(places[:-1])


@lru_cache(_REMEMBERED)
def _members(type_: Structure) -> Mapping[str, tuple[int, Type]]:
    """Return the offset and type of each member by its name in upper case; the first one counts."""
    pairs = zip(type_.members, _places(type_), strict=True)
    return {one.name.upper(): (place, one.type) for one, place in reversed(tuple(pairs))}


@lru_cache(_REMEMBERED)
def row_of(type_: Array) -> Type:
    """Return the type of an element of the first dimension: a row, or an element."""
    return Array(type_.element, type_.sizes[1:]) if len(type_.sizes) > 1 else type_.element


def _step(type_: Structure | Array, offset: int) -> tuple[str | int, Type, int]:
    """Return the direct part at an offset: its name or index, its type, and the offset in it."""
    if isinstance(type_, Array):
        row = row_of(type_)
        index, left = divmod(offset, size(row))
        return index + 1, row, left
    place = bisect_right(_places(type_), offset) - 1
    member = type_.members[place]
    return member.name.upper(), member.type, offset - _places(type_)[place]


def kind_at(type_: Type, offset: int) -> Plain:
    """Return the type of the cell at an offset, which must be less than the size."""
    if isinstance(type_, Array):
        type_ = type_.element
        offset %= size(type_)
    if isinstance(type_, Structure):
        return _kind_in(type_, offset)
    assert isinstance(type_, Plain), "what has a size is made of scalars"
    return type_


@lru_cache(_REMEMBERED)
def _kind_in(type_: Structure, offset: int) -> Plain:
    _, part, left = _step(type_, offset)
    return kind_at(part, left)


def path_to(type_: Type, offset: int, wanted: Type | None = None) -> Path | None:
    """Return the names and indices that lead to the part at an offset, or ``None``.

    ``wanted`` is the type of the part; by default it is the single cell. A row of an array is a
    part.
    """
    if not 0 <= offset < size(type_):
        return None
    path: list[str | int] = []
    while type_ != wanted or offset:
        if not isinstance(type_, Structure | Array):
            return tuple(path) if wanted is None else None
        step, type_, offset = _step(type_, offset)
        path.append(step)
    return tuple(path)


def array_at(type_: Type, offset: int, element: Type, dimensions: int) -> Array | None:
    """Return the array, or the row of one, with these elements and dimensions at an offset."""
    while isinstance(type_, Structure | Array):
        if isinstance(type_, Array) and (type_.element, len(type_.sizes), offset) == (
            *(element, dimensions, 0),
        ):
            return type_
        _, type_, offset = _step(type_, offset)
    return None


def offset_of(type_: Type, path: Sequence[str | int]) -> tuple[int, Type] | None:
    """Return the offset and the type of a part, or ``None``; the inverse of `path_to`."""
    offset = 0
    for step in path:
        match type_, step:
            case Structure(), str() if step.upper() in _members(type_):
                place, type_ = _members(type_)[step.upper()]
                offset += place
            case Array(), int() if 1 <= step <= array_sizes(type_)[0]:
                type_ = row_of(type_)
                offset += (step - 1) * size(type_)
            case _:
                return None
    return offset, type_


@lru_cache(_REMEMBERED)
def shared_cells(to: Type, of: Type) -> int | None:
    """Return the number of leading cells that two positions of one family have in common.

    Return ``None`` if they are not both cartesian positions or both axis positions.
    """
    families = {_family(to), _family(of)}
    if len(families) != 1 or None in families:
        return None
    count = min(size(to), size(of))
    alike = all(kind_at(to, place) == kind_at(of, place) for place in range(count))
    return count if alike else None


def _family(type_: Type) -> bool | None:
    if is_cartesian(type_):
        return True
    return False if is_axes(type_) else None


# ------------------------------------------------------------------------------------ values


@lru_cache(_REMEMBERED)
def shown(type_: Type) -> Type:
    """Return a type as values show it: without ``@2``, which distinguishes types in a program."""
    match type_:
        case Array():
            return Array(shown(type_.element), type_.sizes)
        case Enumeration() if "@" in type_.name:
            return Enumeration(type_.name.partition("@")[0], type_.constants)
        case Structure():
            members = tuple(Member(one.name, shown(one.type)) for one in type_.members)
            if "@" in type_.name or members != type_.members:
                return Structure(type_.name.partition("@")[0], members)
    return type_


def value_of(raw: Raw, type_: Plain) -> Value:
    """Return the value in a cell of this type."""
    if isinstance(type_, Enumeration):
        kind = shown(type_)
        assert isinstance(kind, Enumeration), "shown as it is"
        return EnumValue(kind, int(raw))
    return chr(int(raw)) if type_ == CHAR else raw


def raw_of(value: Value, type_: Plain) -> Raw:
    """Return the contents of a cell for a value of exactly this type."""
    if isinstance(value, EnumValue):
        return value.index
    if isinstance(value, str):
        return ord(value)
    assert isinstance(value, Raw), f"{value!r} is no value of {type_}"
    return value


def value_at(cells: Sequence[Raw | None], address: int, type_: Type) -> Value | None:
    """Return the value stored in cells; ``None`` only for a scalar without a value."""
    match type_:
        case Structure():
            members = [
                value_at(cells, address + offset, member.type)
                for member, offset in zip(type_.members, _places(type_), strict=True)
            ]
            return StructureValue(shown(type_), members)  # type: ignore[arg-type]  # a structure
        case Array(element=element):
            found = _elements_at(cells, address, type_, element)
            return ArrayValue(shown(type_), found)  # type: ignore[arg-type]  # an array
    raw = cells[address]
    assert isinstance(type_, Plain), "what has a size is made of scalars"
    return None if raw is None else value_of(raw, type_)


def _elements_at(
    cells: Sequence[Raw | None], address: int, type_: Array, element: Type
) -> list[Any]:
    """Return the elements of an array; fast for numbers and letters, because texts are frequent."""
    count = size(type_)
    if element == CHAR:
        letters: Any = cells[address : address + count]
        return [None if raw is None else chr(raw) for raw in letters]
    if isinstance(element, Scalar):
        return list(cells[address : address + count])
    places = range(address, address + count, size(element))
    return [value_at(cells, place, element) for place in places]


def cells_of(value: Value | None, type_: Type) -> list[Raw | None]:
    """Return the cells of a value, after it is converted to a type as by an assignment.

    Raises `interp.values.faults.Fault` if the value cannot be converted.
    """
    if value is None:
        return [None] * size(type_)
    if isinstance(value, str) and isinstance(type_, Array) and type_.element == CHAR:
        length = size(type_)
        if len(type_.sizes) == 1:  # else it cannot be
            given: list[Raw | None] = [ord(letter) for letter in value[:length]]
            return given + [None] * (length - len(given))
    kind = shown(type_)
    if not (isinstance(value, StructureValue | ArrayValue) and value.type == kind):
        value = converted(value, kind)
    return flattened(value, type_)


def flattened(value: Value | None, type_: Type) -> list[Raw | None]:
    """Return the cells of a value of exactly this type."""
    match value:
        case None:
            return [None] * size(type_)
        case StructureValue():
            pairs = zip(value.members, value.type.members, strict=True)
            return [raw for part, member in pairs for raw in flattened(part, member.type)]
        case ArrayValue() if value.type.element == CHAR:
            letters: Any = value
            return [None if letter is None else ord(letter) for letter in letters]
        case ArrayValue():
            return [raw for part in value for raw in flattened(part, value.type.element)]
    assert isinstance(type_, Plain), "what is no structure and no array is a scalar"
    return [raw_of(value, type_)]


# ------------------------------------------------------------------------------------- words


def word_of(raw: Raw) -> int:
    """Return the word of an image for the contents of a cell."""
    return bits_of(raw) if isinstance(raw, float) else int(raw)


def raw_of_word(word: int, type_: Plain) -> Raw:
    """Return the contents of a cell for a valid word; the inverse of `word_of`."""
    if type_ == REAL:
        return real_of(word)
    return bool(word) if type_ == BOOL else word


def is_word_of(word: int, type_: Plain) -> bool:
    """Return whether a word represents a value of this type."""
    if isinstance(type_, Enumeration):
        return 0 <= word < len(type_.constants)
    if type_ == REAL:
        return math.isfinite(real_of(word))
    low, high = _RANGES[type_]
    return low <= word <= high


_RANGES = {INT: (INT_MIN, INT_MAX), BOOL: (0, 1), CHAR: (0, 255)}
