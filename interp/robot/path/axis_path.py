"""Curves in joint space: the axes along a path, as functions of its parameter u from 0 to 1.

Axes are arrays ``(n, axes)``: the six of the robot, then the external axes, which usually move in
proportion to u. `AxisPath.rates` are the first to third derivatives by u. They are exact for joint
curves; for others they are those of a spline through sufficiently many points of the curve. The
axes themselves are always exact.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Protocol

import numpy as np

from interp.robot.kinematics.kinematics import Array, Kinematics, matrix_of
from interp.robot.kinematics.placement import IpoMode, Placement
from interp.robot.kinematics.solution_choice import check_path, follow
from interp.robot.path.pose_path import GRID, PosePath, poses_of
from interp.robot.path.transition import Transition, chained
from interp.robot.path.uniform_spline import UniformSpline
from interp.values.faults import Fault

if TYPE_CHECKING:
    from scipy.interpolate import CubicSpline

#: First to third derivatives of axes by u, each ``(n, axes)``.
Rates = tuple[Array, Array, Array]

_COARSE = 8
#: Degrees of fourth differences below which only every `_COARSE`-th point is kept: for closer
#: points, rounding would dominate the differences.
_NOISE = 1e-11
_COUNTS = tuple((len(GRID) - 1) * 2**doubled + 1 for doubled in range(8))
#: Largest fourth difference of points in degrees; a cubic spline errs by 5/384 of it at most.
_SMOOTH = 0.004
_ROUGH = 0.05  # degrees of fourth difference at which, with most points, an axis jumps


class AxisPath(Protocol):
    """Some axes as functions of u."""

    @property
    def grid(self) -> Array:
        """Parameters ``(n,)`` from 0 to 1, close enough to capture the whole path."""
        ...

    @property
    def end(self) -> Array:
        """The axes at u = 1, ``(axes,)``."""
        ...

    def axes(self, u: Array) -> Array:
        """Return the axes at parameters ``(n,)``."""
        ...

    def rates(self, u: Array) -> Rates:
        """Return the first to third derivatives of the axes by u."""
        ...


class Curve(AxisPath, Protocol):
    """A path of all axes; two curves are equal only if they are the same object."""

    def __hash__(self) -> int: ...

    @property
    def arm(self) -> Kinematics:
        """The kinematics of the arm."""
        ...

    @property
    def placement(self) -> Placement:
        """The frames in force, which determine the place of the tool."""
        ...

    @property
    def pose_path(self) -> PosePath | None:
        """The path of the tool, if the motion was programmed as one."""
        ...

    @property
    def is_straight(self) -> bool:
        """Whether the axes are linear in u, so that the second derivative is zero."""
        ...


@dataclass(frozen=True, slots=True, eq=False)
class LinearAxes:
    """Axes that are linear in u."""

    start: Array
    end: Array

    @property
    def grid(self) -> Array:
        """See `AxisPath.grid`."""
        return np.linspace(0.0, 1.0, 2)

    def axes(self, u: Array) -> Array:
        """See `AxisPath.axes`."""
        return self.start + u[:, None] * (self.end - self.start)

    def rates(self, u: Array) -> Rates:
        """See `AxisPath.rates`."""
        zeros = np.zeros((len(u), len(self.start)))
        return zeros + (self.end - self.start), zeros, zeros


@dataclass(frozen=True, slots=True, eq=False)
class SplineAxes:
    """A section of a spline: from its parameter ``start`` over ``length``."""

    spline: CubicSpline
    start: float
    length: float

    @property
    def grid(self) -> Array:
        """See `AxisPath.grid`."""
        return GRID

    @property
    def end(self) -> Array:
        """See `AxisPath.end`."""
        end: Array
        (end,) = self.axes(np.ones(1))
        return end

    def axes(self, u: Array) -> Array:
        """See `AxisPath.axes`."""
        axes: Array = self.spline(self.start + u * self.length)
        return axes

    def rates(self, u: Array) -> Rates:
        """See `AxisPath.rates`."""
        where = self.start + u * self.length
        first, second, third = (self.spline(where, n) * self.length**n for n in (1, 2, 3))
        return first, second, third


def splined(spans: Sequence[float], points: Array) -> list[AxisPath]:
    """Return the axes between points ``(n, axes)`` that lie so far apart, in u of a common spline.

    Its second derivative is 0 at both ends. Between two points it is a line.
    """
    if len(spans) == 1:
        return [LinearAxes(*points)]
    from scipy.interpolate import CubicSpline

    knots = np.cumsum([0.0, *spans])
    spline = CubicSpline(knots, points, bc_type="natural")
    return [SplineAxes(spline, *part) for part in zip(knots.tolist(), spans, strict=False)]


@dataclass(frozen=True, slots=True, eq=False)
class BlendedAxes:
    """A blend of axes: ``first(one(u)) - P + second(other(u))`` [BLD-12].

    P is the position of the axes at the point between the two motions.
    """

    first: AxisPath
    second: AxisPath
    transition: Transition

    @property
    def grid(self) -> Array:
        """See `AxisPath.grid`."""
        even = max(self.first.grid, self.second.grid, GRID, key=len)
        return np.unique(np.concatenate((even, self.transition.breaks)))

    @property
    def end(self) -> Array:
        """See `AxisPath.end`."""
        end: Array
        (end,) = self.axes(np.ones(1))
        return end

    def axes(self, u: Array) -> Array:
        """See `AxisPath.axes`."""
        one, other = self.transition.at(u)
        axes: Array = self.first.axes(one) - self.first.end + self.second.axes(other)
        return axes

    def rates(self, u: Array) -> Rates:
        """See `AxisPath.rates`."""
        (one, other), rates = self.transition.at(u), self.transition.rates(u)
        of_one, of_other = (each[:, :, None] for each in rates)
        leaving = chained(self.first.rates(one), of_one)
        joining = chained(self.second.rates(other), of_other)
        first, second, third = (left + right for left, right in zip(leaving, joining, strict=True))
        return first, second, third


@dataclass(frozen=True, eq=False)
class JointCurve:
    """All axes along a path in axis space: PTP [MOT-01], its blocks, and blends."""

    arm: Kinematics
    placement: Placement
    path: AxisPath

    pose_path = None

    @property
    def is_straight(self) -> bool:
        """See `Curve.is_straight`."""
        return isinstance(self.path, LinearAxes)

    @property
    def grid(self) -> Array:
        """See `AxisPath.grid`."""
        return self.path.grid

    @cached_property
    def end(self) -> Array:
        """See `AxisPath.end`."""
        return self.path.end

    def axes(self, u: Array) -> Array:
        """See `AxisPath.axes`."""
        return self.path.axes(u)

    def rates(self, u: Array) -> Rates:
        """See `AxisPath.rates`."""
        return self.path.rates(u)


class PosePathCurve:
    """The axes along a path of poses, continuous from ``start``; Turn results from it [POS-02].

    ``start`` are the six axes of the robot, ``others`` the path of the external axes. Raises
    `Fault` 1366, 1447 or 1211 if the path cannot be followed, and 1102 if it leads through a
    singularity in which an axis would jump.
    """

    is_straight = False

    def __init__(
        self,
        arm: Kinematics,
        placement: Placement,
        pose_path: PosePath,
        start: Array,
        others: AxisPath,
    ) -> None:
        self.arm = arm
        self.placement = placement
        self.pose_path: PosePath | None = pose_path
        self.tool_path = pose_path
        self._before = matrix_of(placement.before)
        self._after = matrix_of(placement.after)
        self._tool = matrix_of(placement.tool)
        self.others = others
        self.grid, axes = self._points(start)
        self._table = UniformSpline(axes)
        self.end: Array = np.concatenate((axes[-1], others.end))

    def axes(self, u: Array) -> Array:
        """See `AxisPath.axes`."""
        robot = self._exact_axes(u, self._table.at(u))
        return np.concatenate((robot, self.others.axes(u)), axis=1)

    def rates(self, u: Array) -> Rates:
        """See `AxisPath.rates`."""
        first, second, third = (
            np.concatenate(both, axis=1)
            for both in zip(self._table.rates(u), self.others.rates(u), strict=True)
        )
        return first, second, third

    def _exact_axes(self, u: Array, references: Array) -> Array:
        """Return the exact six axes, given approximate ones."""
        robot = self.arm.inverse_near(self._flanges(u), references)
        lost = np.isnan(robot).any(axis=1)
        if lost.any():  # fully extended, to within a nanometre
            robot[lost] = references[lost]
        return robot

    def _axes_along(self, u: Array, start: Array) -> Array:
        """Return the six axes at increasing parameters, continuous from the start."""
        flanges = self._flanges(u)
        axes = self.arm.inverse_along(flanges, start.tolist())
        return follow(self.arm, flanges, start.tolist()) if axes is None else axes

    def _chains_before(self, u: Array) -> Array:
        """Return the transforms before the points of the path, in the chain to the flange."""
        if not self.placement.is_carried:
            return self._before
        return self.placement.chains_before(self.others.axes(u))

    def _flanges(self, u: Array) -> Array:
        poses = poses_of(self.tool_path, u)
        is_turned = self.placement.mode is IpoMode.TCP
        tools = np.linalg.inv(poses) if is_turned else poses
        flanges: Array = self._chains_before(u) @ tools @ self._after
        return flanges if is_turned else self.arm.about_tips(flanges, self._tool)

    def _points(self, start: Array) -> tuple[Array, Array]:
        """Return parameters and axes of enough points for a spline to represent the curve."""
        for count in _COUNTS:
            grid = np.linspace(0.0, 1.0, count)
            axes = self._axes_along(grid, start)
            rough = np.abs(np.diff(axes, n=4, axis=0)).max()
            if rough < _SMOOTH:
                break
        if max(rough, np.abs(axes[0] - start).max()) > _ROUGH:
            text = "the path leads through a singularity, where an axis would have to jump"
            raise Fault("axis_velocity", text, number=1102, rules=("MOT-08",))
        check_path(self.arm.machine.axes, axes)
        if np.abs(np.diff(axes[::_COARSE], n=4, axis=0)).max() < _NOISE:
            return grid[::_COARSE], axes[::_COARSE]
        return grid, axes
