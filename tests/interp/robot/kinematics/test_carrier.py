"""Robots on linear units and turning tables: what external axes carry them to."""

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from grammar.syntax.source import Source
from interp.port.requests import At
from interp.program.load import load
from interp.robot.arm import Motion, Settings
from interp.robot.kinematics.machine_data import MachineData, MachineDataError
from interp.robot.kinematics.machine_reader import read_machine
from interp.robot.kinematics.placement import Placement
from interp.session import RunSetup, run_program
from interp.values.poses import Pose

pytest.importorskip("ruckig")
pytest.importorskip("scipy")

from interp.robot.planning.planned_arm import PlannedArm

UNIT = (
    "INT $EX_AX_NUM=2",
    "$AXIS_TYPE[7]=1",
    "$SOFTN_END[7]=-3000.0",
    "$SOFTP_END[7]=3000.0",
    "DECL EX_KIN $EX_KIN={ET1 #ERSYS,ET2 #NONE,ET3 #NONE,ET4 #NONE,ET5 #NONE,ET6 #NONE}",
    "DECL ET_AX $ET1_AX={TR_A1 #E1,TR_A2 #NONE,TR_A3 #NONE}",
    "FRAME $ERSYSROOT={X 100.0,Y 200.0,Z 0.0,A 90.0,B 0.0,C 0.0}",
    "FRAME $ET1_TA1KR={X 0.0,Y 0.0,Z 450.0,A 0.0,B 90.0,C 0.0}",
    "FRAME $ET1_TFLA3={X 0.0,Y 0.0,Z 0.0,A 0.0,B -90.0,C 0.0}",
)
"""A linear unit that slides along its own X, which lies along the Y of the world."""
START = (0.0, -90.0, 100.0, 0.0, 60.0, 0.0, 0.0, 0.0)


@pytest.fixture(scope="module")
def unit(machine_text: Callable[..., str]) -> MachineData:
    return read_machine(machine_text(*UNIT))


def test_a_linear_unit_slides(unit: MachineData) -> None:
    """The foot moves along the axis of the unit and keeps its orientation."""
    foot = Pose.of(100, 200, 450, a=90)
    assert foot.components == pytest.approx(unit.foot((0.0, 0.0)).components)
    moved = unit.foot((500.0, 0.0)).components
    assert (foot @ Pose.of(x=500)).components == pytest.approx(moved)


def test_axes_behind_one_another(machine_text: Callable[..., str]) -> None:
    """A turning table on a slide: each turns or slides by the Z of its own frame, in order."""
    lines = (*UNIT[:5], "DECL ET_AX $ET1_AX={TR_A1 #E1,TR_A2 #E2}", "FRAME $ET1_TA2A1={X 70.0}")
    machine = read_machine(machine_text(*lines, "FRAME $ET1_TA3A2={Y 5.0}", "$AXIS_DIR[8]=-1"))
    expected = Pose.of(z=300) @ Pose.of(x=70) @ Pose.of(a=-40) @ Pose.of(y=5)
    assert expected.components == pytest.approx(machine.foot((300.0, 40.0)).components)


@pytest.mark.parametrize("named", ["{TR_A1 #E3}", "{TR_A1 #NONE}", "{TR_A1 #E1,TR_A2 #E1}"])
def test_axes_that_are_not_there(machine_text: Callable[..., str], named: str) -> None:
    """A system of axes that the machine does not have is one line with its place."""
    text = machine_text(*UNIT, f"DECL ET_AX $ET1_AX={named}")
    line = len(text.splitlines()) - 1
    with pytest.raises(MachineDataError, match=rf"m.dat:{line}: \$ET1_AX names no axes"):
        read_machine(text, "m.dat")


def travelled(
    machine: MachineData, kind: str, target: dict[str, float], **others: str
) -> tuple[np.ndarray, np.ndarray]:
    """Axes along a motion, and where the tool is in the base."""
    arm = PlannedArm(machine, START)
    base = Pose.of(300, 900, 500, a=30)
    placement = Placement(base, Pose.of(z=120), machine.robroot, carrier=machine.carrier)
    settings = Settings(placement=placement, **others)  # type: ignore[arg-type]
    arm.plan(0, Motion(1, At("t.src", 1, 0), kind, settings, target, is_relative=True))
    end = 0
    while arm.next_event() is not None:
        end = arm.take().time
    axes = arm.sample(np.linspace(0, end, 60).astype(np.int64)).axes
    feet = [placement.at(row[6:].tolist()) for row in axes]
    flanges = (arm.position(int(time)).flange for time in np.linspace(0, end, 60))
    points = [at.point(flange).components for at, flange in zip(feet, flanges, strict=True)]
    return axes, np.array(points)


