"""The simulated arm: how well it follows, and how it stops where it cannot."""

from collections.abc import Callable

import numpy as np
import numpy.typing as npt
import pytest

from interp.robot.api.commands import Transaction
from interp.robot.api.control_core import ControlCore
from interp.robot.api.motions import MotionFactory
from interp.robot.arm import Samples, Settings
from interp.robot.kinematics.kinematics_choice import kinematics_of
from interp.robot.kinematics.machine_reader import read_machine
from interp.robot.kinematics.solution_choice import follow, solve
from interp.robot.models import default_machine
from interp.robot.simulation.cell import Cell
from interp.robot.simulation.factory import make_robot
from interp.robot.simulation.robot import RobotFault
from interp.robot.simulation.tracking import Tracking
from interp.values.poses import Pose

pytest.importorskip("mujoco")
pytest.importorskip("ruckig")
pytest.importorskip("scipy")

from interp.robot.planning.planned_arm import PlannedArm
from interp.robot.simulation.mujoco import MujocoRobot

Array = npt.NDArray[np.float64]
HOME = (0.0, -70.0, 100.0, 0.0, 30.0, 0.0)


def samples_of(axes: Array, start: int = 0) -> Samples:
    """Set-points 1 ms apart; the robot looks at their places only."""
    times = start + 1_000 * np.arange(1, len(axes) + 1, dtype=np.int64)
    return Samples(times, axes)


def smooth(count: int) -> Array:
    """From 0 to 1 with speed and acceleration 0 at both ends; at most 1.875 / count a step."""
    share: Array = np.arange(1, count + 1) / count
    return 6 * share**5 - 15 * share**4 + 10 * share**3


def line(along: float, milliseconds: int) -> tuple[tuple[float, ...], Array, Array]:
    """Start, axes and flanges of a straight line of so many mm along Y, with HOME in its middle."""
    arm = kinematics_of(default_machine())
    poses = np.repeat(arm.forward(np.array(HOME))[None], milliseconds, axis=0)
    first = poses[0].copy()
    first[1, 3] -= along / 2
    poses[:, 1, 3] += (smooth(milliseconds) - 0.5) * along
    start = solve(arm, Pose.from_matrix(first), start=HOME).axes
    return start, follow(arm, poses, start), poses


def test_it_stands_against_gravity() -> None:
    """Told to stay where it is for a second, stretched forward, it does."""
    robot = MujocoRobot(Cell(default_machine()))
    robot.stand((0.0,) * 6)
    measured = robot.follow(samples_of(np.zeros((1000, 6)))).axes
    assert np.abs(measured).max() < 1e-6


def test_the_size_of_a_chunk_does_not_matter_much() -> None:
    """Gains follow the arm a chunk at a time; where it is differs by less than the tracking."""
    start, axes, _ = line(200.0, 600)
    ends = []
    for size in (60, 600):
        robot = MujocoRobot(Cell(default_machine()))
        robot.stand(start)
        for at in range(0, 600, size):
            robot.follow(samples_of(axes[at : at + size], 1_000 * at))
        ends.append(robot.axes)
    np.testing.assert_allclose(ends[0], ends[1], atol=1e-3)


@pytest.mark.parametrize(
    "carried",
    [(), ("DECL EX_KIN $EX_KIN={ET1 #ERSYS}", "DECL ET_AX $ET1_AX={TR_A1 #E1}")],
    ids=["beside", "below"],
)
def test_external_axes_follow(machine_text: Callable[..., str], carried: tuple[str, ...]) -> None:
    """A track follows in mm, beside the arm and below it."""
    machine = read_machine(machine_text("INT $EX_AX_NUM=1", "$AXIS_TYPE[7]=1", *carried))
    robot = MujocoRobot(Cell(machine))
    robot.stand((*HOME, 100.0))
    axes = np.tile((*HOME, 100.0), (500, 1))
    axes[:, 6] += 400.0 * smooth(500)
    measured = robot.follow(samples_of(axes)).axes
    assert 500.0 == pytest.approx(measured[-1, 6], abs=0.05)
    np.testing.assert_allclose(measured[:, :6], axes[:, :6], atol=1e-3)


