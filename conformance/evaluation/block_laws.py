"""Laws about what a spline block does along its path, as docs/motion.md says of our simulator.

Parts of a TIME_BLOCK take their shares of its time, a range of CONST_VEL has the speed of its
slowest segment, and the arm stands at corners and at places of STOP WHEN PATH only. Places follow
from the programmed points (`conformance.evaluation.spline_laws`), without the planner.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Final

import numpy as np

from conformance.evaluation.laws import OVERRIDE, STOP, Deviations, Laws, Run, Subjects
from conformance.evaluation.motions import Array, EndedMotion
from conformance.evaluation.path_geometry import TOLERANCE_MM, change_rates, lengths
from conformance.evaluation.spline_laws import Segment, blocks_from_rest, chains_of, segments_of
from interp.port.requests import SplineRange
from interp.robot.arm import Motion

LAWS: Final = Laws(OVERRIDE, STOP)
#: Seconds within which a part of a TIME_BLOCK takes its share, as its ends lie between samples; and
#: the share of its speed or acceleration that one uses which cannot be as quick.
_SHARE_SECONDS: Final = 0.015
_FULL: Final = 0.8
#: Fraction by which a constant speed may be off, because samples are chords of arcs.
_SAME: Final = 0.005
#: mm between two samples below which the arm stands; and the share of the lower speed on both sides
#: of a point that is kept there where the path goes straight on.
_STILL: Final = 1e-6
_KEPT: Final = 0.08


@dataclass(frozen=True)
class _Block:
    """A block from rest to rest, with its segments and the points of its path, (n, 3)."""

    one: EndedMotion
    segments: Sequence[Segment]
    points: Array

    @cached_property
    def ends(self) -> Array:
        """The lengths in mm at the start, and at the end of each segment."""
        return np.cumsum([0.0, *(segment.length for segment in self.segments)])

    @cached_property
    def times(self) -> Array:
        """The times in s at its points."""
        one = self.one
        return np.concatenate(([one.start], one.times, [one.end])) / 1e6

    @cached_property
    def ways(self) -> Array:
        """The lengths in mm at its points."""
        sums = lengths(self.points)
        ways: Array = sums * (self.ends[-1] / sums[-1])
        return ways

    @cached_property
    def passed(self) -> Array:
        """The times in s at the start, and at the end of each segment."""
        return np.interp(self.ends, self.ways, self.times)

    @cached_property
    def speeds(self) -> Array:
        """The speeds in mm/s between its points, without the first and the last piece."""
        return change_rates(self.one.times, self.ways[1:-1, None])[:, 0]


def _blocks(run: Run) -> Subjects[_Block]:
    for event, one in blocks_from_rest(run):
        first, last = one.points(one.ends)
        segments = segments_of(first, one.motion.parts)
        if segments is not None and one.is_in_base:
            points = np.concatenate((first[None], one.tools[:, :3, 3], last[None]))
            yield event, _Block(one, segments, points)


# ------------------------------------------------------------------------------------ TIME_BLOCK


@LAWS.law("a part of a TIME_BLOCK takes its share, or as long as it needs", of=_blocks)
def _wrong_share(block: _Block) -> Deviations:
    """A part may take longer that uses the programmed speed or acceleration."""
    motion, times, passed = block.one.motion, block.times, block.passed
    gains = change_rates(block.one.times[1:], block.speeds[:, None])[:, 0]
    for begin, end, wanted in _shares_of_time(motion):
        took = passed[end] - passed[begin]
        settings = motion.parts[begin].settings or motion.settings
        own = (times[2:-1] > passed[begin]) & (times[2:-1] <= passed[end])
        fastest = block.speeds[own].max(initial=0.0) / (settings.velocity * 1000.0)
        steepest = np.abs(gains[own[1:]]).max(initial=0.0) / (settings.acceleration * 1000.0)
        is_full = max(fastest, steepest) > _FULL
        if took < wanted - _SHARE_SECONDS or (took > wanted + _SHARE_SECONDS and not is_full):
            yield f"{took:.3f} s, not {wanted:.3f} s"


def _shares_of_time(motion: Motion) -> Iterator[tuple[int, int, float]]:
    """Yield the segments between which each part of a TIME_BLOCK lies, and its seconds."""
    begin, parts = 0, list[tuple[int, int, float]]()
    for number, mark in _marks(motion, "TIME_BLOCK"):
        if mark.edge == "PART":
            parts.append((begin, number, mark.value or 0.0))
        elif mark.edge == "END":
            whole = math.fsum(share for _, _, share in parts) or 1.0
            for start, end, share in parts or [(begin, number, 1.0)]:
                yield start, end, (mark.value or 0.0) * share / whole
            parts = []
        begin = number


def _marks(motion: Motion, keyword: str) -> Iterator[tuple[int, SplineRange]]:
    """Yield the marks of ranges, with the number of the segment before which they are written."""
    for number, marks in enumerate([*(part.ranges for part in motion.parts), motion.ranges]):
        for mark in marks:
            if mark.keyword == keyword:
                yield number, mark


# ------------------------------------------------------------------------------------- CONST_VEL


@LAWS.law("a range of CONST_VEL has the speed of its slowest segment", of=_blocks)
def _not_constant(block: _Block) -> Deviations:
    motion, ways = block.one.motion, block.ways[1:-1]
    for first, last in _constant_ranges(block):
        if last <= first:
            continue
        speed = 1000.0 * min(
            (part.settings or motion.settings).velocity
            for part, (start, end) in zip(motion.parts, pairwise(block.ends), strict=True)
            if start < last - TOLERANCE_MM and end > first + TOLERANCE_MM
        )
        inside = (ways >= first + TOLERANCE_MM) & (ways <= last - TOLERANCE_MM)
        own = block.speeds[inside[:-1] & inside[1:]]
        off = float(np.abs(own / speed - 1.0).max(initial=0.0))
        if off > _SAME:
            yield f"{off:.1%} off {speed:.1f} mm/s"


def _constant_ranges(block: _Block) -> Iterator[tuple[float, float]]:
    """Yield the lengths in mm between which each range of CONST_VEL lies."""
    start: float | None = None
    for number, mark in _marks(block.one.motion, "CONST_VEL"):
        segment = min(number + (not mark.on_start), len(block.segments))
        place = float(np.clip(block.ends[segment] + (mark.value or 0.0), 0.0, block.ends[-1]))
        if mark.edge == "START":
            start = place
        elif start is not None:
            yield start, place
            start = None
    if start is not None:
        yield start, float(block.ends[-1])


# ------------------------------------------------------------------------------------------ stops


def _corners(block: _Block) -> list[float]:
    """Return the lengths in mm at which a block has to stop."""
    return [block.ends[first] for first, _ in chains_of(block.segments)[1:]]


@LAWS.law("within a block the arm stands at corners and at STOP WHEN PATH only", of=_blocks)
def _stopped(block: _Block) -> Deviations:
    lines = np.concatenate([segment.points for segment in block.segments])
    wanted = np.clip([*_corners(block), *_stop_places(block)], 0.0, block.ends[-1])
    places = np.stack([np.interp(wanted, lengths(lines), column) for column in lines.T], axis=1)
    steps = np.linalg.norm(np.diff(block.points, axis=0), axis=1)
    for row in np.flatnonzero(steps[1:-1] < _STILL) + 1:
        if np.linalg.norm(places - block.points[row], axis=1).min(initial=math.inf) > TOLERANCE_MM:
            yield f"it stands {block.ways[row]:.3f} mm behind its start"
            return


@LAWS.law("within a block the arm keeps moving where its path goes straight on", of=_blocks)
def _nearly_stopped(block: _Block) -> Deviations:
    between, corners = block.times[2:-1], _corners(block)
    if list(_stop_places(block)):
        return
    for number, end in enumerate(block.ends[1:-1], 1):
        sides = [
            block.speeds[(between > start) & (between <= stop)].max(initial=0.0)
            for start, stop in pairwise(block.passed[number - 1 : number + 2])
        ]
        nearest = int(np.searchsorted(between, block.passed[number]))
        slowest = float(block.speeds[max(nearest - 1, 0) : nearest + 2].min(initial=math.inf))
        if end not in corners and slowest < _KEPT * min(sides):
            yield f"{slowest:.2f} mm/s between {sides[0]:.1f} and {sides[1]:.1f}"


def _stop_places(block: _Block) -> Iterator[float]:
    """Yield the lengths in mm at which a block may stop [SPL-06]."""
    motion = block.one.motion
    for number, part in enumerate(motion.parts):
        for place in part.stop_places:
            yield block.ends[number + (not place.on_start)] + place.position
    for place in motion.stop_places:
        yield block.ends[0 if place.on_start else -1] + place.position
