"""Spans: stretches of a path that are travelled as one, and the speeds possible at their ends.

A span is a row of stretches with similar bounds, over any number of motions. Within it the arm
accelerates and brakes as if it were one stretch; the acceleration is zero at its ends. A blend is a
span of its own. A curved one is passed at constant speed; one that overlaps the end of a motion
with the start of the next is entered while braking and left while accelerating.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

from interp.robot.path.speed_profile import SpeedProfile, bisected, steady
from interp.robot.planning.junctions import STOP, JoinedStretch, PathState
from interp.robot.planning.profile import travel
from interp.robot.planning.ramps import Bounds, at_most, ramp, speed_after

#: Share of a length that changes of speed may use, so that rounding makes none impossible.
_SPARE = 1.0 - 1e-6
#: Ratio above which two speeds count as equal.
_ALIKE = 1.0 - 1e-3
#: Ratios of speeds above which stretches are joined: the lower speed for fewer spans, or alike.
RATIOS = (0.6, _ALIKE)
#: Ratio of accelerations or jerks above which the lower one is better than another span.
_ABOUT = 0.8
#: Share of the maximum acceleration by which it may jump where two blends meet.
_JUMP = 0.01


@dataclass(slots=True)
class Span:
    """Stretches that are travelled as one, in the unit of the first span after a stop.

    ``bounds`` are the lowest of its stretches, ``highest`` the highest. ``scales`` convert the
    parameters of its stretches to that unit, ``ends`` are the positions of their ends. The
    acceleration is ``entry_bend`` times the square of the speed at the start, and ``exit_bend``
    times at the end; both are 0 except beside a blend. At the start of the first span it is
    ``acceleration``. Where two blends meet, it jumps by ``jump`` times the square of the speed.
    ``stands`` if the arm stops before the span.

    A blend that ``is_constant`` is passed at constant speed up to ``constant.velocity``. If its
    speed changes, it has the other ``bounds``, unless it is entered faster than ``eased``.
    """

    bounds: Bounds
    highest: Bounds
    constant: Bounds
    eased: float
    is_blend: bool
    is_constant: bool
    stands: bool
    acceleration: float = 0.0
    entry_bend: float = 0.0
    exit_bend: float = 0.0
    jump: float = 0.0
    scales: list[float] = field(default_factory=list)
    ends: list[float] = field(default_factory=list)

    @property
    def length(self) -> float:
        """The distance from its start to its end."""
        return self.ends[-1]

    def add(self, scale: float, length: float) -> None:
        """Append a stretch."""
        self.scales.append(scale)
        self.ends.append((self.ends[-1] if self.ends else 0.0) + length)

    def follow(self, before: Span, bend: float) -> None:
        """Set the accelerations where it follows a span, in which they jump by bend·speed²."""
        if self.is_blend is before.is_blend:
            self.jump = bend
        elif self.is_blend:
            before.exit_bend = -bend
        else:
            self.entry_bend = bend

    # ------------------------------------------------------------------- speeds and profiles

    def fastest_entry(self) -> float:
        """Return the largest speed at which its bounds allow to enter it."""
        most = self._fastest_with(self.entry_bend)
        if self.jump:
            most = min(most, math.sqrt(_JUMP * self.bounds.acceleration / abs(self.jump)))
        return most

    def fastest_exit(self) -> float:
        """Return the largest speed at which its bounds allow to leave it."""
        return self._fastest_with(self.exit_bend)

    def entry_speed(self, wanted: float, most: float) -> float:
        """Return the largest speed, at most ``most``, to enter it and leave it at ``wanted``."""
        if self.is_constant:
            return min(wanted, most)

        def fits(speed: float) -> bool:
            change = self._distance(speed, self.entry_bend * speed**2, min(wanted, speed))
            return at_most(change, self.length * _SPARE)

        return bisected(fits, 0.0, most)

    def exit_speed(
        self, speed: float, wanted: float, *, is_from_rest: bool = False
    ) -> float | None:
        """Return the speed at its end if entered at ``speed``: ``wanted``, or the nearest possible.

        A lower speed is preferred. Return ``None`` if the acceleration cannot be reduced to zero in
        time; if the path is travelled from rest, there is always a speed.
        """
        if self.is_constant:
            return speed
        acceleration = self._entry_acceleration(speed)

        def fits(target: float) -> bool:
            return at_most(self._distance(speed, acceleration, target), self.length)

        def eased(target: float) -> float:
            final = self.exit_bend * target**2 if is_from_rest else 0.0
            return speed_after(speed, acceleration, final, jerk)

        if fits(wanted):
            return wanted
        within, jerk = 0.0, self.bounds.jerk
        if not fits(within):
            # Braking hard, it may take longer to stand still than to ease off the brake at once.
            most = speed_after(speed, abs(acceleration), 0.0, jerk)
            within = bisected(lambda target: target <= eased(target), 0.0, most)
            within = max(within, eased(within))
        return bisected(fits, within, wanted) if fits(within) else None

    def profiles(self, speed: float, final: float) -> list[SpeedProfile]:
        """Return the profile of each stretch between the speeds at both ends of the span."""
        if self.is_constant:
            return [steady(speed, self.length)]
        start, end = self._entry_acceleration(speed), self.exit_bend * final**2
        return travel(self.length, speed, start, final, self.bounds, end).split(self.ends)

    def stop(self, speed: float) -> list[SpeedProfile] | None:
        """Return the profiles up to a stop within the span, or ``None`` if it is too short."""
        whole = ramp(speed, 0.0, self.bounds, self._entry_acceleration(speed))
        if not at_most(whole.length, self.length):
            return None
        last = next(place for place, end in enumerate(self.ends) if at_most(whole.length, end))
        return whole.split([*self.ends[:last], whole.length])

    def _fastest_with(self, bend: float) -> float:
        """Return the largest speed at which an acceleration of bend·speed² can be reduced to zero.

        The speed must not exceed its bound meanwhile.
        """
        fastest = (self.constant if self.is_constant else self.bounds).velocity

        def fits(speed: float) -> bool:
            gain = abs(bend) * speed**2
            eased = speed_after(speed, gain, 0.0, self.bounds.jerk)
            return gain * _SPARE <= self.bounds.acceleration and eased * _SPARE <= fastest

        return bisected(fits, 0.0, fastest)

    def _entry_acceleration(self, speed: float) -> float:
        return self.acceleration + self.entry_bend * speed**2

    def _distance(self, speed: float, acceleration: float, final: float) -> float:
        """Return the distance on which the speed changes to a final one."""
        return ramp(speed, final, self.bounds, acceleration, self.exit_bend * final**2).length


def spans_of(
    stretches: Sequence[JoinedStretch],
    state: PathState,
    override: float,
    *,
    ratio: float,
    is_hard: bool = False,
) -> list[Span]:
    """Return the spans of a row of stretches, from a state on the first one.

    Stretches are joined of which the speeds have at least this ``ratio``: one of `RATIOS`.
    """
    spans: list[Span] = []
    for joined in stretches:
        stretch, junction = joined.stretch, joined.junction
        last = spans[-1] if spans else None
        is_blend, stands = stretch.constant is not None, last is not None and junction == STOP
        scale = stretch.size if last is None or stands else last.scales[-1] / junction.gear
        own = stretch.bounds(override, is_hard)
        if is_blend and last is None and state.speed * _ALIKE > stretch.normal.velocity:
            own = stretch.constant_bounds(override)
        bounds = own * scale
        if (
            last is not None
            and not (stands or is_blend or last.is_blend)
            and _is_about(last.highest, bounds, ratio)
            and _is_about(bounds, last.bounds, ratio)
        ):
            last.highest = last.highest.merged(bounds, max)
            last.bounds = last.bounds.merged(bounds, min)
        else:
            constant = stretch.constant_bounds(override) * scale
            eased = stretch.normal.velocity * scale
            is_constant = is_blend and last is not None
            spans.append(Span(bounds, bounds, constant, eased, is_blend, is_constant, stands))
            if last is not None and not stands:
                spans[-1].follow(last, scale * junction.bend / last.scales[-1] ** 2)
        start = state.u if last is None else stretch.start
        spans[-1].add(scale, (stretch.end - start) * scale)
    spans[0].acceleration = state.acceleration * spans[0].scales[0]
    return spans


def _is_about(inner: Bounds, outer: Bounds, ratio: float) -> bool:
    """Return whether bounds exceed others only by differences that are not worth another span."""
    return (
        inner.velocity * ratio <= outer.velocity
        and inner.acceleration * _ABOUT <= outer.acceleration
        and inner.jerk * _ABOUT <= outer.jerk
    )
