"""Axes to poses and back: against the chain of the machine data, and on a great many poses."""

import math
import os
from collections.abc import Callable

import numpy as np
import pytest

from interp.robot.kinematics.central_wrist import CentralWrist
from interp.robot.kinematics.kinematics import Array, Kinematics, matrix_of
from interp.robot.kinematics.kinematics_choice import kinematics_of
from interp.robot.kinematics.machine_data import MachineData, MachineDataError
from interp.robot.kinematics.machine_reader import read_machine
from interp.values.poses import IDENTITY, Pose

MakeArm = Callable[..., Kinematics]

MANY = int(os.environ.get("KRL_ARM_POSES", "10000"))  # 100,000 where it is worth a few seconds
OTHERS = {
    "trough": ("FRAME $TX3P3={X 420.0,Y 0.0,Z -41.0,A 0.0,B 90.0,C 0.0}",),
    "intersecting": ("FRAME $TX3P3={X 420.0,Y 0.0,Z 0.0,A 0.0,B 90.0,C 0.0}",),
    "aside": ("FRAME $TX3P3={X 420.0,Y 30.0,Z 35.0,A 0.0,B 90.0,C 0.0}",),
    "wrist turned": ("FRAME $TX3P3={X 420.0,Y 0.0,Z 35.0,A 90.0,B 60.0,C 90.0}",),
    "axis 4 backward": ("FRAME $TX3P3={X 420.0,Y 0.0,Z 35.0,A 0.0,B -90.0,C 0.0}",),
    "other twist": ("$DH_4={DHART_ALPHA -90.0}", "$DH_5={DHART_ALPHA 90.0}"),
    "mathematical senses": tuple(f"$AXIS_DIR[{i}]=1" for i in range(1, 7)),
    "reversed senses": tuple(f"$AXIS_DIR[{i}]=-1" for i in range(1, 7)),
    "foot and flange askew": (
        "FRAME $TIRORO={X 10.0,Y 20.0,Z 400.0,A 10.0,B 20.0,C 30.0}",
        "FRAME $TFLWP={X 5.0,Y -3.0,Z 80.0,A -40.0,B 15.0,C 70.0}",
    ),
}


def chain(machine: MachineData, axes: list[float]) -> Pose:
    """The chain of the machine data, frame by frame."""
    a1, a2, a3, a4, a5, a6 = (
        axis.direction * value for axis, value in zip(machine.axes, axes, strict=True)
    )
    return (
        machine.tiroro
        @ Pose.of(a=a1)
        @ Pose.of(machine.length_a)
        @ Pose.of(b=a2)
        @ Pose.of(machine.length_b)
        @ Pose.of(b=a3)
        @ machine.tx3p3
        @ Pose.of(a=a4)
        @ Pose.of(c=machine.dh_4.alpha)
        @ Pose.of(a=a5)
        @ Pose.of(c=machine.dh_5.alpha)
        @ Pose.of(a=a6)
        @ machine.tflwp
    )


def limits(arm: Kinematics) -> tuple[Array, Array]:
    axes = arm.machine.axes
    return np.array([axis.lower for axis in axes]), np.array([axis.upper for axis in axes])


def random_axes(arm: Kinematics, count: int, seed: int = 7) -> Array:
    """Axes spread over all that the software limits allow."""
    return np.random.default_rng(seed).uniform(*limits(arm), (count, 6))


def whole_turns_off(ways: Array, axes: Array) -> Array:
    """How far ways ``(n, 8, 6)`` are from axes ``(n, 6)``, whole turns aside; inf for none."""
    difference = np.abs((ways - axes[:, None] + 180.0) % 360.0 - 180.0).max(axis=-1)
    return np.where(np.isnan(difference), math.inf, difference)


def errors(arm: Kinematics, poses: Array, ways: Array) -> tuple[float, float]:
    """How far the ways miss their poses: the worst position in m, the worst rotation."""
    missed = np.abs(arm.forward(ways) - poses[:, None])
    return float(np.nanmax(missed[..., :3, 3])) / 1000.0, float(np.nanmax(missed[..., :3, :3]))


@pytest.mark.parametrize("lines", [(), *OTHERS.values()], ids=["usual", *OTHERS])
def test_forward_is_the_chain(make_arm: MakeArm, lines: tuple[str, ...]) -> None:
    """Forward kinematics is the chain of the machine data, whatever its senses and frames."""
    arm = make_arm(*lines)
    axes = random_axes(arm, 50)
    expected = np.array([chain(arm.machine, row).matrix for row in axes.tolist()])
    assert np.allclose(expected, arm.forward(axes), rtol=0, atol=1e-9)


