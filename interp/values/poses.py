"""Poses: position and orientation of one frame relative to another, and their composition.

Lengths are in mm and angles in degrees, as in KRL. A, B and C are Z-Y'-X'' Euler angles: a rotation
about Z, then about the new Y, then about the new X, so ``R = Rz(A) Ry(B) Rx(C)`` [ARI-09]. In
``left @ right``, ``right`` is relative to the frame ``left`` [ARI-08].
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

Row = tuple[float, float, float, float]

#: Cosine of B below which A and C rotate about the same axis; the orientation errs by no more.
_LOCKED = 1e-12


@dataclass(frozen=True, slots=True)
class Pose:
    """A pose as the upper three rows of its homogeneous 4 x 4 matrix; the position is in mm."""

    rows: tuple[Row, Row, Row]

    @classmethod
    def of(
        cls,
        x: float = 0.0,
        y: float = 0.0,
        z: float = 0.0,
        a: float = 0.0,
        b: float = 0.0,
        c: float = 0.0,
    ) -> Pose:
        """Return the pose of a FRAME in mm and degrees; multiples of 90 degrees are exact."""
        return cls.turned((x, y, z), sine_cosine(a), sine_cosine(b), sine_cosine(c))

    @classmethod
    def turned(
        cls,
        position: tuple[float, float, float],
        a: tuple[float, float],
        b: tuple[float, float],
        c: tuple[float, float],
    ) -> Pose:
        """Return the pose of a position in mm and of three angles, each as (sine, cosine)."""
        (x, y, z), (sa, ca), (sb, cb), (sc, cc) = position, a, b, c
        return cls(
            (
                (ca * cb, ca * sb * sc - sa * cc, ca * sb * cc + sa * sc, x),
                (sa * cb, sa * sb * sc + ca * cc, sa * sb * cc - ca * sc, y),
                (-sb, cb * sc, cb * cc, z),
            )
        )

    @classmethod
    def from_matrix(cls, matrix: Sequence[Sequence[float]]) -> Pose:
        """Return the pose of a homogeneous matrix with three or four rows."""
        first, second, third = (
            (float(row[0]), float(row[1]), float(row[2]), float(row[3])) for row in matrix[:3]
        )
        return cls((first, second, third))

    @property
    def matrix(self) -> tuple[Row, Row, Row, Row]:
        """The homogeneous matrix, 4 x 4."""
        return (*self.rows, (0.0, 0.0, 0.0, 1.0))

    @property
    def position(self) -> tuple[float, float, float]:
        """X, Y and Z in mm."""
        return self.rows[0][3], self.rows[1][3], self.rows[2][3]

    @property
    def angles(self) -> tuple[float, float, float]:
        """A, B and C in degrees: A and C in (-180, 180], B in [-90, 90].

        Composed again they give the same rotation, also at and near B = ±90. There only the sum or
        the difference of A and C is defined, and A is 0.
        """
        (r00, r01, r02, _), (r10, r11, r12, _), (r20, _, _, _) = self.rows
        cb = math.hypot(r00, r10)
        a = math.atan2(r10, r00) if cb > _LOCKED else 0.0
        # C is computed from A, so that it compensates for rounding in A.
        sa, ca = math.sin(a), math.cos(a)
        c = math.atan2(sa * r02 - ca * r12, ca * r11 - sa * r01)
        return _degrees(a), _degrees(math.atan2(-r20, cb)), _degrees(c)

    @property
    def components(self) -> tuple[float, float, float, float, float, float]:
        """X, Y, Z in mm and A, B, C in degrees: the components of a FRAME."""
        return (*self.position, *self.angles)

    @property
    def is_finite(self) -> bool:
        """Whether no number in the matrix is infinite or NaN."""
        return all(math.isfinite(value) for row in self.rows for value in row)

    def __matmul__(self, other: Pose) -> Pose:
        (b00, b01, b02, bx), (b10, b11, b12, by), (b20, b21, b22, bz) = other.rows
        first, second, third = (
            (
                m0 * b00 + m1 * b10 + m2 * b20,
                m0 * b01 + m1 * b11 + m2 * b21,
                m0 * b02 + m1 * b12 + m2 * b22,
                m0 * bx + m1 * by + m2 * bz + place,
            )
            for m0, m1, m2, place in self.rows
        )
        return Pose((first, second, third))

    def inverse(self) -> Pose:
        """Return the inverse: the pose of the outer frame relative to this one."""
        (r00, r01, r02, x), (r10, r11, r12, y), (r20, r21, r22, z) = self.rows
        return Pose(
            (
                (r00, r10, r20, -(r00 * x + r10 * y + r20 * z)),
                (r01, r11, r21, -(r01 * x + r11 * y + r21 * z)),
                (r02, r12, r22, -(r02 * x + r12 * y + r22 * z)),
            )
        )


def sine_cosine(degrees: float) -> tuple[float, float]:
    """Return sine and cosine of an angle in degrees, exact at multiples of 90.

    The angle is reduced before it is converted to radians, so full turns cost no precision. Both
    are NaN if the angle is infinite or NaN.
    """
    if not math.isfinite(degrees):
        return math.nan, math.nan
    quarter = round(math.fmod(degrees, 360.0) / 90.0)
    rest = math.radians(math.fmod(degrees, 360.0) - 90.0 * quarter)
    sine, cosine = math.sin(rest), math.cos(rest)
    turned = ((sine, cosine), (cosine, -sine), (-sine, -cosine), (-cosine, sine))[quarter % 4]
    return turned[0] + 0.0, turned[1] + 0.0  # no negative zeros


def _degrees(radians: float) -> float:
    value = math.degrees(radians) + 0.0
    return 180.0 if value == -180.0 else value


#: The pose of a frame relative to itself, $NULLFRAME.
IDENTITY = Pose.of()
