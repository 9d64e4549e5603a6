"""Palletisers, and arms that are solved by numbers: there and back on machine data at random."""

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from interp.robot.kinematics.chain import Chain, Joint
from interp.robot.kinematics.kinematics import Array, Kinematics, matrix_of
from interp.robot.kinematics.kinematics_choice import kinematics_of
from interp.robot.kinematics.machine_data import (
    MachineData,
    MachineDataError,
    Palletising,
    WristLink,
)
from interp.robot.kinematics.machine_reader import read_machine
from interp.robot.kinematics.numeric import NumericKinematics
from interp.robot.kinematics.palletiser import Palletiser
from interp.robot.kinematics.solution_choice import ptp_target, solve
from interp.values.faults import Fault
from interp.values.poses import Pose

MakeArm = Callable[..., Kinematics]
FIXED = ("BOOL $DEF_A4FIX=TRUE",)

lengths = st.integers(200, 1500)
offsets = st.integers(-200, 200)
senses = st.sampled_from((-1, 1))


@st.composite
def shapes(draw: st.DrawFn) -> dict[str, Any]:
    """What to replace of machine data for an arm of any size, with axes that count either way."""
    twist = draw(st.sampled_from((90.0, -90.0)))
    return {
        "senses": [draw(senses) for _ in range(6)],
        "tiroro": Pose.of(z=draw(lengths), a=draw(offsets)),
        "length_a": float(draw(st.integers(0, 500))),
        "length_b": float(draw(lengths)),
        "tx3p3": Pose.of(draw(lengths), 0.0, draw(offsets), b=90.0),
        "tflwp": Pose.of(z=draw(st.integers(0, 400)), a=draw(offsets)),
        "dh_4": WristLink(0.0, 0.0, twist),
        "dh_5": WristLink(0.0, 0.0, -twist),
    }


def shaped(machine: MachineData, shape: dict[str, Any], **others: Any) -> MachineData:
    """A machine of another shape."""
    values = {**shape, **others}
    pairs = zip(machine.axes, values.pop("senses"), strict=True)
    axes = tuple(replace(axis, direction=sense) for axis, sense in pairs)
    return replace(machine, axes=axes, **values)


def angles(draw: st.DrawFn) -> Array:
    """Six axes away from where the arm is stretched or folded."""
    ranges = ((-170, 170), (-130, -50), (40, 140), (-150, 150), (-100, 100), (-170, 170))
    return np.array([draw(st.floats(*ends, allow_subnormal=False)) for ends in ranges])


axes_at_random = st.composite(angles)()


def nearest(ways: Array, axes: Array) -> float:
    """How far the nearest of the ways is, whole turns aside."""
    return float(np.nanmin(np.abs((ways - axes + 180.0) % 360.0 - 180.0).max(axis=-1)))


@pytest.mark.parametrize("held", Palletising)
@given(shape=shapes(), axes=axes_at_random)
def test_palletisers_there_and_back(
    arm: Kinematics, held: Palletising, shape: dict[str, Any], axes: Array
) -> None:
    """The ways to a pose reach it to 1 nm, and one of them is where it came from."""
    arm = kinematics_of(shaped(arm.machine, shape, palletising=held))
    assert isinstance(arm, Palletiser)
    axes = arm.coupled(axes)
    pose = arm.forward(axes)
    ways = arm.inverse(pose)
    reached = arm.forward(ways[~np.isnan(ways[:, 0])])
    np.testing.assert_allclose(reached, [pose] * len(reached), atol=1e-6)
    assert nearest(ways, axes) < 1e-6


@given(shape=shapes(), axes=axes_at_random)
def test_a_parallelogram_keeps_the_flange_level(
    arm: Kinematics, shape: dict[str, Any], axes: Array
) -> None:
    """Whatever A5 a target has, the axis of the flange points down."""
    arm = kinematics_of(shaped(arm.machine, shape, palletising=Palletising.LINKED_A5))
    np.testing.assert_allclose(arm.forward(axes)[:3, 2], [0, 0, -1], atol=1e-12)


@given(axes=axes_at_random, turn=st.tuples(*(st.floats(-30, 30),) * 3))
def test_five_axes_reach_every_place(
    arm: Kinematics, axes: Array, turn: tuple[float, float, float]
) -> None:
    """An orientation beside the plane of the arm changes; the position is met all the same.

    Where the wrist is out of reach then, there is no way at all.
    """
    arm = kinematics_of(replace(arm.machine, palletising=Palletising.FIXED_A4))
    pose = arm.forward(arm.coupled(axes))
    a, b, c = turn
    pose[:3, :3] = pose[:3, :3] @ np.array(Pose.of(a=a, b=b, c=c).matrix)[:3, :3]
    ways = arm.inverse(pose)
    reached = arm.forward(ways[~np.isnan(ways[:, 0])])
    places = np.broadcast_to(pose[:3, 3], (len(reached), 3))
    np.testing.assert_allclose(reached[:, :3, 3], places, atol=1e-6)


