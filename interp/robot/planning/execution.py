"""A route travelled: legs laid from where the arm is, to its end or to a stop."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from interp.robot.planning.profile import standing
from interp.robot.planning.schedule import GearedStretch, PathState, braking, schedule
from interp.robot.planning.timeline import Key, Leg, Section, Timeline

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
            return self._lay(route, PathState(u, 0.0, 0.0), begins, override, is_strict)
        # The acceleration may be such that it cannot be taken back in time, or the override has
        # dropped and what is under way ends faster than it allows now. Neither is the fault of what
        # comes far behind, so it begins where that can be.
        for state, begins, rest in self._ahead_of(leg, route, max(time, leg.begins)):
            if is_strict and not any(section is new_behind for section in rest):
                return False
            if not rest or self._lay(rest, state, begins, override, is_strict):
                return True
        return False

    def halt(self, route: Sequence[Section], time: float, *, is_hard: bool) -> None:
        """Stop on the route as soon as can be."""
        leg = self._under_way(time)
        if leg is None or not route:
            past = self._timeline.leg_at(time)
            self._timeline.cut(time if past is None else max(time, past.ends))
            return
        time = max(time, leg.begins)
        begins, legs = self._ramp_down(leg, route, time, is_hard)
        self._timeline.cut(begins)
        for each in legs:
            self._timeline.append(each)

    def stop_from(self, route: Sequence[Section], time: float) -> tuple[Key, float] | None:
        """Where a stop that begins at a time would end; ``None`` where the arm stands then."""
        leg = self._timeline.leg_at(time)
        if leg is None or leg.ends <= time:
            return None
        _, legs = self._ramp_down(leg, route, time, is_hard=False)
        last = legs[-1] if legs else leg
        return last.section.key, last.last

    def _under_way(self, time: float) -> Leg | None:
        """The leg that is not over at a time, but for less than a microsecond."""
        leg = self._timeline.leg_at(time + _INSTANT)
        return leg if leg is not None and leg.ends > time + _INSTANT else None

    def _waiting(self, section: Section, time: float) -> tuple[float, float]:
        """When and where on a section to continue, with an arm that stands, or will do before that.

        Legs that are planned behind the stop are those of an earlier plan, and count for nothing.
        """
        legs = self._timeline.of(section.key)
        begins = next((leg.begins for leg in legs if leg.begins > time), self._timeline.end)
        passed = [leg for leg in legs if leg.begins < begins]
        return max(time, begins), passed[-1].last if passed else section.start

    def _ahead_of(
        self, leg: Leg, route: Sequence[Section], time: float
    ) -> Iterator[tuple[PathState, float, tuple[Section, ...]]]:
        """Where a plan may begin: now, or at the end of a leg that is under way or follows.

        The state there, the time, and what is left of the route.
        """
        yield leg.state(time), time, tuple(route)
        following = self._timeline.after(leg)
        for each in (leg, *following):
            while route and route[0].key < each.section.key:
                route = route[1:]
            if not route or route[0].key != each.section.key:
                return
            rest, state = _behind(each, route)
            yield state, each.ends, rest
            if not rest:
                return

    def _ramp_down(
        self, leg: Leg, route: Sequence[Section], time: float, is_hard: bool
    ) -> tuple[float, list[Leg]]:
        """Legs to a stop for a brake at a time on a leg, and when the first of them begins."""
        while route and route[0].key < leg.section.key:
            route = route[1:]
        # What is planned is no faster than allowed, so a brake that would be begins later.
        for is_strict in (True, False):
            for state, begins, rest in self._ahead_of(leg, route, time):
                entries = [entry for entry in _entries(rest, state.u) if entry[1] is not None]
                profiles = braking(_steps(entries), state, is_hard=is_hard, is_strict=is_strict)
                if profiles is None:
                    continue
                legs, start = [], begins
                for (section, step), profile in zip(entries, profiles, strict=False):
                    if step is not None:
                        ends = start + profile.duration
                        legs.append(Leg(section, step.stretch, profile, start, ends))
                        start = ends
                return begins, legs
        return self._timeline.end, []

    def _lay(
        self,
        route: Sequence[Section],
        state: PathState,
        begins: float,
        override: float,
        is_strict: bool,
    ) -> bool:
        """Schedule a route from a state on and put its legs behind what is kept of the timeline."""
        entries = _entries(route, state.u)
        steps = _steps(entries)
        profiles = schedule(steps, state, override, is_strict=is_strict) if steps else []
        if profiles is None:
            return False
        self._timeline.cut(begins)
        queue = iter(profiles)
        for section, step in entries:
            profile = standing(0.0) if step is None else next(queue)
            stretch = step.stretch if step is not None else section.ceiling.stretches[0]
            ends = begins + profile.duration
            self._timeline.append(Leg(section, stretch, profile, begins, ends))
            begins = ends
        return True


def _steps(entries: Sequence[Entry]) -> list[GearedStretch]:
    return [step for _, step in entries if step is not None]


def _behind(leg: Leg, route: Sequence[Section]) -> tuple[tuple[Section, ...], PathState]:
    """What of a route is left when a leg has ended, and the state there."""
    state = leg.state(leg.ends)
    if leg.last < route[0].end - _THERE:
        return tuple(route), replace(state, u=leg.last)
    rest = list(route[1:])
    while rest and rest[0].is_used_up:
        used = rest.pop(0)
        state = state.behind(used.start, used.gear, used.bend)
    if not rest:
        return (), PathState(leg.last, 0.0, 0.0)
    return tuple(rest), state.behind(rest[0].start, rest[0].gear, rest[0].bend)


def _entries(route: Sequence[Section], start: float) -> list[Entry]:
    """The steps of a route from a parameter of its first section on.

    A section that two blends have used up has no step; how it changes speeds counts for the next.
    """
    entries: list[Entry] = []
    gear, bend = 1.0, 0.0
    for place, section in enumerate(route):
        if section.is_still:
            entries.append((section, None))
            gear, bend = 1.0, 0.0
            continue
        steps = section.steps(start if place == 0 else section.start)
        gear, bend = gear * section.gear, section.gear * bend + section.bend * gear**2
        for number, step in enumerate(steps):
            first = replace(step, gear=gear, bend=bend) if number == 0 else step
            entries.append((section, first))
            gear, bend = 1.0, 0.0
    return entries
