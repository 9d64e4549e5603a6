"""A route travelled: legs laid from where the arm is, to its end or to a stop."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from interp.robot.planning.profile import SpeedProfile, standing
from interp.robot.planning.schedule import GearedStretch, PathState, braking, schedule
from interp.robot.planning.timeline import Key, Leg, Section, Timeline

__all__ = ["PathExecution"]

_THERE = 1e-9
"""Of u: a section whose rest is shorter has been travelled."""
_INSTANT = 2e-9
"""Seconds by which whole microseconds may fall short of what happens in them."""

#: A section and a step of it; ``None`` for a motion of no length.
Entry = tuple[Section, GearedStretch | None]


class PathExecution:
    """Lays the legs of a timeline. Times are seconds; a route is what lies ahead at a time.

    What was travelled before a time is never touched.
    """

    def __init__(self, timeline: Timeline) -> None:
        self._timeline = timeline

    # --------------------------------------------------------------------------- what is behind

    def ahead(self, route: Sequence[Section], time: float) -> tuple[Section, ...]:
        """What of a route is not yet travelled at a time."""
        travelled = 0
        while travelled < len(route) and self._is_travelled(route[travelled], time):
            travelled += 1
        return tuple(route[travelled:])

    def reached(self, section: Section, time: float) -> float:
        """The parameter up to which a section is travelled at a time."""
        leg = self._timeline.leg_at(time)
        if leg is None or leg.section.key != section.key:
            return section.start
        return leg.state(time).u

    def stood_at(self, section: Section) -> float:
        """The parameter at which a section was left standing."""
        legs = self._timeline.of(section.key)
        return legs[-1].last if legs else section.start

    def _is_travelled(self, section: Section, time: float) -> bool:
        legs = self._timeline.of(section.key)
        if not legs:
            leg = self._timeline.leg_at(time)
            return section.is_used_up and leg is not None and leg.section.key > section.key
        return legs[-1].ends <= time + _INSTANT and legs[-1].last >= section.end - _THERE

    def is_moving(self, time: float) -> bool:
        """Whether the arm is on its way at a time."""
        return self._under_way(time) is not None

    # -------------------------------------------------------------------------- going and stopping

    def go(
        self,
        route: Sequence[Section],
        time: float,
        override: float,
        *,
        new_behind: Section | None = None,
    ) -> bool:
        """Travel a route from a time on, from whatever the arm does then.

        ``new_behind``: what follows this section is new. Then nothing is done, and the result is
        false, where a seam would be passed faster than is allowed.
        """
        is_strict = new_behind is not None
        if not route:
            return True
        leg = self._under_way(time)
        if leg is None or leg.section.key != route[0].key:
            begins, u = self._waiting(route[0], time)
            return self._lay(route, PathState(u, 0.0, 0.0), begins, None, override, is_strict)
        time = max(time, leg.begins)
        laid = self._lay(route, leg.state(time), time, leg, override, is_strict)
        if laid:
            return True
        # The acceleration cannot be taken back before the leg ends, or the override has dropped
        # and the leg ends faster than it allows now. Neither is the fault of what comes far behind.
        rest, state = _behind(leg, route)
        if is_strict and not any(section is new_behind for section in rest):
            return False
        return not rest or self._lay(rest, state, leg.ends, None, override, is_strict)

    def halt(
        self, route: Sequence[Section], time: float, override: float, *, is_hard: bool
    ) -> None:
        """Stop on the route as soon as can be."""
        leg = self._under_way(time)
        if leg is None or not route:
            past = self._timeline.leg_at(time)
            self._timeline.cut(time if past is None else max(time, past.ends))
            return
        time = max(time, leg.begins)
        begins, legs = _ramp_down(leg, route, time, override, is_hard)
        self._timeline.cut(begins)
        for each in legs:
            self._timeline.append(each)

    def stop_from(
        self, route: Sequence[Section], time: float, override: float
    ) -> tuple[Key, float] | None:
        """Where a stop that begins at a time would end; ``None`` where the arm stands then."""
        leg = self._timeline.leg_at(time)
        if leg is None or leg.ends <= time:
            return None
        _, legs = _ramp_down(leg, route, time, override, is_hard=False)
        last = legs[-1] if legs else leg
        return last.section.key, last.last

    def _under_way(self, time: float) -> Leg | None:
        """The leg that is not over at a time, but for less than a microsecond."""
        leg = self._timeline.leg_at(time + _INSTANT)
        return leg if leg is not None and leg.ends > time + _INSTANT else None

    def _waiting(self, section: Section, time: float) -> tuple[float, float]:
        """When and where on a section to go on, with an arm that stands, or will do before that.

        Legs that are planned behind the stop are those of an earlier plan, and count for nothing.
        """
        legs = self._timeline.of(section.key)
        begins = next((leg.begins for leg in legs if leg.begins > time), self._timeline.end)
        passed = [leg for leg in legs if leg.begins < begins]
        return max(time, begins), passed[-1].last if passed else section.start

    def _lay(
        self,
        route: Sequence[Section],
        state: PathState,
        begins: float,
        leg: Leg | None,
        override: float,
        is_strict: bool,
    ) -> bool:
        """Schedule a route from a state on and put its legs behind what is kept of the timeline.

        ``leg`` is the one under way, which stays where nothing about it changes.
        """
        entries = _entries(route, state.u)
        steps = _steps(entries)
        planned = None
        if leg is not None and steps and _goes_on(leg, steps[0], override):
            planned = leg.state(leg.ends).speed
        profiles: list[SpeedProfile | None] | None = []
        if steps:
            profiles = schedule(steps, state, override, planned=planned, is_strict=is_strict)
        if profiles is None:
            return False
        if profiles and profiles[0] is None and leg is not None:
            begins = leg.ends
        self._timeline.cut(begins)
        queue = iter(profiles)
        for section, step in entries:
            profile = standing(0.0) if step is None else next(queue)
            if profile is None:
                continue
            stretch = step.stretch if step is not None else section.ceiling.stretches[0]
            ends = begins + profile.duration
            self._timeline.append(Leg(section, stretch, profile, begins, ends, override))
            begins = ends
        return True


def _ramp_down(
    leg: Leg, route: Sequence[Section], time: float, override: float, is_hard: bool
) -> tuple[float, list[Leg]]:
    """Legs to a stop for a brake at a time on a leg, and when the first of them begins."""
    while route and route[0].key < leg.section.key:
        route = route[1:]
    begins, state = time, leg.state(time)
    entries = [entry for entry in _entries(route, state.u) if entry[1] is not None]
    profiles = braking(_steps(entries), state, override, is_hard=is_hard)
    if profiles is None:  # it cannot before the leg ends
        begins = leg.ends
        route, state = _behind(leg, route)
        entries = [entry for entry in _entries(route, state.u) if entry[1] is not None]
        profiles = braking(_steps(entries), state, override, is_hard=is_hard) or []
    legs, start = [], begins
    for (section, step), profile in zip(entries, profiles, strict=False):
        if step is not None:
            legs.append(Leg(section, step.stretch, profile, start, start + profile.duration))
            start += profile.duration
    return begins, legs


def _steps(entries: Sequence[Entry]) -> list[GearedStretch]:
    return [step for _, step in entries if step is not None]


def _behind(leg: Leg, route: Sequence[Section]) -> tuple[tuple[Section, ...], PathState]:
    """What of a route is left when a leg has ended, and the state there."""
    speed = leg.state(leg.ends).speed
    if route[0].key != leg.section.key or leg.last < route[0].end - _THERE:
        return tuple(route), PathState(leg.last, speed, 0.0)
    rest = list(route[1:])
    while rest and rest[0].is_used_up:
        speed *= rest.pop(0).gear
    if not rest:
        return (), PathState(leg.last, 0.0, 0.0)
    return tuple(rest), PathState(rest[0].start, speed * rest[0].gear, 0.0)


def _entries(route: Sequence[Section], start: float) -> list[Entry]:
    """The steps of a route from a parameter of its first section on.

    A section that two blends have used up has no step; its gear goes on to the next.
    """
    entries: list[Entry] = []
    gear = 1.0
    for place, section in enumerate(route):
        if section.is_still:
            entries.append((section, None))
            gear = 1.0
            continue
        steps = section.steps(start if place == 0 else section.start)
        gear *= section.gear
        for number, step in enumerate(steps):
            entries.append((section, replace(step, gear=gear) if number == 0 else step))
            gear = 1.0
    return entries


def _goes_on(leg: Leg, step: GearedStretch, override: float) -> bool:
    """Whether the leg under way is one with all the bounds that are in force now."""
    own, other = leg.stretch, step.stretch
    if leg.override is None or leg.last < own.end - _THERE:
        return False
    return own.end == other.end and own.bounds(leg.override) == other.bounds(override)
