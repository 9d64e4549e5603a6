"""Moving and braking along a path: legs from the present state to the end, or to a stop."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from interp.robot.path.speed_profile import SpeedProfile, steady
from interp.robot.planning.junctions import SAME_CURVE, JoinedStretch, PathState
from interp.robot.planning.schedule import Schedule, brakings, schedule
from interp.robot.planning.timeline import Key, Leg, Section, Timeline

#: A section whose rest is shorter than this, in u, counts as travelled.
_THERE = 1e-9
#: Seconds by which a time in whole microseconds may be before the event in it.
_INSTANT = 2e-9

#: A section and a stretch of it; ``None`` for a motion of no length.
Entry = tuple[Section, JoinedStretch | None]


class PathExecution:
    """Adds the legs of a timeline.

    Times are seconds; a path is that of a plan, and a route the part of it that lies ahead at a
    time. What was travelled before that time is never changed.
    """

    def __init__(self, timeline: Timeline) -> None:
        self._timeline = timeline

    # --------------------------------------------------------------------------- progress

    def ahead(self, path: Sequence[Section], time: float) -> tuple[Section, ...]:
        """Return the part of a path that is not travelled yet at a time."""
        travelled = 0
        while travelled < len(path) and self._is_travelled(path[travelled], time):
            travelled += 1
        return tuple(path[travelled:])

    def reached(self, section: Section, time: float) -> float:
        """Return the parameter that is reached on a section at a time."""
        leg = self._timeline.leg_at(time)
        if leg is None or leg.section.key != section.key:
            return section.start
        return leg.state(time).u

    def stood_at(self, section: Section) -> float:
        """Return the parameter at which the arm stopped on a section."""
        legs = self._timeline.of(section.key)
        return legs[-1].last if legs else section.start

    def _is_travelled(self, section: Section, time: float) -> bool:
        legs = self._timeline.of(section.key)
        if not legs:
            leg = self._timeline.leg_at(time)
            return section.is_used_up and leg is not None and leg.section.key > section.key
        return legs[-1].ends <= time + _INSTANT and legs[-1].last >= section.end - _THERE

    def is_moving(self, time: float) -> bool:
        """Return whether the arm moves at a time."""
        return self._under_way(time) is not None

    # -------------------------------------------------------------------------- motion and stops

    def go(
        self, path: Sequence[Section], time: float, override: float, *, is_strict: bool = False
    ) -> bool:
        """Travel a path from a time on, starting in the state of the arm at that time.

        Returns whether that was possible. With ``is_strict`` it is not, and nothing changes, where
        a seam would be passed faster than is allowed.
        """
        route = self.ahead(path, time)
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
            if not rest or self._lay(rest, state, begins, override, is_strict):
                return True
        return False

    def halt(self, path: Sequence[Section], time: float, *, is_hard: bool) -> None:
        """Stop on the path as soon as possible."""
        route = self.ahead(path, time)
        leg = self._under_way(time)
        if leg is None:
            past = self._timeline.leg_at(time)
            self._timeline.cut(time if past is None else max(time, past.ends))
            return
        if not route or route[0].key != leg.section.key:  # it stops on a path that was left
            keys = {section.key for section in route}
            legs = self._timeline.after(leg)
            starts = (each.begins for each in legs if each.section.key in keys)
            self._timeline.cut(next(starts, self._timeline.end))
            return
        time = max(time, leg.begins)
        begins, legs = self._ramp_down(leg, route, time, is_hard)
        self._timeline.cut(begins)
        for each in legs:
            self._timeline.append(each)

    def stop_from(self, path: Sequence[Section], time: float) -> tuple[Key, float] | None:
        """Return where a stop that begins at a time would end; ``None`` if the arm stands then."""
        leg = self._timeline.leg_at(time)
        if leg is None or leg.ends <= time:
            return None
        _, legs = self._ramp_down(leg, path, time, is_hard=False)
        last = legs[-1] if legs else leg
        return last.section.key, last.last

    def _under_way(self, time: float) -> Leg | None:
        """Return the leg at a time, unless it ends within a microsecond."""
        leg = self._timeline.leg_at(time + _INSTANT)
        return leg if leg is not None and leg.ends > time + _INSTANT else None

    def _waiting(self, section: Section, time: float) -> tuple[float, float]:
        """Return the time and the parameter at which an arm that stands or stops continues.

        Legs planned after the stop belong to an earlier plan and are ignored.
        """
        legs = self._timeline.of(section.key)
        begins = next((leg.begins for leg in legs if leg.begins > time), self._timeline.end)
        passed = [leg for leg in legs if leg.begins < begins]
        return max(time, begins), passed[-1].last if passed else section.start

    def _ahead_of(
        self, leg: Leg, route: Sequence[Section], time: float
    ) -> Iterator[tuple[PathState, float, tuple[Section, ...]]]:
        """Yield the points at which a new plan may begin: now, or at the end of a leg.

        Each has its state, its time, and the remaining route.
        """
        places = {section.key: place for place, section in enumerate(route)}
        if leg.section.key not in places:
            return
        yield leg.state(time), time, tuple(route[places[leg.section.key] :])
        for each in (leg, *self._timeline.after(leg)):
            place = places.get(each.section.key)
            if place is None or each.last > route[place].end + _THERE:
                return  # it is on a path that was left, or goes on where the path now turns off
            rest, state = _behind(each, route[place:])
            yield state, each.ends, rest

    def _ramp_down(
        self, leg: Leg, route: Sequence[Section], time: float, is_hard: bool
    ) -> tuple[float, list[Leg]]:
        """Return the legs of a stop that begins at a time, and the start of the first leg."""

        def ways() -> Iterator[tuple[Schedule, float, list[Entry]]]:
            for state, begins, rest in self._ahead_of(leg, route, time):
                entries = [entry for entry in _entries(rest, state.u) if entry[1] is not None]
                for one in brakings(_known(entries), state, is_hard=is_hard):
                    yield one, begins, entries

        # What is planned is no faster than allowed, so a brake that would be begins later.
        way = next((way for way in ways() if not way[0].over), None) or next(ways(), None)
        if way is None:
            return self._timeline.end, []
        found, begins, entries = way
        return begins, _legs(entries, found.profiles, begins)

    def _lay(
        self,
        route: Sequence[Section],
        state: PathState,
        begins: float,
        override: float,
        is_strict: bool,
    ) -> bool:
        """Schedule a route from a state, append its legs, and return whether that was possible."""
        entries = _entries(route, state.u)
        found = schedule(_known(entries), state, override, is_strict=is_strict)
        if found is None or (is_strict and found.over):
            return False
        self._timeline.cut(begins)
        for leg in _legs(entries, found.profiles, begins):
            self._timeline.append(leg)
        return True


def _legs(entries: Sequence[Entry], profiles: Sequence[SpeedProfile], begins: float) -> list[Leg]:
    """Return the legs of all entries, or up to the one with the last profile."""
    legs: list[Leg] = []
    queue = iter(profiles)
    for section, joined in entries:
        profile = steady(0.0, 0.0) if joined is None else next(queue, None)
        if profile is None:
            break
        stretch = section.limits.stretches[0] if joined is None else joined.stretch
        legs.append(Leg(section, stretch, profile, begins, begins + profile.duration))
        begins += profile.duration
    return legs


def _known(entries: Sequence[Entry]) -> list[JoinedStretch]:
    return [joined for _, joined in entries if joined is not None]


def _behind(leg: Leg, route: Sequence[Section]) -> tuple[tuple[Section, ...], PathState]:
    """Return the route that remains after a leg, and the state there."""
    state = leg.state(leg.ends)
    if state.u < route[0].end - _THERE:
        return tuple(route), state
    for place, section in enumerate(route[1:], start=1):
        state = section.junction.passed(state, section.start)
        if not section.is_used_up:
            return tuple(route[place:]), state
    return (), state


def _entries(route: Sequence[Section], start: float) -> list[Entry]:
    """Return the stretches of a route from a parameter of its first section on.

    A section that two blends have used up has none; its junction is combined with the next one.
    """
    entries: list[Entry] = []
    junction = SAME_CURVE
    for place, section in enumerate(route):
        if section.is_still:
            entries.append((section, None))
            junction = SAME_CURVE
            continue
        junction = junction.then(section.junction)
        stretches = section.stretches(section.start if place else start, junction)
        if stretches:
            entries += [(section, joined) for joined in stretches]
            junction = SAME_CURVE
    return entries