def test_published_dimensions(arm: Kinematics) -> None:
    """With the upper arm upright and the forearm level, the flange is where the data sheet says."""
    x, y, z, a, b, c = Pose.from_matrix(arm.forward([0, -90, 90, 0, 0, 0]).tolist()).components
    assert (525, 0, 890, 0, 90, 0) == pytest.approx((x, y, z, a, b, c), abs=1e-9)
    x, _, z = Pose.from_matrix(arm.forward([0] * 6).tolist()).position
    assert (25 + 455 + 420 + 80, 435) == pytest.approx((x, z))


@pytest.mark.parametrize(
    ("axis", "along", "sign"), [(0, 1, -1), (1, 2, -1), (2, 2, -1), (4, 2, -1)]
)
def test_senses_of_rotation(arm: Kinematics, axis: int, along: int, sign: int) -> None:
    """Positive angles turn axis 1 clockwise from above, and axes 2, 3 and 5 downward."""
    home = np.array([0.0, -90.0, 90.0, 0.0, 0.0, 0.0])
    moved = home.copy()
    moved[axis] += 10.0
    step = arm.forward(moved)[along, 3] - arm.forward(home)[along, 3]
    assert sign == np.sign(step)


@pytest.mark.parametrize("axis", [3, 5])
def test_senses_of_the_hand(arm: Kinematics, axis: int) -> None:
    """Positive angles turn axes 4 and 6 against the sense of a screw along the forearm."""
    axes = [0.0, -90.0, 90.0, 0.0, 0.0, 0.0]
    axes[axis] = 10.0
    turned = Pose.of(c=-10) @ Pose.of(b=90)
    assert np.allclose(matrix_of(turned)[:3, :3], arm.forward(axes)[:3, :3], atol=1e-12)


def test_there_and_back_on_many_poses(arm: Kinematics) -> None:
    """All ways reach their poses, and Status and software limits leave the one that was taken."""
    axes = random_axes(arm, MANY)
    poses = arm.forward(axes)
    ways = arm.inverse(poses)
    position, rotation = errors(arm, poses, ways)
    assert position < 1e-9
    assert rotation < 1e-12
    lower, upper = limits(arm)
    turns = ways + 360.0 * np.arange(-1, 2)[:, None, None, None]
    possible = ((turns >= lower - 1e-6) & (turns <= upper + 1e-6)).any(axis=0).all(axis=-1)
    chosen = possible & (arm.status(ways) == arm.status(axes)[:, None])
    assert (1 == chosen.sum(axis=1)).all()
    off = whole_turns_off(ways, axes)[np.arange(MANY), chosen.argmax(axis=1)]
    assert off.max() < 1e-5
    assert np.median(off) < 1e-11


@pytest.mark.parametrize("lines", OTHERS.values(), ids=list(OTHERS))
def test_there_and_back_on_other_arms(make_arm: MakeArm, lines: tuple[str, ...]) -> None:
    """Arms of other shapes, wrists and senses are solved as well."""
    arm = make_arm(*lines)
    axes = random_axes(arm, 2_000)
    poses = arm.forward(axes)
    ways = arm.inverse(poses)
    position, rotation = errors(arm, poses, ways)
    assert position < 1e-9
    assert rotation < 1e-12
    assert whole_turns_off(ways, axes).min(axis=1).max() < 1e-5


@pytest.mark.parametrize("a5", [0.0, 1e-9, -1e-7, 1e-5, -1e-3, 0.1])
@pytest.mark.parametrize("main", [(10, -90, 90), (166.67, -76.94, -40.92), (0, 0, 0)])
def test_a_straight_wrist(arm: Kinematics, main: tuple[float, ...], a5: float) -> None:
    """Near and at A5 = 0 the pose is met exactly; where the wrist is straight, A4 is 0."""
    poses = arm.forward([[*main, 30.0, a5, 40.0]])
    ways = arm.inverse(poses)
    position, rotation = errors(arm, poses, ways)
    assert position < 1e-9
    assert rotation < 1e-14
    best = ways[0, np.nanargmin(np.abs(ways[0, :, :3] - main).max(axis=1))]
    if a5 == 0.0:
        assert (0.0, 0.0, 70.0) == pytest.approx(best[3:], abs=1e-9)
    assert main == pytest.approx(best[:3], abs=1e-4)


