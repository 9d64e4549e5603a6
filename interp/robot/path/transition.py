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

import numpy as np
from numpy.polynomial import Polynomial
from numpy.polynomial.polynomial import polyval

from interp.robot.kinematics.kinematics import Array
from interp.robot.path.arc_length import ArcLength
from interp.robot.path.speed_profile import SpeedProfile

#: Largest ratio of the durations of both sides: beyond it, a blend may cost more than it saves.
_UNEVEN = 2.0
#: Offset in u after a break; rounding never moves it to before the break.
_BEHIND = 1e-9


@dataclass(frozen=True, eq=False)
class Rounding:
    """A rounded corner; if the paths continue straight, a line at constant speed.

    ``before`` and ``after`` are shares of both paths, ``weights`` the lengths of both sides of the
    zone, in the same unit. Both sides follow
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
        """The values of u at which a third derivative jumps: none."""
        return np.empty(0)

    def at(self, u: Array) -> tuple[Array, Array]:
        """Return the parameters ``(n,)`` of the first and of the second path."""
        left, joined = _side_rates(self._inner(u), self.slope, 0)
        return 1.0 - self.before * left, self.after * joined

    def rates(self, u: Array) -> tuple[Array, Array]:
        """Return the first to third derivatives of both by u, each ``(3, n)``."""
        return _rates(self, u.tobytes())

    def rates_at(self, u: Array) -> tuple[Array, Array]:
        """Compute `rates` without the cache."""
        rates = _side_rates(self._inner(u), self.slope, slice(1, None))
        first, second, third = _directed(rates, self._shares, self.cosine)
        square = (first * first).sum(axis=1)
        half = (first * second).sum(axis=1)  # of its first derivative
        bend = (second * second + first * third).sum(axis=1)
        root = np.sqrt(square)
        w1, w2, w3 = (
            w / self.way.length for w in (root, half / root, bend / root - half**2 / root**3)
        )
        inner = (1.0 / w1, -w2 / w1**3, (3.0 * w2 * w2 - w1 * w3) / w1**5)
        one, other = (np.stack(chained(rates[:, side], inner)) for side in (0, 1))
        return -self.before * one, self.after * other

    @property
    def _shares(self) -> tuple[float, float]:
        total = sum(self.weights)
        return self.weights[0] / total, self.weights[1] / total

    def _inner(self, u: Array) -> Array:
        """Return the parameter v for u."""
        return _inner(self.way, u.tobytes())

    @property
    def way(self) -> ArcLength:
        """The length along the curve as a function of v, in sums of both sides."""
        return _way(self._shares, self.slope, self.cosine)


@dataclass(frozen=True, eq=False)
class Overlap:
    """The end of one motion and the start of the next, executed at the same time.

    ``ending`` is the way over time on the first path in u while it brakes to its end, ``starting``
    that on the second path while it accelerates from its start. Each motion is executed as it would
    be alone. So the blend takes the longer of both times, while a stop takes their sum.
    """

    ending: SpeedProfile
    starting: SpeedProfile

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

    @property
    def before(self) -> float:
        """The share of the first path that the blend uses."""
        return self.ending.length

    @property
    def after(self) -> float:
        """The share of the second path that the blend uses."""
        return self.starting.length

    @property
    def breaks(self) -> Array:
        """The values of u at which a third derivative jumps, moved slightly to after the jump."""
        ending, starting = (
            np.array([knot[0] for knot in each.knots]) for each in (self.ending, self.starting)
        )
        times = np.concatenate((ending, starting + self._delay))
        return np.minimum(times / self.duration + _BEHIND, 1.0)

    def at(self, u: Array) -> tuple[Array, Array]:
        """Return the parameters ``(n,)`` of the first and of the second path."""
        one, other = self._both(u)
        return 1.0 - self.before + one[0], other[0]

    def rates(self, u: Array) -> tuple[Array, Array]:
        """Return the first to third derivatives of both by u, each ``(3, n)``."""
        return _rates(self, u.tobytes())

    def rates_at(self, u: Array) -> tuple[Array, Array]:
        """Compute `rates` without the cache."""
        times = u * self.duration
        one, other = self._both(u)
        one = one[1:] * (times <= self.ending.duration)
        other = other[1:] * (times >= self._delay)
        return one, other

    def _both(self, u: Array) -> tuple[Array, Array]:
        """Return values and derivatives by u, ``(4, n)`` each."""
        times, powers = u * self.duration, self.duration ** np.arange(4.0)[:, None]
        return self.ending.at(times) * powers, self.starting.at(times - self._delay) * powers

    @property
    def _delay(self) -> float:
        """The time in s after which the second motion begins."""
        return self.duration - self.starting.duration


#: The parameters of both paths in a blend.
Transition = Rounding | Overlap


def chained(
    outer: Sequence[Array] | Array, inner: Sequence[Array] | Array
) -> tuple[Array, Array, Array]:
    """Return the first to third derivatives of a composed function, by the chain rule.

    ``outer`` are the derivatives of the function by its parameter, ``inner`` those of the
    parameter: three arrays each, of shapes that NumPy can broadcast.
    """
    (f1, f2, f3), (x1, x2, x3) = outer, inner
    return (f1 * x1, f2 * x1**2 + f1 * x2, f3 * x1**3 + 3.0 * f2 * x1 * x2 + f1 * x3)


@lru_cache(maxsize=16)
def _sides(slope: float) -> Array:
    """Return coefficients in v of what is left of one side, and of what was travelled of the other.

    They are ``(5, 4, 2)``: by power, derivative and side.
    """
    joined = Polynomial((0.0, 0.0, 0.0, 4.0 - slope, slope - 3.0))
    sides = joined(Polynomial((1.0, -1.0))), joined
    return np.array(
        [[np.pad(side.deriv(order).coef, (0, order)) for side in sides] for order in range(4)]
    ).transpose(2, 0, 1)


def _side_rates(v: Array, slope: float, orders: int | slice) -> Array:
    """Return derivatives of both sides by v, ``(orders, 2, n)``."""
    return np.asarray(polyval(v, _sides(slope)[:, orders]), dtype=np.float64)


def _directed(rates: Array, shares: tuple[float, float], cosine: float) -> Array:
    """Return derivatives of a place ``(..., n, 2)`` from those of both sides ``(..., 2, n)``.

    Lengths are in sums of both sides.
    """
    left, joined = (share * rates[..., side, :] for side, share in enumerate(shares))
    sine = math.sqrt(1.0 - cosine * cosine)
    return np.stack((cosine * joined - left, sine * joined), axis=-1)


@lru_cache(maxsize=16)  # checks of a blend sample the same few transitions repeatedly
def _rates(transition: Rounding | Overlap, parameters: bytes) -> tuple[Array, Array]:
    """Return the rates at the float64 of an array ``(n,)``; they are read-only."""
    one, other = transition.rates_at(np.frombuffer(parameters))
    one.setflags(write=False)
    other.setflags(write=False)
    return one, other


@lru_cache(maxsize=16)  # a corner tries zones of several sizes that have one shape
def _way(shares: tuple[float, float], slope: float, cosine: float) -> ArcLength:
    """Return the length along a rounding as a function of v, in sums of both sides."""
    return ArcLength(lambda v: _directed(_side_rates(v, slope, 1), shares, cosine))


@lru_cache(maxsize=16)  # values and derivatives are computed at the same parameters
def _inner(way: ArcLength, parameters: bytes) -> Array:
    """Return the parameter v of a rounding for u, the float64 of an array; it is read-only."""
    v = way.parameters(np.frombuffer(parameters) * way.length)
    v.setflags(write=False)
    return v
