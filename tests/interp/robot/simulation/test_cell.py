"""A cell: contacts on the way, loads that change torques, and limits that a plan exceeds."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from interp.robot.arm import Load, Samples
from interp.robot.kinematics.kinematics_choice import kinematics_of
from interp.robot.models import default_machine
from interp.robot.simulation.observations import Observation, TorqueCheck
from interp.robot.simulation.scene import Scene, SceneObject
from interp.values.poses import IDENTITY, Pose

pytest.importorskip("mujoco")

from interp.robot.simulation.cell import Cell
from interp.robot.simulation.contacts import ContactCheck
from interp.robot.simulation.mujoco import MujocoRobot

Array = npt.NDArray[np.float64]
HOME = (0.0, -90.0, 90.0, 0.0, 60.0, 0.0)
CYCLE = 12_000


def turned(degrees: float, count: int = 50) -> Array:
    """Axis 1 turns from 0."""
    axes = np.tile(HOME, (count, 1))
    axes[:, 0] = np.linspace(0.0, degrees, count)
    return axes


def contacts(axes: Array, *objects: SceneObject) -> tuple[Observation, ...]:
    check = ContactCheck(Cell(default_machine(), Scene(objects)))
    check.observe(CYCLE * np.arange(len(axes), dtype=np.int64), axes)
    return check.observations()


def flange(axes: Sequence[float]) -> Pose:
    return Pose.from_matrix(kinematics_of(default_machine()).forward(axes).tolist())


@settings(max_examples=15)
@given(angle=st.floats(20.0, 160.0), count=st.integers(2, 60))
def test_nothing_is_passed_through(angle: float, count: int) -> None:
    """However far apart set-points are, a thin wall in the way is touched where it stands."""
    x, y, z = flange((angle, *HOME[1:])).position
    wall = SceneObject("wall", "box", Pose.of(x, y, z, a=-angle), (200.0, 1.0, 200.0))
    found = contacts(turned(180.0, count), wall)
    assert found, "the hand passes through"
    assert {"wall"} <= {part for one in found for part in one.parts}
    touched = found[0].start / (CYCLE * (count - 1)) * 180.0
    assert touched <= angle + 1.0
    assert touched >= angle - 25.0


def test_a_contact_has_a_beginning_and_an_end() -> None:
    """What the hand sweeps over is told once, with both names."""
    x, y, z = flange((45.0, *HOME[1:])).position
    found = contacts(turned(90.0), SceneObject("ball", "sphere", Pose.of(x, y, z), (20.0,) * 3))
    assert {("ball", "link 6")} >= {one.parts for one in found if "link 6" in one.parts}
    assert all(0 < one.start < one.end < 49 * CYCLE for one in found)


def test_what_is_held_goes_along() -> None:
    """A long rod on the flange touches what the hand itself does not reach."""
    x, y, z = (flange((45.0, *HOME[1:])) @ Pose.of(z=290)).position
    post = SceneObject("post", "sphere", Pose.of(x, y, z), (20.0,) * 3)
    rod = SceneObject("rod", "cylinder", Pose.of(z=155), (10.0, 10.0, 300.0), is_held=True)
    assert () == contacts(turned(90.0), post)
    assert [("post", "rod")] == [one.parts for one in contacts(turned(90.0), post, rod)]


def test_a_mesh_is_an_obstacle(tmp_path: Path) -> None:
    """An OBJ file in mm stands where its frame says."""
    corners = [(a, b, c) for a in (-20, 20) for b in (-20, 20) for c in (-20, 20)]
    faces = ((1, 2, 4), (1, 4, 3), (5, 7, 8), (5, 8, 6), (1, 5, 6), (1, 6, 2), (3, 4, 8), (3, 8, 7))
    lines = [f"v {x} {y} {z}" for x, y, z in corners]
    lines += [f"f {a} {b} {c}" for a, b, c in (*faces, (1, 3, 7), (1, 7, 5), (2, 6, 8), (2, 8, 4))]
    (tmp_path / "cube.obj").write_text("\n".join(lines) + "\n", encoding="ascii")
    place = Pose.of(*flange((45.0, *HOME[1:])).position)
    cube = SceneObject("cube", "mesh", place, file=tmp_path / "cube.obj")
    assert "cube" in {part for one in contacts(turned(90.0), cube) for part in one.parts}
    assert () == contacts(turned(20.0), cube)


def torques(loads: dict[str, Load], axes: Sequence[float] = HOME) -> Array:
    """What holds the arm still at axes."""
    robot = MujocoRobot(Cell(default_machine()))
    robot.stand(axes)
    robot.carry(loads)
    rows = np.tile(axes, (3, 1))
    times = 1_000 * np.arange(1, 4, dtype=np.int64)
    found: Array = robot.follow(Samples(times, rows)).torques[-1]
    return found


@settings(max_examples=10)
@given(mass=st.floats(0.5, 20.0), x=st.integers(-200, 200), z=st.integers(0, 300))
def test_a_load_weighs_on_the_axes(mass: float, x: int, z: int) -> None:
    """Held still, each axis bears more by weight times arm: the work of lifting the load."""
    load = {"$LOAD": Load(mass, Pose.of(x=x, z=z))}
    kinematics = kinematics_of(default_machine())

    def height(axes: Array) -> float:
        return float((kinematics.forward(axes) @ np.array([x, 0.0, z, 1.0]))[2]) / 1000.0

    step = 1e-4
    lifted = [
        (height(HOME + step * row) - height(HOME - step * row)) / np.radians(2 * step)
        for row in np.eye(6)
    ]
    np.testing.assert_allclose(
        torques(load) - torques({}), mass * 9.81 * np.array(lifted), atol=1e-3 * mass
    )


@pytest.mark.parametrize(("name", "bears"), [("$LOAD_A2", 1), ("$LOAD_A3", 2)])
def test_loads_on_the_arm(name: str, bears: int) -> None:
    """An additional load weighs on the axes before it and on none behind."""
    at = {"$LOAD_A2": Pose.of(x=200, z=600), "$LOAD_A3": Pose.of(z=-200)}[name]
    more = torques({name: Load(10.0, at)}) - torques({})
    assert abs(more[bears]) > 0.1
    assert np.abs(more[bears + 1 :]).max() < 1e-9


def test_torques_beyond_what_an_axis_bears() -> None:
    """A period has the axis, the greatest torque in it, and the limit."""
    check = TorqueCheck(replace(default_machine(), torques=(100.0,) * 6))
    found = np.zeros((5, 6))
    found[1:4, 2] = 110.0, -130.0, 120.0
    check.check(1_000 * np.arange(5, dtype=np.int64), found)
    expected = Observation("torque", 1_000, 3_000, ("A3",), 130.0, 100.0, is_estimate=True)
    assert (expected,) == check.observations()


def test_no_limits_no_torques_beyond_them() -> None:
    """Where machine data has no torques, none is too great."""
    check = TorqueCheck(default_machine())
    check.check(np.zeros(1, dtype=np.int64), np.full((1, 6), 1e9))
    assert () == check.observations()


def test_a_scene_that_cannot_be_built(tmp_path: Path) -> None:
    """A mesh that is none is one line."""
    from interp.robot.simulation.scene import SceneError

    (tmp_path / "bad.stl").write_bytes(b"solid nothing")
    file = tmp_path / "bad.stl"
    bad = SceneObject("bad", "mesh", IDENTITY, file=file, where="scene.toml:3")
    with pytest.raises(SceneError, match=r"^scene.toml:3: ") as caught:
        Cell(default_machine(), Scene((bad,))).model()
    assert "\n" not in str(caught.value)
