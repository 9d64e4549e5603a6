"""Set-points from a path to a robot, and the record of both."""

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from interp.port.requests import At
from interp.robot.arm import Motion, Position, Samples, Settings
from interp.robot.kinematics.kinematics_choice import kinematics_of
from interp.robot.kinematics.machine_data import MachineData
from interp.robot.kinematics.placement import Placement
from interp.robot.models import default_machine
from interp.robot.planning.planned_arm import PlannedArm
from interp.robot.simulation.factory import make_robot
from interp.robot.simulation.robot import KinematicRobot, Measured, NoRobot, RobotFault
from interp.robot.simulation.tracking import Tracking
from interp.values.poses import IDENTITY, Pose

START = (0.0, -90.0, 90.0, 0.0, 0.0, 0.0)


class Turning:
    """An arm whose axis 1 turns by a degree each millisecond; only what a robot needs of it."""

    def __init__(self) -> None:
        self.asked: list[int] = []
        self.kept = 0

    def position(self, time: int) -> Position:
        """The set-point."""
        return Position((time / 1_000.0, *START[1:]), IDENTITY)

    def sample(self, times: npt.NDArray[np.int64]) -> Samples:
        """Set-points; how many were asked for is kept."""
        self.asked.append(len(times))
        axes = np.tile(START, (len(times), 1))
        axes[:, 0] = times / 1_000.0
        return Samples(times, axes)

    def forget(self, time: int) -> None:
        """Note that this time and what comes after it will be asked for."""
        self.kept = time


class Lagging(KinematicRobot):
    """Measures half a degree less, until it fails."""

    step = 1_000
    chunk = 50_000

    def follow(self, samples: Samples) -> Any:
        """Half a degree less."""
        failing = samples.times >= 100_000
        if failing.any():
            raise RobotFault("collision", "a touches b", int(samples.times[np.argmax(failing)]))
        return Measured(samples.axes - 0.5, np.zeros_like(samples.axes))


@pytest.fixture
def arm() -> Any:
    return Turning()


def test_a_row_each_cycle(arm: Any) -> None:
    """The record has the start and each interpolation cycle, with the flange at axis angles."""
    tracking = Tracking(arm, KinematicRobot(12_000), default_machine(), 12_000, START)
    tracking.advance(40_000)
    assert [] == arm.asked
    tracking.settle(40_000)
    record = tracking.record()
    assert [0, 12_000, 24_000, 36_000] == record.times.tolist()
    assert [0.0, 12.0, 24.0, 36.0] == record.axes[:, 0].tolist()
    flange = Pose.from_matrix(kinematics_of(default_machine()).forward((36.0, *START[1:])).tolist())
    assert flange.components == pytest.approx(record.points[-1], abs=1e-9)
    assert record.axes_measured is None
    assert "t q1 q2 q3 q4 q5 q6 x y z a b c".split() == list(record.columns())


def test_external_axes_without_a_known_start(machine: MachineData) -> None:
    """They stand at 0 at first, in the record and for the robot, and have columns of their own."""
    arm = PlannedArm(machine, START)
    tracking = Tracking(arm, KinematicRobot(12_000), machine, 12_000, START)
    arm.plan(0, Motion(1, At("test.src", 1, 0), "PTP", Settings(), {"E1": 300.0}))
    tracking.settle(2_000_000)
    columns = tracking.record().columns()
    assert 0.0 == columns["e1"][0]
    assert 300.0 == pytest.approx(columns["e1"][-1])
    assert "t q1 q2 q3 q4 q5 q6 e1 x y z a b c".split() == list(columns)


def test_set_points_go_in_chunks(arm: Any) -> None:
    """They are asked for a second's worth at once, however often time goes on.

    What was asked for may be forgotten.
    """
    tracking = Tracking(arm, KinematicRobot(10_000), default_machine(), 10_000, START)
    for now in range(0, 2_500_000, 3_000):
        tracking.advance(now)
    assert ([100, 100], 2_000_000) == (arm.asked, arm.kept)
    tracking.settle(2_500_000)
    assert ([100, 100, 50], 2_500_000) == (arm.asked, arm.kept)


def test_points_in_the_frames_in_force(arm: Any) -> None:
    """From the time on that other frames are in force, points count in them."""
    tracking = Tracking(arm, KinematicRobot(12_000), default_machine(), 12_000, START)
    placement = Placement(base=Pose.of(100, 200, 300, 20, 10, 5), tool=Pose.of(z=50, b=30))
    tracking.placed(18_000, Placement(base=Pose.of(1.0)))
    tracking.placed(18_000, placement)
    tracking.settle(36_000)
    points = tracking.record().points
    flanges = kinematics_of(default_machine()).forward(tracking.record().axes)
    assert Pose.from_matrix(flanges[1]).components == pytest.approx(points[1], abs=1e-9)
    expected = placement.point(Pose.from_matrix(flanges[2])).components
    assert expected == pytest.approx(points[2], abs=1e-9)
    tip = (Pose.from_matrix(flanges[2]) @ placement.tool).position
    assert tip == pytest.approx(tracking.record().tips[2], abs=1e-9)


def test_measured_positions(arm: Any) -> None:
    """What a robot measures stands beside the set-points, and is known at any time."""
    tracking = Tracking(arm, Lagging(12_000), default_machine(), 12_000, START)
    assert 60.5 - 0.5 - 0.5 == tracking.measured(60_500)[0]
    record = tracking.record()
    assert record.axes_measured is not None
    assert [0.0, 11.5, 23.5, 35.5, 47.5, 59.5] == record.axes_measured[:, 0].tolist()
    assert "q1_meas" in record.columns()
    assert len(record.times) == len(record.columns()["c_meas"])


def test_a_fault_of_the_robot(arm: Any) -> None:
    """It is told when its chunk is sent, and the record ends before it."""
    tracking = Tracking(arm, Lagging(12_000), default_machine(), 12_000, START)
    with pytest.raises(RobotFault, match="a touches b"):
        tracking.advance(150_000)
    times = tracking.record().times
    assert 96_000 == times[-1]
    assert len(times) == len(tracking.record().columns()["q1_meas"])


def test_no_robot(arm: Any) -> None:
    """Without a robot no set-point is ever taken; the plan stands for what is measured."""
    tracking = Tracking(arm, NoRobot(), default_machine(), 12_000, START)
    tracking.settle(5_000_000)
    assert ([], 7.0) == (arm.asked, tracking.measured(7_000)[0])
    assert [0] == tracking.record().times.tolist()


def test_a_cycle_the_robot_cannot_keep(arm: Any) -> None:
    """The interpolation cycle is a multiple of the robot's step."""
    with pytest.raises(ValueError, match="no multiple"):
        Tracking(arm, Lagging(12_000), default_machine(), 12_500, START)


def test_robots_by_name() -> None:
    """A robot is made by its name; what a cycle is counts for the kinematic one."""
    machine = default_machine()
    assert (0, 4_000) == (
        make_robot("none", machine, 4_000).step,
        make_robot("kinematic", machine, 4_000).step,
    )
