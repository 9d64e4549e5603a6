"""Law about the shape of spline blocks, which docs/motion.md gives as that of our simulator.

No public source gives the shape between the points, so the law holds for our own planned paths
only. It computes the shape from the programmed points, without the planner: a run of SPL is a cubic
spline over the distances of its points, of degree five where it joins a line or an arc; orientation
and external axes are splines over the length; a PTP block is a spline over the times of its axes.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import groupby, pairwise
from typing import Final

import numpy as np

from conformance.evaluation.laws import Deviations, Laws, Run, Subjects
from conformance.evaluation.motions import (
    ANGLES,
    NEAR_DEGREES,
    POINT,
    Array,
    EndedMotion,
    completed,
)
from conformance.evaluation.path_geometry import (
    TOLERANCE_DEGREES,
    TOLERANCE_MM,
    circle_of,
    drawn,
    feet,
    lengths,
)
from interp.robot.arm import SplinePart, Target
from interp.robot.kinematics.kinematics import matrix_of
from interp.robot.kinematics.machine_data import ROBOT_AXES
from interp.values.poses import Pose

LAWS: Final = Laws()
#: The number of points of a drawn segment, and the largest number of samples that are compared.
_POINTS: Final = 257
_SAMPLES: Final = 150
#: mm of a segment below which the tool may only turn, and the difference of tangents at a corner.
_SHORT: Final = 1.0
_BEND: Final = 1e-6
#: mm by which a place may lie ahead of the expected one, or behind the last one; and by which
#: distances differ that count as equal: where a path leads back over itself, the first is taken.
_AHEAD: Final = 2.0
_BACK: Final = 0.02
_EQUAL: Final = 1e-6

#: Values (n, …) at n places of a path.
_Curve = Callable[[Array], Array]


@dataclass(frozen=True)
class Segment:
    """A segment (n, 3) in mm; of all but SPL with unit tangents and curvature vectors at its ends.

    These are (2, 3) each. Those of SPL are not known from its own points.
    """

    points: Array
    tangents: Array | None = None
    bends: Array | None = None

    @property
    def length(self) -> float:
        """The length in mm."""
        return float(lengths(self.points)[-1])


def blocks_from_rest(run: Run) -> Subjects[EndedMotion]:
    """Yield the spline blocks from rest to rest that nothing has held."""
    for one in run.free:
        if one.motion.parts and one.begins and one.stops and len(one.tools) >= 2:
            yield one.event, one


@LAWS.law("a spline block has the shape that docs/motion.md describes", of=blocks_from_rest)
def _misshapen(one: EndedMotion) -> Deviations:
    """Yield what of a block is off, unless its targets are not numeric, or are no axes of SPTP."""
    if not any(part.is_relative for part in one.motion.parts):
        off_block = _off_ptp_block if one.motion.kind == "PTP_SPLINE" else _off_block
        if off := off_block(one):
            yield off


def _off_block(one: EndedMotion) -> str:
    """Return what of a block is off, or "" if nothing is or its points are not numeric."""
    parts = one.motion.parts
    if not one.is_in_base or any(part.angle is not None for part in parts):
        return ""
    start = one.poses(one.ends[:1])[0]
    segments = segments_of(start[:3, 3], parts)
    if segments is None:
        return ""
    every = max(len(one.tools) // _SAMPLES, 1)
    tools, axes = one.tools[::every], one.axes[::every]
    lines = np.concatenate([segment.points for segment in segments])
    places, off = _along(lines, tools[:, :3, 3])
    if off.max() > TOLERANCE_MM:
        return f"{off.max():.3f} mm beside it"
    rotations = _rotations(start[:3, :3], one)
    if rotations is not None:
        wanted = _over_length(segments, places, rotations, _turning)
        turned = np.degrees(np.abs(wanted - tools[:, :3, :3]).max())
        if turned > NEAR_DEGREES:
            return f"turned {turned:.3f} degrees beside it"
    externals = _external_targets(one)
    if externals is not None:
        wanted = _over_length(segments, places, externals, _smooth)
        moved = np.abs(wanted - axes[:, ROBOT_AXES:]).max()
        if moved > NEAR_DEGREES:
            return f"an external axis {moved:.3f} beside it"
    return ""


def _off_ptp_block(one: EndedMotion) -> str:
    """Return by how much the axes of a block of SPTP are off, or "" if its targets are no axes."""
    names = [axis.name for axis in one.machine.every_axis]
    points, speeds = [one.ends[0]], []
    for part in one.motion.parts:
        own = replace(one.motion, settings=part.settings or one.motion.settings)
        most = replace(one, motion=own).axis_rates
        if most is None:
            return ""
        speeds.append(most[0])
        if not set(names[:ROBOT_AXES]) & set(part.target) or set(POINT) & set(part.target):
            return ""
        points.append(completed(part.target, names, points[-1]))
    targets = np.array(points)
    spans = (np.abs(np.diff(targets, axis=0)) / speeds).max(axis=1)
    if spans.min() < TOLERANCE_DEGREES or len(spans) < 2:
        return ""
    knots = np.cumsum([0.0, *spans])
    curve = np.concatenate(_sampled(_smooth(knots, targets), knots))
    _, off = _along(curve, one.axes[:: max(len(one.tools) // _SAMPLES, 1)])
    return f"{off.max():.3f} degrees beside it" if off.max() > TOLERANCE_DEGREES else ""


# ----------------------------------------------------------------------------- shape of segments


def segments_of(start: Array, parts: Sequence[SplinePart]) -> list[Segment] | None:
    """Return the segments of a block; ``None`` if one is short or a target is not numeric."""
    points, shapes = [start], list[Segment | None]()
    for part in parts:
        last = points[-1]
        point, middle = _point(part.target, last), _point(part.auxiliary or {}, last)
        if point is None or math.dist(point, last) < _SHORT:
            return None
        try:
            shapes.append(_exact(part.kind, last, middle, point))
        except ValueError:
            return None
        points.append(point)
    found: list[Segment] = []
    for is_run, group in groupby(
        zip(pairwise(points), shapes, strict=True), lambda row: not row[1]
    ):
        rows = [*group]
        if is_run:
            place = len(found) + len(rows)
            row = np.array(points[len(found) : place + 1])
            found += _run(row, found[-1:], shapes[place : place + 1])
        else:
            found += (shape for _, shape in rows if shape is not None)
    return found


def _point(target: Target, before: Array) -> Array | None:
    """Return the point of a target; omitted components keep their value [MOT-16]."""
    return completed(target, POINT, before) if set(POINT) & set(target) else None


def _exact(kind: str, first: Array, middle: Array | None, last: Array) -> Segment | None:
    """Return a SLIN or SCIRC; ``None`` for SPL. Raises `ValueError` for another kind, or no arc."""
    if kind == "SPL":
        return None
    if kind == "SLIN":
        along = (last - first) / np.linalg.norm(last - first)
        points = drawn("line", np.array([first, last]), _POINTS)
        return Segment(points, np.array([along, along]), np.zeros((2, 3)))
    if kind != "SCIRC" or middle is None:
        raise ValueError(kind)
    centre, axis = circle_of(first, middle, last)
    outward = np.array([first, last]) - centre
    radius = float(np.linalg.norm(outward[0]))
    points = drawn("circle", np.array([first, middle, last]), 4 * _POINTS)
    return Segment(points, np.cross(axis, outward) / radius, -outward / radius**2)


def _run(
    points: Array, before: Sequence[Segment], after: Sequence[Segment | None]
) -> list[Segment]:
    """Return a run of SPL between two exact segments; there is none at an end of the block."""
    ends = [
        None
        if one is None or one.tangents is None or one.bends is None
        # of the end of the segment before, and the start of that behind
        else (one.tangents[side], one.bends[side])
        for side, one in ((1, next(iter(before), None)), (0, next(iter(after), None)))
    ]
    knots = lengths(points)
    return [Segment(each) for each in _sampled(_smooth(knots, points, *ends), knots)]


def _smooth(
    knots: Array,
    values: Array,
    before: tuple[Array, Array] | None = None,
    after: tuple[Array, Array] | None = None,
) -> _Curve:
    """Return a cubic spline, of degree 5 where its ends have given first and second derivatives.

    Without those its second derivative at an end is zero.
    """
    from scipy.interpolate import BPoly, CubicSpline

    none = 2, np.zeros(values.shape[1:])
    cubic = CubicSpline(
        knots, values, bc_type=[(1, one[0]) if one else none for one in (before, after)]
    )
    bends = cubic(knots, 2)
    if before is not None:
        bends[0] = before[1]
    if after is not None:
        bends[-1] = after[1]
    curve: _Curve = BPoly.from_derivatives(
        knots, np.stack((values, cubic(knots, 1), bends), axis=1)
    )
    return curve


def _sampled(curve: _Curve, knots: Array) -> list[Array]:
    """Return points of a curve between each two of its knots."""
    return [curve(np.linspace(*ends, _POINTS)) for ends in pairwise(knots)]


def _along(lines: Array, rows: Array) -> tuple[Array, Array]:
    """Return for each row the length along a polyline up to its nearest place, and the distance.

    Rows are in the order of the polyline, which may cross itself or lead back.
    """
    sums = lengths(lines)
    sizes = np.diff(sums)
    places, off = np.zeros(len(rows)), np.zeros(len(rows))
    at, before = 0.0, rows[0]
    for number, row in enumerate(rows):
        ahead = at + 2.0 * float(np.linalg.norm(row - before)) + _AHEAD
        first, last = np.searchsorted(sums, [at - _BACK, ahead])
        own = slice(max(first - 1, 0), max(min(last, len(sizes)), first))
        least = np.clip((at - _BACK - sums[:-1][own]) / np.maximum(sizes[own], 1e-9), 0.0, 1.0)
        shares, distances = feet(lines[:-1][own], lines[1:][own], row, least)
        best = int(np.argmax(distances <= distances.min() + _EQUAL))
        at, before = float(sums[own][best] + shares[best] * sizes[own][best]), row
        places[number], off[number] = at, distances[best]
    return places, off


# --------------------------------------------------------------------- orientation, external axes


def chains_of(segments: Sequence[Segment]) -> list[tuple[int, int]]:
    """Return first and last + 1 of the segments that are passed without a stop."""
    cuts = [
        place
        for place, (one, other) in enumerate(pairwise(segments), 1)
        if one.tangents is not None
        and other.tangents is not None
        and np.linalg.norm(one.tangents[1] - other.tangents[0]) > _BEND
    ]
    return [*pairwise((0, *cuts, len(segments)))]


def _rotations(start: Array, one: EndedMotion) -> Array | None:
    """Return the rotations at the points of a block, (n + 1, 3, 3); ``None`` if not numeric."""
    if not one.has_six:
        return None
    found = [start]
    for part in one.motion.parts:
        given = set(ANGLES) & set(part.target)
        if (part.settings or one.motion.settings).orientation == "#CONSTANT" or not given:
            found.append(found[-1])
        elif len(given) == len(ANGLES):
            pose = Pose.of(0.0, 0.0, 0.0, *(part.target[name] for name in ANGLES))
            found.append(matrix_of(pose)[:3, :3])
        else:
            return None
    return np.array(found)


def _turning(knots: Array, rotations: Array) -> _Curve:
    """Return the spline of rotations (n, 3, 3)."""
    from scipy.spatial.transform import Rotation, RotationSpline

    if np.allclose(rotations, rotations[0], rtol=0.0, atol=1e-9):
        return lambda places: np.broadcast_to(rotations[0], (len(places), 3, 3))
    spline = RotationSpline(knots, Rotation.from_matrix(rotations))
    return lambda places: np.asarray(spline(places).as_matrix())


def _external_targets(one: EndedMotion) -> Array | None:
    """Return the external axes at the points of a block, (n + 1, axes); ``None`` without any."""
    names = [axis.name for axis in one.machine.externals]
    found = [one.ends[0][ROBOT_AXES:]]
    if not names or len(found[0]) != len(names):
        return None
    for part in one.motion.parts:
        found.append(completed(part.target, names, found[-1]))
    return np.array(found)


def _over_length(
    segments: Sequence[Segment],
    places: Array,
    values: Array,
    curve_of: Callable[[Array, Array], _Curve],
) -> Array:
    """Return values (n, …) at n lengths in mm along a block from those at the ends of segments.

    They lie on a curve that begins anew at each stop.
    """
    ends = np.cumsum([0.0, *(segment.length for segment in segments)])
    places = np.clip(places, 0.0, ends[-1])
    found = np.empty((len(places), *values.shape[1:]))
    for first, last in chains_of(segments):
        knots = ends[first : last + 1]
        own = (places >= knots[0]) & (places <= knots[-1])
        found[own] = curve_of(knots, values[first : last + 1])(places[own])
    return found
