"""Jerk-limited profiles: position, speed and acceleration over time on a stretch of path.

A profile has one degree of freedom. Ruckig computes it; here it becomes a sequence of cubic
polynomials, which can be evaluated at many times at once. Positions have the unit of the caller;
times are in seconds.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cached_property, lru_cache
from itertools import pairwise

import numpy as np
import ruckig

from interp.robot.kinematics.kinematics import Array
from interp.robot.planning.ramps import NO_RAMP, Bounds, Ramp, bisected, ramp, speed_after

_SLACK = 1e-7
"""Relative difference within which a change of speed fills a length."""
_EXACT = 1e-9
"""Relative error of a length that is accepted from Ruckig."""
_ROUNDS = 60
_INSTANT = 1e-12  # seconds

#: Duration in s, initial acceleration, and jerk.
Piece = tuple[float, float, float]
#: Time, position, speed, acceleration, jerk.
Knot = tuple[float, float, float, float, float]


class SpeedProfile:
    """A sequence of cubics, given by the state at the start of each, and at the end of the last.

    It begins at time 0 and position 0.
    """

    def __init__(self, knots: Sequence[Knot]) -> None:
        self.knots = knots
        #: Seconds from start to end; the position and the speed there.
        self.duration, self.length, self.final, *_ = knots[-1]

    @property
    def lowest(self) -> float:
        """The lowest speed at the start of a piece or at the end."""
        return min(knot[2] for knot in self.knots)

    @cached_property
    def _columns(self) -> Array:
        return np.array(self.knots).T

    def at(self, times: Array) -> Array:
        """Return positions at times; before the start and after the end those of start and end."""
        clipped = np.minimum(np.maximum(times, 0.0), self.duration)
        starts, positions, speeds, accelerations, jerks = self._columns
        place = np.searchsorted(starts, clipped, side="right") - 1
        dt = clipped - starts[place]
        bends = accelerations[place] / 2 + dt * jerks[place] / 6
        found: Array = positions[place] + dt * (speeds[place] + dt * bends)
        return found

    def state(self, time: float) -> tuple[float, float, float]:
        """Return position, speed and acceleration at a time; outside as in `at`."""
        clipped = min(max(time, 0.0), self.duration)
        later = (place for place, knot in enumerate(self.knots) if knot[0] > clipped)
        # where none is later, that is the last one
        start, position, speed, acceleration, jerk = self.knots[next(later, 0) - 1]
        dt = clipped - start
        return (
            position + dt * (speed + dt * (acceleration / 2 + dt * jerk / 6)),
            speed + dt * (acceleration + dt * jerk / 2),
            acceleration + dt * jerk,
        )

    def time_at(self, position: float) -> float:
        """Return the first time at which a position above 0 is reached, or that of the end."""
        if position >= self.length:
            return self.duration
        (origin, start, speed, acceleration, jerk), (end, *_) = next(
            pair for pair in pairwise(self.knots) if pair[1][1] >= position
        )
        first, last = 0.0, end - origin
        dt = last / 2
        for _ in range(_ROUNDS):
            beyond = start + dt * (speed + dt * (acceleration / 2 + dt * jerk / 6)) - position
            first, last = (first, dt) if beyond >= 0.0 else (dt, last)
            slope = speed + dt * (acceleration + dt * jerk / 2)
            following = dt - beyond / slope if slope > 0.0 else -1.0
            if not first <= following <= last:
                following = (first + last) / 2
            if abs(following - dt) < _INSTANT:
                break
            dt = following
        return origin + dt

    def stretched(self, length: float) -> SpeedProfile:
        """Return the profile with an end position that differs only by rounding."""
        return self if self.length <= 0.0 else self.scaled(length / self.length, length)

    def scaled(self, share: float, length: float | None = None) -> SpeedProfile:
        """Return the profile with positions in another unit."""
        knots = [(t, p * share, v * share, a * share, j * share) for t, p, v, a, j in self.knots]
        if length is not None:
            time, _, speed, acceleration, jerk = knots[-1]
            knots[-1] = (time, length, speed, acceleration, jerk)
        return SpeedProfile(knots)

    def split(self, ends: Sequence[float]) -> list[SpeedProfile]:
        """Return the parts up to each of these increasing positions; the last one is the end."""
        parts: list[SpeedProfile] = []
        before, place = 0.0, 0.0
        for number, end in enumerate(ends, start=1):
            after = self.duration if number == len(ends) else self.time_at(end)
            parts.append(self._part(before, max(after, before)).stretched(end - place))
            before, place = max(after, before), end
        return parts

    def _part(self, start: float, end: float) -> SpeedProfile:
        _, speed, _ = self.state(start)
        pieces = []
        for (begin, _, _, acceleration, jerk), (finish, *_) in pairwise(self.knots):
            first, last = max(begin, start), min(finish, end)
            pieces.append((last - first, acceleration + (first - begin) * jerk, jerk))
        return profile_of(speed, pieces)


def profile_of(speed: float, pieces: Iterable[Piece]) -> SpeedProfile:
    """Return the profile of the pieces that last, from a speed on."""
    time = position = final = slew = 0.0
    knots: list[Knot] = []
    for duration, acceleration, jerk in pieces:
        if duration > 0.0:
            knots.append((time, position, speed, acceleration, jerk))
            position += duration * (speed + duration * (acceleration / 2.0 + duration * jerk / 6.0))
            speed += duration * (acceleration + duration * jerk / 2.0)
            time += duration
            final, slew = acceleration + duration * jerk, jerk
    return SpeedProfile([*knots, (time, position, speed, final, slew)])


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
    direct = ramp(speed, acceleration, target, bounds, final)
    if direct.distance >= length * (1.0 - _SLACK):
        return profile_of(speed, direct.pieces).stretched(length)
    found = _solved(length, speed, acceleration, target, bounds, final)
    misses = found is None or abs(found.length - length) > _EXACT * length
    if found is None or misses or found.lowest < -_SLACK * bounds.velocity:
        found = _searched(length, speed, acceleration, target, bounds, final)
    return found.stretched(length)


def stop(speed: float, acceleration: float, bounds: Bounds) -> SpeedProfile:
    """Return the fastest profile to standstill, over any length."""
    return profile_of(speed, ramp(speed, acceleration, 0.0, bounds).pieces)


def steady(speed: float, length: float) -> SpeedProfile:
    """Return the profile over a length at one speed; without a speed it takes no time."""
    return profile_of(speed, _at(speed, length))


def _at(speed: float, length: float) -> tuple[Piece, ...]:
    return ((length / speed, 0.0, 0.0),) if speed > 0.0 else ()


def _solved(
    length: float, speed: float, acceleration: float, target: float, bounds: Bounds, final: float
) -> SpeedProfile | None:
    """Return the profile that Ruckig finds, or ``None``.

    Ruckig has absolute tolerances, so it is called in units in which the speed is at most 1.
    """
    unit = max(bounds.velocity, target)
    asked = ruckig.InputParameter(1)
    asked.current_position = [0.0]
    asked.current_velocity = [speed / unit]
    asked.current_acceleration = [acceleration / unit]
    asked.target_position = [length / unit]
    asked.target_velocity = [target / unit]
    asked.target_acceleration = [final / unit]
    asked.max_velocity = [1.0]
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


def _searched(
    length: float, speed: float, acceleration: float, target: float, bounds: Bounds, final: float
) -> SpeedProfile:
    """Return the profile by a search for the cruise speed, if rounding makes Ruckig fail."""

    def parts(cruise: float) -> tuple[Ramp, Ramp]:
        return (ramp(speed, acceleration, cruise, bounds), ramp(cruise, 0.0, target, bounds, final))

    def fits(cruise: float) -> bool:
        return sum(part.distance for part in parts(cruise)) <= length

    eased = speed_after(speed, acceleration, 0.0, bounds.jerk)
    low = max(eased, speed_after(target, final, 0.0, -bounds.jerk))
    if fits(low):
        low = bisected(fits, low, max(bounds.velocity, low))
        ramps = parts(low)
    else:  # it brakes already, and all that is left over is travelled behind that
        low, ramps = target, (ramp(speed, acceleration, target, bounds, final), NO_RAMP)
    up, down = ramps
    cruise = _at(low, length - up.distance - down.distance)
    return profile_of(speed, (*up.pieces, *cruise, *down.pieces))
