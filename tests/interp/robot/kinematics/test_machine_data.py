"""Machine data: what it says about an arm, and what is said about it where it does not."""

import math
from collections.abc import Callable

import pytest

from interp.robot.kinematics.machine_data import AxisKind, CartesianLimits, MachineDataError
from interp.robot.kinematics.machine_reader import read_machine
from interp.values.poses import IDENTITY, Pose


def test_lengths_and_frames(machine_text: Callable[..., str]) -> None:
    """The chain of an arm is read as it is written."""
    machine = read_machine(machine_text("FRAME $ROBROOT={X 1.0,Y 2.0,Z 3.0,A 90.0,B 0.0,C 0.0}"))
    assert "TRY6R900 C4 FLR" == machine.name
    assert (25.0, 455.0) == (machine.length_a, machine.length_b)
    assert Pose.of(420, 0, 35, 0, 90, 0) == machine.tx3p3
    assert Pose.of(z=400) == machine.tiroro
    assert Pose.of(z=80) == machine.tflwp
    assert Pose.of(1, 2, 3, a=90) == machine.robroot
    assert [-1, 1, 1, -1, -1, -1] == [axis.direction for axis in machine.axes]
    assert (-190.0, 45.0) == (machine.axes[1].lower, machine.axes[1].upper)
    assert ["A1", "A2", "A3", "A4", "A5", "A6"] == [axis.name for axis in machine.axes]


def test_what_is_not_said(machine_text: Callable[..., str]) -> None:
    """Speeds may be missing; frames and limits of the path have their usual values."""
    machine = read_machine(machine_text())
    assert [None] * 6 == [axis.dynamics for axis in machine.axes]
    assert IDENTITY == machine.robroot
    assert CartesianLimits(3.0, 400.0, 400.0) == machine.velocity
    assert CartesianLimits(10.0, 1000.0, 1000.0) == machine.acceleration
    assert (0, 0, 0) == machine.singul_pos
    assert () == machine.externals


def test_speed_follows_from_motor_and_gear(machine_text: Callable[..., str]) -> None:
    """4500 rpm over a gear of 1798/7 are 105 degrees a second, whatever its sign [MOT-06]."""
    lines = "$VEL_AXIS_MA[1]=4500.0", "$RAT_MOT_AX[1]={N -1798,D 7}"
    dynamics = read_machine(machine_text(*lines)).axes[0].dynamics
    assert dynamics is not None
    assert 105.1 == pytest.approx(dynamics.velocity, abs=0.05)


def test_run_up_time(machine_text: Callable[..., str]) -> None:
    """$RAISE_TIME and the filter, in ms, make acceleration and jerk of the speed."""
    lines = "$VEL_AXIS_MA[1]=3000.0", "$RAT_MOT_AX[1]={N 100,D 1}"
    more = "$RAISE_TIME[1]=500.0", "INT $DEF_FLT_PTP=200"
    dynamics = read_machine(machine_text(*lines, *more)).axes[0].dynamics
    assert dynamics is not None
    found = dynamics.velocity, dynamics.acceleration, dynamics.jerk
    assert (180.0, 360.0, 1800.0) == pytest.approx(found)


def test_jerk(machine_text: Callable[..., str]) -> None:
    """Where the data has the jerk, speed is reached on average as fast as that allows."""
    lines = "$VEL_AXIS_MA[1]=3000.0", "$RAT_MOT_AX[1]={N 100,D 1}", "$AXIS_JERK[1]=18000.0"
    dynamics = read_machine(machine_text(*lines)).axes[0].dynamics
    assert dynamics is not None
    assert 18000.0 == dynamics.jerk
    assert math.sqrt(180.0 * 18000.0) / 2 == pytest.approx(dynamics.acceleration)


def test_a_linear_external_axis(machine_text: Callable[..., str]) -> None:
    """Its gear is in revolutions a metre of travel, its limits are mm."""
    lines = (
        *("INT $EX_AX_NUM=2", "$AXIS_TYPE[7]=1", "$AXIS_TYPE[8]=5"),
        *("$VEL_AXIS_MA[7]=3000.0", "$RAT_MOT_AX[7]={N 25,D 1}"),
        *("$SOFTN_END[7]=-100.0", "$SOFTP_END[7]=4000.0", "$SOFTN_END[8]=1.0", "$SOFTP_END[8]=2.0"),
    )
    track, table = read_machine(machine_text(*lines)).externals
    assert ("E1", AxisKind.LINEAR, -100.0, 4000.0) == (
        *(track.name, track.kind),
        *(track.lower, track.upper),
    )
    assert track.dynamics is not None
    assert 2000.0 == pytest.approx(track.dynamics.velocity)
    assert (AxisKind.ENDLESS, -math.inf, math.inf) == (table.kind, table.lower, table.upper)