@pytest.mark.parametrize("held", Palletising)
@given(axes=axes_at_random, turn=st.tuples(*(st.floats(-30, 30),) * 3))
def test_the_tip_of_a_palletiser_is_where_it_was_sent(
    arm: Kinematics, held: Palletising, axes: Array, turn: tuple[float, float, float]
) -> None:
    """Whatever of the orientation it cannot have."""
    arm = kinematics_of(replace(arm.machine, palletising=held))
    tool = matrix_of(Pose.of(30.0, -20.0, 200.0))
    poses = arm.forward(axes[None]) @ matrix_of(Pose.of(0.0, 0.0, 0.0, *turn))
    reached = arm.about_tips(poses, tool)
    (ways,) = arm.inverse(reached)
    known = ways[~np.isnan(ways).any(axis=1)]
    assume(len(known) > 0)
    told = np.broadcast_to((poses[0] @ tool)[:3, 3], (len(known), 3))
    assert (arm.forward(known) @ tool)[:, :3, 3] == pytest.approx(told, abs=1e-5)


def test_axis_4_of_a_palletiser_stays(make_arm: MakeArm) -> None:
    """What a point says of A4 has no effect, and straight down is no singularity of the wrist."""
    arm = make_arm(*FIXED)
    home = [10.0, -80.0, 100.0, 55.0, 0.0, 20.0]
    flange = Pose.from_matrix(arm.forward(home).tolist())
    found = ptp_target(arm, flange, home)
    assert (10.0, -80.0, 100.0, 0.0, 0.0, 20.0) == pytest.approx(found.axes)
    assert () == found.singularities


@pytest.mark.parametrize("line", ["FRAME $TFLWP={X 10.0,Z 80.0}", "FRAME $TX3P3={X 420,Y 9,B 90}"])
def test_palletisers_beside_their_plane(machine_text: Callable[..., str], line: str) -> None:
    """A palletiser whose flange does not lie in the plane of its arm is refused."""
    with pytest.raises(MachineDataError, match="the plane of the arm"):
        kinematics_of(read_machine(machine_text(*FIXED, line)))


_KNOWN: dict[tuple[str, ...], Kinematics] = {}


def _made(make_arm: MakeArm, lines: tuple[str, ...]) -> Kinematics:
    """The arm of machine data, which takes a while to read."""
    if lines not in _KNOWN:
        _KNOWN[lines] = make_arm(*lines)
    return _KNOWN[lines]


WRISTS = {
    "offset between axes 4 and 5": ("$DH_4={DHART_A 30.0,DHART_D 12.0,DHART_ALPHA 90.0}",),
    "offset between axes 5 and 6": ("$DH_5={DHART_A 60.0,DHART_D 0.0,DHART_ALPHA -90.0}",),
    "askew": ("$DH_4={DHART_ALPHA 60.0}", "$DH_5={DHART_ALPHA -60.0}"),
    "hanging": ("$TX3P3={X 420.0,Z 35.0,B 70.0}",),
}


@pytest.mark.parametrize("lines", WRISTS.values(), ids=list(WRISTS))
@settings(max_examples=8)
@given(data=st.data())
def test_wrists_that_are_not_central(
    make_arm: MakeArm, lines: tuple[str, ...], data: st.DataObject
) -> None:
    """Numbers reach the pose to 10 nm, from all ways and from axes beside it."""
    arm, axes = _made(make_arm, lines), data.draw(axes_at_random)
    assert isinstance(arm, NumericKinematics)
    pose = arm.forward(axes)
    ways = arm.inverse(pose)
    ways = ways[~np.isnan(ways[:, 0])]
    assert len(ways)
    np.testing.assert_allclose(arm.forward(ways), [pose] * len(ways), atol=1e-5)
    near = arm.inverse_near(pose[None], axes[None] + 1.0)
    np.testing.assert_allclose(arm.forward(near)[0], pose, atol=1e-5)


