"""Arms from URDF and MJCF: their chains are those of MuJoCo, and poses lead there and back."""

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from interp.robot.arm import Samples
from interp.robot.kinematics.kinematics_choice import kinematics_of
from interp.robot.simulation.scene import Scene, SceneObject
from interp.values.poses import Pose

pytest.importorskip("mujoco")

import mujoco

from interp.robot.simulation.cell import Cell
from interp.robot.simulation.contacts import ContactCheck
from interp.robot.simulation.mujoco import MujocoRobot
from interp.robot.simulation.robot_files import RobotFile, RobotFileError, read_robot

INERTIAL = (
    '<inertial><origin xyz="0 0 0.1"/><mass value="2"/>'
    '<inertia ixx="0.02" iyy="0.02" izz="0.02" ixy="0" ixz="0" iyz="0"/></inertial>'
)
MESH = '<geometry><mesh filename="package://arm/link.stl"/></geometry>'
Step = tuple[tuple[float, ...], tuple[float, ...], str]

numbers = st.floats(-0.4, 0.4).map(lambda value: round(value, 3))
turns = st.sampled_from((0.0, math.pi / 2, -math.pi / 2, 0.3))
steps = st.tuples(
    st.tuples(numbers, numbers, numbers),
    st.tuples(turns, turns, turns),
    st.sampled_from(("0 0 1", "0 1 0", "1 0 0", "0 0 -1")),
)


def urdf(chain: list[Step], more: str = "") -> str:
    """An arm of joints j1, j2 and so on, with a tool0 behind the last."""
    parts = ['<robot name="arm"><link name="base"/>']
    before = "base"
    for number, (place, turn, axis) in enumerate(chain, start=1):
        xyz, rpy = (" ".join(map(str, values)) for values in (place, turn))
        parts.append(
            f'<link name="l{number}">{INERTIAL}<visual>{MESH}</visual>'
            f"<collision>{MESH}</collision></link>"
            f'<joint name="j{number}" type="revolute"><parent link="{before}"/>'
            f'<child link="l{number}"/><origin xyz="{xyz}" rpy="{rpy}"/><axis xyz="{axis}"/>'
            '<limit lower="-3" upper="3" effort="80" velocity="3.0"/></joint>'
        )
        before = f"l{number}"
    parts.append(
        f'<link name="tool0"/><joint name="end" type="fixed"><parent link="{before}"/>'
        '<child link="tool0"/><origin xyz="0 0.05 0.1" rpy="0 1.2 0"/></joint>'
    )
    return "".join([*parts, more, "</robot>"])


def read(folder: Path, text: str, name: str = "arm.urdf") -> RobotFile:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return read_robot(path)


@given(chain=st.lists(steps, min_size=1, max_size=6), seed=st.integers(0, 1000))
def test_the_chain_of_a_urdf(
    tmp_path_factory: pytest.TempPathFactory, chain: list[Step], seed: int
) -> None:
    """At axes at random the flange stands where MuJoCo has tool0, within 1 µm."""
    found = read(tmp_path_factory.mktemp("urdf"), urdf(chain))
    arm, cell = kinematics_of(found.machine), Cell(found.machine, robot=found)
    model = cell.model()
    data = mujoco.MjData(model)
    columns, units = cell.columns(model)
    axes = np.zeros(6)
    axes[: len(chain)] = np.random.default_rng(seed).uniform(-170, 170, len(chain))
    data.qpos[:] = axes[columns] * units
    mujoco.mj_kinematics(model, data)
    pose = arm.forward(axes)
    np.testing.assert_allclose(pose[:3, 3], data.body("tool0").xpos * 1000.0, atol=1e-3)
    np.testing.assert_allclose(pose[:3, :3], data.body("tool0").xmat.reshape(3, 3), atol=1e-6)


COBOT: list[Step] = [
    ((0, 0, 0.089), (0, 0, 0), "0 0 1"),
    ((0, 0.136, 0), (0, math.pi / 2, 0), "0 1 0"),
    ((0, -0.12, 0.425), (0, 0, 0), "0 1 0"),
    ((0, 0, 0.392), (0, math.pi / 2, 0), "0 1 0"),
    ((0, 0.093, 0), (0, 0, 0), "0 0 1"),
    ((0, 0, 0.095), (0, 0, 0), "0 1 0"),
]
"""An arm without a central wrist, of the size of common ones."""


@pytest.fixture(scope="module")
def cobot(tmp_path_factory: pytest.TempPathFactory) -> RobotFile:
    return read(tmp_path_factory.mktemp("cobot"), urdf(COBOT))


@settings(max_examples=20)
@given(axes=st.tuples(*(st.floats(-165.0, 165.0),) * 6))
def test_there_and_back(cobot: RobotFile, axes: tuple[float, ...]) -> None:
    """Every way to a pose reaches it to 10 nm, and one at least is found."""
    arm = kinematics_of(cobot.machine)
    pose = arm.forward(axes)
    ways = arm.inverse(pose)
    ways = ways[~np.isnan(ways[:, 0])]
    assert len(ways)
    np.testing.assert_allclose(arm.forward(ways), [pose] * len(ways), atol=1e-5)