@pytest.mark.parametrize("shoulder", [0.0, -160.0])
@pytest.mark.parametrize("lines", [(), OTHERS["aside"]], ids=["usual", "aside"])
def test_a_stretched_arm(make_arm: MakeArm, lines: tuple[str, ...], shoulder: float) -> None:
    """The end of the reach is within reach, in front of axis 1 and behind it."""
    arm = make_arm(*lines)
    axes = np.array(
        [[a1, shoulder, arm.machine.elbow, 20.0, 30.0, 40.0] for a1 in range(-170, 170)]
    )
    poses = arm.forward(axes)
    ways = arm.inverse(poses)
    off = whole_turns_off(ways, axes)
    assert ((off < 0.01).sum(axis=1) == 2).all()
    position, rotation = errors(arm, poses, ways)
    assert position < 1e-9
    assert rotation < 1e-12


def test_the_wrist_above_axis_1(arm: Kinematics) -> None:
    """With the wrist on axis 1 that axis is free, and taken as 0."""
    machine = arm.machine
    forearm = math.hypot(*machine.tx3p3.position)
    level = (machine.length_b * math.cos(math.radians(60)) - machine.length_a) / forearm
    axes = [40.0, -120.0, 120 + machine.elbow - math.degrees(math.acos(level)), 10.0, 20.0, 30.0]
    assert float(arm.distance_to_axis_1(axes)) < 1e-9
    pose = arm.forward(axes)
    ways = arm.inverse(pose)
    assert {0.0, 180.0} == set(ways[:, 0])
    position, rotation = errors(arm, pose[None], ways[None])
    assert position < 1e-9
    assert rotation < 1e-14


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, 1e300, 1e12])
def test_poses_that_are_none(arm: Kinematics, value: float) -> None:
    """No way leads to what is no number or out of this world, and the other poses are solved."""
    poses = np.array([matrix_of(IDENTITY), arm.forward([0, -90, 90, 0, 45, 0])])
    poses[0, 0, 3] = value
    ways = arm.inverse(poses)
    assert np.isnan(ways[0]).all()
    assert not np.isnan(ways[1]).all()


def test_poses_out_of_reach(arm: Kinematics) -> None:
    """Too far away, and too near for a forearm that is shorter than the upper arm."""
    far, near = Pose.of(2000, 0, 400), Pose.of(1, 0, 400) @ arm.machine.tflwp
    ways = arm.inverse(np.array([matrix_of(far), matrix_of(near)]))
    assert np.isnan(ways).all()


def test_shapes_are_kept(arm: Kinematics) -> None:
    """Batches of any shape go in and come out."""
    axes = random_axes(arm, 6).reshape(2, 3, 6)
    assert (2, 3, 4, 4) == arm.forward(axes).shape
    assert (2, 3, 8, 6) == arm.inverse(arm.forward(axes)).shape
    assert (2, 3) == arm.status(axes).shape
    assert (0, 8, 6) == arm.inverse(np.empty((0, 4, 4))).shape


def test_status_of_an_elbow_without_offset(make_arm: MakeArm) -> None:
    """Where A3 and A4 intersect, bit 1 is set from A3 = 0 on [POS-04]."""
    arm = make_arm(*OTHERS["intersecting"])
    assert [0, 2, 2] == arm.status([[0, -90, a3, 0, 1, 0] for a3 in (-0.001, 0, 0.001)]).tolist()


@pytest.mark.parametrize(
    "line",
    [
        "$DH_4={DHART_A 1.0,DHART_ALPHA 90.0}",
        "$DH_5={DHART_ALPHA -80.0}",
        "$DH_5={DHART_ALPHA 90.0}",
        "$TX3P3={X 420.0,B 80.0}",
    ],
)
def test_wrists_that_are_not_central(machine_text: Callable[..., str], line: str) -> None:
    """A wrist of another kind is refused rather than solved wrongly."""
    machine = read_machine(machine_text(line))
    assert not machine.is_wrist_central
    with pytest.raises(MachineDataError, match="not central"):
        CentralWrist(machine)


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("$LENGTH_B=0.0", "LENGTH_B is 0: the arm has no upper arm"),
        ("$LENGTH_B=-5.0", "LENGTH_B is -5: the arm has no upper arm"),
        ("$LENGTH_A=1.0E200", r"LENGTH_A has a length of 1e\+200 mm"),
        ("$DH_5={DHART_D 1.0E30}", r"DH_5 has a length of 1e\+30 mm"),
        ("$TX3P3={X 0.0,Y 9.0,Z 0.0,A 0.0,B 90.0,C 0.0}", "the arm has no forearm"),
    ],
)
def test_lengths_of_no_arm(machine_text: Callable[..., str], line: str, said: str) -> None:
    """An arm that could reach nothing, or whose reach cannot be computed, is told by one line."""
    with pytest.raises(MachineDataError, match=said):
        kinematics_of(read_machine(machine_text(line)))