@settings(max_examples=15)
@given(axes=axes_at_random)
def test_numbers_agree_with_the_closed_form(arm: Kinematics, axes: Array) -> None:
    """Forward, Status and elbow are those of the closed form, and its way is among those found."""
    other = NumericKinematics(arm.machine)
    pose = arm.forward(axes)
    np.testing.assert_allclose(other.forward(axes), pose, atol=1e-9)
    assert int(arm.status(axes)) == int(other.status(axes))
    assert arm.elbow == pytest.approx(other.elbow)
    if abs(axes[4]) > 1.0:
        assert nearest(other.inverse(pose), axes) < 1e-4


def test_a_chain_of_four_joints(arm: Kinematics) -> None:
    """A SCARA reaches what it can, and refuses an orientation that it cannot take."""
    chain = Chain(
        (
            Joint("A1", Pose.of(z=300)),
            Joint("A2", Pose.of(x=350)),
            Joint("A3", Pose.of(x=300), is_linear=True),
            Joint("A4", Pose.of()),
        ),
        Pose.of(c=180),
    )
    scara = kinematics_of(replace(arm.machine, own_chain=chain))
    axes = np.array([20.0, 60.0, -110.0, 35.0, 0.0, 0.0])
    pose = scara.forward(axes)
    assert nearest(scara.inverse(pose), axes) < 1e-6
    tilted = Pose.from_matrix(pose.tolist()) @ Pose.of(b=20)
    with pytest.raises(Fault, match="cannot be reached"):
        solve(scara, tilted)


@st.composite
def chains(draw: st.DrawFn) -> tuple[Chain, Array, Array]:
    """A chain of two to six joints, some of which slide, and two neighbouring places of it."""
    directions = st.sampled_from(((1.0, 0.0, 0.0), (0.0, -1.0, 0.0), (0.0, 0.6, 0.8)))
    sides, turns = st.integers(-500, 500), st.sampled_from((0, 90, -90, 30))
    frames = st.builds(Pose.of, *(sides,) * 3, *(turns,) * 3)
    count = draw(st.integers(2, 6))
    linear = [draw(st.booleans()) if place < 2 else False for place in range(count)]
    joints = tuple(
        Joint(f"A{place + 1}", draw(frames), draw(directions), linear[place])
        for place in range(count)
    )
    here = np.zeros(6)
    here[:count] = [draw(st.integers(-120, 120)) for _ in range(count)]
    step = np.zeros(6)
    step[:count] = [draw(st.integers(-15, 15)) for _ in range(count)]
    return Chain(joints, draw(frames)), here, here + step


@settings(max_examples=25)
@given(drawn=chains())
def test_chains_of_any_joints(arm: Kinematics, drawn: tuple[Chain, Array, Array]) -> None:
    """Joints reach where their transforms lead, back from there, and along what lies between."""
    chain, here, there = drawn
    other = kinematics_of(replace(arm.machine, own_chain=chain))
    pose = np.eye(4)
    for joint, value in zip(chain.joints, here.tolist(), strict=False):
        x, y, z = (value * part for part in joint.axis)
        turn = np.eye(4)
        turn[:3, :3] = Rotation.from_rotvec((x, y, z), degrees=True).as_matrix()
        move = matrix_of(Pose.of(x, y, z)) if joint.is_linear else turn
        pose = pose @ matrix_of(joint.frame) @ move
    np.testing.assert_allclose(other.forward(here), pose @ matrix_of(chain.end), atol=1e-8)
    way = here + np.linspace(0.0, 1.0, 65)[:, None] * (there - here)
    poses = other.forward(way)
    followed = other.inverse_along(poses, here.tolist())
    assert followed is not None
    near = 0.1 if len(chain.joints) < 6 else 1e-5  # mm, or of a cosine by 1e-3
    np.testing.assert_allclose(other.forward(followed), poses, atol=near)
    ways = other.inverse(poses[-1])
    reached = other.forward(ways[~np.isnan(ways[:, 0])])
    assert len(reached)
    np.testing.assert_allclose(reached, [poses[-1]] * len(reached), atol=near)


def test_a_joint_slides_beyond_a_turn(arm: Kinematics) -> None:
    """The way of a linear joint is no angle, and axis 1 of it is nowhere near."""
    chain = Chain((Joint("A1", Pose.of(), is_linear=True), Joint("A2", Pose.of(x=100))))
    slide = kinematics_of(replace(arm.machine, own_chain=chain))
    axes = np.array([700.0, 30.0, 0.0, 0.0, 0.0, 0.0])
    ways = slide.inverse(slide.forward(axes))
    assert np.nanmin(np.abs(ways - axes).max(axis=-1)) < 1e-6
    assert float(slide.distance_to_axis_1(axes)) == math.inf
