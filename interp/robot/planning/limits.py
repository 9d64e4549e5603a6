"""Speed limits along a curve such that no axis exceeds its machine data.

For u(t) along a curve q(u), an axis has the speed ``q'·u̇`` and the acceleration ``q''·u̇² +
q'·ü``. If ``|q''|·v² + |q'|·a`` is below the limit of every axis, every profile with speeds up to v
and accelerations up to a respects the limits; the same holds for the jerk. So each stretch of a
curve gets one set of bounds, computed from samples; a curve whose samples differ much is divided
into several stretches. The torques of an arm with known masses lower the bounds
(`interp.robot.planning.torque_limits`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from interp.robot.kinematics.kinematics import Array
from interp.robot.path.axis_path import AxisPath, Curve, Rates
from interp.robot.planning.axis_limits import AxisLimits
from interp.robot.planning.ramps import Bounds
from interp.robot.planning.torque_limits import TorqueLimits, TorqueMargin

#: Share of a limit that is used, because limits are checked at samples only.
_MARGIN = 0.97
_ROUNDING = 1.0 - 1e-9
#: Share of an axis's acceleration for changes of speed on a curve; the rest is for curvature.
_SHARE = 0.5
#: Share of an axis's jerk for curvature, and again for changes of speed on a curve; the rest is for
#: building up accelerations.
_BENT = 0.25
#: Share of the constant speed of a blend, if the speed changes in it.
_EASED = 0.8
#: Ratio of speeds in a stretch above which it is cut.
_UNEVEN = 1.25
_SHORTEST = 4  # samples of a stretch
#: Seconds over which a path acceleration builds up: an assumption, no rule has a figure.
_RAMP = 0.08


@dataclass(frozen=True, slots=True)
class PathLimits:
    """The length that u represents, and the maximum speed, acceleration and jerk along it.

    There is one for each of path (mm), swivel and rotation of the tool (degrees) [ORI-06]; the
    slowest is decisive. If ``jerk`` is infinite, acceleration builds up over a fixed time.
    """

    length: float
    velocity: float
    acceleration: float
    jerk: float = math.inf


@dataclass(frozen=True, slots=True)
class Stretch:
    """A part of a curve with one set of bounds, in units of u.

    ``size`` is the length in mm or degrees that u represents; it keeps numbers in a sensible range.
    ``programmed`` is the speed that the override scales. ``normal`` are the bounds of a change of
    speed, ``hard`` those of the hardest possible braking ramp [INT-09]. A blend may be passed at
    constant speed with the bounds ``constant``: a higher speed than in ``normal``, with the
    acceleration and jerk that remain at that speed.
    """

    start: float
    end: float
    size: float
    programmed: float
    normal: Bounds
    hard: Bounds
    constant: Bounds | None = None

    def bounds(self, override: float = 1.0, is_hard: bool = False) -> Bounds:
        """Return the bounds of a change of speed at an override of 0 to 1."""
        return (self.hard if is_hard else self.normal).up_to(self.programmed * override)

    def constant_bounds(self, override: float) -> Bounds:
        """Return the bounds at constant speed."""
        return (self.constant or self.normal).up_to(self.programmed * override)

    def within(self, margin: TorqueMargin) -> Stretch:
        """Return the stretch with bounds at which no torque exceeds what is free of it."""

        def bounded(bounds: Bounds) -> Bounds:
            velocity = min(bounds.velocity, margin.fastest)
            left = margin.left(min(velocity, self.programmed))
            return Bounds(velocity, min(bounds.acceleration, left), bounds.jerk)

        constant = self.constant and bounded(self.constant)
        return replace(
            self, normal=bounded(self.normal), hard=bounded(self.hard), constant=constant
        )

    def between(self, start: float, end: float) -> Stretch:
        """Return the part between two parameters."""
        return replace(self, start=max(start, self.start), end=min(end, self.end))

    def part(self, start: float, share: float) -> Stretch:
        """Return the stretch in the parameter of a part of the curve, given its start and share.

        The curve is no blend.
        """
        return Stretch(
            (self.start - start) / share,
            (self.end - start) / share,
            self.size * share,
            self.programmed / share,
            self.normal * (1.0 / share),
            self.hard * (1.0 / share),
        )


@dataclass(frozen=True, slots=True, eq=False)
class CurveLimits:
    """The stretches of a curve, from u = 0 to 1."""

    stretches: tuple[Stretch, ...]

    def within(self, torques: TorqueLimits | None, curve: AxisPath) -> CurveLimits:
        """Return the stretches with bounds at which no torque of the arm is exceeded."""
        if torques is None:
            return self
        margin = torques.along(curve)
        return CurveLimits(
            tuple(each.within(margin.between(each.start, each.end)) for each in self.stretches)
        )

    def between(self, start: float, end: float) -> tuple[Stretch, ...]:
        """Return the stretches of a part of the curve, cut at its ends."""
        parts = (stretch.between(start, end) for stretch in self.stretches)
        return tuple(part for part in parts if part.end > part.start)

    def part(self, start: float, end: float) -> CurveLimits:
        """Return the stretches of a part of the curve; its own parameter goes from 0 to 1."""
        share = end - start
        return CurveLimits(tuple(each.part(start, share) for each in self.between(start, end)))


def curve_limits_of(
    curve: Curve, machine: AxisLimits, programmed: AxisLimits, paths: Sequence[PathLimits]
) -> CurveLimits:
    """Return the bounds along a curve.

    ``machine`` is never exceeded. ``programmed`` limits accelerations, and limits speeds like a
    programmed speed, which the override scales. ``paths`` are the components of a CP motion, or
    empty.
    """
    grid = curve.grid
    samples = _Samples(curve.rates(grid))
    slowest = np.minimum(
        samples.speed(programmed),
        min((path.velocity / path.length for path in paths), default=math.inf),
    )
    steepest = min((path.acceleration / path.length for path in paths), default=math.inf)
    if curve.is_straight:
        normal, hard = samples.straight(machine, programmed, steepest)
    else:
        normal, hard = samples.curved(machine, programmed, steepest, slowest)
    velocity, acceleration, jerk = normal
    jerk = np.minimum(jerk, hard[2])
    for path in paths:
        is_known = math.isfinite(path.jerk)
        jerk = np.minimum(jerk, path.jerk / path.length if is_known else acceleration / _RAMP)
    size = max([*(path.length for path in paths), float(samples.first.max(initial=0.0)), 1e-9])
    stretches = []
    for low, high in pairwise(_cuts(np.minimum(velocity, slowest), 0, len(grid) - 1)):
        part = slice(max(low - 1, 0), high + 2)  # with the next sample on either side
        start, end = float(grid[low]), float(grid[high])
        wanted = float(slowest[part].min()) * _ROUNDING
        bounds = (
            Bounds(*(float(row[part].min()) * _ROUNDING for row in rows))
            for rows in ((velocity, acceleration, jerk), hard)
        )
        stretches.append(Stretch(start, end, size, wanted, *bounds))
    return CurveLimits(tuple(stretches)).within(programmed.torques, curve)


def constant_speed_limits(
    rates: Rates,
    limits: AxisLimits,
    beside: Sequence[Bounds],
    programmed: float,
    most: float,
    size: float,
) -> CurveLimits:
    """Return the bounds of a blend with these derivatives, which may be passed at constant speed.

    ``beside`` are the bounds on both sides in the units of the blend; ``programmed`` is a speed
    that the override scales, ``most`` one that is never exceeded. If the speed changes in the
    blend, it is limited to a share of the constant speed.
    """
    programmed = min(programmed, *(bounds.velocity for bounds in beside))
    samples = _Samples(rates)
    fastest = float(samples.speed(limits).min()) * _ROUNDING
    sharpest, quickest = samples.steady_speeds(limits)

    def bounds(share: float) -> Bounds:
        """Return the bounds up to a share of the speed at which curvature takes all of an axis."""
        speed = min(fastest, share * sharpest, share * quickest, most)
        return Bounds(speed, *samples.left(limits, min(speed, programmed), beside))

    normal, constant = bounds(_MARGIN * _EASED), bounds(_MARGIN)
    return CurveLimits((Stretch(0.0, 1.0, size, programmed, normal, normal, constant),))


class _Samples:
    """Samples of a curve: what they leave of the limits of the axes, and bounds from that.

    ``first``, ``second`` and ``third`` are the absolute derivatives of the axes by u, each
    ``(n, axes)``.
    """

    def __init__(self, rates: Rates) -> None:
        self.first, self.second, self.third = (np.abs(each) for each in rates)
        self._divisors = _positive(self.first)

    def speed(self, limits: AxisLimits) -> Array:
        """Return the largest speed at each sample, ``(n,)``."""
        return _least(limits.velocity / self._divisors)

    def acceleration(self, limits: AxisLimits, speed: Array | float = 0.0) -> Array:
        """Return the acceleration that curvature leaves at a speed, ``(n,)``."""
        return _least((limits.acceleration - self.second * speed**2) / self._divisors)

    def jerk(self, limits: AxisLimits, used: Array | float = 0.0) -> Array:
        """Return the jerk that is left of the limits once so much of it is used, ``(n,)``."""
        return _least((limits.jerk - used) / self._divisors)

    def straight(
        self, machine: AxisLimits, programmed: AxisLimits, steepest: float
    ) -> tuple[Rates, Rates]:
        """Return the normal and the hard bounds of a straight curve: speed, acceleration, jerk.

        The normal acceleration is at most ``steepest``.
        """
        velocity = self.speed(machine)
        acceleration = np.minimum(self.acceleration(programmed), steepest)
        hard = velocity, self.acceleration(machine), self.jerk(machine)
        return (velocity, acceleration, self.jerk(programmed)), hard

    def curved(
        self, machine: AxisLimits, programmed: AxisLimits, steepest: float, slowest: Array
    ) -> tuple[Rates, Rates]:
        """Return the same of a curve that is travelled at the speed ``slowest`` ``(n,)`` or less.

        The speed leaves the axes enough for half of their acceleration.
        """
        acceleration = np.minimum(_SHARE * _MARGIN * self.acceleration(programmed), steepest)
        left = programmed.acceleration - self.first * acceleration[:, None]
        bent = np.sqrt(_least(left / _positive(self.second)))
        velocity = np.minimum(self.speed(machine), bent) * _MARGIN
        turned = np.cbrt(_least(_BENT * programmed.jerk / _positive(self.third)))
        velocity = np.minimum(velocity, turned)
        speed = np.minimum(velocity, slowest)[:, None]
        most = _least(_BENT * programmed.jerk / _positive(3.0 * self.second * speed))
        acceleration = np.minimum(acceleration, most)
        hardest = np.minimum(self.acceleration(machine, speed) * _MARGIN, most)
        hardest = np.maximum(hardest, acceleration)
        jerk = self.third * speed**3 + 3.0 * self.second * speed * acceleration[:, None]
        smooth, sharpest = (self.jerk(each, jerk) * _MARGIN for each in (programmed, machine))
        return (velocity, acceleration, smooth), (velocity, hardest, sharpest)

    def steady_speeds(self, limits: AxisLimits) -> tuple[float, float]:
        """Return the speeds at which curvature takes all of an axis's acceleration, and jerk."""
        sharpest = math.sqrt((limits.acceleration / _positive(self.second)).min())
        return sharpest, math.cbrt((limits.jerk / _positive(self.third)).min())

    def left(
        self, limits: AxisLimits, speed: float, beside: Sequence[Bounds]
    ) -> tuple[float, float]:
        """Return the acceleration and jerk that remain at a speed, at most those beside it."""
        turned = limits.jerk - self.third * speed**3
        bent = 3.0 * self.second * speed
        acceleration = min(
            float(self.acceleration(limits, speed).min()),
            float((turned / 2.0 / _positive(bent)).min()),
            *(bounds.acceleration for bounds in beside),
        )
        jerk = float(((turned - bent * acceleration) / self._divisors).min())
        return acceleration * _ROUNDING, min(jerk, *(bounds.jerk for bounds in beside)) * _ROUNDING


def _cuts(speeds: Array, low: int, high: int) -> list[int]:
    """Return the indices of samples at which to cut, including both ends."""
    part = speeds[low : high + 1]
    if high - low < 2 * _SHORTEST or float(part.max()) <= _UNEVEN * float(part.min()):
        return [low, high]
    middle = (low + high) // 2
    left, right = _cuts(speeds, low, middle), _cuts(speeds, middle, high)
    lowest = [float(speeds[a : b + 1].min()) for a, b in ((left[-2], middle), (middle, right[1]))]
    if max(lowest) <= _UNEVEN * min(lowest):  # no use in a cut between two that are alike
        return [*left[:-1], *right[1:]]
    return [*left, *right[1:]]


def _positive(rates: Array) -> Array:
    return np.maximum(rates, 1e-12)


def _least(ratios: Array) -> Array:
    least: Array = ratios.min(axis=1)
    return least
