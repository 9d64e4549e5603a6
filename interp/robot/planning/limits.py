"""Speed limits along a curve, so that no axis exceeds what the machine data allow.

With u(t) along a curve q(u), an axis has the speed ``q'·u̇`` and the acceleration
``q''·u̇² + q'·ü``. Where ``|q''|·v² + |q'|·a`` stays below the limit of each axis, every profile
with speeds up to v and accelerations up to a keeps it. So each stretch of a curve gets one v and
one a of that kind, from samples of it; a curve whose samples differ much is cut into stretches.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from interp.robot.kinematics.machine_data import Axis, AxisKind, Dynamics, MachineData
from interp.robot.kinematics.solver import Array
from interp.robot.path.axis_path import Curve, Rates
from interp.robot.planning.profile import Bounds

_MARGIN = 0.97
"""Share of a limit that is used, for what lies between samples."""
_ROUNDING = 1.0 - 1e-9
_SHARE = 0.5
"""Share of an axis's acceleration that a change of speed may take on a curve; the rest is left for
the bends of the curve."""
_BENT = 0.25
"""Share of an axis's jerk that the bends of a curve may take, and as much of it changes of speed in
the bends; the rest is left for how quickly an acceleration builds up."""
_EASED = 0.8
"""Share of the speed at which a blend can be passed evenly, where speeds change in it."""
_UNEVEN = 1.25
"""Ratio of speeds within a stretch above which it is worth cutting."""
_SHORTEST = 4  # samples of a stretch
_RAMP = 0.08
"""Seconds over which a path acceleration builds up: an assumption, no rule has a figure."""

_ROTARY = Dynamics(180.0, 450.0, 4500.0)
_LINEAR = Dynamics(1000.0, 2500.0, 25000.0)
"""What an axis may do whose machine data do not say: assumed, of the size of other arms'."""


@dataclass(frozen=True, slots=True, eq=False)
class AxisLimits:
    """Speed, acceleration and jerk of all axes, each ``(axes,)``, in deg or mm and seconds."""

    velocity: Array
    acceleration: Array
    jerk: Array

    def equals(self, other: AxisLimits) -> bool:
        """Whether all limits are the same."""
        names = ("velocity", "acceleration", "jerk")
        return all(np.array_equal(getattr(self, n), getattr(other, n)) for n in names)

    def scaled(
        self, velocity: Sequence[float], acceleration: Sequence[float], jerk: Sequence[float]
    ) -> AxisLimits:
        """With shares in per cent of each [MOT-02]; what lies outside 0 to 100 counts as 100."""
        count = len(self.velocity)
        return AxisLimits(
            self.velocity * _shares(velocity, count),
            self.acceleration * _shares(acceleration, count),
            self.jerk * _shares(jerk, count),
        )

    def merged(self, other: AxisLimits, choose: Callable[[Array, Array], Array]) -> AxisLimits:
        """For each axis the lower or the higher of two limits."""
        return AxisLimits(
            choose(self.velocity, other.velocity),
            choose(self.acceleration, other.acceleration),
            choose(self.jerk, other.jerk),
        )


@dataclass(frozen=True, slots=True)
class PathLimits:
    """A length that u stands for, how fast it may grow, and how fast its speed may change.

    Millimetres or degrees: the path, the swivel and the rotation of the tool each have one
    [ORI-06]. The slowest of them decides. Where ``jerk`` is infinite, acceleration builds up over
    a fixed time.
    """

    length: float
    velocity: float
    acceleration: float
    jerk: float = math.inf


