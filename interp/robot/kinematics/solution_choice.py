"""Which axes reach a point: the choice by Status, Turn or the start [POS-04 to POS-08].

Up to eight solutions reach a pose, and more if an axis can turn further than 360 degrees. Status
selects the configuration; among the solutions within the software limits no two have the same
[POS-12]. Turn then only selects the sense of an axis that can turn further [POS-07]. Axes are in
degrees.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import Enum

import numpy as np
import numpy.typing as npt

from interp.robot.kinematics.kinematics import Array, Kinematics, matrix_of, nearest_turns
from interp.robot.kinematics.machine_data import ROBOT_AXES, Axis
from interp.values.faults import Fault
from interp.values.poses import IDENTITY, Pose

Axes = tuple[float, ...]

_ALL_BITS = 7
#: Degrees below zero that still count as zero for Turn: points have about six digits.
_ZERO = 1e-7
#: Degrees by which an axis may exceed its software limit switch, because of rounding.
_LIMIT = 1e-6
_WRIST = 0.01812  # degrees of A5, given in [POS-08]
_ELBOW = 1e-4  # degrees of A3; this and the next, mm from axis 1, are ours: the manual has none
_OVERHEAD = 1e-6


class TargetStatus(Enum):
    """$TARGET_STATUS: the Status of a target that gives none [POS-09]."""

    SOURCE = "#SOURCE"
    BEST = "#BEST"


class Singularity(Enum):
    """Positions in which an axis is undetermined; the values are indices of $SINGUL_POS.

    In the first a bit of Status is, in the second the next, in the third the last.
    """

    OVERHEAD = 1
    EXTENDED = 2
    WRIST = 3


@dataclass(frozen=True, slots=True)
class Solution:
    """Six axes in degrees, their Status and Turn, and the singularities in which they lie."""

    axes: Axes
    status: int
    turn: int
    singularities: tuple[Singularity, ...]


def turn_of(axes: Sequence[float]) -> int:
    """Return the Turn of six axes: bit i-1 is set if axis i is negative [POS-07]."""
    return sum(1 << place for place, value in enumerate(axes) if value < -_ZERO)


def singularities(arm: Kinematics, axes: Sequence[float]) -> tuple[Singularity, ...]:
    """Return the singularities in which six axes lie [POS-08]."""
    found = {
        Singularity.OVERHEAD: float(arm.distance_to_axis_1(axes)) <= _OVERHEAD,
        Singularity.EXTENDED: abs(axes[2] - arm.elbow) <= _ELBOW,
        Singularity.WRIST: arm.has_wrist_singularity and abs(axes[4]) <= _WRIST,
    }
    return tuple(kind for kind, holds in found.items() if holds)


def check_limits(axes: Sequence[Axis], values: Sequence[float]) -> None:
    """Raise `Fault` 1447 if a value exceeds a software limit switch, or is NaN."""
    for axis, value in zip((axis.unlimited() for axis in axes), values, strict=True):
        if not axis.lower - _LIMIT <= value <= axis.upper + _LIMIT:
            raise _limit_fault(axis, value)


def check_path(axes: Sequence[Axis], path: Array) -> None:
    """Raise `Fault` if a path ``(n, axes)`` exceeds a software limit switch [MOT-15].

    It is 1447 if the path ends there, because no point beyond a limit can be reached, and 1211 if
    the limit is exceeded on the way to a point within it.
    """
    axes = [axis.unlimited() for axis in axes]
    lower = np.array([axis.lower for axis in axes]) - _LIMIT
    upper = np.array([axis.upper for axis in axes]) + _LIMIT
    outside = np.argwhere((path < lower) | (path > upper))
    if len(outside):
        check_limits(axes, path[-1].tolist())
        row, column = outside[0]
        where = _limit_text(axes[column], float(path[row, column]))
        text = f"the path leads onto a software limit switch: {where}"
        raise Fault("software_limit", text, number=1211, rules=("MOT-15",))


def solve(
    arm: Kinematics,
    flange: Pose,
    *,
    tool: Pose = IDENTITY,
    status: int | None = None,
    turn: int | None = None,
    start: Sequence[float] = (0.0,) * ROBOT_AXES,
    preference: TargetStatus = TargetStatus.BEST,
) -> Solution:
    """Return the axes for a pose of the flange relative to the robot's foot.

    An orientation that the arm cannot take is turned about the tip of ``tool``.

    ``status`` selects the configuration; its bits 3 and 4 have no meaning [POS-06]. Without it the
    configuration is the one whose leading axis arrives first, or with ``preference``
    `TargetStatus.SOURCE` that of ``start``. ``turn`` selects among full turns of an axis if there
    are several; without it each axis takes the shortest way from ``start`` [POS-02]. From 0 the
    most central solution is taken.

    Raises `Fault` 1366 if no such solution exists, 1447 if it exists but not within the software
    limits [MOT-15].
    """
    solutions = np.empty((0, ROBOT_AXES))
    if flange.is_finite:
        solutions = arm.inverse(arm.about_tips(matrix_of(flange), matrix_of(tool)))
    return _choose(arm, solutions, status, turn, start, preference)


def ptp_target(
    arm: Kinematics,
    flange: Pose,
    start: Sequence[float],
    *,
    tool: Pose = IDENTITY,
    status: int | None = None,
    turn: int | None = None,
    preference: TargetStatus = TargetStatus.SOURCE,
) -> Solution:
    """Return the axes of a PTP target as `solve` does, with undetermined axes as in $SINGUL_POS.

    In a singularity, axis 1 or axis 4 goes to 0 or keeps its value at the start [POS-08]. Near a
    straight wrist this changes the orientation by up to 0.018 degrees. If the arm is extended,
    nothing is undetermined.
    """
    found = solve(
        arm, flange, tool=tool, status=status, turn=turn, start=start, preference=preference
    )
    keeps = arm.machine.singul_pos
    if Singularity.OVERHEAD in found.singularities and keeps[0]:
        zero, turned = arm.forward(((0.0,) * 6, (-start[0], *(0.0,) * 5)))
        moved = turned @ np.linalg.inv(zero) @ matrix_of(flange)
        solutions = arm.inverse(arm.about_tips(moved, matrix_of(tool)))
        solutions = solutions[np.abs(solutions[:, 0]) <= 90.0]  # the others turn axis 1 by 180
        solutions[:, 0] += start[0]
        found = _choose(arm, solutions, status, turn, start, preference)
    if Singularity.WRIST in found.singularities:
        found = _settled_wrist(arm, found, start[3] if keeps[2] else 0.0, turn, start)
    return found


def follow(arm: Kinematics, flanges: npt.ArrayLike, start: Sequence[float]) -> Array:
    """Return continuous axes ``(n, 6)`` from ``start`` along a path of flange poses ``(n, 4, 4)``.

    Status and Turn result from the path [POS-01, POS-02]: each sample takes the solution nearest to
    the previous one. Raises `Fault` as `solve` does, for the first sample out of reach, and as
    `check_path` does.
    """
    before = np.asarray(start, dtype=np.float64)
    forearm, hand = arm.machine.axes[3].direction, arm.machine.axes[5].direction
    path = []
    for choices in arm.inverse(flanges):
        straight = np.abs(choices[:, 4]) <= _ZERO  # axis 4 keeps its value
        choices[straight, 5] += forearm * hand * (choices[straight, 3] - before[3])
        choices[straight, 3] = before[3]
        near = nearest_turns(choices, before)
        distances = np.abs(near - before).max(axis=1)
        if np.isnan(distances).all():
            raise Fault("unreachable", "the path cannot be followed", number=1366)
        before = near[int(np.nanargmin(distances))]
        path.append(before)
    followed = np.array(path).reshape(-1, 6)
    check_path(arm.machine.axes, followed)
    return followed


# ------------------------------------------------------------------------------------- one target


def _choose(
    arm: Kinematics,
    solutions: Array,
    status: int | None,
    turn: int | None,
    start: Sequence[float],
    preference: TargetStatus,
) -> Solution:
    solutions = solutions[~np.isnan(solutions).any(axis=1)]
    if status is None and preference is TargetStatus.SOURCE:
        status = int(arm.status(start))
    if status is not None:
        solutions = solutions[[_has_status(arm, one, status) for one in solutions.tolist()]]
    if not len(solutions):
        raise Fault("unreachable", "the target cannot be reached", number=1366, rules=("MOT-15",))
    limited = arm.machine.axes
    for axes in (limited, tuple(axis.unlimited() for axis in limited)):
        fits = (_within_limits(axes, solution.tolist(), turn, start) for solution in solutions)
        fitting = [fit for fit in fits if fit is not None]
        if fitting:
            break
    else:
        named = zip(axes, solutions[0].tolist(), start, strict=True)
        raise next(
            _limit_fault(axis, value)
            for axis, value, before in named
            if not _full_turns(axis, value, before)
        )
    found = min(fitting, key=lambda fit: _effort(limited, fit, start))
    return Solution(found, int(arm.status(found)), turn_of(found), singularities(arm, found))


def _has_status(arm: Kinematics, solution: Sequence[float], status: int) -> bool:
    """Return whether six axes have a Status; in a singularity its bit is ignored [POS-08]."""
    free = sum(1 << kind.value - 1 for kind in singularities(arm, solution))
    return (int(arm.status(solution)) ^ status) & _ALL_BITS & ~free == 0


def _within_limits(
    axes: Sequence[Axis], solution: Sequence[float], turn: int | None, origin: Sequence[float]
) -> Axes | None:
    """Return a solution with full turns added so that all axes are within limits, or ``None``."""
    fitted = []
    for place, (axis, value) in enumerate(zip(axes, solution, strict=True)):
        choices = _full_turns(axis, value, origin[place])
        if turn is not None:
            is_negative = bool(turn >> place & 1)
            choices = [c for c in choices if (c < -_ZERO) == is_negative] or choices
        if not choices:
            return None
        fitted.append(_nearest(choices, origin[place]))
    return tuple(fitted)


def _nearest(choices: Sequence[float], origin: float) -> float:
    """Return the choice nearest to an origin; of two, the greater, whatever the rounding."""
    return min(choices, key=lambda choice: (round(abs(choice - origin), 6), -choice))


def _full_turns(axis: Axis, value: float, origin: float) -> list[float]:
    """Return the angles within the limits that differ from ``value`` by full turns."""
    lower = max(axis.lower, min(origin, 0.0) - 360.0) - _LIMIT
    upper = min(axis.upper, max(origin, 0.0) + 360.0) + _LIMIT
    first = math.ceil((lower - value) / 360.0)
    last = math.floor((upper - value) / 360.0)
    return [value + 360.0 * count for count in range(first, last + 1)]


def _effort(
    machine_axes: Sequence[Axis], axes: Axes, origin: Sequence[float]
) -> tuple[float, float]:
    """Return the time of the leading axis at full speed, and the sum over all axes.

    They are in degrees instead of seconds if speeds are unknown.
    """
    travels = [abs(value - start) for value, start in zip(axes, origin, strict=True)]
    speeds = [axis.dynamics.velocity if axis.dynamics else 1.0 for axis in machine_axes]
    times = [travel / speed for travel, speed in zip(travels, speeds, strict=True)]
    return max(times), sum(times)


def _settled_wrist(
    arm: Kinematics, found: Solution, a4: float, turn: int | None, start: Sequence[float]
) -> Solution:
    """Return a straight wrist with axis 4 at ``a4``; unchanged if axis 6 cannot compensate."""
    axes = arm.machine.axes
    difference = found.axes[3] - a4
    a5 = found.axes[4] * math.cos(math.radians(difference))
    a6 = found.axes[5] + axes[3].direction * axes[5].direction * difference
    settled = _within_limits(axes, (*found.axes[:3], a4, a5, a6), turn, start)
    if settled is None:
        return found
    return replace(found, axes=settled, status=int(arm.status(settled)), turn=turn_of(settled))


def _limit_fault(axis: Axis, value: float) -> Fault:
    text = f"the point lies behind a software limit switch: {_limit_text(axis, value)}"
    return Fault("software_limit", text, number=1447, rules=("MOT-15",))


def _limit_text(axis: Axis, value: float) -> str:
    return f"{axis.name} at {round(value, 4) + 0.0:g}, not within {axis.lower:g} to {axis.upper:g}"
