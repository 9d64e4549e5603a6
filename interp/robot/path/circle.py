"""A circle through three points, and the angle that a motion covers [MOT-12, MOT-13, MOT-20]."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from interp.robot.kinematics.kinematics import Array
from interp.values.faults import Fault

_SAME = 1e-6  # mm below which two points are the same
#: Square of the sine of the angle at a point below which three points are collinear.
_STRAIGHT = 1e-12


@dataclass(frozen=True, slots=True, eq=False)
class Circle:
    """An arc: ``centre + radius · (cos φ · first + sin φ · second)``, φ from 0 to ``angle``.

    ``normal`` is the axis about which φ increases. ``programmed`` is φ at the programmed end point;
    a programmed circular angle may end before or after it. Angles are in radians, lengths in mm.
    """

    centre: Array
    first: Array
    second: Array
    radius: float
    angle: float
    programmed: float

    @property
    def normal(self) -> Array:
        """The unit vector along the axis of the circle."""
        return np.cross(self.first, self.second)

    @property
    def length(self) -> float:
        """The length of the arc in mm."""
        return self.radius * abs(self.angle)

    def at(self, u: Array) -> Array:
        """Return points ``(n, 3)`` for parameters from 0 to 1."""
        phi = (u * self.angle)[:, None]
        return self.centre + self.radius * (np.cos(phi) * self.first + np.sin(phi) * self.second)

    def tangents(self, u: Array) -> Array:
        """Return the derivatives of the points by u in mm, ``(n, 3)``."""
        phi = (u * self.angle)[:, None]
        onward = np.cos(phi) * self.second - np.sin(phi) * self.first
        tangents: Array = self.radius * self.angle * onward
        return tangents


def circle_through(
    start: Array, auxiliary: Array, end: Array, degrees: float | None = None
) -> Circle:
    """Return the arc from start through the auxiliary point to the end, or over a given angle.

    A positive angle goes in the direction of the auxiliary point, a negative one in the other; it
    may exceed a full turn. Raises `Fault` 1456 to 1458 if two points coincide, and 1506 if all
    three are collinear or the angle is infinite or NaN.
    """
    for one, other, number, what in (
        (start, end, 1456, "start and end"),
        (start, auxiliary, 1457, "start and auxiliary point"),
        (auxiliary, end, 1458, "auxiliary point and end"),
    ):
        if float(np.linalg.norm(one - other)) < _SAME:
            text = f"{what} of the circle are the same point"
            raise Fault("circle", text, number=number, rules=("MOT-12",))
    if degrees is not None and not math.isfinite(degrees):
        raise _inadmissible("the circular angle is no number")
    to_auxiliary, to_end = auxiliary - start, end - start
    across = np.cross(to_auxiliary, to_end)
    square = float(across @ across)
    sides = float(to_auxiliary @ to_auxiliary) * float(to_end @ to_end)
    if square < _STRAIGHT * sides:
        raise _inadmissible("start, auxiliary point and end lie on a line")
    to_centre = (
        np.cross(across, to_auxiliary) * float(to_end @ to_end)
        + np.cross(to_end, across) * float(to_auxiliary @ to_auxiliary)
    ) / (2.0 * square)
    radius = float(np.linalg.norm(to_centre))
    first = -to_centre / radius
    second = np.cross(across / math.sqrt(square), first)
    centre = start + to_centre
    outward = end - centre
    programmed = math.atan2(float(outward @ second), float(outward @ first)) % (2.0 * math.pi)
    angle = programmed if degrees is None else math.radians(degrees)
    if angle < 0.0:
        programmed -= 2.0 * math.pi
    return Circle(centre, first, second, radius, angle, programmed)


def _inadmissible(why: str) -> Fault:
    text = f"a parameter of the circle is not allowed: {why}"
    return Fault("circle", text, number=1506, rules=("MOT-12",))
