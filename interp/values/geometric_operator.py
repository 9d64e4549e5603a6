"""The geometric operator and the inverse of a pose, for values of KRL [ARI-08, ARI-09].

All is computed in double on `interp.values.poses.Pose`, and each result is rounded to single once.
Sines, cosines and angles are those of the C library in one order of operations, which the machine
in C repeats to the bit. The angles of a result are A and C in (-180, 180], B in [-90, 90]. Where
the x axis is upright (B = ±90) only the sum or difference of A and C is defined: then A is 0.
"""

from __future__ import annotations

import math
from typing import Any

from grammar.semantics.types import is_cartesian
from interp.values.faults import fault
from interp.values.poses import Pose
from interp.values.values import StructureValue, copied, known, single

#: A degree in radians, and a radian in degrees.
DEGREE = math.pi / 180
RADIAN = 180 / math.pi
#: The x axis is upright when its part in the plane is shorter than this: what singles leave of
#: zero is a tenth of it.
_UPRIGHT = 1e-6


def radians(degrees: float) -> float:
    """An angle in radians; full circles are taken off before, so that large angles stay exact."""
    return math.fmod(degrees, 360.0) * DEGREE


def composed(left: StructureValue, right: StructureValue) -> StructureValue:
    """``left : right``, the pose ``right`` that is given in ``left``, given in what ``left`` is in.

    It has the type of ``right``, and all of its members but X to C: Status, Turn and external axes
    are carried over as they are. Faults ``uninitialised`` where one of X to C is missing,
    ``operand`` where an operand is no pose.
    """
    product = _pose(left) @ _pose(right)
    result: StructureValue = copied(right)
    result.members[:6] = _components(product)
    return result


def inverted(pose: StructureValue) -> StructureValue:
    """The pose that composed with ``pose`` gives zero, in the same type [FCT-03].

    Its other members have no value: Status, Turn and external axes have no inverse. Faults as
    `composed`.
    """
    back = _pose(pose).inverse()
    result = StructureValue(pose.type, [None] * len(pose.members))
    result.members[:6] = _components(back)
    return result


def _pose(value: StructureValue) -> Pose:
    """X to C, which are the first six members of all poses."""
    if not is_cartesian(value.type):
        raise fault("operand")
    numbers: list[Any] = [known(member) for member in value.members[:6]]
    x, y, z, *angles = numbers
    a, b, c = ((math.sin(one), math.cos(one)) for one in map(radians, angles))
    return Pose.turned((x, y, z), a, b, c)


def _components(pose: Pose) -> tuple[float, ...]:
    """X to C as REAL."""
    (m00, m01, m02, x), (m10, m11, m12, y), (m20, _, _, z) = pose.rows
    across, along = m10, m00
    if math.sqrt(along * along + across * across) < _UPRIGHT:
        across, along = 0.0, 1.0
    a = math.atan2(across, along)
    sin_a, cos_a = math.sin(a), math.cos(a)
    b = math.atan2(-m20, cos_a * m00 + sin_a * m10)
    c = math.atan2(sin_a * m02 - cos_a * m12, cos_a * m11 - sin_a * m01)
    return single(x), single(y), single(z), _degrees(a), _degrees(b), _degrees(c)


def _degrees(angle: float) -> float:
    degrees = single(angle * RADIAN)
    return 180.0 if degrees == -180.0 else degrees + 0.0
