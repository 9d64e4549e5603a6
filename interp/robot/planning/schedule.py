"""When the path is passed where: speeds at the seams of stretches, then a profile for each.

Along a stretch the bounds are the same, and at its end the acceleration is zero. What speed a seam
is passed with follows from two looks: backwards, from what can still be braked down to what comes;
forwards, from what can be reached until there.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from interp.robot.planning.limits import Stretch
from interp.robot.planning.profile import Bounds, SpeedProfile, ramp, stop, travel

__all__ = ["AtRest", "GearedStretch", "PathState", "braking", "schedule"]

_SPARE = 1.0 - 1e-6
"""Share of a length that changes of speed may fill, so that rounding never makes one impossible."""
_SAME = 1e-5
"""Relative difference of speeds at a seam below which what was planned stays."""


@dataclass(frozen=True, slots=True)
class GearedStretch:
    """A stretch, and by what its speed differs from that of the one before.

    Both count speeds in units of their own parameter; ``gear`` times the one before is that of this
    one. It is 0 where the arm stands between them.
    """

    stretch: Stretch
    gear: float


@dataclass(frozen=True, slots=True)
class PathState:
    """Where on the first stretch, with what speed and acceleration, all per unit of u."""

    u: float
    speed: float
    acceleration: float


AtRest = PathState(0.0, 0.0, 0.0)


def schedule(
    steps: Sequence[GearedStretch],
    state: PathState,
    override: float,
    *,
    planned: float | None = None,
    is_strict: bool = False,
) -> list[SpeedProfile | None] | None:
    """A profile for each step from a state on, to stand still in the end of the last.

    Positions of a profile are u from its start times `Stretch.size`. ``planned`` is the speed at
    the end of the first step as planned until now, where nothing but what follows has changed; if
    it may stay, the first profile is ``None``. Returns ``None`` where it cannot be done: the
    acceleration cannot be taken back in time, or, with ``is_strict``, the first seam would be
    passed faster than what follows allows.
    """
    bounds = [step.stretch.bounds(override) for step in steps]
    allowed = _allowed(steps, bounds)
    profiles: list[SpeedProfile | None] = []
    for place, (step, bound) in enumerate(zip(steps, bounds, strict=True)):
        stretch = step.stretch
        length = stretch.end - state.u
        found = _out(state, length, allowed[place], bound, stretch.size)
        if found is None or (is_strict and found > allowed[place] * (1.0 + 1e-9) + 1e-12):
            return None
        out = found
        if (
            place == 0
            and planned is not None
            and planned <= allowed[0] * (1.0 + 1e-9)
            and abs(planned - out) <= _SAME * out
        ):
            profiles.append(None)
            out = planned
        else:
            profiles.append(_profile(state, length, out, bound, stretch.size))
        if place + 1 < len(steps):
            following = steps[place + 1]
            state = PathState(following.stretch.start, out * following.gear, 0.0)
    return profiles


def braking(
    steps: Sequence[GearedStretch], state: PathState, override: float, *, is_hard: bool
) -> list[SpeedProfile] | None:
    """Profiles that stand still as soon as can be; the last ends within its step.

    ``None`` where the acceleration cannot be taken back on the first step.
    """
    profiles = []
    for place, step in enumerate(steps):
        stretch = step.stretch
        size, length = stretch.size, stretch.end - state.u
        bound = stretch.bounds(override, is_hard)
        sized = _sized(bound, size)
        way = ramp(state.speed * size, state.acceleration * size, 0.0, sized).distance
        if _fits(way, length * size):
            profiles.append(stop(state.speed * size, state.acceleration * size, sized))
            return profiles
        out = _out(state, length, 0.0, bound, size)
        if out is None:
            return None
        profiles.append(_profile(state, length, out, bound, size))
        if place + 1 < len(steps):
            following = steps[place + 1]
            state = PathState(following.stretch.start, out * following.gear, 0.0)
    return profiles


def _allowed(steps: Sequence[GearedStretch], bounds: Sequence[Bounds]) -> list[float]:
    """The greatest speed at the end of each step from which all that follows can be braked for."""
    allowed = [0.0] * len(steps)
    for place in range(len(steps) - 1, 0, -1):
        stretch, gear = steps[place].stretch, steps[place].gear
        if gear <= 0.0:
            continue
        length = (stretch.end - stretch.start) * _SPARE
        into = min(_other_end(allowed[place], length, bounds[place]), bounds[place].velocity)
        allowed[place - 1] = min(into / gear, bounds[place - 1].velocity)
    return allowed


def _out(
    state: PathState, length: float, allowed: float, bound: Bounds, size: float
) -> float | None:
    """The speed in which a stretch ends: at best the allowed one, else the nearest that can be.

    Lower where that can be; ``None`` where not even the acceleration can be taken back.
    """
    eased = state.speed + state.acceleration * abs(state.acceleration) / (2.0 * bound.jerk)
    sized = _sized(bound, size)

    def fits(target: float) -> bool:
        way = ramp(state.speed * size, state.acceleration * size, target * size, sized).distance
        return _fits(way, length * size)

    if fits(allowed):
        return allowed
    if state.acceleration == 0.0 and allowed > state.speed:
        return max(_other_end(state.speed, length * _SPARE, bound), state.speed)
    # Not every speed between two that can be reached can be reached: braking hard, it may take
    # longer to ease off the brake at some speed than to stand still.
    within = 0.0 if fits(0.0) else eased
    if within < 0.0 or not fits(within):
        return None
    beyond = allowed
    for _ in range(48):
        middle = (beyond + within) / 2.0
        if fits(middle):
            within = middle
        else:
            beyond = middle
    return within


def _fits(way: float, length: float) -> bool:
    """Whether a ramp is no longer than a length, but for rounding; both in mm or degrees."""
    return way <= length * (1.0 + 1e-9) + 1e-9


def _other_end(speed: float, length: float, bound: Bounds) -> float:
    """The greatest speed at the other end of a length that begins or ends with a speed.

    With a change of speed Δ: up to a²/j it takes ``2·√(Δ/j)``, above that ``Δ/a + a/j`` seconds, at
    the mean of both speeds.
    """
    a, j = bound.acceleration, bound.jerk
    threshold = a * a / j
    if (2.0 * speed + threshold) * a / j >= length:
        # x³ + 2·speed·x = length·√j with x = √Δ, which has one root.
        third, half = 2.0 * speed / 3.0, length * math.sqrt(j) / 2.0
        root = math.cbrt(half + math.sqrt(half * half + third**3))
        x = root - third / root if root > 0.0 else 0.0
        return speed + x * x
    b = speed / a + a / (2.0 * j)
    c = speed * a / j - length
    return speed + a * (math.sqrt(b * b - 2.0 * c / a) - b)


def _sized(bound: Bounds, size: float) -> Bounds:
    return Bounds(bound.velocity * size, bound.acceleration * size, bound.jerk * size)


def _profile(
    state: PathState, length: float, out: float, bound: Bounds, size: float
) -> SpeedProfile:
    return travel(
        length * size,
        state.speed * size,
        state.acceleration * size,
        out * size,
        _sized(bound, size),
    )