@pytest.mark.parametrize("name", ["kinematic", "mujoco"])
def test_a_set_point_that_is_no_number(name: str) -> None:
    """NaN is a fault at its time, and never reaches the arm."""
    robot = make_robot("mujoco" if name == "mujoco" else "kinematic", default_machine(), 12_000)
    axes = np.tile(HOME, (10, 1))
    robot.stand(HOME)
    robot.follow(samples_of(axes))
    axes[3, 2] = np.nan
    with pytest.raises(RobotFault, match="no number") as caught:
        robot.follow(samples_of(axes, 10_000))
    assert 14_000 == caught.value.time


def test_a_jump_is_a_fault() -> None:
    """Set-points that leap 90 degrees in a step are followed by no arm."""
    robot = MujocoRobot(Cell(default_machine()))
    robot.stand(HOME)
    axes = np.tile(HOME, (200, 1))
    axes[100:, 0] = 90.0 * (-1.0) ** np.arange(100)
    with pytest.raises(RobotFault, match="does not follow") as caught:
        robot.follow(samples_of(axes))
    assert "tracking" == caught.value.slug


def test_any_path_up_to_a_metre_a_second() -> None:
    """Where the tool is no faster than 1 m/s it is within 0.05 mm, on the way of fast axes too."""
    machine = default_machine()
    motions = MotionFactory(Settings(velocity=1.0, acceleration=5.0))
    home = (0.0, -90.0, 90.0, 0.0, 90.0, 0.0)
    arm = PlannedArm(machine, home)
    core = ControlCore(arm, lambda *_: None, 12_000)
    tracking = Tracking(arm, MujocoRobot(Cell(machine)), machine, 12_000, home)
    work = [
        motions.ptp(a1=-90, a2=-60, a3=90, a4=90, a5=60, a6=200),
        motions.ptp(a1=-30, a2=-90, a3=90, a4=0, a5=90, a6=0),
        motions.lin(x=450, y=-350, z=500),
        motions.lin(y=350, criteria=["C_DIS"]),
        motions.ptp(a1=90, a2=-120, a3=120, a4=-90, a6=-200),
    ]
    core.load(0, Transaction(*work))
    while (time := core.next_time()) is not None:
        core.run_until(time)
        tracking.advance(time)
    tracking.settle(core.now)
    record = tracking.record()
    assert record.tips_measured is not None
    steps = np.linalg.norm(np.diff(record.tips, axis=0), axis=1) / 12.0
    off = np.linalg.norm(record.tips - record.tips_measured, axis=1)[1:]
    assert steps.max() > 1.2
    assert 0.01 < off[steps <= 1.0].max() < 0.05


def test_rest_is_not_simulated(monkeypatch: pytest.MonkeyPatch) -> None:
    """An arm that has settled stays in place under the torques that hold it, and moves on."""
    robot = MujocoRobot(Cell(default_machine()))
    robot.stand(HOME)
    there = np.array(HOME) + smooth(400)[:, None] * np.array([5.0, 4.0, 3.0, 2.0, 1.0, 6.0])
    still = np.tile(there[-1], (500, 1))
    robot.follow(samples_of(there))
    settled = robot.follow(samples_of(still))
    with monkeypatch.context() as patched:
        patched.setattr("interp.robot.simulation.mujoco.rollout", None)
        rest = robot.follow(samples_of(still))
    back = robot.follow(samples_of(there[::-1]))
    np.testing.assert_allclose(rest.axes, still, atol=1e-6)
    np.testing.assert_allclose(rest.torques, settled.torques[-100:][[-1] * 500], atol=1e-6)
    assert np.abs(back.axes - there[::-1]).max() < 0.01
