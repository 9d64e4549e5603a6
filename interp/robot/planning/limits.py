"""Speed limits along a curve such that no axis exceeds its machine data.

For u(t) along a curve q(u), an axis has the speed ``q'·u̇`` and the acceleration ``q''·u̇² +
q'·ü``. If ``|q''|·v² + |q'|·a`` is below the limit of every axis, every profile with speeds up to v
and accelerations up to a respects the limits. So each stretch of a curve gets one v and one a,
computed from samples; a curve whose samples differ much is divided into several stretches. The
torques of an arm with known masses lower both (`interp.robot.planning.torque_limits`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from interp.robot.arm import Load
from interp.robot.kinematics.machine_data import Axis, AxisKind, Dynamics, MachineData
from interp.robot.kinematics.solver import Array
from interp.robot.path.axis_path import Curve, Rates
from interp.robot.planning.ramps import Bounds
from interp.robot.planning.torque_limits import TorqueLimits, TorqueMargin

_MARGIN = 0.97
"""Share of a limit that is used, because limits are checked at samples only."""
_ROUNDING = 1.0 - 1e-9
_SHARE = 0.5
"""Share of an axis's acceleration for changes of speed on a curve; the rest is for curvature."""
_BENT = 0.25
"""Share of an axis's jerk for curvature, and again for changes of speed on a curve; the rest is for
building up accelerations."""
_EASED = 0.8
"""Share of the constant speed of a blend, if the speed changes in it."""
_UNEVEN = 1.25
"""Ratio of speeds in a stretch above which it is cut."""
_SHORTEST = 4  # samples of a stretch
_RAMP = 0.08
"""Seconds over which a path acceleration builds up: an assumption, no rule has a figure."""

_ROTARY = Dynamics(180.0, 450.0, 4500.0)
_LINEAR = Dynamics(1000.0, 2500.0, 25000.0)
"""The dynamics of an axis without machine data: assumed, similar to those of other arms."""


