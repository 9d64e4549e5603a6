"""Where values are: places of the program's own data, and places of the world.

A `Local` is an element of a list: of the one cell of a variable, of the members of a structure, of
the elements of an array. So a reference to a part is a place like any other, and what is passed
:OUT is the place itself [SCO-06].
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any, Final

from grammar.types import UNKNOWN, Array, Structure, Type
from interp.faults import LinkError, fault
from interp.requests import Path
from interp.values import (
    ArrayValue,
    StructureValue,
    Value,
    converted,
    copied,
    empty,
    fill,
    member_place,
)

__all__ = [
    "MOST_CELLS",
    "Local",
    "Place",
    "Remote",
    "cells",
    "element",
    "fresh",
    "member",
    "of_type",
    "sized",
]


#: All variables of a program together hold at most so many scalars, as in the machines.
MOST_CELLS: Final = 1 << 20


@dataclass(frozen=True, slots=True)
class Local:
    """A place of the program. ``path`` is what the routine that uses it calls it."""

    parts: list[Any]
    at: int
    type: Type
    path: Path

    def get(self) -> Value | None:
        """What is there, if anything."""
        found: Value | None = self.parts[self.at]
        return found

    def set(self, value: Value) -> None:
        """Convert and copy a value into the place; faults `inadmissible`, `overflow`."""
        old = self.parts[self.at]
        if isinstance(old, StructureValue | ArrayValue):
            fill(old, value)
        else:
            self.parts[self.at] = of_type(self.type, value)


@dataclass(frozen=True, slots=True)
class Remote:
    """A system variable or a part of one, which is asked for and told."""

    path: Path
    type: Type


Place = Local | Remote


def of_type(type_: Type, value: Value) -> Value:
    """A copy of a value, converted as far as the type it is for is known."""
    if type_ == UNKNOWN or (isinstance(type_, Array) and None in type_.sizes):
        kept: Value = copied(value)
        return kept
    return converted(value, type_)


def fresh(type_: Type, name: str) -> Local:
    """A variable without a value."""
    is_open = type_ == UNKNOWN or (isinstance(type_, Array) and None in type_.sizes)
    return Local([None if is_open else empty(type_)], 0, type_, (name,))


@cache
def cells(type_: Type) -> int:
    """How many scalars a variable holds; 1 where its type or size is not known.

    Raises `LinkError` where there are more than a program may have.
    """
    match type_:
        case Structure():
            count = sum(cells(one.type) for one in type_.members)
        case Array():
            count = cells(type_.element) * math.prod(size or 1 for size in type_.sizes)
        case _:
            return 1
    if count > MOST_CELLS:
        raise LinkError(f"a variable of type {type_} is too large")
    return count


def sized(type_: Type, value: Value) -> Type:
    """The type of a formal array ``X[]``, which has its sizes from what it receives."""
    if isinstance(type_, Array) and None in type_.sizes:
        if isinstance(value, ArrayValue):
            return Array(type_.element, value.sizes)
        if isinstance(value, str):
            return Array(type_.element, (max(1, len(value)),))
    return type_


def member(base: Place, name: str) -> Place:
    """``base.name``; faults `uninitialised` where there is nothing to take it of."""
    key = name.upper()
    if isinstance(base, Remote):
        known = base.type.member(key) if isinstance(base.type, Structure) else None
        return Remote((*base.path, key), known or UNKNOWN)
    whole = base.get()
    if not isinstance(whole, StructureValue):
        raise (
            fault("uninitialised") if whole is None else LinkError(f"{key} is a member of nothing")
        )
    at = member_place(whole.type, key)
    return Local(whole.members, at, whole.type.members[at].type, (*base.path, key))


def element(base: Place, indices: Sequence[int]) -> Place:
    """``base[indices]``, or what is left of an array; faults `index`, `uninitialised`."""
    path = (*base.path, *indices)
    if isinstance(base, Remote):
        is_whole = isinstance(base.type, Array) and len(base.type.sizes) == len(indices)
        return Remote(
            path, base.type.element if is_whole and isinstance(base.type, Array) else UNKNOWN
        )
    whole = base.get()
    if not isinstance(whole, ArrayValue):
        raise fault("uninitialised") if whole is None else LinkError("an index of what is no array")
    if len(indices) > len(whole.sizes):
        raise LinkError("an array has too many indices")
    if len(indices) < len(whole.sizes):
        part = whole.part(*indices)
        return Local([part], 0, part.type, path)
    return Local(whole.elements, whole.place(indices), whole.type.element, path)
