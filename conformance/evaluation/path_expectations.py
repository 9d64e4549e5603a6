"""Expectations about the path of a motion: shape, speed, tracking.

The path of a line is that of its last motion, from start to end. For lines and circles, only the
section between the blends is compared. The expected path is given analytically in the case; the
observed path are the set-points in each interpolation cycle.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise, starmap
from typing import Final

import numpy as np
import numpy.typing as npt

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


@dataclass(frozen=True, slots=True)
class _MotionPath:
    """The motion of a line, with times in µs.

    ``entered`` is the end of the blend before it, or its start. ``leave`` and ``join`` are the
    start and the end of the blend after it. With ``is_whole`` it is the path of the whole run.
    """

    path: PathRecord
    start: int
    end: int
    entered: int
    leave: int | None
    join: int | None
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

    def own(self) -> Array:
        """Return the samples of the tool between the blends."""
        last = self.end if self.leave is None else self.leave
        kept = (self.path.times >= self.entered) & (self.path.times <= last)
        return self.points[kept]

    def stretches(self) -> Iterator[slice]:
        """Yield rows with the same frames and tool; points of different rows are not comparable."""
        if not self.is_whole:
            kept = np.flatnonzero(
                self.within(self.start, self.end if self.join is None else self.join)
            )
            yield slice(int(kept[0]), int(kept[-1]) + 1) if len(kept) else slice(0)
            return
        times = [time for time, _ in self.path.placements]
        bounds = sorted(
            {0, *np.searchsorted(self.path.times, times).tolist(), len(self.path.times)}
        )
        yield from starmap(slice, pairwise(bounds))

    def within(self, start: int, end: int) -> npt.NDArray[np.bool_]:
        """Return which samples lie between two times."""
        kept: npt.NDArray[np.bool_] = (self.path.times >= start) & (self.path.times <= end)
        return kept


def evaluate_on_path(one: Expectation, seen: Observation, marks: Marks) -> Evaluated:
    """Return whether an expectation about the path is met, with what was observed."""
    if seen.path is None:
        return "open", "no path was recorded"
    part = _motion_path(one, seen, seen.path)
    if part is None:
        return "unmet", "the motion did not begin and end"
    if one.kind in ("pose", "axes"):
        return _position(one, seen, part, marks)
    return _EVALUATORS[one.kind](one, seen, part)


def _motion_path(one: Expectation, seen: Observation, path: PathRecord) -> _MotionPath | None:
    if not one.file:
        first, last = int(path.times[0]), int(path.times[-1])
        return _MotionPath(path, first, last, first, None, None, is_whole=True)
    starts = seen.on_line(one.file, one.line, "motion_start")
    if not starts:
        return None
    number = starts[-1].fields.get("motion")
    times = {
        (event.kind, event.fields.get("motion")): event.time
        for event in seen.of_kind("motion_start", "motion_end", "blend_start", "blend_end")
    }
    start, end = times["motion_start", number], times.get(("motion_end", number))
    if start is None or end is None or number is None:
        return None
    entered = times.get(("blend_end", number))
    leave = times.get(("blend_start", number))
    join = None if leave is None else times.get(("blend_end", number + 1))
    return _MotionPath(path, start, end, start if entered is None else entered, leave, join)


# ------------------------------------------------------------------------------------- places


def _numbers(one: Expectation) -> Array:
    found = []
    for word in one.arguments:
        try:
            found.append(float(word))
        except ValueError:
            continue
    return np.array(found)


def _within_tolerance(
    one: Expectation, off: float, unit: str = "mm", usual: float = TOLERANCE_MM
) -> Evaluated:
    margin = usual if one.tolerance is None else one.tolerance
    return ("met" if off <= margin else "unmet"), f"{off:.4f} {unit} off"


def _path(one: Expectation, _seen: Observation, part: _MotionPath) -> Evaluated:
    numbers = _numbers(one).reshape(-1, 3)
    match one.arguments[0]:
        case "joint":
            return _joint(one, part)
        case "blend":
            if part.leave is None or part.join is None:
                return "unmet", "there is no blend"
            points = part.points[part.within(part.leave, part.join)]
            off = from_arc(points, numbers[0], numbers[1], numbers[2])
        case "circle":
            points, off = part.own(), from_circle(part.own(), *numbers)
        case _:
            points, off = part.own(), from_line(part.own(), *numbers)
    if not len(points):
        return "unmet", "there is no part of the path between the blends"
    return _within_tolerance(one, float(off.max()))


def _joint(one: Expectation, part: _MotionPath) -> Evaluated:
    """Check that all axes always have covered the same fraction of their way [MOT-01]."""
    last = part.end if part.leave is None else part.leave
    axes = part.path.axes[part.within(part.entered, last)][:, :6]
    if not len(axes):
        return "unmet", "there is no part of the path between the blends"
    off = from_synchronous(axes)
    if off is None:
        return "unmet", "no axis moves"
    return _within_tolerance(one, off, "degrees", TOLERANCE_DEGREES)


def _distance(part: _MotionPath, point: Array) -> float:
    """Return the smallest distance of the tool from a point, including the blend that follows."""
    if part.is_whole:
        stretches = [_refined(part, rows) for rows in part.stretches()]
        return min(float(nearest(points[:-1], points[1:], point).min()) for points in stretches)
    last = part.end if part.join is None else part.join
    points = refined(part.path.times, part.points, part.start, last, 2_000)
    return float(np.linalg.norm(points - point, axis=1).min())


def _refined(part: _MotionPath, rows: slice) -> Array:
    """Return the points of some rows with interpolated points between them, at least two."""
    times, points = part.path.times[rows], part.points[rows]
    return refined(times, points, float(times[0]), float(times[-1]), 4 * len(times) + 2)


def _avoids(one: Expectation, _seen: Observation, part: _MotionPath) -> Evaluated:
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
            return "unmet", f"inside at {part.path.times[first] / 1e6:.6f} s, from {at} on"
    return "met", ""


def _passes(one: Expectation, _seen: Observation, part: _MotionPath) -> Evaluated:
    return _within_tolerance(one, _distance(part, _numbers(one)))


def _misses(one: Expectation, _seen: Observation, part: _MotionPath) -> Evaluated:
    *point, wanted = _numbers(one)
    off = _distance(part, np.array(point))
    margin = wanted * 0.05 if one.tolerance is None else one.tolerance
    return ("met" if abs(off - wanted) <= margin else "unmet"), f"{off:.4f} mm away"


def _leaves(one: Expectation, _seen: Observation, part: _MotionPath) -> Evaluated:
    moment = part.leave if one.kind == "leaves" else part.join
    if moment is None:
        return "unmet", "there is no blend"
    *point, wanted = _numbers(one)
    off = float(np.linalg.norm(part.at(moment) - np.array(point)))
    margin = TOLERANCE_MM if one.tolerance is None else one.tolerance
    return ("met" if abs(off - wanted) <= margin else "unmet"), f"{off:.4f} mm before or behind it"


def _position(one: Expectation, seen: Observation, part: _MotionPath, marks: Marks) -> Evaluated:
    moment = part.end
    if one.when is not None:
        try:
            moment = time_of(one.when.first, seen, marks)
        except LookupError as error:
            return "unmet", str(error.args[0])
    wanted = _numbers(one)
    moments = around(moment, seen.unsure if one.when is not None else 0)
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
    margin = usual if one.tolerance is None else one.tolerance
    return ("met" if float(off[best].max()) <= margin else "unmet"), actual


# ------------------------------------------------------------------------------------- speeds


def _speed(one: Expectation, _seen: Observation, part: _MotionPath) -> Evaluated:
    kept = part.within(part.start, part.end if part.join is None else part.join)
    if part.is_whole:
        return _speed_of_run(one, part)
    if one.arguments[0] == "drops":
        if part.leave is None or part.join is None:
            return "unmet", "there is no blend"
        kept = part.within(part.leave, part.join)
    rates = change_rates(part.path.times[kept], part.points[kept])
    speeds = np.linalg.norm(rates, axis=1) / 1_000
    if not len(speeds):
        return "unmet", "there are too few samples"
    wanted = float(one.arguments[-1])
    fastest, slowest = float(speeds.max()), float(speeds.min())
    match one.arguments[0]:
        case "most":
            return ("met" if fastest <= wanted * (1 + _SPEED) else "unmet"), f"{fastest:.4f} m/s"
        case "reaches":
            is_met = abs(fastest - wanted) <= wanted * _SPEED
            return ("met" if is_met else "unmet"), f"{fastest:.4f} m/s"
    return ("met" if slowest < wanted else "unmet"), f"{slowest:.4f} m/s"


def _speed_of_run(one: Expectation, part: _MotionPath) -> Evaluated:
    """Check the highest speed of the tool in $WORLD during the whole run."""
    wanted, fastest, when = float(one.arguments[-1]), 0.0, 0
    for rows in part.stretches():
        times = part.path.times[rows]
        if len(times) > 1:
            speeds = np.linalg.norm(change_rates(times, part.path.tips[rows]), axis=1) / 1_000
            if speeds.max() > fastest:
                fastest, when = float(speeds.max()), int(times[int(np.argmax(speeds))])
    is_met = fastest <= wanted * (1 + _SPEED)
    if one.arguments[0] == "reaches":
        is_met = is_met and fastest >= wanted * (1 - _SPEED)
    elif one.arguments[0] == "drops":
        return "open", "it is about the blend of a line"
    return ("met" if is_met else "unmet"), f"{fastest:.4f} m/s at {when / 1e6:.6f} s"


def _limits(one: Expectation, seen: Observation, part: _MotionPath) -> Evaluated:
    """Check that no axis exceeds its speed limit, or with ``smooth`` its acceleration limit."""
    if seen.machine is None:
        return "open", "the limits of the arm are not known"
    last = part.end if part.join is None else part.join
    kept = part.within(part.start, last)
    axes = seen.machine.axes
    dynamics = [axis.dynamics for axis in axes[:6]]
    rates = change_rates(part.path.times[kept], part.path.axes[kept][:, :6])
    most = np.array([one.velocity if one else math.inf for one in dynamics])
    if one.kind == "smooth":
        rates = change_rates(part.path.times[kept][1:], rates)
        most = np.array([one.acceleration if one else math.inf for one in dynamics])
    if not len(rates):
        return "unmet", "there are too few samples"
    worst = np.abs(rates).max(axis=0) / most
    axis = int(np.argmax(worst))
    actual = f"{axes[axis].name} at {worst[axis] * 100:.1f} % of its limit"
    return ("met" if float(worst.max()) <= _RATE_MARGIN else "unmet"), actual


def _tracks(one: Expectation, _seen: Observation, part: _MotionPath) -> Evaluated:
    """Check that the measured tool is near its set-points."""
    measured = part.path.points_measured
    if measured is None:
        return "open", "nothing was measured"
    kept = part.within(part.start, part.end)
    off = np.linalg.norm(measured[kept, :3] - part.points[kept], axis=1)
    return _within_tolerance(one, float(off.max()), usual=_TRACKING)


_EVALUATORS: Final[Mapping[str, Callable[[Expectation, Observation, _MotionPath], Evaluated]]] = {
    "path": _path,
    "passes": _passes,
    "misses": _misses,
    "avoids": _avoids,
    "leaves": _leaves,
    "joins": _leaves,
    "speed": _speed,
    "smooth": _limits,
    "limits": _limits,
    "tracks": _tracks,
}
