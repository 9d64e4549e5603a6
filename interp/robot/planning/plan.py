"""What an arm has planned: the motions on its path in their order, and the blends between them."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from interp.robot.arm import ArmEvent, Motion, Place, SplinePart
from interp.robot.path.programmed_targets import Programmed
from interp.robot.path.tool_path import tool_way
from interp.robot.planning.blending import PlannedBlend
from interp.robot.planning.straight_run import StraightRun
from interp.robot.planning.timeline import APEX, Key, Section
from interp.robot.planning.tracks import Track

#: Kind and key of an event of one motion.
Taken = tuple[str, int | None]


@dataclass(frozen=True, slots=True, eq=False)
class Passage:
    """A motion on the path: its sections, the blends on both sides, if any, and past events."""

    motion: Motion
    body: tuple[Section, ...]
    into: Section | None = None
    out: Section | None = None
    taken: frozenset[Taken] = frozenset()

    @property
    def number(self) -> int:
        """The number of the motion."""
        return self.motion.number

    @property
    def sections(self) -> tuple[Section, ...]:
        """Its sections and both blends."""
        return tuple(part for part in (self.into, *self.body, self.out) if part is not None)

    @property
    def start(self) -> tuple[Section, float]:
        """Section and parameter at which the motion starts: the apex of the blend before it."""
        return (self.body[0], self.body[0].start) if self.into is None else (self.into, APEX)

    @property
    def end(self) -> tuple[Section, float]:
        """Section and parameter at which the motion ends: the apex of the blend behind it."""
        return (self.body[-1], self.body[-1].end) if self.out is None else (self.out, APEX)

    @property
    def has_ended(self) -> bool:
        """Whether its end was taken."""
        return ("motion_end", None) in self.taken

    @property
    def is_over(self) -> bool:
        """Whether all of its events were taken; those of STOP WHEN PATH come before its end."""
        wanted: set[Taken] = {("motion_start", None), ("motion_end", None)}
        wanted |= {("place", place.key) for place, _ in places_of(self.motion)}
        if self.into is not None:
            wanted.add(("blend_end", None))
        if self.out is not None:
            wanted |= {("blend_start", None), ("blend_apex", None)}
        return wanted <= self.taken

    def distances(self, key: Key, u: float) -> tuple[float, float]:
        """Return the mm travelled and left at a parameter of one of its sections [MOT-18]."""
        travelled = here = 0.0
        for section in self.sections:
            start = APEX if section is self.into else section.start
            end = APEX if section is self.out else section.end
            way = tool_way(section.curve)
            if section.key == key:
                first, now = way.at(np.array([start, min(max(u, start), end)]))
                here = travelled + float(now - first)
            first, last = way.at(np.array([start, end]))
            travelled += float(last - first)
        return here, travelled - here


@dataclass(frozen=True, slots=True, eq=False)
class Plan:
    """The motions with an event ahead, and the last one; the next motion starts at ``programmed``.

    ``last`` is the track of the last motion; ``straight`` is the straight run that ends with it, if
    that has more than one motion.
    """

    programmed: Programmed
    passages: tuple[Passage, ...] = ()
    last: Track | None = None
    straight: StraightRun | None = None
    is_aborted: bool = False

    @property
    def sections(self) -> tuple[Section, ...]:
        """The whole path of its motions; a blend is part of two of them."""
        found = (section for passage in self.passages for section in passage.sections)
        return tuple({section.key: section for section in found}.values())

    @property
    def oldest(self) -> float:
        """The number of the oldest motion of which a part or an event may lie ahead."""
        return self.passages[0].sections[0].number if self.passages else math.inf

    @property
    def pending(self) -> int:
        """The number of motions that have not ended."""
        return sum(not passage.has_ended for passage in self.passages)

    def with_motion(self, track: Track, programmed: Programmed) -> Plan:
        """Return the plan with one more motion, behind an exact stop."""
        passage = Passage(track.motion, _sections(track))
        return Plan(programmed, (*self.passages, passage), track)

    def with_blend(self, blend: PlannedBlend, track: Track, programmed: Programmed) -> Plan:
        """Return the plan with one more motion, and a blend into it from the last one."""
        *others, before = self.passages
        *body, last = before.body
        first, *following = _sections(track)
        shorter = replace(last, end=1.0 - blend.zone.before)
        through = Section(last.number, first.number, blend.curve, blend.limits, junction=blend.into)
        rest = replace(first, start=blend.zone.after, junction=blend.out)
        passages = (
            *others,
            replace(before, body=(*body, shorter), out=through),
            Passage(track.motion, (rest, *following), into=through),
        )
        if blend.straight is not None:
            passages = tuple(_bounded(passage, blend.straight) for passage in passages)
        return Plan(programmed, passages, track, blend.straight)

    def without(self, event: ArmEvent) -> Plan:
        """Return the plan without an event; a motion without any is dropped unless it is last."""
        found = []
        for passage in self.passages:
            known = passage
            if passage.number == event.motion:
                known = replace(passage, taken=passage.taken | {(event.kind, event.key)})
            if passage is self.passages[-1] or not known.is_over:
                found.append(known)
        return replace(self, passages=tuple(found))


def places_of(motion: Motion, *, is_stop: bool = False) -> Iterator[tuple[Place, int | None]]:
    """Yield the places of a motion, or those of STOP WHEN PATH [SPL-06].

    In a spline block with the segment to which they refer.
    """
    owners: list[tuple[int | None, Motion | SplinePart]] = [
        (None, motion),
        *enumerate(motion.parts),
    ]
    for segment, owner in owners:
        for place in owner.stop_places if is_stop else owner.places:
            yield place, segment


def _sections(track: Track) -> tuple[Section, ...]:
    """Return the sections of a motion without blends."""
    return tuple(
        Section(
            track.motion.number,
            None,
            piece.curve,
            piece.limits,
            end=0.0 if piece.is_still else 1.0,
            junction=piece.junction,
            is_still=piece.is_still,
            part=part,
        )
        for part, piece in enumerate(track.pieces)
    )


def _bounded(passage: Passage, run: StraightRun) -> Passage:
    """Return a motion with the limits of the straight run in all sections that are part of it."""
    return replace(
        passage,
        body=tuple(run.bounded(section) for section in passage.body),
        into=passage.into and run.bounded(passage.into),
        out=passage.out and run.bounded(passage.out),
    )