def test_what_a_urdf_says_of_its_axes(cobot: RobotFile) -> None:
    """Limits are in degrees, speeds and torques those of the file; meshes need not be there."""
    axis = cobot.machine.axes[1]
    assert (-math.degrees(3), math.degrees(3)) == pytest.approx((axis.lower, axis.upper))
    assert axis.dynamics is not None
    assert math.degrees(3) == pytest.approx(axis.dynamics.velocity)
    assert (80.0,) * 6 == cobot.machine.torques


def test_an_arm_without_heavy_rotors_stands(cobot: RobotFile) -> None:
    """Its controller neither swings nor gives way."""
    robot = MujocoRobot(Cell(cobot.machine, robot=cobot))
    home = np.array([40.0, -60.0, 80.0, -20.0, 60.0, 0.0])
    robot.stand(home.tolist())
    rows = np.tile(home, (500, 1))
    times = 1_000 * np.arange(1, 501, dtype=np.int64)
    measured = robot.follow(Samples(times, rows)).axes
    assert np.abs(measured - home).max() < 1e-6


MJCF = """<mujoco model="scara"><worldbody><body name="base">
<body name="one" pos="0 0 0.3"><joint name="j1" axis="0 0 1" range="-150 150"/>
 <geom size="0.02" fromto="0 0 0 0.35 0 0" type="capsule"/>
 <body name="two" pos="0.35 0 0"><joint name="j2" axis="0 0 1" range="-150 150"/>
  <geom size="0.02" fromto="0 0 0 0.3 0 0" type="capsule"/>
  <body name="lift" pos="0.3 0 0"><joint name="j3" type="slide" axis="0 0 1" range="-0.2 0"/>
   <geom size="0.01" fromto="0 0 0 0 0 -0.1" type="capsule"/>
   <body name="hand"><joint name="j4" axis="0 0 -1"/>
    <geom size="0.02" type="sphere"/><site name="flange" pos="0 0 -0.1" euler="180 0 0"/>
    <body name="left"><joint name="finger 1" type="slide"/><geom size="0.01"/></body>
    <body name="right"><joint name="finger 2" type="slide"/><geom size="0.01"/></body>
   </body></body></body></body></body></worldbody>
<actuator><motor joint="j1" forcerange="-90 90" gear="2"/><position joint="j2"/></actuator>
<keyframe><key qpos="0 0 0 0 0 0"/></keyframe></mujoco>"""


def test_an_arm_of_four_axes_with_a_gripper(tmp_path: Path) -> None:
    """Fingers are no axes; a slide counts in mm, and what the arm lacks stays at 0."""
    found = read(tmp_path, MJCF, "scara.xml")
    assert ("j1", "j2", "j3", "j4") == found.joints
    axes = found.machine.axes
    assert (-200.0, 0.0) == pytest.approx((axes[2].lower, axes[2].upper))
    assert (0.0, 0.0) == (axes[4].lower, axes[4].upper)
    assert (180.0, math.inf) == found.machine.torques[:2]
    arm = kinematics_of(found.machine)
    pose = arm.forward([30.0, 60.0, -150.0, 20.0, 0.0, 0.0])
    assert 50.0 == pytest.approx(pose[2, 3])
    ways = arm.inverse(pose)
    found_ways = ways[~np.isnan(ways[:, 0])].round(3)
    assert 2 == len(np.unique(found_ways, axis=0))
    assert 4 == Cell(found.machine, robot=found).model().nv


FREE = '<mujoco><worldbody><body><freejoint name="f"/><geom size="1"/></body></worldbody></mujoco>'


def test_parts_that_overlap_by_design_touch_nothing(tmp_path: Path) -> None:
    """A hand within the reach of its own link is no contact; a post in its way is one."""
    found = read(tmp_path, MJCF, "scara.xml")
    times = 12_000 * np.arange(20, dtype=np.int64)
    axes = np.zeros((20, 6))
    axes[:, 0] = np.linspace(0.0, 90.0, 20)
    post = SceneObject("post", "box", Pose.of(0, 600, 300), (60.0, 60.0, 200.0))
    for objects, touched in (((), set()), ((post,), {"post"})):
        check = ContactCheck(Cell(found.machine, Scene(objects), found))
        check.observe(times, axes)
        parts = {part for one in check.observations() for part in one.parts}
        assert touched == parts & {"post"}
        assert bool(objects) == bool(parts)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", ":1: not XML"),
        ("<robot><link></robot>", ":1: not XML"),
        ("<sdf/>", ": neither URDF nor MJCF: <sdf>"),
        ('<robot name="a"><link name="b"/></robot>', ": no joint moves anything"),
        ("<mujoco><worldbody><nothing/></worldbody></mujoco>", ": "),
        (FREE, ": a joint of the arm neither turns nor slides"),
        (urdf(COBOT + COBOT[:1]), ": 7 joints in a row"),
    ],
)
def test_files_that_are_no_arm(tmp_path: Path, text: str, said: str) -> None:
    """One line names the file and what it is instead."""
    with pytest.raises(RobotFileError) as caught:
        read(tmp_path, text)
    assert str(caught.value).startswith(f"{tmp_path / 'arm.urdf'}{said}")
    assert "\n" not in str(caught.value)
