"""Bounds of curves: what no profile within them can exceed."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
import pytest

from interp.robot.kinematics.kinematics_choice import kinematics_of
from interp.robot.kinematics.placement import Placement
from interp.robot.kinematics.solution_choice import follow
from interp.robot.path.axis_path import LinearAxes, PosePathCurve
from interp.robot.path.orientation import turning
from interp.robot.path.pose_path import Line, OrientedPath, poses_of
from interp.robot.planning.axis_limits import axis_limits
from interp.robot.planning.limits import CurveLimits, PathLimits, curve_limits_of

if TYPE_CHECKING:
    from interp.robot.kinematics.kinematics import Array
    from interp.robot.kinematics.machine_data import MachineData

START = np.array([0.0, -90.0, 100.0, 0.0, 60.0, 0.0, 0.0])
NONE = np.zeros(1)


def line(
    machine: MachineData, shift: tuple[float, float, float], start: Array = START
) -> PosePathCurve:
    """A straight line from axes on."""
    arm = kinematics_of(machine)
    pose = arm.forward(start[:6])
    still = turning(pose[:3, :3], pose[:3, :3])
    pose_path = OrientedPath(Line(pose[:3, 3], pose[:3, 3] + np.array(shift)), still)
    return PosePathCurve(arm, Placement(), pose_path, start[:6], LinearAxes(NONE, NONE))


@pytest.mark.parametrize(
    ("percent", "share"), [(30.0, 0.3), (100.0, 1.0), (130.0, 1.0), (0.0, 1.0)]
)
def test_percentages(machine: MachineData, percent: float, share: float) -> None:
    """A percentage that is none counts as all [MOT-02]."""
    limits = axis_limits(machine)
    scaled = limits.scaled((percent,) * 12, (100.0,) * 12, (100.0,) * 12)
    assert limits.velocity * share == pytest.approx(scaled.velocity)


def bounds_hold(curve: PosePathCurve, curve_limits: CurveLimits, machine: MachineData) -> None:
    """At the bounds of each stretch, no axis exceeds its own, wherever on the stretch."""
    limits = axis_limits(machine)
    for stretch in curve_limits.stretches:
        u = np.linspace(stretch.start, stretch.end, 301)
        step = 1e-3
        middle = np.clip(u, step, 1 - step)
        before, here, behind = (curve.axes(middle + shift) for shift in (-step, 0.0, step))
        first = np.abs(behind - before) / (2 * step)
        second = np.abs(behind - 2 * here + before) / step**2
        for bounds in (stretch.bounds(1.0), stretch.bounds(1.0, is_hard=True)):
            assert (first * bounds.velocity <= limits.velocity * (1 + 1e-6)).all()
            used = second * bounds.velocity**2 + first * bounds.acceleration
            assert (used <= limits.acceleration * (1 + 1e-3)).all()


@pytest.mark.parametrize("shift", [(100, 0, 0), (0, 300, 0), (-150, 200, 100), (0, -1, 0)])
def test_lines(machine: MachineData, shift: tuple[float, float, float]) -> None:
    """The bounds of a line leave every axis within its limits, also between the samples."""
    curve = line(machine, shift)
    limits = axis_limits(machine)
    length = math.hypot(*shift)
    paths = (PathLimits(length, 3000.0, 10000.0),)
    bounds_hold(curve, curve_limits_of(curve, limits, limits, paths), machine)


def test_a_line_past_a_singularity(machine: MachineData) -> None:
    """Where axis 4 has to turn fast only the stretches beside it are slow, and the rest is not."""
    start = np.array([0.0, -90.0, 100.0, 40.0, 6.0, 0.0, 0.0])
    curve = line(machine, (-40.0, 150.0, 60.0), start)
    limits = axis_limits(machine)
    curve_limits = curve_limits_of(curve, limits, limits, (PathLimits(166.0, 2000.0, 5000.0),))
    speeds = [stretch.normal.velocity for stretch in curve_limits.stretches]
    assert max(speeds) > 3 * min(speeds)
    assert all(one.end == other.start for one, other in pairwise(curve_limits.stretches))
    bounds_hold(curve, curve_limits, machine)


def test_cutting_a_limits(machine: MachineData) -> None:
    """A part of a curve has the stretches between its ends, cut there."""
    curve = line(machine, (0, 300, 0))
    limits = axis_limits(machine)
    curve_limits = curve_limits_of(curve, limits, limits, (PathLimits(300.0, 500.0, 1000.0),))
    parts = curve_limits.between(0.2, 0.7)
    assert (0.2, 0.7) == (parts[0].start, parts[-1].end)
    assert () == curve_limits.between(0.5, 0.5)


def test_axes_along_a_pose_path_are_exact(machine: MachineData) -> None:
    """At any parameter the axes put the flange where the path says, in the way of the start."""
    curve = line(machine, (-150, 200, 100))
    u = np.random.default_rng(2).uniform(0, 1, 300)
    assert curve.pose_path is not None
    poses = poses_of(curve.pose_path, u)
    assert np.allclose(kinematics_of(machine).forward(curve.axes(u)[:, :6]), poses, atol=1e-9)
    rising = np.linspace(0, 1, 50)
    followed = follow(curve.arm, poses_of(curve.pose_path, rising), START[:6].tolist())
    assert np.allclose(followed, curve.axes(rising)[:, :6], atol=1e-9)


def test_derivatives_along_a_pose_path(machine: MachineData) -> None:
    """First and second derivatives are those of the axes, to a thousandth."""
    curve = line(machine, (-150, 200, 100))
    u, step = np.linspace(0.05, 0.95, 40), 1e-3
    before, here, behind = (curve.axes(u + shift) for shift in (-step, 0.0, step))
    first, second, _ = curve.rates(u)
    assert np.allclose((behind - before) / (2 * step), first, atol=1e-3 * np.abs(first).max())
    bend = (behind - 2 * here + before) / step**2
    assert np.allclose(bend, second, atol=1e-2 * np.abs(second).max())
