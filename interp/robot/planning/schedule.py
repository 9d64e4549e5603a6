"""When the path is passed where: speeds at the ends of spans of path, then a profile for each span.

Stretches whose bounds are alike are one span, over as many motions as there are: within it the
arm speeds up and brakes as if there were no seams. Between spans the acceleration is zero. A blend
that bends is a span that is passed at one speed; where it was made of the end of one motion and the
start of the next, it is entered while braking and left while speeding up.

What speed the end of a span is passed with follows from two looks: backwards, from what can still
be braked down to what comes; forwards, from what can be reached until there.
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
"""Share of a length that changes of speed may fill, so that rounding never makes one impossible."""
_ALIKE = 1.0 - 1e-3
"""Ratio of speeds that counts as 1."""
_LOOSE = 0.6
"""Ratio of speeds from which the lower one may be no loss, since neither is reached."""
_ABOUT = 0.8
"""Ratio of accelerations or jerks from which it is better to have the lower one than a seam."""
_JUMP = 0.01
"""Share of the acceleration by which that of the path may jump where two blends touch."""
_HELD = 0.8
"""Share of the speed at which a blend could be passed evenly below which it is held up."""
_STANDS = 1e-3
"""Speed in mm/s or deg/s that rounding may leave where the arm stands at the end."""
_HALVINGS = 48


@dataclass(frozen=True, slots=True)
class GearedStretch:
    """A stretch, and how its speed and acceleration follow from those of the one before.

    Both count in units of their own parameter: the speed is ``gear`` times that before, the
    acceleration ``gear`` times that before plus ``bend`` times the square of the speed before. A
    gear of 0 is where the arm stands between them.
    """

    stretch: Stretch
    gear: float
    bend: float = 0.0


@dataclass(frozen=True, slots=True)
class PathState:
    """Where on the first stretch, with what speed and acceleration, all per unit of u."""

    u: float
    speed: float
    acceleration: float

    def behind(self, start: float, gear: float, bend: float) -> PathState:
        """The state behind a seam, at the start of what comes there."""
        acceleration = gear * self.acceleration + bend * self.speed**2
        return PathState(start, self.speed * gear, acceleration)


AtRest = PathState(0.0, 0.0, 0.0)


@dataclass(slots=True)
class _Span:
    """Stretches travelled as one, all in the unit of the first span behind a stop.

    ``scales`` are what the parameters of its stretches are multiplied with, ``ends`` where each of
    them ends. A blend that is a span of its own ``is_blend``; ``even`` are its bounds where it is
    passed at one speed, as it ``is_even``, or entered faster than ``eased``. ``bend`` times the
    square of the speed at its start is by how much more the acceleration is there than at the end
    of the span before; ``stands``: the arm stands before it. ``highest`` are the greatest bounds of
    its stretches.
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
        """Whether a stretch with such bounds can be travelled with it as one; then it will be."""
        ratio = _LOOSE if is_loose else _ALIKE
        if not _is_about(self.highest, bounds, ratio) or not _is_about(bounds, self.bounds, ratio):
            return False
        self.highest = self.highest.merged(bounds, max)
        self.bounds = self.bounds.merged(bounds, min)
        return True


def schedule(
    steps: Sequence[GearedStretch], state: PathState, override: float, *, is_strict: bool = False
) -> list[SpeedProfile] | None:
    """A profile for each step from a state on, to stand still in the end of the last.

    Positions of a profile are u from its start times `Stretch.size`. Returns ``None`` where it
    cannot be done: the acceleration cannot be taken back in time, the end is too near to stand
    still there, or, with ``is_strict``, the end of a span would be passed faster than what follows
    allows.
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
    """The speed at the end of each span, and the way on which they are above what is allowed.

    That happens where the override has dropped: braking takes its way.
    """

    ends: list[float]
    over: float


@dataclass(frozen=True, slots=True)
class _Plan:
    """Spans, a profile for each of their stretches, and the seconds that all of them take."""

    spans: Sequence[_Span]
    profiles: list[SpeedProfile]
    over: float
    duration: float


def _better(
    best: _Plan | None, spans: Sequence[_Span], start: tuple[float, float], found: _Speeds | None
) -> _Plan | None:
    """Of a plan and one of other speeds that with less way above them, else the quicker."""
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
    """Speeds with which no blend is entered too fast for how its speed changes."""
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
    """Profiles that stand still as soon as can be; the last ends within its step.

    The override has no part in it, as it scales no acceleration [MOT-09]. Speeds change in blends
    ahead only where else one would be entered too fast.

    ``None`` where the acceleration cannot be taken back on the first span, or, with ``is_strict``,
    a span would be passed faster than what follows allows.
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
    """Profiles of all stretches up to that on which the arm stands still, as `braking`."""
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
    """Whether a speed is no more than is allowed, but for rounding."""
    return speed <= allowed * (1.0 + 1e-6) + 1e-9


@lru_cache(maxsize=64)  # a motion is the second of one blend, then the first of another
def alone(ceiling: Ceiling) -> Cubics | None:
    """The parameter of a curve over time from rest to rest; ``None`` where it cannot be."""
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
    """The spans of a row of stretches; loosely, where a lower speed is taken for fewer seams."""
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
    """Let speeds change in blends that what is beside them holds up; whether there are any.

    All of them where else speeds are above what is allowed: who brakes can end within a blend.
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
    """Let speeds change, and slowly, in blends that are entered too fast; whether there are any."""
    is_any = False
    for speed, span in zip(ends, spans[1:], strict=False):
        if span.is_even and not _fits(speed, span.even.velocity):
            span.is_even, is_any = False, True
        elif not span.is_even and span.is_blend and not _fits(speed, span.eased):
            is_any = is_any or span.bounds != span.even
            span.bounds = span.even
    return is_any


def _is_about(inner: Bounds, outer: Bounds, ratio: float) -> bool:
    """Whether some bounds are no more than others, but for what is not worth a seam."""
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
    """The greatest speed at the end of each span from which all that follows can be braked for."""
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
    """The greatest speed at the start of a span, up to a given one, to leave it with a speed."""
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
    """The speed in which a span ends: at best the allowed one, else the nearest that can be.

    Lower where that can be; ``None`` where not even the acceleration can be taken back. An arm that
    ``stood`` has nothing else that it could do, so more is tried for it.
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
    """The speed at which the greatest jerk has turned an acceleration into another."""
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
    """The acceleration with which the next span begins."""
    return _entering(spans, place + 1, speed) if place + 1 < len(spans) else 0.0


def _entering(spans: Sequence[_Span], place: int, speed: float) -> float:
    """The acceleration at the start of a span behind a blend."""
    span = spans[place]
    if not place or span.is_blend or not spans[place - 1].is_blend:
        return 0.0
    return span.bend * speed**2


def _leaving(spans: Sequence[_Span], place: int, speed: float) -> float:
    """The acceleration at the end of a span before a blend."""
    if place + 1 == len(spans) or spans[place].is_blend or not spans[place + 1].is_blend:
        return 0.0
    return -spans[place + 1].bend * speed**2


def _most_with(bend: float, bounds: Bounds) -> float:
    """The greatest speed at which an acceleration of ``bend`` times its square can be taken back.

    Without being faster than the bound in doing so.
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
    """The speed nearest to one that does not fit which still fits."""
    for _ in range(_HALVINGS):
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
