"""Spline blocks: one path through all points, independent of the speed [SPL-01 to SPL-03, BLD-09].

SLIN and SCIRC are exact lines and arcs. A run of SPL between them is a cubic spline over the
distances of its points; its ends take tangent and curvature from an adjacent line or arc. So
position, tangent and curvature are continuous wherever one side is free to adapt. The arm stops
where two exact segments meet at an angle, and before and after a segment in which the tool only
turns. Orientations are a spline of rotations over the length of the path.

How a real controller shapes SPL is not published: the shape is an assumption. That the path passes
through the points is not.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import TYPE_CHECKING

import numpy as np

from interp.robot.kinematics.kinematics import Array
from interp.robot.path.arc_length import ArcLength
from interp.robot.path.circle import Circle
from interp.robot.path.orientation import Orientation, turning
from interp.robot.path.pose_path import GRID, Line, OrientedPath, PathShape

if TYPE_CHECKING:
    from scipy.spatial.transform import RotationSpline

_BEND = 1e-6  # norm of the difference of two unit tangents below which they are equal
_SHORT = 1e-3  # mm of path below which the tool hardly does more than turn
_SAMPLES = 129
_ENDS = 0.0, 1.0  # of the parameter of a segment


@dataclass(frozen=True, slots=True, eq=False)
class Knot:
    """A point of a block: position in mm, rotation ``(3, 3)``."""

    position: Array
    rotation: Array


@dataclass(frozen=True, slots=True, eq=False)
class Segment:
    """A segment as programmed, from one knot to the next; ``circle`` is set for SCIRC."""

    kind: str
    start: Knot
    end: Knot
    circle: Circle | None = None

    @property
    def is_exact(self) -> bool:
        """Whether its shape is determined by its own points."""
        return self.kind != "SPL"

    @property
    def chord(self) -> float:
        """The distance between its ends in mm, or the length of the arc."""
        return self.shape.length

    @property
    def shape(self) -> Circle | Line:
        """The line or arc of an exact segment."""
        return self.circle or Line(self.start.position, self.end.position)

    def tangent(self, u: float) -> Array:
        """Return the unit tangent of an exact segment."""
        (tangent,) = self.shape.tangents(np.array([u]))
        direction: Array = tangent / np.linalg.norm(tangent)
        return direction

    def curvature(self, u: float) -> Array:
        """Return the curvature vector of an exact segment in 1/mm."""
        if self.circle is None:
            return np.zeros(3)
        (place,) = self.circle.at(np.array([u]))
        inward: Array = (self.circle.centre - place) / self.circle.radius**2
        return inward


@dataclass(frozen=True, slots=True, eq=False)
class _Swept:
    """The orientation on a section of a spline of rotations over the length of a path."""

    spline: RotationSpline
    start: float
    length: float
    swivel: float
    rotation: float = 0.0

    def at(self, u: Array) -> Array:
        rotations: Array = self.spline(self.start + u * self.length).as_matrix()
        return rotations


class FreeCurve:
    """The path of an SPL segment: a quintic polynomial, reparametrised by its length.

    ``ends`` has position, first and second derivative at both ends, ``(2, 3, 3)``, by a parameter
    whose range is ``span``.
    """

    def __init__(self, ends: Array, span: float) -> None:
        from scipy.interpolate import BPoly, CubicSpline

        self._curve = BPoly.from_derivatives(_ENDS, ends * span ** np.arange(3.0)[:, None])
        self._slopes = self._curve.derivative()
        self.way = ArcLength(self._slopes)
        self.length = self.way.length
        grid = np.linspace(0.0, 1.0, _SAMPLES)
        self._parameter = CubicSpline(self.way.at(grid) / self.length, grid)

    def at(self, u: Array) -> Array:
        """See `interp.robot.path.pose_path.PathShape.at`."""
        points: Array = self._curve(self._parameter(u))
        return points

    def tangents(self, u: Array) -> Array:
        """See `interp.robot.path.pose_path.PathShape.tangents`."""
        slopes = self._slopes(self._parameter(u))
        tangents: Array = slopes / np.linalg.norm(slopes, axis=1)[:, None] * self.length
        return tangents


def chains_of(segments: Sequence[Segment]) -> list[list[Segment]]:
    """Return the segments grouped into chains that are passed without a stop."""
    chains: list[list[Segment]] = []
    for segment in segments:
        before = chains[-1][-1] if chains else None
        if before is None or _is_corner(before, segment):
            chains.append([segment])
        else:
            chains[-1].append(segment)
    return chains


def pose_paths_of(chain: Sequence[Segment]) -> list[OrientedPath]:
    """Return the paths of the segments of one chain, which join smoothly."""
    start = chain[0].start
    if chain[0].chord < _SHORT:
        turned = turning(start.rotation, chain[0].end.rotation)
        return [OrientedPath(Line(start.position, start.position), turned)]
    shapes: list[PathShape] = []
    for is_exact, group in groupby(chain, key=lambda segment: segment.is_exact):
        run, place = [*group], len(shapes)
        if is_exact:
            shapes += (segment.shape for segment in run)
            continue
        behind = place + len(run)
        before = chain[place - 1] if place else None
        ends, spans = _run(run, before, chain[behind] if behind < len(chain) else None)
        shapes += (FreeCurve(ends[n : n + 2], span) for n, span in enumerate(spans))
    turns = _orientations(chain, [shape.length for shape in shapes])
    return [OrientedPath(*path) for path in zip(shapes, turns, strict=True)]


def _is_corner(before: Segment, segment: Segment) -> bool:
    if before.chord < _SHORT or segment.chord < _SHORT:
        return True
    if not (before.is_exact and segment.is_exact):
        return False
    return float(np.linalg.norm(before.tangent(1.0) - segment.tangent(0.0))) > _BEND


def _run(
    run: Sequence[Segment], before: Segment | None, following: Segment | None
) -> tuple[Array, Array]:
    """Return position, first and second derivative at the points of a run of SPL, and its spans."""
    points = np.array([run[0].start.position, *(segment.end.position for segment in run)])
    spans = np.array([segment.chord for segment in run])
    free = (2, np.zeros(3))
    from scipy.interpolate import CubicSpline

    spline = CubicSpline(
        np.concatenate(([0.0], np.cumsum(spans))),
        points,
        bc_type=(
            (1, before.tangent(1.0)) if before else free,
            (1, following.tangent(0.0)) if following else free,
        ),
    )
    knots = spline.x
    ends = np.stack((points, spline(knots, 1), spline(knots, 2)), axis=1)
    if before:
        ends[0, 2] = before.curvature(1.0)
    if following:
        ends[-1, 2] = following.curvature(0.0)
    return ends, spans


def _orientations(chain: Sequence[Segment], lengths: Sequence[float]) -> Sequence[Orientation]:
    rotations = np.array([chain[0].start.rotation, *(segment.end.rotation for segment in chain)])
    knots = np.concatenate(([0.0], np.cumsum(lengths)))
    from scipy.spatial.transform import Rotation, RotationSpline

    spline = RotationSpline(knots, Rotation.from_matrix(rotations))
    swept = []
    for start, length in zip(knots.tolist(), lengths, strict=False):
        rates = np.linalg.norm(spline(start + GRID * length, 1), axis=1)
        swept.append(_Swept(spline, start, length, float(rates.max()) * length))
    return swept