@settings(max_examples=12)
@given(
    slide=st.integers(-400, 400),
    x=st.integers(-60, 60),
    z=st.integers(-60, 60),
    orientation=st.sampled_from(("#VAR", "#JOINT")),
)
def test_a_line_stays_straight_while_the_robot_rides(
    unit: MachineData, slide: int, x: int, z: int, orientation: str
) -> None:
    """LIN with E1: the tool goes straight in the base to 1 µm, whatever the unit does."""
    # The unit goes along the line, so that the arm does not have to reach farther.
    target = {"X": float(x), "Y": 40.0, "Z": float(z), "E1": float(slide) / 4.0}
    axes, points = travelled(unit, "LIN", target, orientation=orientation)
    assert axes[-1, 6] - axes[0, 6] == pytest.approx(slide / 4.0)
    assert points[-1, :3] - points[0, :3] == pytest.approx((x, 40.0, z), abs=1e-5)
    way = points[-1, :3] - points[0, :3]
    off = np.cross(points[:, :3] - points[0, :3], way / np.linalg.norm(way))
    assert np.abs(off).max() < 1e-3


def test_the_tool_stands_still_while_only_the_unit_moves(unit: MachineData) -> None:
    """LIN_REL {E1 150}: the robot makes up for what its foot travels."""
    axes, points = travelled(unit, "LIN", {"E1": 150.0})
    assert 150.0 == pytest.approx(axes[-1, 6] - axes[0, 6])
    np.testing.assert_allclose(points[:, :3], [points[0, :3]] * 60, atol=1e-4)
    assert np.abs(axes[-1, :6] - axes[0, :6]).max() > 1.0


def test_a_ptp_reaches_its_point_on_the_unit(unit: MachineData) -> None:
    """PTP to a point and E1 ends at that point in the base."""
    axes, points = travelled(unit, "PTP", {"X": 20.0, "Y": 30.0, "Z": -10.0, "E1": 100.0})
    assert 100.0 == pytest.approx(axes[-1, 6] - axes[0, 6])
    assert points[-1, :3] - points[0, :3] == pytest.approx((20.0, 30.0, -10.0), abs=1e-5)


TABLE = (
    "INT $EX_AX_NUM=1",
    "DECL EX_KIN $EX_KIN={ET1 #EASYS,ET2 #NONE}",
    "DECL ET_AX $ET1_AX={TR_A1 #E1,TR_A2 #NONE}",
    "FRAME $ET1_TFLA3={X 0.0,Y 0.0,Z 60.0,A 0.0,B 0.0,C 0.0}",
)
"""A turntable that E1 turns about its Z."""
ON_TABLE = """DEF CELL()
DECL FRAME root, offset
$TOOL={X 0,Y 0,Z 100,A 0,B 0,C 0}
$BASE=$NULLFRAME
PTP {A1 0,A2 -90,A3 100,A4 0,A5 60,A6 0,E1 0}
root={X 500,Y 0,Z 300,A 0,B 0,C 0}
offset={X 100,Y 0,Z 0,A 0,B 0,C 0}
$BASE=EK(root,#EASYS,offset)
LIN {X 0,Y 0,Z 150,A 0,B 90,C 0,E1 0}
LIN {E1 40}
END
"""


def test_a_base_on_a_turntable(machine_text: Callable[..., str]) -> None:
    """With $BASE=EK(...) the tool rides on the table: still in the base, on an arc in the world."""
    machine = read_machine(machine_text(*TABLE))
    program = load([Source(ON_TABLE, "cell.src")], "cell.src")
    ran = run_program(program, RunSetup(robot="kinematic", machine=machine))
    assert "end" == ran.outcome.ending, ran.outcome.error
    assert ran.path is not None
    rows = ran.path.axes[:, 6] > 0.0
    assert rows.sum() > 20
    points, tips = ran.path.points[rows], ran.path.tips[rows]
    np.testing.assert_allclose(points[:, :3], [(0.0, 0.0, 150.0)] * len(points), atol=1e-2)
    angles = np.radians(ran.path.axes[rows, 6])
    arc = np.stack((500.0 + 100.0 * np.cos(angles), 100.0 * np.sin(angles)), axis=1)
    np.testing.assert_allclose(tips[:, :2], arc, atol=1e-2)
    np.testing.assert_allclose(tips[:, 2], 300.0 + 60.0 + 150.0, atol=1e-2)
