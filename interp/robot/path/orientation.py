"""The orientation of the tool along a path [ORI-01 to ORI-06].

The change between two orientations is a swivel, which turns the tool direction the shortest way,
followed by a rotation about that direction. Both are linear in u. The tool direction is the X axis
of the tool. Rotations are matrices ``(…, 3, 3)``, angles are in radians.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np
import numpy.typing as npt

from interp.robot.kinematics.kinematics import Array

_PARALLEL = 1e-12
_DIRECTION = np.array([1.0, 0.0, 0.0])


class Orientation(Protocol):
    """An orientation as a function of the path parameter from 0 to 1."""

    @property
    def swivel(self) -> float:
        """The angle by which the tool direction changes in radians, 0 or more."""
        ...

    @property
    def rotation(self) -> float:
        """The angle by which the tool turns about its direction in radians, 0 or more."""
        ...

    def at(self, u: Array) -> Array:
        """Return rotations ``(n, 3, 3)`` for parameters ``(n,)``."""
        ...


@dataclass(frozen=True, slots=True, eq=False)
class Turning:
    """Swivel and rotation, both linear in u: ``start · R(axis, u·swivel) · Rx(u·twist)``."""

    start: Array
    axis: Array
    swivel: float
    twist: float

    @property
    def rotation(self) -> float:
        """See `Orientation.rotation`."""
        return abs(self.twist)

    def at(self, u: Array) -> Array:
        """See `Orientation.at`."""
        turned = np.tile(self.start, (len(u), 1, 1))
        for axis, angle in ((self.axis, self.swivel), (_DIRECTION, self.twist)):
            if angle:  # most tools do not turn
                turned = turned @ rotations_about(axis, u * angle)
        return turned


@dataclass(frozen=True, slots=True, eq=False)
class Carried:
    """An orientation in a frame that turns about an axis by ``angle``: #PATH on circles."""

    inner: Turning
    axis: Array
    angle: float

    @property
    def swivel(self) -> float:
        """See `Orientation.swivel`; an upper bound, because the two rotations add up."""
        return self.inner.swivel + abs(self.angle)

    @property
    def rotation(self) -> float:
        """See `Orientation.rotation`."""
        return self.inner.rotation

    def at(self, u: Array) -> Array:
        """See `Orientation.at`."""
        turned: Array = rotations_about(self.axis, u * self.angle) @ self.inner.at(u)
        return turned


def turning(start: Array, end: Array, extent: float = 1.0) -> Turning:
    """Return the change between two rotations; with ``extent``, ``end`` is at 1 / extent."""
    change = start.T @ end
    ahead, left, up = change[:, 0]
    aside = math.hypot(left, up)
    swivel = math.atan2(aside, ahead)
    if aside < _PARALLEL:
        # The tool direction stays, or is reversed, in which case no shortest way exists.
        axis = np.array([0.0, 1.0, 0.0])
        swivel = 0.0 if ahead > 0.0 else math.pi
    else:
        axis = np.array([0.0, -up, left]) / aside
    (rest,) = rotations_about(axis, np.array([-swivel])) @ change
    twist = math.atan2(rest[2, 1], rest[1, 1])
    if abs(twist) < _PARALLEL:
        twist = 0.0
    return Turning(start, axis, swivel * extent, twist * extent)


def rotations_about(axis: Array, radians: npt.NDArray[np.float64]) -> Array:
    """Return rotations ``(n, 3, 3)`` about a unit axis by angles ``(n,)``."""
    from scipy.spatial.transform import Rotation

    turned: Array = Rotation.from_rotvec(radians[:, None] * axis).as_matrix()
    return turned
