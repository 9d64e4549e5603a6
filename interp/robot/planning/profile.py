"""Jerk-limited profiles over a length, from one speed to another, and to a stop.

A profile has one degree of freedom. Ruckig computes it; here it becomes a sequence of cubics.
"""

from __future__ import annotations

from functools import lru_cache

import ruckig

from interp.robot.path.speed_profile import SpeedProfile, joined, profile_of, steady
from interp.robot.planning.ramps import Bounds, ramp, speed_after

#: Relative difference within which a change of speed fills a length.
_SLACK = 1e-7
#: Relative difference by which rounding may let the speed beside an end exceed its bound.
_SPARE = 2e-6
#: Relative difference by which Ruckig may exceed the speed.
_ROUNDING = 1e-11


@lru_cache(maxsize=256)  # plans that differ in a blend have most of their spans in common
def travel(
    length: float,
    speed: float,
    acceleration: float,
    target: float,
    bounds: Bounds,
    final: float = 0.0,
) -> SpeedProfile:
    """Return the fastest profile over a length, from a speed and acceleration to others.

    The caller has checked with `ramp` that it is possible. If the change of speed just fits into
    the length, it is the whole profile.
    """
    direct = ramp(speed, target, bounds, acceleration, final)
    if direct.length >= length * (1.0 - _SLACK):
        return direct.stretched(length)
    found = _solved(length, speed, acceleration, target, bounds, final)
    if found is None or found.lowest < -_SLACK * bounds.velocity:
        found = _unhurried(length, speed, acceleration, target, bounds, final)
    return found.stretched(length)


def _solved(
    length: float, speed: float, acceleration: float, target: float, bounds: Bounds, final: float
) -> SpeedProfile | None:
    """Return the profile that Ruckig finds, or ``None``.

    Ruckig has absolute tolerances, so it is called in units in which the speed is about 1 at most.
    Where a state needs more than that by rounding, Ruckig would find nothing, or brake first.
    """
    unit = max(bounds.velocity, target)
    for v, a, jerk in ((speed, acceleration, bounds.jerk), (target, final, -bounds.jerk)):
        eased = speed_after(v, a, 0.0, jerk)
        if eased * (1.0 - _SPARE) <= unit:
            unit = max(eased, unit)
    asked = ruckig.InputParameter(1)
    asked.current_velocity = [speed / unit]
    asked.current_acceleration = [acceleration / unit]
    asked.target_position = [length / unit]
    asked.target_velocity = [target / unit]
    asked.target_acceleration = [final / unit]
    asked.max_velocity = [1.0 + _ROUNDING]
    asked.max_acceleration = [max(bounds.acceleration, abs(final)) / unit]
    asked.max_jerk = [bounds.jerk / unit]
    trajectory = ruckig.Trajectory(1)
    try:
        result = ruckig.Ruckig(1).calculate(asked, trajectory)
    except ruckig.RuckigError:
        return None
    if result not in (ruckig.Result.Working, ruckig.Result.Finished):
        return None
    ((solved,),) = trajectory.profiles
    pieces = [
        *zip(solved.brake.t, solved.brake.a, solved.brake.j, strict=True),
        *zip(solved.t, solved.a[:-1], solved.j, strict=True),
    ]
    return profile_of(speed, ((t, a * unit, jerk * unit) for t, a, jerk in pieces))


def _unhurried(
    length: float, speed: float, acceleration: float, target: float, bounds: Bounds, final: float
) -> SpeedProfile:
    """Return a profile that goes to its highest speed first, as far as the length allows that.

    Ruckig has none where the override has dropped and the speed is above its bound.
    """
    fastest = bounds.velocity
    before = ramp(speed, fastest, bounds, acceleration)
    behind = ramp(fastest, target, bounds, final=final)
    left = length - before.length - behind.length
    if left >= 0.0:
        return joined((before, steady(fastest, left), behind))
    direct = ramp(speed, target, bounds, acceleration, final)
    return joined((direct, steady(target, length - direct.length)))
