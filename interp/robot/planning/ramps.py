"""Ramps: the fastest changes of speed under bounds of acceleration and jerk.

Lengths are in the unit of the caller, times in seconds.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from interp.robot.path.speed_profile import SpeedProfile, profile_of

_ROUNDING = 1e-9


@dataclass(frozen=True, slots=True)
class Bounds:
    """The maximum speed, acceleration and jerk of a profile."""

    velocity: float
    acceleration: float
    jerk: float

    def merged(self, other: Bounds, choose: Callable[[float, float], float]) -> Bounds:
        """Return the lower or the higher of each pair of bounds."""
        return Bounds(
            choose(self.velocity, other.velocity),
            choose(self.acceleration, other.acceleration),
            choose(self.jerk, other.jerk),
        )

    def up_to(self, velocity: float) -> Bounds:
        """Return the bounds with at most this speed."""
        return Bounds(min(self.velocity, velocity), self.acceleration, self.jerk)

    def __mul__(self, scale: float) -> Bounds:
        """Return the bounds in another unit."""
        return Bounds(self.velocity * scale, self.acceleration * scale, self.jerk * scale)


def ramp(
    speed: float, target: float, bounds: Bounds, acceleration: float = 0.0, final: float = 0.0
) -> SpeedProfile:
    """Return the fastest change to a target speed, from one acceleration to another.

    If one of these accelerations exceeds its bound, it replaces the bound.
    """
    jerk, most = bounds.jerk, max(bounds.acceleration, abs(acceleration), abs(final))
    sign = math.copysign(1.0, target - speed_after(speed, acceleration, final, jerk))
    start, end = sign * acceleration, sign * final  # as if speeding up
    square = jerk * sign * (target - speed) + (start * start + end * end) / 2
    highest = math.sqrt(abs(square))  # below 0 by rounding
    peak = min(highest, most)
    pieces = (
        ((peak - start) / jerk, acceleration, sign * jerk),
        ((highest - peak) * (highest + peak) / (jerk * most), sign * peak, 0.0),
        ((peak - end) / jerk, sign * peak, -sign * jerk),
    )
    return profile_of(speed, pieces)


def speed_after(speed: float, acceleration: float, final: float, jerk: float) -> float:
    """Return the speed once a maximum jerk has changed one acceleration to another."""
    return speed + (final + acceleration) * abs(final - acceleration) / (2.0 * jerk)


def at_most(value: float, limit: float) -> bool:
    """Return whether a length or speed is not above a limit, up to rounding errors."""
    return value <= limit + _ROUNDING * (limit + 1.0)
