"""The transition of a blend from one path to the next: the parameters of both as functions of u.

A blend is ``first(one(u)) - P + second(other(u))`` with u from 0 to 1. ``one`` runs from the start
of the blend zone to the end of the first path, ``other`` from the start of the second path to the
end of the zone. At the end of ``one`` and at the start of ``other``, the first and second
derivatives are zero. So the blend leaves one path and joins the other with continuous tangent and
curvature, whatever the paths are, and its jerk is bounded.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Protocol

import numpy as np

from interp.robot.kinematics.kinematics import Array
from interp.robot.path.arc_length import ArcLength

_ROUNDS = 60
_EXACT = 1e-15
_UNEVEN = 2.0
"""Largest ratio of the durations of both sides: beyond it, a blend may cost more than it saves."""
_BEHIND = 1e-9
"""Offset in u after a break; rounding never moves it to before the break."""


class Transition(Protocol):
    """The parameters of both paths in a blend; ``before`` and ``after`` are the shares it uses."""

    @property
    def before(self) -> float:
        """The share of the first path that the blend uses."""
        ...

    @property
    def after(self) -> float:
        """The share of the second path that the blend uses."""
        ...

    @property
    def breaks(self) -> Array:
        """The values of u at which a third derivative jumps, moved slightly to after the jump."""
        ...

    def at(self, u: Array) -> tuple[Array, Array]:
        """Return the parameters ``(n,)`` of the first and of the second path."""
        ...

    def rates(self, u: Array) -> tuple[Array, Array]:
        """Return the first to third derivatives of both by u, each ``(3, n)``."""
        ...


@dataclass(frozen=True, eq=False)
class Rounding:
    """A rounded corner; if the paths continue straight, a line at constant speed.

    ``weights`` are the lengths of both sides of the zone, in the same unit. Both sides follow
    ``h = (4 - slope)·v³ + (slope - 3)·v⁴`` over a parameter v. With a slope of 1, a blend between
    two lines has the apex of a parabola and differs from it by at most 0.3 per cent of the zone,
    but its curvature rises quickly. With a slope of 2 the curvature rises over the whole zone. u is
    proportional to the sum of both sides, or, with the ``cosine`` of the angle between two lines,
    to the length along the curve.
    """

    before: float
    after: float
    weights: tuple[float, float]
    slope: float
    cosine: float = 1.0

    @property
    def breaks(self) -> Array:
        """See `Transition.breaks`."""
        return np.empty(0)

    def at(self, u: Array) -> tuple[Array, Array]:
        """See `Transition.at`."""
        v = self._inner(u)
        one, other = _side(1.0 - v, self.slope)[0], _side(v, self.slope)[0]
        return 1.0 - self.before * one, self.after * other

    def rates(self, u: Array) -> tuple[Array, Array]:
        """See `Transition.rates`."""
        return _rates(self, u.tobytes())

    def rates_at(self, u: Array) -> tuple[Array, Array]:
        """Compute `rates` without the cache."""
        v = self._inner(u)
        _, *left = _side(1.0 - v, self.slope)
        _, *right = _side(v, self.slope)
        signs = (1.0, -1.0, 1.0)
        one = [self.before * s * side for s, side in zip(signs, left, strict=True)]
        other = [self.after * side for side in right]
        (a, b), c = self._shares, self.cosine
        (x1, x2, x3), (y1, y2, y3) = (
            [a * s * x for s, x in zip(signs, left, strict=True)],
            [b * y for y in right],
        )
        square = x1 * x1 + y1 * y1 + 2.0 * c * x1 * y1
        half = x1 * x2 + y1 * y2 + c * (x2 * y1 + x1 * y2)  # of its first derivative
        bend = x2 * x2 + x1 * x3 + y2 * y2 + y1 * y3 + c * (x3 * y1 + 2.0 * x2 * y2 + x1 * y3)
        root = np.sqrt(square)
        w1, w2, w3 = (
            w / self._length for w in (root, half / root, bend / root - half**2 / root**3)
        )
        inner = (1.0 / w1, -w2 / w1**3, (3.0 * w2 * w2 - w1 * w3) / w1**5)
        return np.stack(chained(one, inner)), np.stack(chained(other, inner))

    @property
    def _shares(self) -> tuple[float, float]:
        total = sum(self.weights)
        return self.weights[0] / total, self.weights[1] / total

    def _inner(self, u: Array) -> Array:
        """Return the parameter v for u."""
        if self.cosine == 1.0:
            return _inner(*self._shares, self.slope, u.tobytes())
        return self._way.parameters(u * self._length)

    @cached_property
    def _way(self) -> ArcLength:
        """The length along the curve as a function of v, in sums of both sides."""
        (a, b), c = self._shares, self.cosine

        def tangents(v: Array) -> Array:
            one, other = a * _side(1.0 - v, self.slope)[1], b * _side(v, self.slope)[1]
            return np.stack((one + c * other, math.sqrt(1.0 - c * c) * other), axis=1)

        return ArcLength(tangents)

    @property
    def _length(self) -> float:
        return 1.0 if self.cosine == 1.0 else self._way.length


@dataclass(frozen=True, eq=False)
class Cubics:
    """A parameter as a function of time: consecutive cubics, given by the state at their starts.

    ``knots`` is ``(n, 5)``: time, value, and first to third derivative, from time 0 on; the last
    one is the end.
    """

    knots: Array

    @property
    def duration(self) -> float:
        """The time of all of them."""
        return float(self.knots[-1, 0])

    def at(self, times: Array) -> Array:
        """Return values and first to third derivatives, ``(4, n)``."""
        place = np.searchsorted(self.knots[:, 0], times, side="right") - 1
        start, value, speed, bend, jerk = self.knots.T[:, place]
        dt = times - start
        found = np.empty((4, len(times)))
        found[0] = value + dt * (speed + dt * (bend / 2.0 + dt * jerk / 6.0))
        found[1] = speed + dt * (bend + dt * jerk / 2.0)
        found[2] = bend + dt * jerk
        found[3] = jerk
        return found

    def since(self, value: float) -> Cubics:
        """Return the part from the time at which a value is reached; values must increase."""
        return self.between(self._time(value), self.duration)

    def until(self, value: float) -> Cubics:
        """Return the part up to the time at which a value is reached; values must increase."""
        return self.between(0.0, self._time(value))

    def _time(self, value: float) -> float:
        place = max(int(np.searchsorted(self.knots[:, 1], value)) - 1, 0)
        start, origin, speed, bend, jerk = map(float, self.knots[place])
        low, high = 0.0, float(self.knots[place + 1, 0]) - start
        for _ in range(_ROUNDS):
            dt = (low + high) / 2.0
            if origin + dt * (speed + dt * (bend / 2.0 + dt * jerk / 6.0)) < value:
                low = dt
            else:
                high = dt
        return start + high

    def between(self, start: float, end: float) -> Cubics:
        """Return the part between two times."""
        times = self.knots[:, 0]
        inside = self.knots[(times > start) & (times < end)]
        first, last = np.vstack(((start, end), self.at(np.array([start, end])))).T
        knots = np.vstack((first, inside, last))
        knots[:, 0] -= start
        return Cubics(knots)


@dataclass(frozen=True, eq=False)
class Overlap:
    """The end of one motion and the start of the next, executed at the same time.

    ``ending`` is the parameter of the first path over time while it brakes to its end, ``starting``
    that of the second path while it accelerates from its start. Each motion is executed as it would
    be alone. So the blend takes the longer of both times, while a stop takes their sum.
    """

    ending: Cubics
    starting: Cubics

    @cached_property
    def duration(self) -> float:
        """The duration in s, unless an axis is too fast when both motions are executed at once."""
        return max(self.ending.duration, self.starting.duration)

    @property
    def is_even(self) -> bool:
        """Whether the durations are similar enough for the blend to save more than it costs."""
        durations = self.ending.duration, self.starting.duration
        return max(durations) <= _UNEVEN * min(durations)

    def evened(self) -> Overlap:
        """Return the part in which both motions are executed; outside it, each runs alone."""
        both = min(self.ending.duration, self.starting.duration)
        ending = self.ending.between(self.ending.duration - both, self.ending.duration)
        return Overlap(ending, self.starting.between(0.0, both))

    @cached_property
    def before(self) -> float:
        """See `Transition.before`."""
        return 1.0 - float(self.ending.knots[0, 1])

    @cached_property
    def after(self) -> float:
        """See `Transition.after`."""
        return float(self.starting.knots[-1, 1])

    @property
    def breaks(self) -> Array:
        """See `Transition.breaks`."""
        starting = self.duration - self.starting.duration + self.starting.knots[:, 0]
        times = np.concatenate((self.ending.knots[:, 0], starting))
        return np.minimum(times / self.duration + _BEHIND, 1.0)

    def at(self, u: Array) -> tuple[Array, Array]:
        """See `Transition.at`."""
        one, other = self._both(u)
        return np.minimum(one[0], 1.0), np.maximum(other[0], 0.0)

    def rates(self, u: Array) -> tuple[Array, Array]:
        """See `Transition.rates`."""
        return _rates(self, u.tobytes())

    def rates_at(self, u: Array) -> tuple[Array, Array]:
        """Compute `rates` without the cache."""
        times = u * self.duration
        one, other = self._both(u)
        one = one[1:] * (times <= self.ending.duration)
        other = other[1:] * (times >= self.duration - self.starting.duration)
        return one, other

    def _both(self, u: Array) -> tuple[Array, Array]:
        """Return values and derivatives by u, ``(4, n)`` each."""
        times, powers = u * self.duration, self.duration ** np.arange(4.0)[:, None]
        ending = np.minimum(times, self.ending.duration)
        starting = np.maximum(times - (self.duration - self.starting.duration), 0.0)
        return self.ending.at(ending) * powers, self.starting.at(starting) * powers


def chained(
    outer: Sequence[Array] | Array, inner: Sequence[Array] | Array
) -> tuple[Array, Array, Array]:
    """Return the first to third derivatives of a composed function, by the chain rule.

    ``outer`` are the derivatives of the function by its parameter, ``inner`` those of the
    parameter: three arrays each, of shapes that NumPy can broadcast.
    """
    (f1, f2, f3), (x1, x2, x3) = outer, inner
    return (f1 * x1, f2 * x1**2 + f1 * x2, f3 * x1**3 + 3.0 * f2 * x1 * x2 + f1 * x3)


def _side(v: Array, slope: float) -> tuple[Array, Array, Array, Array]:
    """Return the polynomial of one side of a rounding, and its derivatives."""
    c, d = 4.0 - slope, slope - 3.0
    return (
        v**3 * (c + d * v),
        v**2 * (3.0 * c + 4.0 * d * v),
        v * (6.0 * c + 12.0 * d * v),
        6.0 * c + 24.0 * d * v,
    )


@lru_cache(maxsize=16)  # checks of a blend sample the same few transitions repeatedly
def _rates(transition: Rounding | Overlap, parameters: bytes) -> tuple[Array, Array]:
    """Return the rates at the float64 of an array ``(n,)``; they are read-only."""
    one, other = transition.rates_at(np.frombuffer(parameters))
    one.setflags(write=False)
    other.setflags(write=False)
    return one, other


@lru_cache(maxsize=16)  # values and derivatives are computed at the same parameters
def _inner(a: float, b: float, slope: float, parameters: bytes) -> Array:
    """Return the parameter v of a rounding for u, by Newton's method with bisection as fallback.

    ``a`` and ``b`` are the shares of both sides; ``parameters`` are the float64 of an array
    ``(n,)``.
    """
    u: Array = np.frombuffer(parameters)
    c, d = 4.0 - slope, slope - 3.0
    c3, d4 = 3.0 * c, 4.0 * d
    v, low, high = u.copy(), np.zeros_like(u), np.ones_like(u)
    for _ in range(_ROUNDS):
        w = 1.0 - v
        beyond = a * (1.0 - w**3 * (c + d * w)) + b * (v**3 * (c + d * v)) - u
        if np.abs(beyond).max(initial=0.0) < _EXACT:
            break
        low, high = np.where(beyond <= 0.0, v, low), np.where(beyond >= 0.0, v, high)
        slopes = a * (w**2 * (c3 + d4 * w)) + b * (v**2 * (c3 + d4 * v))
        following = v - beyond / slopes
        outside = (following <= low) | (following >= high)
        following = np.where(outside, (low + high) / 2.0, following)
        if np.array_equal(following, v):
            break
        v = following
    v.setflags(write=False)
    return v
