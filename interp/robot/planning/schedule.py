"""The time schedule of a path: the speed at the end of each span, and a jerk-limited profile.

A backward pass finds at which speed each span may be left so that the arm can still brake for all
that follows, a forward pass which of these speeds it can reach. Of the ways to join stretches to
spans and to pass blends, the one that takes the shortest time is used.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

from interp.robot.path.speed_profile import SpeedProfile
from interp.robot.planning.junctions import JoinedStretch, PathState
from interp.robot.planning.ramps import at_most
from interp.robot.planning.spans import RATIOS, Span, spans_of

#: Share of its constant speed below which a blend counts as slowed down by its neighbours.
_HELD = 0.8

#: The speed at the end of each span, and the length on which speeds exceed what is allowed.
_Speeds = tuple[list[float], float]


@dataclass(frozen=True, slots=True)
class Schedule:
    """A profile for each stretch; its positions are u from its start times `Stretch.size`.

    ``over`` is the length of spans that are left faster than what follows allows, as they are after
    the override was reduced, while the arm is still braking.
    """

    profiles: list[SpeedProfile]
    over: float

    @property
    def duration(self) -> float:
        """The duration in seconds."""
        return sum(profile.duration for profile in self.profiles)


def schedule(
    stretches: Sequence[JoinedStretch],
    state: PathState,
    override: float,
    *,
    is_strict: bool = False,
) -> Schedule | None:
    """Return the schedule from a state to standstill at the end of the last stretch.

    If ``is_strict``, no blend is slowed down for the sake of a span that is left too fast. Return
    ``None`` if there is no schedule: the acceleration cannot be reduced in time, or the end is too
    near to stop there.
    """
    if not stretches:
        return Schedule([], 0.0)
    candidates: list[Schedule] = []
    every = (spans_of(stretches, state, override, ratio=ratio) for ratio in RATIOS)
    different = {tuple(span.length for span in spans): spans for spans in every}
    for spans in different.values():
        start = _start(spans, state)
        found = _settled(spans, start, is_strict)
        candidates += _travelled(stretches, spans, start, found)
        if _ease(spans, found):
            candidates += _travelled(stretches, spans, start, _settled(spans, start, is_strict))
    return min(candidates, key=lambda one: (one.over, one.duration), default=None)


def brakings(
    stretches: Sequence[JoinedStretch], state: PathState, *, is_hard: bool
) -> Iterator[Schedule]:
    """Yield schedules that stop the arm as soon as possible; the last profile ends in its stretch.

    The override is ignored, because it does not scale accelerations [MOT-09]. Blends ahead are
    passed at constant speed unless the arm would enter one too fast.
    """
    if not stretches:
        yield Schedule([], 0.0)
        return
    for ratio in RATIOS:
        spans = spans_of(stretches, state, 1.0, ratio=ratio, is_hard=is_hard)
        constant = [span for span in spans if span.is_constant]
        for slowed in ((), constant):
            for span in slowed:
                span.is_constant = False
            yield from _braked(stretches, spans, _start(spans, state))


def _braked(
    stretches: Sequence[JoinedStretch], spans: Sequence[Span], speed: float
) -> Iterator[Schedule]:
    """Yield the schedule up to the stretch on which the arm stops, if it can; see `brakings`."""
    profiles: list[SpeedProfile] = []
    over = 0.0
    for span, most in zip(spans, _allowed(spans), strict=True):
        if not span.is_constant or at_most(speed, span.bounds.velocity):
            last = span.stop(speed)
            if last is not None:
                profiles += last
                break
        found = span.exit_speed(speed, 0.0)
        if found is None:
            return
        if not at_most(found, most):
            over += span.length
        profiles += span.profiles(speed, found)
        speed = found
    yield Schedule(_own_units(stretches, spans, profiles), over)


# -------------------------------------------------------------------------------- both passes


def _allowed(spans: Sequence[Span]) -> list[float]:
    """Return the largest speed at the end of each span from which the arm can still brake."""
    allowed = [0.0]
    for before, span in reversed(list(pairwise(spans))):
        most = 0.0 if span.stands else min(span.fastest_entry(), before.fastest_exit())
        allowed.append(span.entry_speed(allowed[-1], most))
    return allowed[::-1]


def _speeds(spans: Sequence[Span], start: float) -> _Speeds | None:
    """Return the speeds that can be reached, from one at the start to standstill."""
    is_from_rest = start == spans[0].acceleration == 0.0
    speed, over = start, 0.0
    ends: list[float] = []
    for span, most in zip(spans, _allowed(spans), strict=True):
        found = span.exit_speed(speed, most, is_from_rest=is_from_rest)
        if found is None:
            return None
        if not at_most(found, most):
            over += span.length
        ends.append(found)
        speed = found
    return (ends, over) if at_most(speed, 0.0) else None


def _settled(spans: Sequence[Span], start: float, is_strict: bool) -> _Speeds | None:
    """Return speeds at which no blend is entered too fast for the changes of speed inside it."""
    found = _speeds(spans, start)
    while not is_strict and found is not None and found[1] and _slow(spans, found[0]):
        found = _speeds(spans, start)
    return found


# -------------------------------------------------------------------------------- alternatives


def _travelled(
    stretches: Sequence[JoinedStretch], spans: Sequence[Span], start: float, found: _Speeds | None
) -> list[Schedule]:
    """Return how spans are travelled at these speeds, if there are any."""
    if found is None:
        return []
    ends, over = found
    steps = zip(spans, [start, *ends], ends, strict=False)
    profiles = [profile for span, *speeds in steps for profile in span.profiles(*speeds)]
    return [Schedule(_own_units(stretches, spans, profiles), over)]


def _ease(spans: Sequence[Span], found: _Speeds | None) -> bool:
    """Allow changes of speed in blends that their neighbours slow down; return if there are any.

    If speeds exceed what is allowed, this applies to all blends, since braking may end within a
    blend.
    """
    ends, over = found or ([], 0.0)
    slowed = [
        span
        for place, span in enumerate(spans)
        if span.is_constant
        and (found is None or over or ends[place] < _HELD * span.constant.velocity)
    ]
    for span in slowed:
        span.is_constant = False
    return bool(slowed)


def _slow(spans: Sequence[Span], ends: Sequence[float]) -> bool:
    """Allow slow changes of speed in blends that are entered too fast; return if there are any."""
    is_any = False
    for speed, span in zip(ends, spans[1:], strict=False):
        if span.is_constant and not at_most(speed, span.constant.velocity):
            span.is_constant, is_any = False, True
        elif not span.is_constant and span.is_blend and not at_most(speed, span.eased):
            is_any = is_any or span.bounds != span.constant
            span.bounds = span.constant
    return is_any


def _start(spans: Sequence[Span], state: PathState) -> float:
    """Return the speed at the start in the unit of the spans."""
    return state.speed * spans[0].scales[0]


def _own_units(
    stretches: Sequence[JoinedStretch], spans: Sequence[Span], profiles: Sequence[SpeedProfile]
) -> list[SpeedProfile]:
    """Return the profiles in the unit of their stretch, `Stretch.size`."""
    scales = (scale for span in spans for scale in span.scales)
    return [
        profile if scale == one.stretch.size else profile.scaled(one.stretch.size / scale)
        for one, scale, profile in zip(stretches, scales, profiles, strict=False)
    ]
