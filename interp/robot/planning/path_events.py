"""The events of planned motions, and the times at which the path passes their places.

Times follow from the legs of a timeline, so they change with the plan. An event that was taken
never occurs again.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable

import numpy as np

from interp.robot.arm import ArmEvent, EventKind, Place
from interp.robot.path.speed_profile import bisected
from interp.robot.path.tool_path import tool_way
from interp.robot.planning.blend_zones import wants_blend
from interp.robot.planning.plan import Passage, places_of
from interp.robot.planning.timeline import APEX, MICROSECOND, Key, Section, Timeline, micros

#: What comes first of events of a motion at one time.
_ORDER: tuple[EventKind, ...] = (
    *("motion_start", "blend_end", "blend_start", "blend_apex"),
    *("place", "motion_end"),
)
_ROUNDING = 1e-9  # of u
#: How far in u a stop may end after its place and still be in time: a plan is exact to 1 µs.
_NEAR = 1e-4

#: Where a brake at a time in seconds would end: a section and its parameter.
StopFrom = Callable[[float], tuple[Key, float] | None]
#: An event, and what events are sorted by: time in µs, motion, and rank within the motion.
_Entry = tuple[int, float, int, ArmEvent]


def agenda(
    passages: Iterable[Passage],
    timeline: Timeline,
    now: int,
    stop_from: StopFrom,
    stopped: ArmEvent | None,
) -> list[ArmEvent]:
    """Return all events that have a time and were not taken, the earliest last.

    No time is before ``now``. ``stopped`` is the end of a brake; it comes last of its time.
    """
    found = [
        entry for passage in passages for entry in _events_of(passage, timeline, now, stop_from)
    ]
    if stopped is not None:
        found.append((stopped.time, math.inf, 0, stopped))
    found.sort(key=lambda entry: entry[:3], reverse=True)
    return [event for _, _, _, event in found]


def _events_of(passage: Passage, timeline: Timeline, now: int, stop_from: StopFrom) -> list[_Entry]:
    clock = _Clock(passage, timeline)
    motion, into, out = passage.motion, passage.into, passage.out
    found: list[_Entry] = []

    def add(
        kind: EventKind,
        seconds: float,
        key: int | None = None,
        *,
        is_late: bool = False,
    ) -> None:
        if seconds > timeline.end or (kind, key) in passage.taken:
            return
        time = max(micros(seconds), now)
        is_unwanted = kind == "motion_end" and out is None and wants_blend(motion)
        event = ArmEvent(time, kind, motion.number, key, is_unwanted, is_late)
        found.append((time, motion.number, _ORDER.index(kind), event))

    add("motion_start", clock.time(*passage.start))
    if into is not None:
        add("blend_end", clock.time(into, 1.0))
    if out is not None:
        add("blend_start", clock.time(out, 0.0))
        add("blend_apex", clock.time(out, APEX))
    add("motion_end", clock.time(*passage.end))
    for place, part in places_of(motion):
        add("place", clock.place(place, part), place.key)
    for place, part in places_of(motion, is_stop=True):
        chance, is_late = clock.last_chance(place, part, now, stop_from)
        add("place", chance, place.key, is_late=is_late)
    return found


class _Clock:
    """The times in seconds at which a motion passes its places; behind all legs if not planned."""

    def __init__(self, passage: Passage, timeline: Timeline) -> None:
        self._passage = passage
        self._timeline = timeline

    def time(self, section: Section, u: float) -> float:
        """Return the time at which a parameter is passed."""
        legs = self._timeline.of(section.key)
        if legs and u <= legs[0].stretch.start:
            return legs[0].begins
        for leg in legs:
            last = leg.last
            if u <= last + _ROUNDING:
                return leg.ends if u >= last - _ROUNDING else leg.time_at(u)
        return math.inf

    def place(self, place: Place, part: int | None) -> float:
        """Return the time of a place with its delay, moved into the admissible range."""
        passage, into, out = self._passage, self._passage.into, self._passage.out
        start, end = self.time(*passage.start), self.time(*passage.end)
        earliest = start if into is None else self.time(into, 0.0)
        latest = end if out is None else self.time(out, 1.0)
        if place.kind == "PATH":
            seconds = self.time(*self._on_path(place, part))
        elif place.position == 0.0:
            seconds = start if into is None else self.time(into, 1.0)
            latest = end
        else:
            seconds = end
            if out is not None:
                earliest = self.time(out, 0.0)
        return min(max(seconds + place.delay * MICROSECOND, earliest), latest)

    def last_chance(
        self, place: Place, part: int | None, now: int, stop_from: StopFrom
    ) -> tuple[float, bool]:
        """Return the latest time to brake for a stop at a place; now and True if it is too late."""
        section, u = self._on_path(place, part)
        low, high = max(self.time(*self._passage.start), now * MICROSECOND), self.time(section, u)
        if high > self._timeline.end:
            return high, False
        first = stop_from(low)
        if high <= low or (first is not None and first > (section.key, u + _NEAR)):
            return low, True

        def is_behind(time: float) -> bool:
            stop = stop_from(time)
            return stop is not None and stop >= (section.key, u)

        return bisected(is_behind, high, low), False

    def _on_path(self, place: Place, part: int | None) -> tuple[Section, float]:
        """Return section and parameter of a place in mm from end or start [TRG-04, TRG-11].

        It may lie on the blends on both sides.
        """
        passage = self._passage
        sections = passage.sections
        ways = [tool_way(section.curve) for section in sections]
        ends = [
            way.at(np.array([section.start, section.end]))
            for way, section in zip(ways, sections, strict=True)
        ]
        sums = np.cumsum([0.0, *(end - start for start, end in ends)])
        first = 0 if passage.into is None else 1
        if part is not None and part + (not place.on_start) < len(passage.body):
            origin = sums[first + part + (not place.on_start)]
        elif place.on_start:
            origin = sums[first]
        else:
            origin = sums[-1]
            if passage.out is not None:
                origin -= ends[-1][1] - ways[-1].at(np.array([APEX])).item()
        wanted = float(np.clip(origin + place.position, 0.0, sums[-1]))
        index = max(int(np.searchsorted(sums, wanted)) - 1, 0)
        u = ways[index].parameters(np.array([ends[index][0] + wanted - sums[index]])).item()
        return sections[index], u
