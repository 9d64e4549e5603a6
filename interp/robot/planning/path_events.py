"""The events of planned motions, and the times at which the path passes their places.

Times follow from the legs of a timeline, so they change with the plan. An event that was taken
never occurs again.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from interp.robot.arm import ArmEvent, EventKind, Motion, Place
from interp.robot.planning.blend_zones import wants_blend
from interp.robot.planning.timeline import MICROSECOND, Key, Section, Timeline, micros

_APEX = 0.5
"""The parameter of a blend at which the first motion ends and the second begins [TRG-02]."""
_ORDER: Sequence[EventKind | None] = (
    *("motion_start", "blend_end", "place", "blend_start", "blend_apex"),
    None,  # places that count from the end
    "motion_end",
)
"""What comes first of events of a motion at one time."""
_HALVINGS = 30
_ROUNDING = 1e-9  # of u
_NEAR = 1e-4
"""How far in u a stop may end after its place and still be in time: a plan is exact to 1 µs."""

#: Kind and key of an event of one motion.
Taken = tuple[str, int | None]


@dataclass(frozen=True, slots=True, eq=False)
class Passage:
    """A motion on the path: its sections, and the blends on both sides, if any."""

    motion: Motion
    body: tuple[Section, ...]
    into: Section | None = None
    out: Section | None = None
    taken: frozenset[Taken] = frozenset()

    @property
    def number(self) -> int:
        """The number of the motion."""
        return self.motion.number

    def parts(self) -> Iterator[tuple[Section, float, float]]:
        """Yield the sections with the parameters between which they belong to the motion."""
        if self.into is not None:
            yield self.into, _APEX, 1.0
        for section in self.body:
            yield section, section.start, section.end
        if self.out is not None:
            yield self.out, 0.0, _APEX

    @property
    def is_over(self) -> bool:
        """Whether all of its events were taken."""
        motion = self.motion
        places = [("place", place.key) for place, _ in (*_places(motion), *_stop_places(motion))]
        wanted = {("motion_start", None), ("motion_end", None), *places}
        if self.into is not None:
            wanted.add(("blend_end", None))
        if self.out is not None:
            wanted |= {("blend_start", None), ("blend_apex", None)}
        return wanted <= self.taken

    def distances(self, key: Key, u: float) -> tuple[float, float]:
        """Return the mm travelled and left at a parameter of one of its sections [MOT-18]."""
        sums, here = [0.0], 0.0
        for section, start, end in self.parts():
            if section.key == key:
                first, now = section.way.at(np.array([start, min(max(u, start), end)]))
                here = sums[-1] + float(now - first)
            first, last = section.way.at(np.array([start, end]))
            sums.append(sums[-1] + float(last - first))
        return here, sums[-1] - here


#: Where a brake at a time in seconds would end: a section and its parameter.
StopFrom = Callable[[float], tuple[Key, float] | None]


def events_of(
    passage: Passage, timeline: Timeline, now: int, stop_from: StopFrom
) -> list[tuple[int, int, ArmEvent]]:
    """Return the events of a motion that have a time and were not taken, with time and rank.

    No time is before ``now``.
    """
    clock = _Clock(passage, timeline)
    found: list[tuple[int, int, ArmEvent]] = []

    def add(
        kind: EventKind,
        seconds: float | None,
        key: int | None = None,
        *,
        is_of_end: bool = False,
        is_late: bool = False,
    ) -> None:
        if seconds is not None and (kind, key) not in passage.taken:
            time = max(micros(seconds), now)
            is_unwanted = (
                kind == "motion_end" and passage.out is None and wants_blend(passage.motion)
            )
            event = ArmEvent(time, kind, passage.number, key, is_unwanted, is_late)
            found.append((time, _ORDER.index(None if is_of_end else kind), event))

    add("motion_start", clock.start)
    if passage.into is not None:
        add("blend_end", clock.time(passage.into, 1.0))
    if passage.out is not None:
        add("blend_start", clock.time(passage.out, 0.0))
        add("blend_apex", clock.time(passage.out, _APEX))
    add("motion_end", clock.end)
    for place, part in _places(passage.motion):
        at_start = place.kind == "DISTANCE" and place.position == 0.0
        add("place", clock.place(place, part), place.key, is_of_end=not at_start)
    for place, part in _stop_places(passage.motion):
        chance, is_late = clock.last_chance(place, part, now, stop_from)
        add("place", chance, place.key, is_late=is_late)
    return found


def _places(motion: Motion) -> Iterator[tuple[Place, int | None]]:
    """Yield the places of a motion; in a spline block with the segment to which they refer."""
    for place in motion.places:
        yield place, None
    for number, part in enumerate(motion.parts):
        for place in part.places:
            yield place, number


def _stop_places(motion: Motion) -> Iterator[tuple[Place, int | None]]:
    """Yield the places of STOP WHEN PATH in a block; those of a segment with its number."""
    for place in motion.stop_places:
        yield place, None
    for number, part in enumerate(motion.parts):
        for place in part.stop_places:
            yield place, number


class _Clock:
    """The times at which a motion passes its places."""

    def __init__(self, passage: Passage, timeline: Timeline) -> None:
        self._passage = passage
        self._timeline = timeline

    @property
    def start(self) -> float | None:
        """The start of the motion in seconds; the apex of the blend before it, if any."""
        passage = self._passage
        if passage.into is not None:
            return self.time(passage.into, _APEX)
        return self.time(passage.body[0], passage.body[0].start)

    @property
    def end(self) -> float | None:
        """The end of the motion in seconds."""
        passage = self._passage
        if passage.out is not None:
            return self.time(passage.out, _APEX)
        return self.time(passage.body[-1], passage.body[-1].end)

    def time(self, section: Section, u: float) -> float | None:
        """Return the time in seconds at which a parameter is passed; ``None`` if not planned."""
        legs = self._timeline.of(section.key)
        if legs and u <= legs[0].stretch.start:
            return legs[0].begins
        for leg in legs:
            last = leg.last
            if u <= last + _ROUNDING:
                return leg.ends if u >= last - _ROUNDING else leg.time_at(u)
        return None

    def place(self, place: Place, part: int | None) -> float | None:
        """Return the time of a place with its delay, moved into the admissible range."""
        passage = self._passage
        earliest = self.start if passage.into is None else self.time(passage.into, 0.0)
        latest = self.end if passage.out is None else self.time(passage.out, 1.0)
        if place.kind == "PATH":
            seconds = self._path_place(place, part)
        elif place.position == 0.0:
            seconds = self.start if passage.into is None else self.time(passage.into, 1.0)
            latest = self.end
        else:
            seconds = self.end
            if passage.out is not None:
                earliest = self.time(passage.out, 0.0)
        if seconds is None:
            return None
        seconds += place.delay * MICROSECOND
        if earliest is not None:
            seconds = max(seconds, earliest)
        if latest is None:  # not planned that far, so it may still come to lie earlier
            return seconds if seconds <= self._known_until() else None
        return min(seconds, latest)

    def _known_until(self) -> float:
        legs = self._timeline.legs
        return legs[-1].ends if legs else 0.0

    def last_chance(
        self, place: Place, part: int | None, now: int, stop_from: StopFrom
    ) -> tuple[float | None, bool]:
        """Return the latest time to brake for a stop at a place; now, and True, if it is too late.

        The time is ``None`` if the path is not planned up to there.
        """
        section, u = self._on_path(place, part)
        passed, start = self.time(section, u), self.start
        if passed is None or start is None:
            return None, False
        low, high = max(start, now * MICROSECOND), passed
        first = stop_from(low)
        if high <= low or (first is not None and first > (section.key, u + _NEAR)):
            return low, True
        for _ in range(_HALVINGS):
            middle = (low + high) / 2.0
            stop = stop_from(middle)
            if stop is None or stop < (section.key, u):
                low = middle
            else:
                high = middle
        return high, False

    def _path_place(self, place: Place, part: int | None) -> float | None:
        """Return the time at which the tool passes a place."""
        return self.time(*self._on_path(place, part))

    def _on_path(self, place: Place, part: int | None) -> tuple[Section, float]:
        """Return section and parameter of a place in mm from end or start [TRG-04, TRG-11]."""
        passage = self._passage
        sections = [
            (section, *section.way.at(np.array(range_)))
            for section, range_ in self._extended(passage)
        ]
        sums = np.cumsum([0.0, *(end - start for _, start, end in sections)])
        first = 0 if passage.into is None else 1
        if part is not None and 0 < part + (not place.on_start) < len(passage.body):
            origin = sums[first + part + (not place.on_start)]
        elif place.on_start:
            origin = sums[first]
        else:
            origin = sums[-1]
            if passage.out is not None:
                section, start, end = sections[-1]
                origin -= end - float(section.way.at(np.array([_APEX]))[0])
        wanted = float(np.clip(origin + place.position, 0.0, sums[-1]))
        index = int(np.clip(np.searchsorted(sums, wanted, side="left") - 1, 0, len(sections) - 1))
        section, start, _ = sections[index]
        u = float(section.way.parameters(np.array([start + wanted - sums[index]]))[0])
        return section, u

    @staticmethod
    def _extended(passage: Passage) -> Sequence[tuple[Section, tuple[float, float]]]:
        """Return the sections on which places may lie, with the blends on both sides [TRG-11]."""
        parts = [(section, (section.start, section.end)) for section in passage.body]
        if passage.into is not None:
            parts.insert(0, (passage.into, (0.0, 1.0)))
        if passage.out is not None:
            parts.append((passage.out, (0.0, 1.0)))
        return parts
