"""Values of types as a data list has them, for data that nothing sets; points get places."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Final

from grammar.semantics.types import (
    BOOL,
    CHAR,
    INT,
    REAL,
    UNKNOWN,
    Array,
    Enumeration,
    Scalar,
    Structure,
    Type,
    is_axes,
    is_cartesian,
)
from interp.robot.kinematics.machine_data import AXIS_NAMES, EXTERNAL_NAMES
from interp.robot.models.stand_in import Places

#: Of a structure of arrays, whose elements nothing sets: it cannot be written.
NOTHING: Final = "{}"


class DefaultValues:
    """Values by type; ``placed`` are the variables that have got places so far."""

    def __init__(self, places: Places) -> None:
        self.placed: set[str] = set()
        self._places = places

    def usable(self, type_: Type, name: str) -> str:
        """Return a value for data set outside; numbers are 1, a valid divisor and index."""
        if type_ in (INT, REAL):
            return "1" if type_ == INT else "1.0"
        return self.zero(type_, name)

    def zero(self, type_: Type, name: str, *, is_target: bool = False) -> str:
        """Return a value of a type, with numbers 0; ``name`` is its variable.

        Points have places of their own. A FRAME is a point if it ``is_target`` of motions,
        otherwise a base or an offset.
        """
        match type_:
            case Enumeration(constants=constants):
                return f"#{constants[0]}"
            case Structure():
                is_point = is_cartesian(type_) and (is_target or type_.name.upper() != "FRAME")
                if is_point or is_axes(type_):
                    return f"{{{','.join(self._place(type_, name))}}}"
                return f"{{{','.join(self._components(type_, name))}}}"
            case Scalar():
                return {REAL: "0.0", BOOL: "FALSE", CHAR: '" "'}.get(type_, "0")
        return "0"

    def _place(self, type_: Structure, name: str) -> Iterator[str]:
        self.placed.add(re.split(r"\W", name)[0])
        if is_axes(type_):
            place = zip(AXIS_NAMES, self._places.axes(name), strict=True)
        else:
            place = zip("XYZABC", self._places.pose(name), strict=True)
        yield from (f"{part} {value}" for part, value in place)
        externals = {one.name.upper() for one in type_.members}.intersection(EXTERNAL_NAMES)
        yield from (f"{part} 0.0" for part in sorted(externals))

    def _components(self, type_: Structure, name: str) -> Iterator[str]:
        for member in type_.members:
            if isinstance(member.type, Array):
                if member.type.element == CHAR and len(member.type.sizes) == 1:
                    yield f'{member.name}[] " "'
            elif member.type != UNKNOWN:
                value = self.zero(member.type, f"{name}.{member.name}")
                if value != NOTHING:
                    yield f"{member.name} {value}"
