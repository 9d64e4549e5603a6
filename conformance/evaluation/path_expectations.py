"""Expectations about the path of a motion: shape, speed, tracking.

The path of a line is that of its last motion, from start to end. For lines and circles, only the
section between the blends is compared. The expected path is given analytically in the case; the
observed path are the set-points in each interpolation cycle.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import pairwise, starmap
from typing import Final

import numpy as np
import numpy.typing as npt

from conformance.evaluation.motions import stages
from conformance.evaluation.observation import Observation
from conformance.evaluation.path_geometry import (
    TOLERANCE_DEGREES,
    TOLERANCE_MM,
    around,
    between,
    change_rates,
    crosses_box,
    from_arc,
    from_circle,
    from_line,
    from_synchronous,
    nearest,
    refined,
)
from conformance.evaluation.trace_expectations import Evaluated, Marks, time_of
from conformance.suite.expectations import Expectation
from interp.robot.kinematics.kinematics import matrix_of
from interp.robot.kinematics.machine_data import ROBOT_AXES
from interp.robot.kinematics.placement import Placement
from interp.robot.simulation.tracking import PathRecord
from interp.values.poses import Pose

Array = npt.NDArray[np.float64]

#: The usual tolerance of a speed, as a fraction of it.
_SPEED: Final = 0.01
#: How far a simulated arm may be off its path in mm, unless a case says otherwise [design
#: section 4].
_TRACKING: Final = 0.5
#: The largest factor by which differences of a path, recorded perhaps, may exceed a limit.
_RATE_MARGIN: Final = 1.02
_NO_PART: Final = False, "there is no part of the path between the blends"
_NO_BLEND: Final = False, "there is no blend"


@dataclass(frozen=True, slots=True)
class _MotionPath:
    """The motion of a line, with times in µs, in a run.

    ``entered`` is the end of the blend before it, or its start. ``leave`` and ``join`` are the
    start and the end of the blend after it. With ``is_whole`` it is the path of the whole run.
    """

    seen: Observation
    marks: Marks
    path: PathRecord
    start: int
    end: int
    entered: int
    leave: int | None = None
    join: int | None = None
    is_whole: bool = False

    @property
    def points(self) -> Array:
        """X, Y and Z of the tool in mm at all samples."""
        return np.asarray(self.path.points[:, :3], dtype=np.float64)

    def at(self, time: float) -> Array:
        """Return X, Y and Z of the tool at a time in µs."""
        return between(self.path.times, self.points, time)

    def poses(self, rows: npt.NDArray[np.int64], time: float) -> Array:
        """Return X to C of the tool at samples, all with the frames in force at a time in µs.

        At the end of the motion these are its own. Angles are unwrapped, for interpolation.
        """
        moment = self.start if not self.is_whole and self.start <= time <= self.end else time
        poses, wanted = self.path.points[rows], self._placement(moment)
        for row, pose in zip(rows, poses, strict=True):
            own = self._placement(self.path.times[row])
            if own != wanted:
                externals = self.path.axes[row, ROBOT_AXES:].tolist()
                flange = own.at(externals).flange(Pose.of(*pose))
                pose[:] = wanted.at(externals).point(flange).components
        return np.hstack((poses[:, :3], np.unwrap(poses[:, 3:], period=360.0, axis=0)))

    def _placement(self, time: float) -> Placement:
        """Return the frames in force at a time in µs; a recording may not know any."""
        placed = (one for start, one in reversed(self.path.placements) if start <= time)
        return next(placed, Placement())

    @property
    def last(self) -> int:
        """The end of the blend after it, or its end."""
        return self.end if self.join is None else self.join

    @property
    def own(self) -> npt.NDArray[np.bool_]:
        """Which samples lie between its blends."""
        return self.within(self.entered, self.end if self.leave is None else self.leave)

    @property
    def whole(self) -> npt.NDArray[np.bool_]:
        """Which samples are its own or in the blend after it."""
        return self.within(self.start, self.last)

    def within(self, start: int, end: int) -> npt.NDArray[np.bool_]:
        """Return which samples lie between two times."""
        kept: npt.NDArray[np.bool_] = (self.path.times >= start) & (self.path.times <= end)
        return kept

    def stretches(self) -> Iterator[slice]:
        """Yield rows with the same frames and tool; points of different rows are not comparable."""
        bounds = np.flatnonzero(self.whole)[[0, -1]] + [0, 1] if self.whole.any() else [0, 0]
        if self.is_whole:
            changes = np.searchsorted(self.path.times, [time for time, _ in self.path.placements])
            bounds = np.union1d(bounds, changes)
        yield from starmap(slice, pairwise(bounds))


_Evaluate = Callable[[Expectation, _MotionPath], Evaluated]
#: How expectations about a path are evaluated, by kind.
_EVALUATORS: Final[dict[str, _Evaluate]] = {}


def _evaluates(*kinds: str) -> Callable[[_Evaluate], None]:
    """Return a decorator of a function that evaluates expectations of some kinds."""
    return lambda evaluate: _EVALUATORS.update(dict.fromkeys(kinds, evaluate))


def evaluate_on_path(one: Expectation, seen: Observation, marks: Marks) -> Evaluated:
    """Return whether an expectation about the path is met, with what was observed."""
    if seen.path is None:
        return None, "no path was recorded"
    part = _motion_path(one, seen, seen.path, marks)
    if part is None:
        return False, "the motion did not begin and end"
    return _EVALUATORS[one.kind](one, part)


def _motion_path(
    one: Expectation, seen: Observation, path: PathRecord, marks: Marks
) -> _MotionPath | None:
    if not one.file:
        first, last = int(path.times[0]), int(path.times[-1])
        return _MotionPath(seen, marks, path, first, last, first, is_whole=True)
    starts = seen.on_line(one.file, one.line, "motion_start")
    number = starts[-1].fields.get("motion") if starts else None
    if number is None:
        return None
    every = stages(seen)
    times = {kind: event.time for kind, event in every[number].items()}
    start, end, leave = (times.get(kind) for kind in ("motion_start", "motion_end", "blend_start"))
    if start is None or end is None:
        return None
    entered, joined = times.get("blend_end"), every.get(number + 1, {}).get("blend_end")
    join = None if leave is None or joined is None else joined.time
    entered = start if entered is None else entered
    return _MotionPath(seen, marks, path, start, end, entered, leave, join)


# ------------------------------------------------------------------------------------- places


def _numbers(one: Expectation) -> Array:
    return np.array([float(word) for word in one.arguments if word[-1].isdigit()])


def _within_tolerance(
    one: Expectation, off: float, unit: str = "mm", usual: float = TOLERANCE_MM
) -> Evaluated:
    return off <= one.margin(usual), f"{off:.4f} {unit} off"


@_evaluates("path")
def _path(one: Expectation, part: _MotionPath) -> Evaluated:
    numbers = _numbers(one).reshape(-1, 3)
    if one.arguments[0] == "joint":
        return _joint(one, part)
    if one.arguments[0] == "blend":
        if part.leave is None or part.join is None:
            return _NO_BLEND
        points = part.points[part.within(part.leave, part.join)]
        off = from_arc(points, *numbers)
    else:
        points = part.points[part.own]
        off = (from_circle if one.arguments[0] == "circle" else from_line)(points, *numbers)
    return _within_tolerance(one, float(off.max())) if len(points) else _NO_PART


def _joint(one: Expectation, part: _MotionPath) -> Evaluated:
    """Check that all axes always have covered the same fraction of their way [MOT-01]."""
    axes = part.path.axes[part.own][:, :6]
    if not len(axes):
        return _NO_PART
    off = from_synchronous(axes)
    if off is None:
        return False, "no axis moves"
    return _within_tolerance(one, off, "degrees", TOLERANCE_DEGREES)


def _distance(part: _MotionPath, point: Array) -> float:
    """Return the smallest distance of the tool from a point, including the blend that follows."""
    if part.is_whole:
        stretches = [_refined(part, rows) for rows in part.stretches()]
        return min(float(nearest(points[:-1], points[1:], point).min()) for points in stretches)
    points = refined(part.path.times, part.points, part.start, part.last, 2_000)
    return float(np.linalg.norm(points - point, axis=1).min())


def _refined(part: _MotionPath, rows: slice) -> Array:
    """Return the points of some rows with interpolated points between them, at least two."""
    times, points = part.path.times[rows], part.points[rows]
    return refined(times, points, float(times[0]), float(times[-1]), 4 * len(times) + 2)


@_evaluates("avoids")
def _avoids(one: Expectation, part: _MotionPath) -> Evaluated:
    """Check that the tip of the tool stays out of a zone in $WORLD, also between samples."""
    numbers = _numbers(one)
    zone, frame = (numbers[:-6], numbers[-6:]) if "in" in one.arguments else (numbers, np.zeros(6))
    inverse = matrix_of(Pose.of(*frame.tolist()).inverse())
    for rows in part.stretches():
        tips = part.path.tips[rows] @ inverse[:3, :3].T + inverse[:3, 3]
        starts, ends = (tips, tips) if len(tips) == 1 else (tips[:-1], tips[1:])
        if one.arguments[0] == "sphere":
            inside = nearest(starts, ends, zone[:3]) < zone[3]
        else:
            corners = zone.reshape(2, 3)
            inside = crosses_box(starts, ends, corners.min(axis=0), corners.max(axis=0))
        if inside.any():
            first = rows.start + int(np.argmax(inside))
            at = " ".join(f"{number:.1f}" for number in part.path.tips[first])
            return False, f"inside at {part.path.times[first] / 1e6:.6f} s, from {at} on"
    return True, ""


@_evaluates("passes")
def _passes(one: Expectation, part: _MotionPath) -> Evaluated:
    return _within_tolerance(one, _distance(part, _numbers(one)))


@_evaluates("misses")
def _misses(one: Expectation, part: _MotionPath) -> Evaluated:
    *point, wanted = _numbers(one)
    off = _distance(part, np.array(point))
    return abs(off - wanted) <= one.margin(wanted * 0.05), f"{off:.4f} mm away"


@_evaluates("leaves", "joins")
def _leaves(one: Expectation, part: _MotionPath) -> Evaluated:
    moment = part.leave if one.kind == "leaves" else part.join
    if moment is None:
        return _NO_BLEND
    *point, wanted = _numbers(one)
    off = float(np.linalg.norm(part.at(moment) - np.array(point)))
    return abs(off - wanted) <= one.margin(TOLERANCE_MM), f"{off:.4f} mm before or behind it"


@_evaluates("pose", "axes")
def _position(one: Expectation, part: _MotionPath) -> Evaluated:
    moment = part.end
    if one.when is not None:
        try:
            moment = time_of(one.when.first, part.seen, part.marks)
        except LookupError as error:
            return False, str(error.args[0])
    wanted = _numbers(one)
    moments = around(moment, part.seen.unsure if one.when is not None else 0)
    first, last = np.searchsorted(part.path.times, moments[[0, -1]])
    near = np.arange(max(first - 4, 0), min(last + 4, len(part.path.times)))
    rows = part.path.axes[near] if one.kind == "axes" else part.poses(near, moment)
    found = between(part.path.times[near], rows, moments)[:, : len(wanted)]
    off = np.abs(found - wanted)
    if one.kind == "pose":  # an angle and one a turn further are the same
        off[:, 3:] = np.abs((found[:, 3:] - wanted[3:] + 180.0) % 360.0 - 180.0)
    best = int(off.max(axis=1).argmin())
    actual = " ".join(f"{number:.4f}" for number in found[best])
    usual = TOLERANCE_MM if one.kind == "pose" else TOLERANCE_DEGREES
    return float(off[best].max()) <= one.margin(usual), actual


# ------------------------------------------------------------------------------------- speeds


@_evaluates("speed")
def _speed(one: Expectation, part: _MotionPath) -> Evaluated:
    if part.is_whole:
        return _speed_of_run(one, part)
    kept, (way, *_, number) = part.whole, one.arguments
    if way == "drops":
        if part.leave is None or part.join is None:
            return _NO_BLEND
        kept = part.within(part.leave, part.join)
    rates = change_rates(part.path.times[kept], part.points[kept])
    speeds = np.linalg.norm(rates, axis=1) / 1_000
    if not len(speeds):
        return False, "there are too few samples"
    wanted, fastest, slowest = float(number), float(speeds.max()), float(speeds.min())
    if way == "drops":
        return slowest < wanted, f"{slowest:.4f} m/s"
    off = fastest - wanted
    return (off if way == "most" else abs(off)) <= wanted * _SPEED, f"{fastest:.4f} m/s"


def _speed_of_run(one: Expectation, part: _MotionPath) -> Evaluated:
    """Check the highest speed of the tool in $WORLD during the whole run."""
    wanted, fastest, when = float(one.arguments[-1]), 0.0, 0
    if one.arguments[0] == "drops":
        return None, "it is about the blend of a line"
    for rows in part.stretches():
        times = part.path.times[rows]
        if len(times) > 1:
            speeds = np.linalg.norm(change_rates(times, part.path.tips[rows]), axis=1) / 1_000
            if speeds.max() > fastest:
                fastest, when = float(speeds.max()), int(times[int(np.argmax(speeds))])
    off = fastest - wanted
    is_met = (off if one.arguments[0] == "most" else abs(off)) <= wanted * _SPEED
    return is_met, f"{fastest:.4f} m/s at {when / 1e6:.6f} s"


@_evaluates("smooth", "limits")
def _limits(one: Expectation, part: _MotionPath) -> Evaluated:
    """Check that no axis exceeds its speed limit, or with ``smooth`` its acceleration limit."""
    if part.seen.machine is None:
        return None, "the limits of the arm are not known"
    axes, times = part.seen.machine.axes[:6], part.path.times[part.whole]
    rates, what = change_rates(times, part.path.axes[part.whole][:, :6]), "velocity"
    if one.kind == "smooth":
        rates, what = change_rates(times[1:], rates), "acceleration"
    if not len(rates):
        return False, "there are too few samples"
    most = [getattr(each.dynamics, what) if each.dynamics else math.inf for each in axes]
    worst = np.abs(rates).max(axis=0) / np.array(most)
    axis = int(np.argmax(worst))
    actual = f"{axes[axis].name} at {worst[axis] * 100:.1f} % of its limit"
    return float(worst.max()) <= _RATE_MARGIN, actual


@_evaluates("tracks")
def _tracks(one: Expectation, part: _MotionPath) -> Evaluated:
    """Check that the measured tool is near its set-points."""
    measured = part.path.points_measured
    if measured is None:
        return None, "nothing was measured"
    kept = part.within(part.start, part.end)
    off = np.linalg.norm(measured[kept, :3] - part.points[kept], axis=1)
    return _within_tolerance(one, float(off.max()), usual=_TRACKING)
