"""Poses as numbers: the geometric operator and the inverse of a pose [ARI-08, ARI-09].

A pose is a place X, Y, Z in mm and an orientation A, B, C in degrees: the rotation matrix
Rz(A)·Ry(B)·Rx(C), in row-major order. All is computed in double, in the order written here, and
each result is rounded to single once.

The angles of a matrix are A and C in (-180, 180], B in [-90, 90]. Where the x axis is upright
(B = ±90) only the sum or difference of A and C is defined: then A is 0.
"""

from __future__ import annotations

import math

from grammar.semantics.types import is_cartesian
from interp.values.faults import fault
from interp.values.values import StructureValue, copied, known, single

__all__ = [
    "DEGREE",
    "RADIAN",
    "Pose",
    "Rotation",
    "angles",
    "composed",
    "inverted",
    "radians",
    "rotation",
]

#: A degree in radians, and a radian in degrees.
DEGREE = math.pi / 180
RADIAN = 180 / math.pi
#: The x axis is upright when its part in the plane is shorter than this: what singles leave of
#: zero is a tenth of it.
_UPRIGHT = 1e-6

Rotation = tuple[float, float, float, float, float, float, float, float, float]
#: X, Y, Z, A, B, C.
Pose = tuple[float, float, float, float, float, float]


def radians(degrees: float) -> float:
    """An angle in radians; full circles are taken off before, so that large angles stay exact."""
    return math.fmod(degrees, 360.0) * DEGREE


def rotation(a: float, b: float, c: float) -> Rotation:
    """The matrix of three angles in degrees."""
    a, b, c = radians(a), radians(b), radians(c)
    sin_a, cos_a = math.sin(a), math.cos(a)
    sin_b, cos_b = math.sin(b), math.cos(b)
    sin_c, cos_c = math.sin(c), math.cos(c)
    return (
        cos_a * cos_b,
        cos_a * sin_b * sin_c - sin_a * cos_c,
        cos_a * sin_b * cos_c + sin_a * sin_c,
        sin_a * cos_b,
        sin_a * sin_b * sin_c + cos_a * cos_c,
        sin_a * sin_b * cos_c - cos_a * sin_c,
        -sin_b,
        cos_b * sin_c,
        cos_b * cos_c,
    )


def angles(matrix: Rotation) -> tuple[float, float, float]:
    """A, B, C of a matrix as REAL, in degrees."""
    across, along = matrix[3], matrix[0]
    if math.sqrt(along * along + across * across) < _UPRIGHT:
        across, along = 0.0, 1.0
    a = math.atan2(across, along)
    sin_a, cos_a = math.sin(a), math.cos(a)
    b = math.atan2(-matrix[6], cos_a * matrix[0] + sin_a * matrix[3])
    c = math.atan2(sin_a * matrix[2] - cos_a * matrix[5], cos_a * matrix[4] - sin_a * matrix[1])
    return _angle(a), _angle(b), _angle(c)


def _angle(radians: float) -> float:
    degrees = single(radians * RADIAN)
    return 180.0 if degrees == -180.0 else degrees + 0.0


def composed(left: StructureValue, right: StructureValue) -> StructureValue:
    """``left : right``, the pose ``right`` that is told in ``left``, told in what ``left`` is in.

    It has the type of ``right``, and all of its members but X to C: Status, Turn and external axes
    are carried over as they are. Faults ``uninitialised`` where one of X to C is missing,
    ``operand`` where an operand is no pose.
    """
    one, other = _pose(left), _pose(right)
    m, n = rotation(*one[3:]), rotation(*other[3:])
    x, y, z = _turned(m, other[0], other[1], other[2])
    product = (
        m[0] * n[0] + m[1] * n[3] + m[2] * n[6],
        m[0] * n[1] + m[1] * n[4] + m[2] * n[7],
        m[0] * n[2] + m[1] * n[5] + m[2] * n[8],
        m[3] * n[0] + m[4] * n[3] + m[5] * n[6],
        m[3] * n[1] + m[4] * n[4] + m[5] * n[7],
        m[3] * n[2] + m[4] * n[5] + m[5] * n[8],
        m[6] * n[0] + m[7] * n[3] + m[8] * n[6],
        m[6] * n[1] + m[7] * n[4] + m[8] * n[7],
        m[6] * n[2] + m[7] * n[5] + m[8] * n[8],
    )
    result: StructureValue = copied(right)
    _put(result, (single(one[0] + x), single(one[1] + y), single(one[2] + z), *angles(product)))
    return result


def inverted(pose: StructureValue) -> StructureValue:
    """The pose that composed with ``pose`` gives zero, in the same type [FCT-03].

    Its other members have no value: Status, Turn and external axes have no inverse. Faults as
    `composed`.
    """
    x, y, z, a, b, c = _pose(pose)
    m = rotation(a, b, c)
    back = (m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8])
    x, y, z = _turned(back, x, y, z)
    result = StructureValue(pose.type, [None] * len(pose.members))
    _put(result, (single(-x), single(-y), single(-z), *angles(back)))
    return result


def _turned(m: Rotation, x: float, y: float, z: float) -> tuple[float, float, float]:
    return (
        m[0] * x + m[1] * y + m[2] * z,
        m[3] * x + m[4] * y + m[5] * z,
        m[6] * x + m[7] * y + m[8] * z,
    )


def _pose(value: StructureValue) -> Pose:
    """X to C, which are the first six members of all poses."""
    if not is_cartesian(value.type):
        raise fault("operand")
    x, y, z, a, b, c = (known(member) for member in value.members[:6])
    return x, y, z, a, b, c  # type: ignore[return-value]  # members of poses are REAL


def _put(value: StructureValue, pose: Pose) -> None:
    value.members[:6] = pose
