"""Straight runs: consecutive collinear motions, planned as one.

The speed limits of a straight path are computed for its whole length, so points on it cost no time.
Each motion and each blend gets its part of these limits.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from interp.robot.kinematics.kinematics import Array
from interp.robot.kinematics.machine_data import ROBOT_AXES
from interp.robot.path.axis_path import Curve, JointCurve, LinearAxes, PosePathCurve
from interp.robot.path.orientation import turning
from interp.robot.path.pose_path import Line, OrientedPath
from interp.robot.planning.limits import CurveLimits, curve_limits_of
from interp.robot.planning.timeline import Key, Section
from interp.robot.planning.tracks import Track, Tracks

#: Distance of a point from a straight run, as a share of its length, that no axis can notice.
_BESIDE = 2e-5
_TINY = 1e-9


@dataclass(frozen=True, slots=True, eq=False)
class StraightPart:
    """A curve with its end pose, computed once because a run is examined again for each new motion.

    ``way`` is its length in mm or degrees; 0 if it is not straight. ``point`` and ``turn`` are the
    pose of the tool at its end; ``None`` for a line in axis space.
    """

    curve: Curve
    way: float
    point: Array | None = None
    turn: Array | None = None

    @classmethod
    def of(cls, curve: Curve) -> StraightPart:
        """Return the part for a curve."""
        if curve.is_straight:
            (way,), _, _ = curve.rates(np.zeros(1))
            return cls(curve, float(np.linalg.norm(way)))
        line = curve.pose_path
        if not (isinstance(line, OrientedPath) and isinstance(line.shape, Line)):
            return cls(curve, 0.0)
        (point,), (turn,) = line.at(np.ones(1))
        return cls(curve, line.length or sum(line.angles), point, turn)


@dataclass(frozen=True, slots=True, eq=False)
class StraightRun:
    """Consecutive motions along one straight line.

    ``places`` are the start and the end of each section, and of the blends between them, in mm or
    degrees from the start of the whole ``length``.
    """

    parts: tuple[StraightPart, ...]
    places: dict[Key, tuple[float, float]]
    length: float
    limits: CurveLimits

    def bounded(self, section: Section) -> Section:
        """Return a section with the limits of the run; unchanged if it is not part of the run."""
        if section.key not in self.places:
            return section
        return replace(section, limits=self.curve_limits_of(section.key))

    def curve_limits_of(self, key: Key) -> CurveLimits:
        """Return the limits of a section."""
        start, end = (where / self.length for where in self.places[key])
        return self.limits.part(start, end)


def extended(
    tracks: Tracks,
    run: StraightRun | None,
    first: Track,
    second: Track,
    shares: tuple[float, float],
) -> StraightRun | None:
    """Return a run with one more motion; if that does not continue it, the run of the last two.

    ``shares`` are the shares of both motions that the blend replaces. Return ``None`` if they are
    not collinear or have different programmed speeds. Raises `Fault` as `PosePathCurve`.
    """
    one, other = first.pieces[-1], second.pieces[0]
    if first.motion.parts or second.motion.parts:  # a block has bounds of its own
        return None
    ours, theirs = (
        [(path.velocity, path.acceleration, path.jerk) for path in piece.paths]
        for piece in (one, other)
    )
    if ours != theirs or not first.axis_limits.equals(second.axis_limits):
        return None
    parts: tuple[StraightPart, ...] = StraightPart.of(one.curve), StraightPart.of(other.curve)
    before, behind = (part.way for part in parts)
    places: dict[Key, tuple[float, float]] = {}
    whole = None
    if run is not None and run.parts[-1].curve is one.curve:
        whole = straight_through((*run.parts, parts[1]))
    if run is not None and whole is not None:
        parts, places = (*run.parts, parts[1]), dict(run.places)
    else:
        whole = straight_through(parts)
    if whole is None:
        return None
    length = math.fsum(part.way for part in parts)
    corner = length - behind
    number, following = first.motion.number, second.motion.number
    places[number, False, 0] = corner - before, corner
    places[number, True, 0] = corner - shares[0] * before, corner + shares[1] * behind
    places[following, False, 0] = corner, length
    if whole.is_straight:
        paths = tracks.reduced_paths(whole, first.motion.settings, second.motion.settings)
    else:
        paths = tuple(replace(x, length=x.length * length / behind) for x in other.paths)
    return StraightRun(
        parts, places, length, curve_limits_of(whole, tracks.limits, second.axis_limits, paths)
    )


def straight_through(
    parts: Sequence[StraightPart], start: float = 0.0, end: float = 1.0
) -> JointCurve | PosePathCurve | None:
    """Return the straight line from a parameter of the first curve to one of the last.

    Return ``None`` if they are not straight, or if a point between two of them does not lie on it.
    Raises `Fault` as `PosePathCurve`.
    """
    one, other = parts[0].curve, parts[-1].curve
    ways = np.array([part.way for part in parts])
    ways[0] *= 1.0 - start
    ways[-1] *= end
    if not ways.all() or not isinstance(one, JointCurve | PosePathCurve):
        return None
    if type(one) is not type(other) or one.placement != other.placement:
        return None
    (leaves,), (joins,) = one.axes(np.array([start])), other.axes(np.array([end]))
    shares = np.cumsum(ways)[:-1] / ways.sum()
    corners = np.array([part.curve.end for part in parts[:-1]])
    if isinstance(one, JointCurve):
        line = JointCurve(one.arm, one.placement, LinearAxes(leaves, joins))
        return line if _is_near(line.axes(shares), corners, joins - leaves) else None
    lines = [line for line in (one.pose_path, other.pose_path) if line is not None]
    (point,), (turned,) = lines[0].at(np.array([start]))
    (there,), (turn,) = lines[1].at(np.array([end]))
    whole = OrientedPath(Line(point, there), turning(turned, turn))
    others = LinearAxes(leaves[ROBOT_AXES:], joins[ROBOT_AXES:])
    places, rotations = whole.at(shares)
    is_through = (
        _is_near(places, np.array([part.point for part in parts[:-1]]), whole.length)
        and _is_near(rotations, np.array([part.turn for part in parts[:-1]]), sum(whole.angles))
        and _is_near(others.axes(shares), corners[:, ROBOT_AXES:], others.end - others.start)
    )
    if not is_through:
        return None
    return PosePathCurve(one.arm, one.placement, whole, leaves[:ROBOT_AXES], others)


def _is_near(ours: Array, theirs: Array, way: Array | float) -> bool:
    off = float(np.abs(ours - theirs).max(initial=0.0))
    return off <= _BESIDE * float(np.abs(way).max(initial=0.0)) + _TINY
