"""Laws about where blends begin and end and when triggers switch, as docs/motion.md says.

They use the programmed paths, from point to point, instead of the executed ones: the extent of a
blend follows from targets, criteria and machine data alone.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from operator import itemgetter
from typing import Final

import numpy as np

from conformance.evaluation.motions import Array, EndedMotion, follows
from conformance.evaluation.observation import Observation
from conformance.evaluation.path_geometry import between, drawn
from conformance.evaluation.run_laws import Violation
from interp.robot.arm import Place, Target
from interp.robot.kinematics.machine_data import ROBOT_AXES
from interp.robot.kinematics.placement import IpoMode

_SHARES: Final = np.linspace(0.0, 1.0, 501)[:, None]
_POINT: Final = ("X", "Y", "Z")
#: Tolerance of a blend zone in mm and degrees.
_NEAR_MM, _NEAR_DEGREES = 0.01, 0.002
#: Tolerance of times in µs, because times and ends of motions are rounded.
_NEAR_TIME: Final = 2
#: The largest fraction of a motion that a blend may use.
_HALF: Final = 0.5
#: The messages of a motion that is not approximated [ADV-12].
_NOT_APPROXIMATED: Final = (1123, 1442)


@dataclass(frozen=True)
class _ProgrammedPath:
    """The programmed path of a motion: axes (n, axes) of a PTP if known, and tool points (n, 3)."""

    axes: Array | None
    points: Array

    @cached_property
    def sums(self) -> Array:
        """The path length of the tool up to each point in mm."""
        steps = np.linalg.norm(np.diff(self.points, axis=0), axis=1)
        return np.concatenate(([0.0], np.cumsum(steps)))

    @property
    def middle(self) -> float:
        """The path length up to the middle of the parameter in mm."""
        return float(np.interp(_HALF, np.linspace(0.0, 1.0, len(self.sums)), self.sums))

    def length_to(self, point: Array) -> float:
        """Return the path length in mm up to the place that is nearest to a point."""
        starts, along = self.points[:-1], np.diff(self.points, axis=0)
        squares = np.maximum((along**2).sum(axis=1), 1e-12)
        shares = np.clip(((point - starts) * along).sum(axis=1) / squares, 0.0, 1.0)
        off = np.linalg.norm(starts + shares[:, None] * along - point, axis=1)
        place = int(np.argmin(off))
        return float(self.sums[place] + shares[place] * np.sqrt(squares[place]))


def blend_violations(motions: Sequence[EndedMotion]) -> Iterator[Violation]:
    """Yield blends that use more of a motion than their criteria say, or less of both [BLD-07]."""
    if all(one.stops for one in motions):
        return
    law = "a blend takes of both motions what its criteria say"
    for (one, way), (other, further) in pairwise(_programmed_paths(motions)):
        if one.stops or other.begins or not one.motion.criteria or not follows(one, other):
            continue
        is_path, leads_on = (not each.motion.kind.endswith("PTP") for each in (one, other))
        main, *second = one.motion.criteria
        second_criterion = main
        if is_path is not leads_on:
            second_criterion = second[0] if second else "C_DIS" if leads_on else "C_PTP"
        off = [
            _excess(one, way, main, one, at_end=True),
            _excess(other, further, second_criterion, one, at_end=False),
        ]
        known = [each for each in off if each is not None]
        if max(known, default=0.0) > 1.0 or (len(known) == 2 and max(known) < -1.0):
            excesses = " and ".join("?" if each is None else f"{each:.1f}" for each in off)
            yield one.broken(law, f"{excesses} tolerances beyond them, before and behind the point")


def missing_blends(motions: Sequence[EndedMotion]) -> Iterator[Violation]:
    """Yield an approximated motion that stops though the next was planned before it began.

    Both have a length, as far as their times tell.
    """
    for one, other in pairwise(motions):
        own, next_own = (each.motion.settings.approximation for each in (one, other))
        if not one.motion.criteria or not one.stops or not follows(one, other):
            continue
        zones = _zones(one)
        if other.motion.kind.endswith("PTP"):
            zones.append(next_own.cptp)
        elif one.motion.kind.endswith("PTP"):
            zones.append(own.cdis)
        is_in_time = other.planned < one.start < one.end and other.start < other.end
        if min(zones) > 0.0 and is_in_time:
            law = "a motion is approximated where the next is planned before it begins"
            yield one.broken(law, "it stops")


def wrong_blend_reports(seen: Observation, motions: Sequence[EndedMotion]) -> Iterator[Violation]:
    """Yield a blend that failed without a message, and a message where none was wanted [ADV-12].

    ``motions`` are those of the run that came to their end.
    """
    told = {
        (one.file, one.line): one
        for one in seen.of_kind("message")
        if one.fields.get("number") in _NOT_APPROXIMATED
    }
    law = "a motion is reported not to be approximated where it should have been"
    for one in motions:
        message = told.get((one.event.file, one.event.line))
        if message is not None and not one.motion.criteria:
            yield Violation(message, law, "it should not have been", "ADV-12")
        elif message is None and one.stops and _has_zone(one):
            yield one.broken(law, "it is not reported", "ADV-12")


def _has_zone(one: EndedMotion) -> bool:
    """Return whether a motion has an approximation criterion, and each is larger than zero."""
    return bool(one.motion.criteria) and min(_zones(one)) > 0.0


def _zones(one: EndedMotion) -> list[float]:
    """Return the sizes of the criteria of a motion, in the unit of each."""
    own = one.motion.settings.approximation
    sizes = {"C_PTP": own.cptp, "C_VEL": own.cvel, "C_ORI": own.cori}
    return [sizes.get(criterion, own.cdis) for criterion in one.motion.criteria]


def _excess(
    one: EndedMotion,
    way: _ProgrammedPath | None,
    criterion: str,
    first: EndedMotion,
    *,
    at_end: bool,
) -> float | None:
    """Return by how many tolerances a blend uses too much of a motion; ``None`` if unknown.

    ``first`` is the motion before the point, whose $APO.CDIS applies on both sides.
    """
    cdis = max(first.motion.settings.approximation.cdis, 0.0)
    is_both = one.motion.kind == "SPTP" and cdis > 0.0
    if way is None or (way.axes is None and criterion == "C_PTP"):
        return None
    found = []
    place = one.ends[int(at_end)]
    if criterion in ("C_DIS", "C_SPL") or is_both:
        length, middle, whole = (
            way.length_to(one.poses(place[None])[0, :3, 3]),
            way.middle,
            way.sums[-1],
        )
        taken, most = (whole - length, whole - middle) if at_end else (length, middle)
        found.append((taken - min(cdis, most)) / _NEAR_MM)
    if way.axes is not None and (criterion == "C_PTP" or one.motion.kind == "SPTP"):
        travel = np.abs(way.axes[-1] - way.axes[0])
        share = min(max(one.motion.settings.approximation.cptp, 0.0), 100.0) / 100.0
        axes = one.machine.every_axis
        reach = share * np.array([axis.approximation for axis in axes])
        most = min(float((reach / np.maximum(travel, 1e-9)).min()), _HALF) * travel.max()
        found.append((np.abs(place - way.axes[-int(at_end)]).max() - most) / _NEAR_DEGREES)
    return float(max(found)) if found else None


def _programmed_paths(
    motions: Sequence[EndedMotion],
) -> Iterator[tuple[EndedMotion, _ProgrammedPath | None]]:
    """Yield each motion with its programmed path, ``None`` if that is not completely numeric."""
    axes: Array | None = None
    point: Array | None = None
    placement = None
    for before, one in zip((None, *motions), motions, strict=False):
        if before is not None and not follows(before, one):
            axes = point = None
        if one.begins or placement != one.motion.settings.placement:
            axes = one.ends[0] if one.begins else axes
            point = None if axes is None else _tool(one, axes)[0]
        placement = one.motion.settings.placement
        start, axes = axes, one.ends[1] if one.stops else axes_of(one, axes)
        origin, point = point, _point(one, one.motion.target, point)
        if axes is not None:
            point = _tool(one, axes)[0]
        yield one, _programmed_path(one, start, axes, origin, point)


def _programmed_path(
    one: EndedMotion,
    start: Array | None,
    end: Array | None,
    origin: Array | None,
    last: Array | None,
) -> _ProgrammedPath | None:
    """Return the path between axes for a PTP, else between points; ``None`` if unknown."""
    motion = one.motion
    is_plain = not motion.parts and motion.angle is None and one.machine.palletising is None
    if not is_plain or motion.settings.placement.mode is not IpoMode.BASE:
        return None
    match motion.kind:
        case "PTP" | "SPTP" if start is not None and end is not None:
            axes = start + _SHARES * (end - start)
            return _ProgrammedPath(axes, _tool(one, axes))
        case "LIN" | "SLIN" if origin is not None and last is not None:
            return _ProgrammedPath(None, np.array([origin, last]))
        case "CIRC" | "SCIRC" if origin is not None and last is not None:
            middle = _point(one, motion.auxiliary, origin)
            return (
                None
                if middle is None
                else _ProgrammedPath(None, drawn("circle", np.array([origin, middle, last]), 501))
            )
    return None


def _tool(one: EndedMotion, axes: Array) -> Array:
    """Return the positions of the tool relative to the base (n, 3) for axes."""
    points: Array = one.poses(np.atleast_2d(axes))[:, :3, 3]
    return points


def axes_of(one: EndedMotion, before: Array | None) -> Array | None:
    """Return the axes of a target given as axes; omitted ones keep their value [MOT-16]."""
    names = [axis.name for axis in one.machine.every_axis]
    target = one.motion.target
    if before is None or one.motion.is_relative or not set(names[:ROBOT_AXES]) & set(target):
        return None
    return np.array([target.get(name, value) for name, value in zip(names, before, strict=True)])


def _point(one: EndedMotion, target: Target | None, before: Array | None) -> Array | None:
    """Return the point of a target; omitted components keep their value [MOT-16]."""
    given = set(_POINT) & set(target or {})
    if target is None or not given or one.motion.is_relative or (before is None and len(given) < 3):
        return None
    if before is None:
        before = np.zeros(3)
    return np.array([target.get(name, old) for name, old in zip(_POINT, before, strict=True)])


# -------------------------------------------------------------------------------------- triggers


def trigger_violations(seen: Observation, motions: Sequence[EndedMotion]) -> Iterator[Violation]:
    """Yield triggers that switch at a time that contradicts the path [TRG-02, TRG-04, TRG-08].

    Yield nothing if some of their motions did not come to their end, or belong to a spline block.
    """
    stopped = min((one.time or 0 for one in seen.of_kind("brake", "resume", "halt")), default=None)
    motions = [one for one in motions if stopped is None or one.end <= stopped]
    moving = [motion for _, motion in seen.path.motions] if seen.path else []
    if any(part.places for motion in moving for part in motion.parts):
        return
    if sum(len(motion.places) for motion in moving) > sum(
        len(one.motion.places) for one in motions
    ):
        return
    known = {one.motion.number: one for one in motions}
    spans = []
    for one in motions:
        number = one.motion.number
        before, after = known.get(number - 1), known.get(number + 1)
        for place in one.motion.places:
            if (before is None and not one.begins) or (after is None and not one.stops):
                return  # a blend of which half is unknown
            row = None if one.begins else before, None if one.stops else after
            spans.append(_period(place, one, *row))
    spans.sort()
    for event in seen.of_kind("trigger"):
        time = event.time or 0
        fitting = [span for span in spans if span[0] - _NEAR_TIME <= time <= span[1] + _NEAR_TIME]
        if spans and not fitting:
            law = "a trigger switches where the path passes its place"
            first, last = spans[0]
            yield Violation(event, law, f"{time} us, not {first:.0f} to {last:.0f}")
            return
        if fitting:  # of overlapping periods, use the one that ends first
            spans.remove(min(fitting, key=itemgetter(1)))


def _period(
    place: Place, one: EndedMotion, before: EndedMotion | None, after: EndedMotion | None
) -> tuple[float, float]:
    """Return the period in µs in which a place is passed, its delay included."""
    earliest = one.start if before is None else before.end
    latest = one.end if after is None else after.start
    end = one.end if after is None else after.event.time or 0
    if place.kind == "PATH":
        times = np.linspace(earliest, latest, 8 * (one.rows.stop - one.rows.start) + 64)
        rows = between(one.path.times, one.path.axes, times)
        sums = _ProgrammedPath(None, _tool(one, rows)).sums
        wanted = float(np.interp(end, times, sums)) + place.position
        near = np.clip([wanted - _NEAR_MM, wanted + _NEAR_MM], 0.0, sums[-1])
        moments = np.interp(near, np.maximum.accumulate(sums), times)
    else:
        moments = np.full(2, one.start if place.position == 0.0 else end)
        if place.position == 0.0:
            latest = end
        elif after is not None:
            earliest = one.end
    first, last = np.clip(moments + place.delay, earliest, latest).tolist()
    return first, last
