"""The time schedule of a path: speeds at the ends of spans, and a jerk-limited profile for each.

A span is a row of stretches with similar bounds, over any number of motions; within a span the arm
accelerates and brakes as if it were one stretch. The acceleration is zero between spans. A curved
blend is a span that is passed at constant speed; a blend that overlaps the end of one motion with
the start of the next is entered while braking and left while accelerating.

The speed at the end of each span follows from a backward pass, from which speed the arm can still
brake for what follows, and a forward pass, which speed it can reach.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np

from interp.robot.path.transition import Cubics
from interp.robot.planning.limits import Ceiling, Stretch
from interp.robot.planning.profile import Bounds, SpeedProfile, ramp, stop, travel

_SPARE = 1.0 - 1e-6
"""Share of a length that changes of speed may use, so that rounding makes none impossible."""
_ALIKE = 1.0 - 1e-3
"""Ratio above which two speeds count as equal."""
_LOOSE = 0.6
"""Ratio of speeds above which the lower one may cost nothing, as neither is reached."""
_ABOUT = 0.8
"""Ratio of accelerations or jerks above which the lower one is better than a seam."""
_JUMP = 0.01
"""Share of the maximum acceleration by which it may jump where two blends meet."""
_HELD = 0.8
"""Share of its constant speed below which a blend counts as slowed down by its neighbours."""
_STANDS = 1e-3
"""Speed in mm/s or deg/s at the end that counts as standstill."""
_HALVINGS = 48


@dataclass(frozen=True, slots=True)
class GearedStretch:
    """A stretch, and how its speed and acceleration follow from those at the end of the one before.

    Both stretches have a parameter u of their own. The speed du/dt is ``gear`` times the one
    before; the acceleration is ``gear`` times the one before plus ``bend`` times the square of the
    speed before. A gear of 0 means that the arm stops between them.
    """

    stretch: Stretch
    gear: float
    bend: float = 0.0


@dataclass(frozen=True, slots=True)
class PathState:
    """The position on the first stretch, with speed and acceleration in units of u."""

    u: float
    speed: float
    acceleration: float

    def behind(self, start: float, gear: float, bend: float) -> PathState:
        """Return the state after a seam, at the start of the next stretch."""
        acceleration = gear * self.acceleration + bend * self.speed**2
        return PathState(start, self.speed * gear, acceleration)


AtRest = PathState(0.0, 0.0, 0.0)


@dataclass(slots=True)
class _Span:
    """Stretches that are travelled as one, in the unit of the first span after a stop.

    ``scales`` convert the parameters of its stretches to that unit, ``ends`` are the positions of
    their ends. ``is_blend`` marks a blend, which is a span of its own; ``even`` are its bounds at
    constant speed, which apply if it ``is_even`` or is entered faster than ``eased``. The
    acceleration at the start of the span differs from that at the end of the span before by
    ``bend`` times the square of the speed. ``stands`` if the arm stops before it. ``highest`` are
    the largest bounds among its stretches.
    """

    bounds: Bounds
    even: Bounds
    eased: float
    bend: float
    stands: bool
    is_blend: bool
    is_even: bool
    highest: Bounds
    scales: list[float] = field(default_factory=list)
    ends: list[float] = field(default_factory=list)

    @property
    def length(self) -> float:
        return self.ends[-1]

    @property
    def fastest(self) -> float:
        return self.even.velocity if self.is_even else self.bounds.velocity

    def add(self, scale: float, length: float) -> None:
        self.scales.append(scale)
        self.ends.append((self.ends[-1] if self.ends else 0.0) + length)

    def takes(self, bounds: Bounds, is_loose: bool) -> bool:
        """Add a stretch with these bounds if they are similar; return whether it was added."""
        ratio = _LOOSE if is_loose else _ALIKE
        if not _is_about(self.highest, bounds, ratio) or not _is_about(bounds, self.bounds, ratio):
            return False
        self.highest = self.highest.merged(bounds, max)
        self.bounds = self.bounds.merged(bounds, min)
        return True


def schedule(
    steps: Sequence[GearedStretch], state: PathState, override: float, *, is_strict: bool = False
) -> list[SpeedProfile] | None:
    """Return a profile for each step, from a state to standstill at the end of the last step.

    Positions of a profile are u from its start times `Stretch.size`. Return ``None`` if that is
    impossible: the acceleration cannot be reduced in time, the end is too near to stop there, or,
    if ``is_strict``, the end of a span would be passed faster than what follows allows.
    """
    best: _Plan | None = None
    known: list[list[float]] = []
    for is_loose in (True, False):
        spans = _spans(steps, state, override, is_loose=is_loose)
        if (lengths := [span.length for span in spans]) in known:
            continue
        known.append(lengths)
        start = _start(spans, state)
        found = _settled(spans, start, is_strict)
        best = _better(best, spans, start, found)
        if _ease(spans, found):
            best = _better(best, spans, start, _settled(spans, start, is_strict))
    return None if best is None else _own_units(steps, best.spans, best.profiles)


@dataclass(frozen=True, slots=True)
class _Speeds:
    """The speed at the end of each span, and the length on which speeds exceed what is allowed.

    They exceed it after the override was reduced, while the arm is still braking.
    """

    ends: list[float]
    over: float


@dataclass(frozen=True, slots=True)
class _Plan:
    """Spans, a profile for each of their stretches, and the total duration in seconds."""

    spans: Sequence[_Span]
    profiles: list[SpeedProfile]
    over: float
    duration: float


def _better(
    best: _Plan | None, spans: Sequence[_Span], start: tuple[float, float], found: _Speeds | None
) -> _Plan | None:
    """Return the better plan: less length at excessive speed, then shorter duration."""
    if found is None or (best is not None and best.over < found.over):
        return best
    speed, acceleration = start
    profiles: list[SpeedProfile] = []
    duration = 0.0
    for place, (span, final) in enumerate(zip(spans, found.ends, strict=True)):
        for profile in _parts(span, _travelled(spans, place, speed, acceleration, final)):
            profiles.append(profile)
            duration += profile.duration
        if best is not None and best.over <= found.over and best.duration <= duration:
            return best
        speed, acceleration = final, _behind(spans, place, final)
    return _Plan(spans, profiles, found.over, duration)


def _settled(spans: Sequence[_Span], start: tuple[float, float], is_strict: bool) -> _Speeds | None:
    """Return speeds at which no blend is entered too fast for the changes of speed inside it."""
    found = _speeds(spans, start, is_strict)
    while found is not None and found.over and _slow(spans, found.ends):
        found = _speeds(spans, start, is_strict)
    return found


def _speeds(spans: Sequence[_Span], start: tuple[float, float], is_strict: bool) -> _Speeds | None:
    allowed = _allowed(spans)
    speed, acceleration = start
    stood = not is_strict and start == (0.0, 0.0)
    ends: list[float] = []
    over = 0.0
    for place, span in enumerate(spans):
        found = _reached(spans, place, speed, acceleration, allowed[place], stood=stood)
        if found is None:
            return None
        if not _keeps(found, allowed[place]):
            if is_strict:
                return None
            over += span.length
        ends.append(found)
        speed, acceleration = found, _behind(spans, place, found)
    return _Speeds(ends, over) if speed <= _STANDS else None


def braking(
    steps: Sequence[GearedStretch], state: PathState, *, is_hard: bool, is_strict: bool = False
) -> list[SpeedProfile] | None:
    """Return profiles that stop the arm as soon as possible; the last one ends within its step.

    The override is ignored, because it does not scale accelerations [MOT-09]. Blends ahead are
    passed at constant speed unless the arm would enter one too fast.

    Return ``None`` if the acceleration cannot be reduced on the first span, or, if ``is_strict``,
    if a span would be passed faster than what follows allows.
    """
    for is_loose in (True, False):
        spans = _spans(steps, state, 1.0, is_hard=is_hard, is_loose=is_loose)
        for _ in range(2):
            profiles = _braked(spans, _start(spans, state), is_strict)
            if profiles is not None:
                return _own_units(steps, spans, profiles)
            for span in spans:
                span.is_even = False
    return None


def _braked(
    spans: Sequence[_Span], start: tuple[float, float], is_strict: bool
) -> list[SpeedProfile] | None:
    """Return the profiles of all stretches up to the one on which the arm stops; see `braking`."""
    allowed = _allowed(spans) if is_strict else [math.inf] * len(spans)
    speed, acceleration = start
    profiles: list[SpeedProfile] = []
    for place, span in enumerate(spans):
        way = ramp(speed, acceleration, 0.0, span.bounds).distance
        is_slow = not span.is_even or _keeps(speed, span.bounds.velocity)
        if is_slow and _fits(way, span.length):
            whole = stop(speed, acceleration, span.bounds)
            last = next(n for n, end in enumerate(span.ends) if _fits(way, end))
            return profiles + whole.split([*span.ends[:last], whole.length])
        found = _reached(spans, place, speed, acceleration, 0.0)
        if found is None or not _keeps(found, allowed[place]):
            return None
        profiles += _parts(span, _travelled(spans, place, speed, acceleration, found))
        speed, acceleration = found, _behind(spans, place, found)
    return profiles


def _keeps(speed: float, allowed: float) -> bool:
    """Return whether a speed is allowed, up to rounding errors."""
    return speed <= allowed * (1.0 + 1e-6) + 1e-9


@lru_cache(maxsize=64)  # a motion is the second of one blend, then the first of another
def alone(ceiling: Ceiling) -> Cubics | None:
    """Return the parameter of a curve over time, from rest to rest, or ``None`` if impossible."""
    steps = [GearedStretch(stretch, 1.0) for stretch in ceiling.stretches]
    profiles = schedule(steps, AtRest, 1.0)
    if profiles is None:
        return None
    knots, time = [], 0.0
    for step, profile in zip(steps, profiles, strict=True):
        start, size = step.stretch.start, step.stretch.size
        for begin, place, *rates in profile.knots:
            knots.append((time + begin, start + place / size, *(rate / size for rate in rates)))
        time += profile.duration
    return Cubics(np.array(knots), time)


# ---------------------------------------------------------------------------------------- spans


def _spans(
    steps: Sequence[GearedStretch],
    state: PathState,
    override: float,
    *,
    is_hard: bool = False,
    is_loose: bool = True,
) -> list[_Span]:
    """Return the spans of a row of stretches.

    If ``is_loose``, stretches with less similar bounds are joined: a lower speed for fewer seams.
    """
    spans: list[_Span] = []
    scale = 0.0
    for place, step in enumerate(steps):
        stretch = step.stretch
        stands = place > 0 and step.gear <= 0.0
        before, scale = scale, stretch.size if not place or stands else scale / step.gear
        bend = 0.0 if not place or stands else scale * step.bend / before**2
        is_blend, is_first = stretch.even > 0.0, place == 0
        own = stretch.bounds(override, is_hard)
        if is_blend and is_first and state.speed * _ALIKE > stretch.velocity:
            own = stretch.even_bounds(override)
        bounds = own.scaled(scale)
        is_alone = stands or is_blend or not spans or spans[-1].is_blend
        if is_alone or not spans[-1].takes(bounds, is_loose):
            even, eased = stretch.even_bounds(override).scaled(scale), stretch.velocity * scale
            is_even = is_blend and not is_first
            spans.append(_Span(bounds, even, eased, bend, stands, is_blend, is_even, bounds))
        length = stretch.end - (state.u if is_first else stretch.start)
        spans[-1].add(scale, length * scale)
    return spans


def _ease(spans: Sequence[_Span], found: _Speeds | None) -> bool:
    """Allow changes of speed in blends that their neighbours slow down; return if there are any.

    If speeds exceed what is allowed, this applies to all blends, since braking may end within a
    blend.
    """
    is_eased = False
    is_over = found is None or found.over > 0.0
    for place, span in enumerate(spans):
        if span.is_even:
            held = is_over or found is None or found.ends[place] < _HELD * span.even.velocity
            span.is_even = not held
            is_eased = is_eased or held
    return is_eased


def _slow(spans: Sequence[_Span], ends: Sequence[float]) -> bool:
    """Allow slow changes of speed in blends that are entered too fast; return if there are any."""
    is_any = False
    for speed, span in zip(ends, spans[1:], strict=False):
        if span.is_even and not _fits(speed, span.even.velocity):
            span.is_even, is_any = False, True
        elif not span.is_even and span.is_blend and not _fits(speed, span.eased):
            is_any = is_any or span.bounds != span.even
            span.bounds = span.even
    return is_any


def _is_about(inner: Bounds, outer: Bounds, ratio: float) -> bool:
    """Return whether bounds exceed others only by differences that are not worth a seam."""
    return (
        inner.velocity * ratio <= outer.velocity
        and inner.acceleration * _ABOUT <= outer.acceleration
        and inner.jerk * _ABOUT <= outer.jerk
    )


def _start(spans: Sequence[_Span], state: PathState) -> tuple[float, float]:
    scale = spans[0].scales[0] if spans else 1.0
    return state.speed * scale, state.acceleration * scale


def _parts(span: _Span, profile: SpeedProfile) -> list[SpeedProfile]:
    return profile.split(span.ends) if len(span.ends) > 1 else [profile]


def _own_units(
    steps: Sequence[GearedStretch], spans: Sequence[_Span], profiles: Sequence[SpeedProfile]
) -> list[SpeedProfile]:
    scales = (scale for span in spans for scale in span.scales)
    return [
        profile if scale == step.stretch.size else profile.scaled(step.stretch.size / scale)
        for step, scale, profile in zip(steps, scales, profiles, strict=False)
    ]


# ---------------------------------------------------------------------------- speeds at the ends


def _allowed(spans: Sequence[_Span]) -> list[float]:
    """Return the largest speed at the end of each span from which the arm can still brake."""
    allowed = [0.0] * len(spans)
    for place in range(len(spans) - 1, 0, -1):
        span, before = spans[place], spans[place - 1]
        if span.stands:
            continue
        most = min(span.fastest, before.fastest)
        if span.is_even:
            most = min(most, allowed[place])
        if span.is_blend is not before.is_blend:  # the other has the acceleration of the seam
            most = min(most, _most_with(span.bend, (before if span.is_blend else span).bounds))
        elif span.bend:
            most = min(most, math.sqrt(_JUMP * span.bounds.acceleration / abs(span.bend)))
        allowed[place - 1] = most if span.is_even else _into(spans, place, allowed[place], most)
    return allowed


def _into(spans: Sequence[_Span], place: int, out: float, most: float) -> float:
    """Return the largest speed at the start of a span to leave it at speed ``out``.

    It is at most ``most``.
    """
    span = spans[place]
    if not _entering(spans, place, 1.0) and not _leaving(spans, place, 1.0):
        return min(_other_end(out, span.length * _SPARE, span.bounds), most)

    def fits(speed: float) -> bool:
        end = min(out, speed)
        acceleration, final = _entering(spans, place, speed), _leaving(spans, place, end)
        way = ramp(speed, acceleration, end, span.bounds, final).distance
        return _fits(way, span.length * _SPARE)

    return most if fits(most) else _bisected(fits, 0.0, most)


def _reached(
    spans: Sequence[_Span],
    place: int,
    speed: float,
    acceleration: float,
    allowed: float,
    *,
    stood: bool = False,
) -> float | None:
    """Return the speed at the end of a span: the allowed one, or the nearest possible one.

    A lower speed is preferred. Return ``None`` if not even the acceleration can be reduced to zero.
    If the arm ``stood`` there is no alternative plan, so more candidates are tried.
    """
    span = spans[place]
    if span.is_even:
        return speed
    bounds = span.bounds

    def fits(target: float) -> bool:
        final = _leaving(spans, place, target)
        return _fits(ramp(speed, acceleration, target, bounds, final).distance, span.length)

    if fits(allowed):
        return allowed
    if acceleration == 0.0 and allowed > speed and not _leaving(spans, place, 1.0):
        return max(_other_end(speed, span.length * _SPARE, bounds), speed)
    # Not every speed between two that can be reached can be reached: braking hard, it may take
    # longer to ease off the brake at some speed than to stand still.
    eased = _turned_to(0.0, speed, acceleration, bounds.jerk)
    candidates = [0.0, eased]
    if stood:  # before a blend that is entered braking the shortest way leads to the brake at once

        def is_slower(target: float) -> bool:
            final = _leaving(spans, place, target)
            return target <= _turned_to(final, speed, acceleration, bounds.jerk)

        candidates.append(_bisected(is_slower, 0.0, max(speed, allowed)))
    within = next((one for one in candidates if one >= 0.0 and fits(one)), None)
    return None if within is None else _bisected(fits, within, allowed)


def _turned_to(final: float, speed: float, acceleration: float, jerk: float) -> float:
    """Return the speed after the maximum jerk has changed one acceleration to another."""
    return speed + (final + acceleration) * abs(final - acceleration) / (2.0 * jerk)


def _travelled(
    spans: Sequence[_Span], place: int, speed: float, acceleration: float, out: float
) -> SpeedProfile:
    span = spans[place]
    if span.is_even:
        return SpeedProfile(speed, ((span.length / speed, 0.0, 0.0),) if speed > 0.0 else ())
    final = _leaving(spans, place, out)
    return travel(span.length, speed, acceleration, out, span.bounds, final)


def _behind(spans: Sequence[_Span], place: int, speed: float) -> float:
    """Return the acceleration at the start of the next span."""
    return _entering(spans, place + 1, speed) if place + 1 < len(spans) else 0.0


def _entering(spans: Sequence[_Span], place: int, speed: float) -> float:
    """Return the acceleration at the start of a span after a blend."""
    span = spans[place]
    if not place or span.is_blend or not spans[place - 1].is_blend:
        return 0.0
    return span.bend * speed**2


def _leaving(spans: Sequence[_Span], place: int, speed: float) -> float:
    """Return the acceleration at the end of a span before a blend."""
    if place + 1 == len(spans) or spans[place].is_blend or not spans[place + 1].is_blend:
        return 0.0
    return -spans[place + 1].bend * speed**2


def _most_with(bend: float, bounds: Bounds) -> float:
    """Return the largest speed for which an acceleration of ``bend`` times its square can end.

    The speed must not exceed its bound while the acceleration is reduced.
    """
    if not bend:
        return bounds.velocity

    def fits(speed: float) -> bool:
        gain = abs(bend) * speed**2
        return (
            gain * _SPARE <= bounds.acceleration
            and (speed + gain**2 / (2.0 * bounds.jerk)) * _SPARE <= bounds.velocity
        )

    return bounds.velocity if fits(bounds.velocity) else _bisected(fits, 0.0, bounds.velocity)


def _bisected(fits: Callable[[float], bool], within: float, beyond: float) -> float:
    """Return the speed that still fits and is nearest to one that does not."""
    for _ in range(_HALVINGS):
        middle = (beyond + within) / 2.0
        if fits(middle):
            within = middle
        else:
            beyond = middle
    return within


def _fits(way: float, length: float) -> bool:
    """Return whether a ramp is not longer than a length, up to rounding; both in mm or degrees."""
    return way <= length * (1.0 + 1e-9) + 1e-9


def _other_end(speed: float, length: float, bound: Bounds) -> float:
    """Return the largest speed at the other end of a length, given the speed at one end.

    A change of speed Δ takes ``2·√(Δ/j)`` seconds up to a²/j, and ``Δ/a + a/j`` above that, at the
    mean of both speeds.
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
