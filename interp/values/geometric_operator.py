"""The geometric operator and the inverse of a pose, on values of KRL [ARI-08, ARI-09].

The computation uses `interp.values.poses.Pose` in double precision, and each result is rounded to
single once. Sines, cosines and angles are those of the C library, in a fixed order of operations
that the machine in C repeats to the bit. In a result, A and C are in (-180, 180] and B is in
[-90, 90]. If the x axis is vertical (B = ±90, gimbal lock), only the sum or the difference of A and
C is defined; then A is 0.
"""

from __future__ import annotations

import math
from typing import Any

from interp.values.poses import Pose
from interp.values.values import StructureValue, copied, known, single

#: A degree in radians, and a radian in degrees.
DEGREE = math.pi / 180
RADIAN = 180 / math.pi
#: The x axis counts as vertical if its projection on the xy plane is shorter than this. Rounding to
#: single leaves a tenth of it instead of zero.
_UPRIGHT = 1e-6


def radians(degrees: float) -> float:
    """Return an angle in radians, reduced by full circles first so that large angles stay exact."""
    return math.fmod(degrees, 360.0) * DEGREE


def composed(left: StructureValue, right: StructureValue) -> StructureValue:
    """Return ``left : right``: the pose ``right``, relative to ``left``, in the base of ``left``.

    The result has the type of ``right`` and all its members except X to C: Status, Turn and
    external axes are carried over. Faults ``uninitialised`` if one of X to C has no value.
    """
    product = _pose(left) @ _pose(right)
    result: StructureValue = copied(right)
    result.members[:6] = _components(product)
    return result


def inverted(pose: StructureValue) -> StructureValue:
    """Return the inverse of ``pose``, in the same type [FCT-03].

    Its other members have no value: Status, Turn and external axes have no inverse. Faults as
    `composed` does.
    """
    back = _pose(pose).inverse()
    result = StructureValue(pose.type, [None] * len(pose.members))
    result.members[:6] = _components(back)
    return result


def _pose(value: StructureValue) -> Pose:
    """Return X to C of a value, the first six members of every pose type, as a transform."""
    numbers: list[Any] = [known(member) for member in value.members[:6]]
    x, y, z, *angles = numbers
    a, b, c = ((math.sin(one), math.cos(one)) for one in map(radians, angles))
    return Pose.turned((x, y, z), a, b, c)


def _components(pose: Pose) -> tuple[float, ...]:
    """Return X to C of a pose as six REAL values.

    `Pose.angles` gives other digits: it takes the length of the projection for the cosine of B, and
    B counts as 90 degrees only within rounding errors of double precision.
    """
    (m00, m01, m02, x), (m10, m11, m12, y), (m20, _, _, z) = pose.rows
    a = 0.0 if math.sqrt(m00 * m00 + m10 * m10) < _UPRIGHT else math.atan2(m10, m00)
    sin_a, cos_a = math.sin(a), math.cos(a)
    b = math.atan2(-m20, cos_a * m00 + sin_a * m10)
    c = math.atan2(sin_a * m02 - cos_a * m12, cos_a * m11 - sin_a * m01)
    return single(x), single(y), single(z), _degrees(a), _degrees(b), _degrees(c)


def _degrees(angle: float) -> float:
    degrees = single(angle * RADIAN)
    return 180.0 if degrees == -180.0 else degrees + 0.0
