"""Storage locations: places in the program's own data, and system variables.

A `LocalPlace` is an element of a list: of the single cell of a variable, of the members of a
structure, or of the elements of an array. So a reference to a part is a place like any other, and
an argument passed :OUT is passed as its place [SCO-06].
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from grammar.semantics.types import CHAR, UNKNOWN, Array, Structure, Type
from interp.port.requests import Path
from interp.program.variables import is_referable, mismatched
from interp.values.faults import LinkError, fault
from interp.values.values import (
    ArrayValue,
    StructureValue,
    Value,
    converted,
    copied,
    empty,
    fill,
    member_place,
    type_of,
)


@dataclass(frozen=True, slots=True)
class LocalPlace:
    """A place in the program's data; ``path`` is its name in the routine that uses it."""

    parts: list[Any]
    type: Type
    path: Path
    at: int = 0

    def get(self) -> Value | None:
        """Return the value at the place, or ``None`` if it has none."""
        found: Value | None = self.parts[self.at]
        return found

    def set(self, value: Value) -> None:
        """Convert and copy a value into the place; faults ``inadmissible``, ``overflow``."""
        old = self.parts[self.at]
        if isinstance(old, ArrayValue) and isinstance(value, ArrayValue):
            _check_elements(old, value)
        if isinstance(old, StructureValue | ArrayValue):
            fill(old, value)
        else:
            self.parts[self.at] = of_type(self.type, value)


@dataclass(frozen=True, slots=True)
class SystemPlace:
    """A system variable or a part of one, which the controller reads and writes.

    ``is_indexed`` is set if the program computed an index in the path.
    """

    path: Path
    type: Type
    is_indexed: bool = False


Place = LocalPlace | SystemPlace


def _check_elements(target: ArrayValue, value: ArrayValue) -> None:
    """Raise `LinkError` if the element types differ: array assignment converts no elements."""
    of, given = target.type.element, value.type.element
    if of != given and len(target.sizes) == len(value.sizes):
        raise LinkError(f"an array of {given} fills one of {of}")


def of_type(type_: Type, value: Value) -> Value:
    """Return a copy of a value, converted to a type as far as the type is known."""
    if type_ == UNKNOWN or (isinstance(type_, Array) and None in type_.sizes):
        kept: Value = copied(value)
        return kept
    return converted(value, type_)


def fresh(type_: Type, name: str) -> LocalPlace:
    """Return the place of a new variable without a value."""
    is_open = type_ == UNKNOWN or (isinstance(type_, Array) and None in type_.sizes)
    return LocalPlace([None if is_open else empty(type_)], type_, (name,))


def is_left_out(place: Place) -> bool:
    """Return whether a place is an array parameter ``X[]`` that the caller omitted."""
    return (
        isinstance(place, LocalPlace) and isinstance(place.type, Array) and None in place.type.sizes
    )


def sized(type_: Type, value: Value) -> Type:
    """Return the type of a formal array ``X[]`` with the sizes of its argument.

    Raises `LinkError` if that is no such array.
    """
    if not isinstance(type_, Array) or None not in type_.sizes:
        return type_
    given = Array(CHAR, (max(1, len(value)),)) if isinstance(value, str) else type_of(value)
    if not is_referable(type_, given):
        raise mismatched(type_)
    return given


def member(base: Place, name: str) -> Place:
    """Return the place of ``base.name``; faults ``uninitialised`` if ``base`` has no value."""
    key = name.upper()
    if isinstance(base, SystemPlace):
        known = base.type.member(key) if isinstance(base.type, Structure) else None
        return SystemPlace((*base.path, key), known or UNKNOWN, base.is_indexed)
    whole = base.get()
    if not isinstance(whole, StructureValue):
        raise (
            fault("uninitialised") if whole is None else LinkError(f"{key} is a member of nothing")
        )
    at = member_place(whole.type, key)
    return LocalPlace(whole.members, whole.type.members[at].type, (*base.path, key), at)


def element(base: Place, indices: Sequence[int]) -> Place:
    """Return the place of ``base[indices]``, or of a part of an array if indices are missing.

    Faults ``index``, and ``uninitialised`` if ``base`` has no value.
    """
    path = (*base.path, *indices)
    if isinstance(base, SystemPlace):
        is_whole = isinstance(base.type, Array) and len(base.type.sizes) == len(indices)
        left = base.type.element if is_whole and isinstance(base.type, Array) else UNKNOWN
        return SystemPlace(path, left, is_indexed=True)
    whole = base.get()
    if not isinstance(whole, ArrayValue):
        raise fault("uninitialised") if whole is None else LinkError("an index of what is no array")
    if len(indices) > len(whole.sizes):
        raise LinkError("an array has too many indices")
    if len(indices) < len(whole.sizes):
        part = whole.part(*indices)
        return LocalPlace([part], part.type, path)
    return LocalPlace(whole.elements, whole.type.element, path, whole.place(indices))