@dataclass(frozen=True, slots=True)
class Stretch:
    """A part of a curve with one set of bounds, all per unit of u.

    ``velocity`` is what the axes allow, ``programmed`` the speed that the override takes shares of.
    ``hardest`` and ``sharpest`` are acceleration and jerk for the hardest ramp there is [INT-09].
    ``size`` is a length in mm or degrees that u stands for: it keeps numbers of a sensible size.
    A blend may be passed at one speed up to ``even``, more than ``velocity``; ``hardest``
    and ``sharpest`` are what is left at that speed, so less than at others.
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
        """Bounds under an override of 0 to 1."""
        speed = min(self.velocity, self.programmed * override)
        if is_hard and not self.even:
            return Bounds(speed, self.hardest, self.sharpest)
        return Bounds(speed, self.acceleration, self.jerk)

    def even_bounds(self, override: float) -> Bounds:
        """Bounds of a blend that is passed at one speed, or is left at that."""
        return Bounds(min(self.even, self.programmed * override), self.hardest, self.sharpest)

    def between(self, start: float, end: float) -> Stretch:
        """The part of it between two parameters."""
        if start <= self.start and end >= self.end:
            return self
        return replace(self, start=max(start, self.start), end=min(end, self.end))

    def part(self, start: float, share: float) -> Stretch:
        """The same over the parameter of a share of the curve from a start on."""
        rates = ("velocity", "programmed", "acceleration", "jerk", "hardest", "sharpest", "even")
        scaled = {name: getattr(self, name) / share for name in rates}
        ends = {"start": (self.start - start) / share, "end": (self.end - start) / share}
        return replace(self, size=self.size * share, **ends, **scaled)


@dataclass(frozen=True, slots=True, eq=False)
class Ceiling:
    """The stretches of a curve, from u = 0 to 1."""

    stretches: tuple[Stretch, ...]

    def between(self, start: float, end: float) -> tuple[Stretch, ...]:
        """The stretches of a part of the curve, cut at its ends."""
        parts = (
            stretch.between(start, end)
            for stretch in self.stretches
            if stretch.end > start and stretch.start < end
        )
        return tuple(part for part in parts if part.end > part.start)

    def part(self, start: float, end: float) -> Ceiling:
        """That of a part of the curve, whose own parameter goes from 0 to 1."""
        share = end - start
        return Ceiling(tuple(each.part(start, share) for each in self.between(start, end)))


def axis_limits(machine: MachineData) -> AxisLimits:
    """What the machine data allow [MOT-05, MOT-06]."""
    known = [_dynamics(axis) for axis in (*machine.axes, *machine.externals)]
    return AxisLimits(
        np.array([one.velocity for one in known]),
        np.array([one.acceleration for one in known]),
        np.array([one.jerk for one in known]),
    )


def ceiling_of(
    curve: Curve, machine: AxisLimits, programmed: AxisLimits, paths: Sequence[PathLimits]
) -> Ceiling:
    """The bounds of a curve.

    ``machine`` is never exceeded; ``programmed`` holds for its speeds like a programmed speed, and
    for accelerations. ``paths`` are those that take part, and may be empty. ``jerk`` is one of the
    path in mm/s³; where it is infinite, accelerations build up over a fixed time.
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
        room = _least(_BENT * programmed.jerk / _positive(3.0 * second * used))
        acceleration = np.minimum(acceleration, room)
        bent = second * used**2
        hardest = _least((machine.acceleration - bent) / straight) * _MARGIN
        hardest = np.maximum(np.minimum(hardest, room), acceleration)
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
    return Ceiling(tuple(_stretch(grid, columns, low, high, size) for low, high in pairwise(cuts)))


def even_ceiling(
    rates: Rates,
    limits: AxisLimits,
    beside: Sequence[Bounds],
    programmed: float,
    most: float,
    size: float,
) -> Ceiling:
    """The bounds of a blend with such derivatives, which may be passed at one speed.

    ``beside`` are the bounds of what it joins, in the units of its own u; ``programmed`` is a
    speed of which the override takes shares, ``most`` one that holds under any. Where speed changes
    in it, it is no more than a share of what it may be otherwise.
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
    return Ceiling((stretch,))


class _Sampled:
    """Samples of a curve, and what they leave of limits."""

    def __init__(self, rates: Rates, limits: AxisLimits) -> None:
        first, second, third = (np.abs(each) for each in rates)
        self._limits = limits
        self._second, self._third = second, third
        self._straight = _positive(first)
        self._fastest = float((limits.velocity / self._straight).min())
        self._sharpest = math.sqrt((limits.acceleration / _positive(second)).min())
        self._quickest = math.cbrt((limits.jerk / _positive(third)).min())

    def steady_speed(self, share: float) -> float:
        """The greatest speed at which the curve can be travelled evenly.

        No more than a share of that at which its bends alone take all of an acceleration or jerk.
        """
        return min(self._fastest * _ROUNDING, share * self._sharpest, share * self._quickest)

    def left(self, speed: float, beside: Sequence[Bounds]) -> tuple[float, float]:
        """Acceleration and jerk that are left at a speed, and no more than beside the curve."""
        limits, straight = self._limits, self._straight
        acceleration = float(((limits.acceleration - self._second * speed**2) / straight).min())
        turned = limits.jerk - self._third * speed**3
        bent = 3.0 * self._second * speed
        room = float((turned / 2.0 / _positive(bent)).min())
        acceleration = min(acceleration, room, *(bounds.acceleration for bounds in beside))
        jerk = float(((turned - bent * acceleration) / straight).min())
        return acceleration * _ROUNDING, min(jerk, *(bounds.jerk for bounds in beside)) * _ROUNDING


def _stretch(grid: Array, columns: Array, low: int, high: int, size: float) -> Stretch:
    """The stretch between two samples, with what the sample beside it on either side allows."""
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
    """Places of samples at which to cut, both ends included."""
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
