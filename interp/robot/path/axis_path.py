"""Curves in joint space: the axes along a path, as functions of its parameter u from 0 to 1.

Axes are arrays ``(n, axes)``: the six of the robot, then the external axes, which usually move in
proportion to u. `Curve.rates` are the first to third derivatives by u. They are exact for joint
curves; for others they are those of a spline through sufficiently many points of the curve. The
axes themselves are always exact.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Protocol

import numpy as np

from interp.robot.kinematics.kinematics import Array, Kinematics, matrix_of
from interp.robot.kinematics.placement import IpoMode, Placement
from interp.robot.kinematics.solution_choice import check_path, follow
from interp.robot.path.pose_path import PosePath, poses_of
from interp.robot.path.transition import Transition, chained
from interp.robot.path.uniform_spline import UniformSpline
from interp.values.faults import Fault

if TYPE_CHECKING:
    from scipy.interpolate import CubicSpline

#: First to third derivatives of axes by u, each ``(n, axes)``.
Rates = tuple[Array, Array, Array]

_FEWEST = 65
"""The smallest number of points of a curve: the third derivative of a blend changes quickly."""
_COARSE = 8
_NOISE = 1e-11
"""Degrees of fourth differences below which only every `_COARSE`-th point is kept: for closer
points, rounding would dominate the differences."""
_COUNTS = tuple((_FEWEST - 1) * 2**doubled + 1 for doubled in range(8))
_SMOOTH = 0.004
"""Largest fourth difference of points in degrees; a cubic spline errs by 5/384 of it at most."""
_ROUGH = 0.05  # degrees of fourth difference at which, with most points, an axis jumps


class Curve(Protocol):
    """A path of the axes; two curves are equal only if they are the same object."""

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

    @property
    def grid(self) -> Array:
        """Parameters ``(n,)`` from 0 to 1, close enough to capture the whole curve."""
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


class ExternalAxes(Protocol):
    """The path of the external axes, as a function of u; arrays are ``(n, axes)``."""

    def at(self, u: Array) -> Array:
        """Return the external axes at parameters ``(n,)``."""
        ...

    def rates(self, u: Array) -> Rates:
        """Return the first to third derivatives by u."""
        ...


@dataclass(frozen=True, slots=True, eq=False)
class LinearExternals:
    """External axes that are linear in u."""

    start: Array
    end: Array

    def at(self, u: Array) -> Array:
        """See `ExternalAxes.at`."""
        return self.start + u[:, None] * (self.end - self.start)

    def rates(self, u: Array) -> Rates:
        """See `ExternalAxes.rates`."""
        zeros = np.zeros((len(u), len(self.start)))
        return zeros + (self.end - self.start), zeros, zeros


@dataclass(frozen=True, slots=True, eq=False)
class BlendedExternals:
    """External axes of a blend, combined as in `BlendedAxes`."""

    first: ExternalAxes
    second: ExternalAxes
    transition: Transition

    def at(self, u: Array) -> Array:
        """See `ExternalAxes.at`."""
        one, other = self.transition.at(u)
        corner = self.first.at(np.ones(1))
        axes: Array = self.first.at(one) - corner + self.second.at(other)
        return axes

    def rates(self, u: Array) -> Rates:
        """See `ExternalAxes.rates`."""
        return _blended_rates(self, u)


@dataclass(frozen=True, slots=True, eq=False)
class Piecewise:
    """A section of a spline: from its parameter ``start`` over ``length``."""

    spline: CubicSpline
    start: float
    length: float

    def at(self, u: Array) -> Array:
        """See `ExternalAxes.at`."""
        axes: Array = self.spline(self.start + u * self.length)
        return axes

    def rates(self, u: Array) -> Rates:
        """See `ExternalAxes.rates`."""
        where = self.start + u * self.length
        first, second, third = (self.spline(where, n) * self.length**n for n in (1, 2, 3))
        return first, second, third


@dataclass(frozen=True, eq=False)
class JointSpline:
    """All axes along a section of a spline through several positions: PTP spline blocks."""

    arm: Kinematics
    placement: Placement
    part: Piecewise

    pose_path = None
    is_straight = False

    @cached_property
    def end(self) -> Array:
        """See `Curve.end`."""
        end: Array
        (end,) = self.part.at(np.ones(1))
        return end

    @property
    def grid(self) -> Array:
        """See `Curve.grid`."""
        return np.linspace(0.0, 1.0, _FEWEST)

    def axes(self, u: Array) -> Array:
        """See `Curve.axes`."""
        return self.part.at(u)

    def rates(self, u: Array) -> Rates:
        """See `Curve.rates`."""
        return self.part.rates(u)


@dataclass(frozen=True, eq=False)
class JointLine:
    """All axes from one position to another, linear in u: PTP [MOT-01]."""

    arm: Kinematics
    placement: Placement
    start: Array
    end: Array

    pose_path = None
    is_straight = True

    @property
    def grid(self) -> Array:
        """See `Curve.grid`."""
        return np.linspace(0.0, 1.0, 2)

    def axes(self, u: Array) -> Array:
        """See `Curve.axes`."""
        return self.start + u[:, None] * (self.end - self.start)

    def rates(self, u: Array) -> Rates:
        """See `Curve.rates`."""
        shape = (len(u), len(self.start))
        zeros = np.zeros(shape)
        return np.broadcast_to(self.end - self.start, shape), zeros, zeros


@dataclass(frozen=True, eq=False)
class BlendedAxes:
    """A blend of axes: ``first(one(u)) - P + second(other(u))`` [BLD-12].

    P is the position of the axes at the point between the two motions.
    """

    first: Curve
    second: Curve
    transition: Transition

    pose_path = None
    is_straight = False

    @property
    def arm(self) -> Kinematics:
        """See `Curve.arm`."""
        return self.first.arm

    @property
    def placement(self) -> Placement:
        """See `Curve.placement`."""
        return self.first.placement

    @cached_property
    def end(self) -> Array:
        """See `Curve.end`."""
        end: Array
        (end,) = self.axes(np.ones(1))
        return end

    @property
    def grid(self) -> Array:
        """See `Curve.grid`."""
        count = max(len(self.first.grid), len(self.second.grid), _FEWEST)
        return np.unique(np.concatenate((np.linspace(0.0, 1.0, count), self.transition.breaks)))

    def axes(self, u: Array) -> Array:
        """See `Curve.axes`."""
        one, other = self.transition.at(u)
        axes: Array = self.first.axes(one) - self.first.end + self.second.axes(other)
        return axes

    def rates(self, u: Array) -> Rates:
        """See `Curve.rates`."""
        return _blended_rates(self, u)


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
        others: ExternalAxes,
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
        self.end: Array = np.concatenate((axes[-1], *others.at(np.ones(1))))

    def axes(self, u: Array) -> Array:
        """See `Curve.axes`."""
        robot = self._exact_axes(u, self._table.at(u))
        return np.concatenate((robot, self.others.at(u)), axis=1)

    def rates(self, u: Array) -> Rates:
        """See `Curve.rates`."""
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
        return self.placement.chains_before(self.others.at(u))

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
            raise _singular()
        check_path(self.arm.machine.axes, axes)
        if np.abs(np.diff(axes[::_COARSE], n=4, axis=0)).max() < _NOISE:
            return grid[::_COARSE], axes[::_COARSE]
        return grid, axes


def _blended_rates(blend: BlendedAxes | BlendedExternals, u: Array) -> Rates:
    """Return the derivatives of a blend by u, from those of its two parts."""
    (one, other), rates = blend.transition.at(u), blend.transition.rates(u)
    of_one, of_other = (each[:, :, None] for each in rates)
    leaving = chained(blend.first.rates(one), of_one)
    joining = chained(blend.second.rates(other), of_other)
    first, second, third = (left + right for left, right in zip(leaving, joining, strict=True))
    return first, second, third


def _singular() -> Fault:
    text = "the path leads through a singularity, where an axis would have to jump"
    return Fault("axis_velocity", text, number=1102, rules=("MOT-08",))
