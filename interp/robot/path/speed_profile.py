"""Position, speed and acceleration over time along a path, as consecutive cubics.

They can be evaluated at many times at once. Positions have the unit of the caller; times are in
seconds.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import cached_property
from itertools import pairwise
from typing import TypeVar

import numpy as np

from interp.robot.kinematics.kinematics import Array

_HALVINGS = 52

#: Duration in s, initial acceleration, and jerk.
Piece = tuple[float, float, float]
#: Time, position, speed, acceleration, jerk.
Knot = tuple[float, float, float, float, float]
_Number = TypeVar("_Number", float, Array)


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
        """Return position, speed, acceleration and jerk at times, ``(4, n)``.

        Before the start and after the end they are those of start and end.
        """
        clipped = np.minimum(np.maximum(times, 0.0), self.duration)
        place = np.searchsorted(self._columns[0], clipped, side="right") - 1
        start, position, speed, acceleration, jerk = self._columns[:, place]
        dt = clipped - start
        states = np.empty((4, len(dt)))  # filled row by row: stacking takes twice as long
        states[0], states[1], states[2] = _moved(dt, position, speed, acceleration, jerk)
        states[3] = jerk
        return states

    def state(self, time: float) -> tuple[float, float, float]:
        """Return position, speed and acceleration at a time; outside as in `at`."""
        clipped = min(max(time, 0.0), self.duration)
        later = (place for place, knot in enumerate(self.knots) if knot[0] > clipped)
        # where none is later, that is the last one
        start, *state = self.knots[next(later, 0) - 1]
        return _moved(clipped - start, *state)

    def time_at(self, position: float) -> float:
        """Return the first time at which a position above 0 is reached, or that of the end."""
        if position >= self.length:
            return self.duration
        (origin, *state), (end, *_) = next(
            pair for pair in pairwise(self.knots) if pair[1][1] >= position
        )
        return origin + bisected(lambda dt: _moved(dt, *state)[0] < position, 0.0, end - origin)

    def stretched(self, length: float) -> SpeedProfile:
        """Return the profile with an end position that differs only by rounding."""
        if self.length <= 0.0:
            return self
        *knots, (time, _, speed, acceleration, jerk) = self.scaled(length / self.length).knots
        return SpeedProfile([*knots, (time, length, speed, acceleration, jerk)])

    def scaled(self, share: float) -> SpeedProfile:
        """Return the profile with positions in another unit."""
        return SpeedProfile(
            [(t, p * share, v * share, a * share, j * share) for t, p, v, a, j in self.knots]
        )

    def split(self, ends: Sequence[float]) -> list[SpeedProfile]:
        """Return the parts up to each of these increasing positions; the last one is the end."""
        parts: list[SpeedProfile] = []
        before = place = 0.0
        for end in ends:
            after = self.time_at(end)
            parts.append(self.between(before, after).stretched(end - place))
            before, place = after, end
        return parts

    def between(self, start: float, end: float) -> SpeedProfile:
        """Return the part between two times."""
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
            position, speed, final = _moved(duration, position, speed, acceleration, jerk)
            time, slew = time + duration, jerk
    return SpeedProfile([*knots, (time, position, speed, final, slew)])


def steady(speed: float, length: float) -> SpeedProfile:
    """Return the profile over a length at one speed; without a speed it takes no time."""
    return profile_of(speed, ((length / speed, 0.0, 0.0),) if speed > 0.0 else ())


def joined(profiles: Sequence[SpeedProfile]) -> SpeedProfile:
    """Return one profile of several that follow one another."""
    time = position = 0.0
    knots: list[Knot] = []
    for profile in profiles:
        own = [(time + t, position + p, v, a, j) for t, p, v, a, j in profile.knots]
        knots = [*knots[:-1], *own]
        time, position, *_ = knots[-1]
    return SpeedProfile(knots)


def bisected(fits: Callable[[float], bool], within: float, beyond: float) -> float:
    """Return the value that fits and is nearest to one that may not."""
    if fits(beyond):
        return beyond
    for _ in range(_HALVINGS):
        middle = (beyond + within) / 2.0
        if fits(middle):
            within = middle
        else:
            beyond = middle
    return within


def _moved(
    dt: _Number, position: _Number, speed: _Number, acceleration: _Number, jerk: _Number
) -> tuple[_Number, _Number, _Number]:
    """Return position, speed and acceleration after a time of constant jerk."""
    return (
        position + dt * (speed + dt * (acceleration / 2.0 + dt * jerk / 6.0)),
        speed + dt * (acceleration + dt * jerk / 2.0),
        acceleration + dt * jerk,
    )
