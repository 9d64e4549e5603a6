"""Law about the shape of spline blocks, which docs/motion.md gives as that of our simulator.

No public source gives the shape between the points, so the law holds for our own planned paths
only. It computes the shape from the programmed points, without the planner: a run of SPL is a cubic
spline over the distances of its points, of degree five where it joins a line or an arc; orientation
and external axes are splines over the length; a PTP block is a spline over the times of its axes.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

import numpy as np

from conformance.evaluation.motions import NEAR_DEGREES, Array, EndedMotion
from conformance.evaluation.path_geometry import TOLERANCE_DEGREES, TOLERANCE_MM, circle_of, drawn
from conformance.evaluation.run_laws import Violation
from interp.robot.arm import SplinePart, Target
from interp.robot.kinematics.kinematics import matrix_of
from interp.robot.kinematics.machine_data import ROBOT_AXES
from interp.robot.kinematics.placement import IpoMode
from interp.values.poses import Pose

_LAW: Final = "a spline block has the shape that docs/motion.md describes"
_POINT: Final = ("X", "Y", "Z")
_ANGLES: Final = ("A", "B", "C")
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


@dataclass(frozen=True)
class Segment:
    """A segment (n, 3) in mm, with unit tangents and curvature vectors at its ends, (2, 3) each.

    Those of SPL are not known from its own points: ``is_exact`` is not set then.
    """

    points: Array
    is_exact: bool
    tangents: Array
    bends: Array

    @property
    def length(self) -> float:
        """The length in mm."""
        return float(np.linalg.norm(np.diff(self.points, axis=0), axis=1).sum())


def spline_violations(motions: Sequence[EndedMotion]) -> Iterator[Violation]:
    """Yield spline blocks from rest to rest that have another shape than docs/motion.md says."""
    for one in motions:
        parts = one.motion.parts
        if not (parts and one.begins and one.stops) or len(one.tools) < 2:
            continue
        if any(part.is_relative for part in parts):
            continue
        off = _off_ptp_block(one) if one.motion.kind == "PTP_SPLINE" else _off_block(one)
        if off:
            yield one.broken(_LAW, off)


def _off_block(one: EndedMotion) -> str:
    """Return what of a block is off, or "" if nothing is or its points are not numeric."""
    placement, parts = one.motion.settings.placement, one.motion.parts
    if placement.mode is not IpoMode.BASE or any(part.angle is not None for part in parts):
        return ""
    start = one.poses(one.ends[:1])[0]
    segments = segments_of(start[:3, 3], parts)
    if segments is None:
        return ""
    every = max(len(one.tools) // _SAMPLES, 1)
    tools, axes = one.tools[::every], one.path.axes[one.rows][::every]
    lines = np.concatenate([segment.points for segment in segments])
    places, off = _along(lines, tools[:, :3, 3])
    if off.max() > TOLERANCE_MM:
        return f"{off.max():.3f} mm beside it"
    chains = chains_of(segments)
    rotations = _rotations(start[:3, :3], one)
    if rotations is not None:
        wanted = _swept(chains, segments, rotations, places)
        turned = np.degrees(np.abs(wanted - tools[:, :3, :3]).max())
        if turned > NEAR_DEGREES:
            return f"turned {turned:.3f} degrees beside it"
    externals = _external_targets(one)
    if externals is not None:
        wanted = _carried(chains, segments, externals, places)
        moved = np.abs(wanted - axes[:, ROBOT_AXES:]).max()
        if moved > NEAR_DEGREES:
            return f"an external axis {moved:.3f} beside it"
    return ""


def _off_ptp_block(one: EndedMotion) -> str:
    """Return by how much the axes of a block of SPTP are off, or "" if its targets are no axes."""
    most = one.axis_rates
    names = [axis.name for axis in one.machine.every_axis]
    speeds = [part.settings.axis_velocity for part in one.motion.parts if part.settings is not None]
    if most is None or any(each != one.motion.settings.axis_velocity for each in speeds):
        return ""
    points = [one.ends[0]]
    for part in one.motion.parts:
        if not set(names[:ROBOT_AXES]) & set(part.target) or set(_POINT) & set(part.target):
            return ""
        points.append(
            np.array([part.target.get(n, v) for n, v in zip(names, points[-1], strict=True)])
        )
    targets = np.array(points)
    spans = (np.abs(np.diff(targets, axis=0)) / most[0]).max(axis=1)
    if spans.min() < TOLERANCE_DEGREES or len(spans) < 2:
        return ""
    slopes, bends = _cubic(spans, targets, None, None)
    curves = [
        _quintic(targets[n : n + 2], slopes[n : n + 2], bends[n : n + 2], span)
        for n, span in enumerate(spans)
    ]
    rows = one.path.axes[one.rows][:: max(len(one.tools) // _SAMPLES, 1)]
    _, off = _along(np.concatenate(curves), rows)
    return f"{off.max():.3f} degrees beside it" if off.max() > TOLERANCE_DEGREES else ""


# ----------------------------------------------------------------------------- shape of segments


def segments_of(start: Array, parts: Sequence[SplinePart]) -> list[Segment] | None:
    """Return the segments of a block; ``None`` if one is short or a target is not numeric."""
    points, middles = [start], []
    for part in parts:
        last = points[-1]
        point, middle = _point(part.target, last), _point(part.auxiliary or {}, last)
        if point is None or math.dist(point, last) < _SHORT:
            return None
        points.append(point)
        middles.append(middle)
    shapes: list[Segment | None] = []
    for part, middle, (first, last) in zip(parts, middles, pairwise(points), strict=True):
        try:
            shapes.append(_exact(part.kind, first, middle, last))
        except ValueError:
            return None
    place = 0
    while place < len(shapes):
        end = place
        while end < len(shapes) and shapes[end] is None:
            end += 1
        if end > place:
            before, after = shapes[place - 1] if place else None, (*shapes, None)[end]
            shapes[place:end] = _run(np.array(points[place : end + 1]), before, after)
        place = end + 1
    return [shape for shape in shapes if shape is not None]


def _point(target: Target, before: Array) -> Array | None:
    """Return the point of a target; omitted components keep their value [MOT-16]."""
    if not set(_POINT) & set(target):
        return None
    return np.array([target.get(name, value) for name, value in zip(_POINT, before, strict=True)])


def _exact(kind: str, first: Array, middle: Array | None, last: Array) -> Segment | None:
    """Return a SLIN or SCIRC; ``None`` for SPL. Raises `ValueError` for another kind, or no arc."""
    if kind == "SPL":
        return None
    if kind == "SLIN":
        along = (last - first) / np.linalg.norm(last - first)
        points = drawn("line", np.array([first, last]), _POINTS)
        return Segment(points, True, np.array([along, along]), np.zeros((2, 3)))
    if kind != "SCIRC" or middle is None:
        raise ValueError(kind)
    centre, axis = circle_of(first, middle, last)
    outward = np.array([first, last]) - centre
    radius = float(np.linalg.norm(outward[0]))
    points = drawn("circle", np.array([first, middle, last]), 4 * _POINTS)
    return Segment(points, True, np.cross(axis, outward) / radius, -outward / radius**2)


def _run(points: Array, before: Segment | None, after: Segment | None) -> list[Segment]:
    """Return a run of SPL between two exact segments; ``None`` at an end of the block."""
    spans = np.linalg.norm(np.diff(points, axis=0), axis=1)
    slopes, bends = _cubic(
        spans,
        points,
        None if before is None else before.tangents[1],
        None if after is None else after.tangents[0],
    )
    if before is not None:
        bends[0] = before.bends[1]
    if after is not None:
        bends[-1] = after.bends[0]
    return [
        Segment(
            _quintic(points[n : n + 2], slopes[n : n + 2], bends[n : n + 2], span),
            False,
            slopes[n : n + 2],
            bends[n : n + 2],
        )
        for n, span in enumerate(spans)
    ]


def _cubic(
    spans: Array, points: Array, first: Array | None, last: Array | None
) -> tuple[Array, Array]:
    """Return first and second derivatives at the points of a cubic spline over ``spans``.

    ``first`` and ``last`` are the first derivatives at its ends; without one, the second is zero.
    """
    count = len(points)
    matrix, right = np.zeros((count, count)), np.zeros(points.shape)
    rises = np.diff(points, axis=0) / spans[:, None]
    for place in range(1, count - 1):
        left, next_ = spans[place - 1], spans[place]
        matrix[place, place - 1 : place + 2] = left, 2.0 * (left + next_), next_
        right[place] = 6.0 * (rises[place] - rises[place - 1])
    matrix[0, 0] = matrix[-1, -1] = 1.0
    if first is not None:
        matrix[0, :2] = 2.0 * spans[0], spans[0]
        right[0] = 6.0 * (rises[0] - first)
    if last is not None:
        matrix[-1, -2:] = spans[-1], 2.0 * spans[-1]
        right[-1] = 6.0 * (last - rises[-1])
    bends = np.linalg.solve(matrix, right)
    slopes = rises - spans[:, None] / 6.0 * (2.0 * bends[:-1] + bends[1:])
    end = rises[-1] + spans[-1] / 6.0 * (bends[-2] + 2.0 * bends[-1])
    every: Array = np.concatenate((slopes, end[None]))
    return every, np.asarray(bends)


def _quintic(points: Array, slopes: Array, bends: Array, span: float) -> Array:
    """Return points of the polynomial of degree 5 with these values and derivatives at its ends."""
    powers, orders = np.arange(6), np.arange(3)[:, None]
    factors = np.array([[math.perm(power, order) for power in powers] for order in range(3)])
    ends = [factors * x ** np.maximum(powers - orders, 0) for x in (0.0, span)]
    wanted = [np.stack(rows) for rows in zip(points, slopes, bends, strict=True)]
    coefficients = np.linalg.solve(np.vstack(ends), np.vstack(wanted))
    curve: Array = np.linspace(0.0, span, _POINTS)[:, None] ** powers @ coefficients
    return curve


def _along(lines: Array, rows: Array) -> tuple[Array, Array]:
    """Return for each row the length along a polyline up to its nearest place, and the distance.

    Rows are in the order of the polyline, which may cross itself or lead back.
    """
    steps = np.diff(lines, axis=0)
    lengths = np.linalg.norm(steps, axis=1)
    sums = np.concatenate(([0.0], np.cumsum(lengths)))
    places, off = np.zeros(len(rows)), np.zeros(len(rows))
    at, before = 0.0, rows[0]
    for number, row in enumerate(rows):
        ahead = at + 2.0 * float(np.linalg.norm(row - before)) + _AHEAD
        first, last = np.searchsorted(sums, [at - _BACK, ahead])
        own = slice(max(first - 1, 0), max(min(last, len(steps)), first))
        sizes = np.maximum(lengths[own], 1e-9)
        shares = ((row - lines[:-1][own]) * steps[own]).sum(axis=1) / sizes**2
        least = np.clip((at - _BACK - sums[:-1][own]) / sizes, 0.0, 1.0)
        shares = np.clip(shares, least, 1.0)
        feet = lines[:-1][own] + shares[:, None] * steps[own]
        distances = np.linalg.norm(feet - row, axis=1)
        best = int(np.argmax(distances <= distances.min() + _EQUAL))
        at, before = float(sums[own][best] + shares[best] * lengths[own][best]), row
        places[number], off[number] = at, distances[best]
    return places, off


# --------------------------------------------------------------------- orientation, external axes


def chains_of(segments: Sequence[Segment]) -> list[tuple[int, int]]:
    """Return first and last + 1 of the segments that are passed without a stop."""
    cuts = [
        place
        for place, (one, other) in enumerate(pairwise(segments), 1)
        if one.is_exact
        and other.is_exact
        and np.linalg.norm(one.tangents[1] - other.tangents[0]) > _BEND
    ]
    return [*pairwise((0, *cuts, len(segments)))]


def _rotations(start: Array, one: EndedMotion) -> Array | None:
    """Return the rotations at the points of a block, (n + 1, 3, 3); ``None`` if not numeric."""
    machine = one.machine
    if machine.palletising is not None or len(machine.chain.joints) < ROBOT_AXES:
        return None
    found = [start]
    for part in one.motion.parts:
        given = set(_ANGLES) & set(part.target)
        if (part.settings or one.motion.settings).orientation == "#CONSTANT" or not given:
            found.append(found[-1])
        elif len(given) == len(_ANGLES):
            pose = Pose.of(0.0, 0.0, 0.0, *(part.target[name] for name in _ANGLES))
            found.append(matrix_of(pose)[:3, :3])
        else:
            return None
    return np.array(found)


def _swept(
    chains: Sequence[tuple[int, int]],
    segments: Sequence[Segment],
    rotations: Array,
    places: Array,
) -> Array:
    """Return the rotations (n, 3, 3) at lengths in mm along a block."""
    from scipy.spatial.transform import Rotation, RotationSpline

    found = np.empty((len(places), 3, 3))
    for first, last, knots, own in _by_chain(chains, segments, places):
        turned = rotations[first : last + 1]
        if np.allclose(turned, turned[0], rtol=0.0, atol=1e-9):
            found[own] = turned[0]
        else:
            spline = RotationSpline(knots, Rotation.from_matrix(turned))
            found[own] = spline(np.clip(places[own], knots[0], knots[-1])).as_matrix()
    return found


def _external_targets(one: EndedMotion) -> Array | None:
    """Return the external axes at the points of a block, (n + 1, axes); ``None`` without any."""
    names = [axis.name for axis in one.machine.externals]
    found = [one.ends[0][ROBOT_AXES:]]
    for part in one.motion.parts:
        last = found[-1]
        found.append(np.array([part.target.get(n, v) for n, v in zip(names, last, strict=False)]))
    return np.array(found) if names and len(found[0]) == len(names) else None


def _carried(
    chains: Sequence[tuple[int, int]],
    segments: Sequence[Segment],
    externals: Array,
    places: Array,
) -> Array:
    """Return the external axes (n, axes) at lengths in mm along a block."""
    found = np.empty((len(places), externals.shape[1]))
    for first, last, knots, own in _by_chain(chains, segments, places):
        targets = externals[first : last + 1]
        slopes, bends = _cubic(np.diff(knots), targets, None, None)
        for n, span in enumerate(np.diff(knots)):
            rows = own & (places >= knots[n]) & (places <= knots[n + 1])
            curve = _quintic(targets[n : n + 2], slopes[n : n + 2], bends[n : n + 2], span)
            grid = np.linspace(knots[n], knots[n + 1], len(curve))
            found[rows] = np.stack(
                [np.interp(places[rows], grid, column) for column in curve.T], axis=1
            )
    return found


def _by_chain(
    chains: Sequence[tuple[int, int]], segments: Sequence[Segment], places: Array
) -> Iterator[tuple[int, int, Array, Array]]:
    """Yield the segments of each chain, the lengths at its points, and which places are on it."""
    sums = np.cumsum([0.0, *(segment.length for segment in segments)])
    for first, last in chains:
        yield first, last, sums[first : last + 1], (places >= sums[first]) & (places <= sums[last])
