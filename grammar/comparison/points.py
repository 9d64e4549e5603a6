"""How far a taught point was moved: distance, rotation, axes; and its tool and base.

Positions are in millimetres, angles in degrees in the convention of KUKA: A about Z, then B about
the new Y, then C about the new X.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass

from grammar.comparison.content import Datum
from grammar.syntax import ast

_POSES = frozenset({"FRAME", "POS", "E3POS", "E6POS"})
_AXES = frozenset({"AXIS", "E3AXIS", "E6AXIS"})
POINT_TYPES = _POSES | _AXES

# In the key of a datum, whose tokens are separated by blanks.
_FRAMES = re.compile(r"\b(TOOL_NO|BASE_NO) (?:[-+] )?\S+")
_Quaternion = tuple[float, float, float, float]


@dataclass(frozen=True, slots=True)
class PointChange:
    """The difference between two values of a point; a field is ``None`` if it does not apply.

    ``distance`` (mm) and ``angle`` (degrees) are those between two poses; ``axis`` is the largest
    difference of a robot axis in degrees. ``components`` are all that differ, with old and new
    value.
    """

    distance: float | None
    angle: float | None
    axis: float | None
    components: Mapping[str, tuple[float | None, float | None]]


def point_change(old: Datum, new: Datum) -> PointChange | None:
    """Return the change from one value to another, or ``None`` unless both are aggregates."""
    before, after = numbers_of(old), numbers_of(new)
    if before is None or after is None:
        return None
    names = dict.fromkeys([*before, *after])
    pairs = {name: (before.get(name), after.get(name)) for name in names}
    changed = {name: pair for name, pair in pairs.items() if pair[0] != pair[1]}
    distance = angle = axis = None
    if {"X", "Y", "Z"} <= before.keys() & after.keys():
        distance = math.dist(*([one[name] for name in "XYZ"] for one in (before, after)))
    if {"A", "B", "C"} <= before.keys() & after.keys():
        angle = _angle(*(_rotation(*(one[name] for name in "ABC")) for one in (before, after)))
    axes = [name for name in pairs if name[0] == "A" and name[1:].isdigit()]
    both = [(a, b) for a, b in map(pairs.__getitem__, axes) if a is not None and b is not None]
    if both:
        axis = max(abs(b - a) for a, b in both)
    return PointChange(distance, angle, axis, changed)


def frame_numbers(data: Mapping[str, Datum], point: str) -> tuple[int | None, int | None]:
    """Return the numbers of tool and base of a point taught by an inline form.

    The form keeps them in a variable beside the point: ``FP1`` for ``XP1``.
    """
    form = data.get(f"F{point[1:]}") if point.startswith("X") else None
    known = numbers_of(form) if form else None
    numbers = [(known or {}).get(name) for name in ("TOOL_NO", "BASE_NO")]
    tool, base = (None if one is None else int(one) for one in numbers)
    return tool, base


def without_frames(data: Mapping[str, Datum], form: Datum) -> str:
    """Return the key of a datum, without tool and base if it is the form of a point in ``data``."""
    name = form.name.upper()
    has_point = name[0] == "F" and f"X{name[1:]}" in data
    return _FRAMES.sub(r"\1", form.key) if has_point else form.key


def numbers_of(datum: Datum) -> dict[str, float] | None:
    """Return the components of an aggregate that are numbers; ``None`` for other values."""
    if not isinstance(datum.value, ast.Aggregate):
        return None
    found = {}
    for one in datum.value.components:
        number = _number(one.value)
        if number is not None and one.indices is None:
            found[one.name.key] = number
    return found


def _number(node: ast.Expression) -> float | None:
    sign = 1.0
    while isinstance(node, ast.Unary) and node.operator in ("-", "+"):
        sign = -sign if node.operator == "-" else sign
        node = node.operand
    if isinstance(node, ast.IntegerLiteral | ast.RealLiteral | ast.BitLiteral):
        return sign * float(node.value)
    return None


def _rotation(a: float, b: float, c: float) -> _Quaternion:
    """Return the rotation of A, B, C as a unit quaternion."""
    (sa, ca), (sb, cb), (sc, cc) = (
        (math.sin(math.radians(one) / 2), math.cos(math.radians(one) / 2)) for one in (a, b, c)
    )
    return (
        ca * cb * cc + sa * sb * sc,
        ca * cb * sc - sa * sb * cc,
        ca * sb * cc + sa * cb * sc,
        sa * cb * cc - ca * sb * sc,
    )


def _angle(one: _Quaternion, other: _Quaternion) -> float:
    """Return the angle between two orientations in degrees; accurate for small angles too."""
    w, x, y, z = one
    v, p, q, r = other
    # the relative rotation; the length of its vector part is the sine of half the angle
    vector = (
        w * p - x * v - y * r + z * q,
        w * q + x * r - y * v - z * p,
        w * r - x * q + y * p - z * v,
    )
    cosine = abs(w * v + x * p + y * q + z * r)
    return math.degrees(2 * math.atan2(math.hypot(*vector), cosine))