def test_where_axes_without_a_start_stand(machine_text: Callable[..., str]) -> None:
    """At 0, or at the software limit nearest to it."""
    lines = ("INT $EX_AX_NUM=2", "$SOFTN_END[7]=150.0", "$SOFTP_END[7]=4000.0")
    machine = read_machine(machine_text(*lines))
    told = (1.0, 2.0, 3.0, 4.0, 5.0, 6.0)
    assert (*told, 150.0, 0.0) == machine.standing(told)
    assert (*told, 700.0, 8.0) == machine.standing((*told, 700.0, 8.0, 9.0))


def test_limits_that_are_none(machine_text: Callable[..., str]) -> None:
    """Two software limits that leave no room are not in use."""
    axis = read_machine(machine_text("$SOFTN_END[4]=0.0", "$SOFTP_END[4]=0.0")).axes[3]
    assert (-math.inf, math.inf) == (axis.lower, axis.upper)


@pytest.mark.parametrize(("up", "elbow"), [(0.0, 0.0), (35.0, 4.763642), (-41.0, -5.575494)])
def test_the_stretched_elbow(machine_text: Callable[..., str], up: float, elbow: float) -> None:
    """An offset between A3 and A4 shifts the angle at which the arm is stretched [POS-04]."""
    line = f"FRAME $TX3P3={{X 420.0,Y 0.0,Z {up},A 0.0,B 90.0,C 0.0}}"
    assert elbow == pytest.approx(read_machine(machine_text(line)).elbow, abs=1e-6)


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("$AXIS_DIR[3]=0", "$AXIS_DIR[3] is 0, not 1 or -1"),
        ("$SOFTN_END[1]=171.0", "$SOFTN_END[1] is above $SOFTP_END[1]"),
        ("$AXIS_TYPE[2]=7", "$AXIS_TYPE[2] is 7, not 1, 3 or 5"),
        ("$AXIS_TYPE[2]=1", "$AXIS_TYPE[2] is 1"),
        ("$LENGTH_B=TRUE", "$LENGTH_B is not a number"),
        ("$LENGTH_B=1E999", "$LENGTH_B is too large a number"),
        ("$LENGTH_B=" + "9" * 400, "$LENGTH_B is too large a number"),
        ("$TX3P3=1.0", "$TX3P3 is not an aggregate"),
        ("$TX3P3={X #A}", "$TX3P3.X is not a number"),
        ("DECL MAIN_AXIS $MAIN_AXIS=#SS", "$MAIN_AXIS is #SS; only an articulated arm"),
        ("INT $TRAFO_AXIS=4", "$TRAFO_AXIS is 4; only an arm of six axes"),
        ("$AXIS_SEQ[2]=3", "$AXIS_SEQ[2] exchanges axes"),
    ],
)
def test_what_is_no_arm(machine_text: Callable[..., str], line: str, said: str) -> None:
    """One line names the file, the line, the datum and what is wrong with it."""
    text = machine_text(line)
    with pytest.raises(MachineDataError) as caught:
        read_machine(text, "m.dat")
    number = text.splitlines().index(line) + 1
    assert str(caught.value).startswith(f"m.dat:{number}: {said}")


def test_data_of_the_cabinet() -> None:
    """The $machine.dat of STEU describes no arm, and the message says where the other one lies."""
    with pytest.raises(MachineDataError, match="R1/Mada"):
        read_machine("DEFDAT $MACHINE PUBLIC\nSIGNAL $T1 $OUT[13]\nENDDAT\n")


def test_a_frame_that_is_missing(machine_text: Callable[..., str]) -> None:
    """Without a frame of the chain there is no arm."""
    text = machine_text().replace("$TFLWP", "$OTHER")
    with pytest.raises(MachineDataError, match=r"\$TFLWP is missing"):
        read_machine(text)