@dataclass(frozen=True, slots=True, eq=False)
class AxisLimits:
    """Speed, acceleration and jerk of all axes, each ``(axes,)``, in deg or mm and seconds.

    ``torques`` are the limits of an arm whose masses are known.
    """

    velocity: Array
    acceleration: Array
    jerk: Array
    torques: TorqueLimits | None = None

    def equals(self, other: AxisLimits) -> bool:
        """Return whether all limits are equal."""
        names = ("velocity", "acceleration", "jerk")
        are_equal = all(np.array_equal(getattr(self, n), getattr(other, n)) for n in names)
        return are_equal and self.torques == other.torques

    def carrying(self, loads: Mapping[str, Load]) -> AxisLimits:
        """Return the limits of the arm with these loads."""
        if self.torques is None:
            return self
        return replace(self, torques=self.torques.carrying(loads))

    def scaled(
        self, velocity: Sequence[float], acceleration: Sequence[float], jerk: Sequence[float]
    ) -> AxisLimits:
        """Return limits scaled by percentages; one outside 0 to 100 counts as 100 [MOT-02]."""
        count = len(self.velocity)
        return AxisLimits(
            self.velocity * _shares(velocity, count),
            self.acceleration * _shares(acceleration, count),
            self.jerk * _shares(jerk, count),
            self.torques,
        )

    def merged(self, other: AxisLimits, choose: Callable[[Array, Array], Array]) -> AxisLimits:
        """Return the lower or the higher limit for each axis; torques are those of the first."""
        return AxisLimits(
            choose(self.velocity, other.velocity),
            choose(self.acceleration, other.acceleration),
            choose(self.jerk, other.jerk),
            self.torques,
        )


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

    ``velocity`` is what the axes allow; ``programmed`` is the speed that the override scales.
    ``hardest`` and ``sharpest`` are acceleration and jerk of the hardest possible braking ramp
    [INT-09]. ``size`` is the length in mm or degrees that u represents; it keeps numbers in a
    sensible range. A blend may be passed at constant speed up to ``even``, which is more than
    ``velocity``; for a blend ``hardest`` and ``sharpest`` are what remains at that speed.
    """

    start: float
    end: float
    velocity: float
    programmed: float
    acceleration: float
    jerk: float
    hardest: float
    sharpest: float
    size: float
    even: float = 0.0

    def bounds(self, override: float, is_hard: bool = False) -> Bounds:
        """Return the bounds at an override of 0 to 1."""
        speed = min(self.velocity, self.programmed * override)
        if is_hard and not self.even:
            return Bounds(speed, self.hardest, self.sharpest)
        return Bounds(speed, self.acceleration, self.jerk)

    def even_bounds(self, override: float) -> Bounds:
        """Return the bounds of a blend at constant speed."""
        return Bounds(min(self.even, self.programmed * override), self.hardest, self.sharpest)

    def within(self, margin: TorqueMargin) -> Stretch:
        """Return the stretch with bounds at which no torque exceeds what is free of it."""
        velocity, even = min(self.velocity, margin.fastest), min(self.even, margin.fastest)
        left = margin.left(min(velocity, self.programmed))
        left_even = margin.left(min(even, self.programmed)) if even else left
        return replace(
            self,
            velocity=velocity,
            acceleration=min(self.acceleration, left),
            hardest=min(self.hardest, left_even),
            even=even,
        )

    def between(self, start: float, end: float) -> Stretch:
        """Return the part between two parameters."""
        if start <= self.start and end >= self.end:
            return self
        return replace(self, start=max(start, self.start), end=min(end, self.end))

    def part(self, start: float, share: float) -> Stretch:
        """Return the stretch in the parameter of a part of the curve, given its start and share."""
        rates = ("velocity", "programmed", "acceleration", "jerk", "hardest", "sharpest", "even")
        scaled = {name: getattr(self, name) / share for name in rates}
        ends = {"start": (self.start - start) / share, "end": (self.end - start) / share}
        return replace(self, size=self.size * share, **ends, **scaled)


@dataclass(frozen=True, slots=True, eq=False)
class CurveLimits:
    """The stretches of a curve, from u = 0 to 1."""

    stretches: tuple[Stretch, ...]

    def within(self, torques: TorqueLimits | None, curve: Curve) -> CurveLimits:
        """Return the stretches with bounds at which no torque of the arm is exceeded."""
        if torques is None:
            return self
        margin = torques.along(curve)
        return CurveLimits(
            tuple(each.within(margin.between(each.start, each.end)) for each in self.stretches)
        )

    def between(self, start: float, end: float) -> tuple[Stretch, ...]:
        """Return the stretches of a part of the curve, cut at its ends."""
        parts = (
            stretch.between(start, end)
            for stretch in self.stretches
            if stretch.end > start and stretch.start < end
        )
        return tuple(part for part in parts if part.end > part.start)

    def part(self, start: float, end: float) -> CurveLimits:
        """Return the stretches of a part of the curve; its own parameter goes from 0 to 1."""
        share = end - start
        return CurveLimits(tuple(each.part(start, share) for each in self.between(start, end)))


def axis_limits(machine: MachineData, torques: TorqueLimits | None = None) -> AxisLimits:
    """Return the limits in the machine data [MOT-05, MOT-06], with those of its torques."""
    known = [_dynamics(axis) for axis in (*machine.axes, *machine.externals)]
    return AxisLimits(
        np.array([one.velocity for one in known]),
        np.array([one.acceleration for one in known]),
        np.array([one.jerk for one in known]),
        torques,
    )


def curve_limits_of(
    curve: Curve, machine: AxisLimits, programmed: AxisLimits, paths: Sequence[PathLimits]
) -> CurveLimits:
    """Return the bounds along a curve.

    ``machine`` is never exceeded. ``programmed`` limits accelerations, and limits speeds like a
    programmed speed, which the override scales. ``paths`` are the components of a CP motion, or
    empty.
    """
    grid = curve.grid
    first, second, third = (np.abs(rates) for rates in curve.rates(grid))
    straight = _positive(first)
    wanted = min((path.acceleration / path.length for path in paths), default=math.inf)
    slowest = np.minimum(
        _least(programmed.velocity / straight),
        min((path.velocity / path.length for path in paths), default=math.inf),
    )
    velocity = _least(machine.velocity / straight)
    per_axis = _least(programmed.acceleration / straight)
    smooth = _least(programmed.jerk / straight)
    hardest = _least(machine.acceleration / straight)
    sharpest = _least(machine.jerk / straight)
    acceleration = np.minimum(per_axis, wanted)
    if not curve.is_straight:
        acceleration = np.minimum(_SHARE * _MARGIN * per_axis, wanted)
        left = programmed.acceleration - first * acceleration[:, None]
        velocity = np.minimum(velocity, np.sqrt(_least(left / _positive(second)))) * _MARGIN
        velocity = np.minimum(velocity, np.cbrt(_least(_BENT * programmed.jerk / _positive(third))))
        used = np.minimum(velocity, slowest)[:, None]
        margin = _least(_BENT * programmed.jerk / _positive(3.0 * second * used))
        acceleration = np.minimum(acceleration, margin)
        bent = second * used**2
        hardest = _least((machine.acceleration - bent) / straight) * _MARGIN
        hardest = np.maximum(np.minimum(hardest, margin), acceleration)
        turned = third * used**3 + 3.0 * second * used * acceleration[:, None]
        smooth = np.minimum(smooth, _least((programmed.jerk - turned) / straight) * _MARGIN)
        sharpest = np.minimum(sharpest, _least((machine.jerk - turned) / straight) * _MARGIN)
    used = np.minimum(velocity, slowest)
    smooth = np.minimum(smooth, sharpest)
    for path in paths:
        is_known = math.isfinite(path.jerk)
        smooth = np.minimum(smooth, path.jerk / path.length if is_known else acceleration / _RAMP)
    size = max([*(path.length for path in paths), float(first.max(initial=0.0)), 1e-9])
    columns = np.stack((velocity, slowest, acceleration, smooth, hardest, sharpest), axis=1)
    columns *= _ROUNDING
    cuts = _cuts(used, 0, len(grid) - 1)
    stretches = (_stretch(grid, columns, low, high, size) for low, high in pairwise(cuts))
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
    sampled = _Sampled(rates, limits)
    even = min(sampled.steady_speed(_MARGIN), most)
    eased = min(sampled.steady_speed(_MARGIN * _EASED), most)
    acceleration, jerk = sampled.left(min(eased, programmed), beside)
    hardest, sharpest = sampled.left(min(even, programmed), beside)
    stretch = Stretch(
        start=0.0,
        end=1.0,
        velocity=eased,
        programmed=programmed,
        acceleration=acceleration,
        jerk=jerk,
        hardest=hardest,
        sharpest=sharpest,
        size=size,
        even=even,
    )
    return CurveLimits((stretch,))


class _Sampled:
    """Samples of a curve, and what they leave of the limits."""

    def __init__(self, rates: Rates, limits: AxisLimits) -> None:
        first, second, third = (np.abs(each) for each in rates)
        self._limits = limits
        self._second, self._third = second, third
        self._straight = _positive(first)
        self._fastest = float((limits.velocity / self._straight).min())
        self._sharpest = math.sqrt((limits.acceleration / _positive(second)).min())
        self._quickest = math.cbrt((limits.jerk / _positive(third)).min())

    def steady_speed(self, share: float) -> float:
        """Return the largest constant speed at which the curve can be travelled.

        It is limited to a share of the speed at which the curvature alone uses all of an axis's
        acceleration or jerk.
        """
        return min(self._fastest * _ROUNDING, share * self._sharpest, share * self._quickest)

    def left(self, speed: float, beside: Sequence[Bounds]) -> tuple[float, float]:
        """Return the acceleration and jerk that remain at a speed, at most those beside it."""
        limits, straight = self._limits, self._straight
        acceleration = float(((limits.acceleration - self._second * speed**2) / straight).min())
        turned = limits.jerk - self._third * speed**3
        bent = 3.0 * self._second * speed
        margin = float((turned / 2.0 / _positive(bent)).min())
        acceleration = min(acceleration, margin, *(bounds.acceleration for bounds in beside))
        jerk = float(((turned - bent * acceleration) / straight).min())
        return acceleration * _ROUNDING, min(jerk, *(bounds.jerk for bounds in beside)) * _ROUNDING


def _stretch(grid: Array, columns: Array, low: int, high: int, size: float) -> Stretch:
    """Return the stretch between two samples; it also respects the next sample on either side."""
    least = columns[max(low - 1, 0) : high + 2].min(axis=0)
    velocity, programmed, acceleration, jerk, hardest, sharpest = (float(value) for value in least)
    return Stretch(
        start=float(grid[low]),
        end=float(grid[high]),
        velocity=velocity,
        programmed=programmed,
        acceleration=acceleration,
        jerk=jerk,
        hardest=hardest,
        sharpest=sharpest,
        size=size,
    )


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


def _dynamics(axis: Axis) -> Dynamics:
    if axis.dynamics is not None:
        return axis.dynamics
    return _LINEAR if axis.kind is AxisKind.LINEAR else _ROTARY


def _shares(percents: Sequence[float], count: int) -> Array:
    known = [percent / 100.0 if 0.0 < percent <= 100.0 else 1.0 for percent in percents[:count]]
    return np.array(known + [1.0] * (count - len(known)))


def _positive(rates: Array) -> Array:
    return np.maximum(rates, 1e-12)


def _least(ratios: Array) -> Array:
    least: Array = ratios.min(axis=1)
    return least
