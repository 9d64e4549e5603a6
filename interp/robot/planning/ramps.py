"""Ramps: the fastest changes of speed under bounds of acceleration and jerk.

Lengths are in the unit of the caller, times in seconds.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from interp.robot.path.speed_profile import SpeedProfile, profile_of

_HALVINGS = 48


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
    speed: float, acceleration: float, target: float, bounds: Bounds, final: float = 0.0
) -> SpeedProfile:
    """Return the fastest change to a target speed, from one acceleration to another.

    If one of these accelerations exceeds its bound, it replaces the bound.
    """
    jerk, most = bounds.jerk, max(bounds.acceleration, abs(acceleration), abs(final))
    sign = 1.0 if target >= speed_after(speed, acceleration, final, jerk) else -1.0
    start, end = sign * acceleration, sign * final  # as if speeding up
    change = sign * (target - speed)
    peak = math.sqrt(abs(jerk * change + (start * start + end * end) / 2))  # below 0 by rounding
    hold = 0.0
    if peak > most:
        hold = (change - (2 * most * most - start * start - end * end) / (2 * jerk)) / most
        peak = most
    pieces = (
        ((peak - start) / jerk, acceleration, sign * jerk),
        (hold, sign * peak, 0.0),
        ((peak - end) / jerk, sign * peak, -sign * jerk),
    )
    return profile_of(speed, pieces)


def speed_after(speed: float, acceleration: float, final: float, jerk: float) -> float:
    """Return the speed once a maximum jerk has changed one acceleration to another."""
    return speed + (final + acceleration) * abs(final - acceleration) / (2.0 * jerk)


def at_most(value: float, limit: float, tolerance: float = 1e-9) -> bool:
    """Return whether a length or speed is not above a limit, up to rounding errors."""
    return value <= limit * (1.0 + tolerance) + 1e-9


def bisected(fits: Callable[[float], bool], within: float, beyond: float) -> float:
    """Return the value that still fits and is nearest to one that does not."""
    for _ in range(_HALVINGS):
        middle = (beyond + within) / 2.0
        if fits(middle):
            within = middle
        else:
            beyond = middle
    return within
