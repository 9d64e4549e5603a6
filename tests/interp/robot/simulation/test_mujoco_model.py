"""The arm as a model for MuJoCo: it stands where the kinematics say, and touches what it should."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from interp.robot.kinematics.kinematics_choice import kinematics_of
from interp.robot.kinematics.machine_data import MachineData
from interp.robot.kinematics.machine_reader import read_machine
from interp.robot.models import default_machine, model_file
from interp.robot.models.generate import generated
from interp.robot.simulation.links import reach_of
from interp.robot.simulation.model_names import FLANGE
from interp.robot.simulation.mujoco_model import mjcf_of
from interp.values.poses import Pose

pytest.importorskip("mujoco")

import mujoco

from interp.robot.simulation.cell import Cell

HOME = (0.0, -90.0, 90.0, 0.0, 0.0, 0.0)


def loaded(machine: MachineData) -> tuple[Any, Any]:
    model = mujoco.MjModel.from_xml_string(mjcf_of(machine))
    return model, mujoco.MjData(model)


def touching(machine: MachineData, axes: tuple[float, ...]) -> int:
    model, data = loaded(machine)
    data.qpos[:] = np.radians(axes)
    mujoco.mj_forward(model, data)
    return int(data.ncon)


def test_the_file_is_fresh() -> None:
    """The model that comes along is what the generator makes of the machine data."""
    text = model_file("kr6r900.xml").read_text(encoding="utf-8")
    assert generated() == text, "run python -m interp.robot.models.generate"


def test_published_figures() -> None:
    """Reach, ranges and speeds are those of the data sheet; so is the mass of the model."""
    machine = default_machine()
    assert 901.5 == pytest.approx(reach_of(machine), abs=0.05)
    ranges = [(axis.lower, axis.upper) for axis in machine.axes]
    published = [(-170, 170), (-190, 45), (-120, 156), (-185, 185), (-120, 120), (-350, 350)]
    assert published == ranges
    speeds = [axis.dynamics.velocity for axis in machine.axes if axis.dynamics]
    assert [360, 300, 360, 381, 388, 615] == pytest.approx(speeds)
    model, _ = loaded(machine)
    assert 52.0 == pytest.approx(model.body_mass.sum(), abs=0.05)


@pytest.mark.parametrize(
    "lines",
    [
        (),
        ("FRAME $ROBROOT={X 100.0,Y -200.0,Z 300.0,A 30.0,B 180.0,C 10.0}",),
        ("FRAME $TX3P3={X 1000.0,Y 20.0,Z -41.0,A 0.0,B 90.0,C 0.0}", "REAL $LENGTH_B=1150.0"),
        ("$AXIS_DIR[2]=-1", "$AXIS_DIR[4]=1", "FRAME $TIRORO={X 1.0,Y 2.0,Z 675.0,A 5.0,B 0,C 0}"),
        (
            "DECL DHART $DH_4={DHART_A 0.0,DHART_D 0.0,DHART_ALPHA -90.0}",
            "DECL DHART $DH_5={DHART_A 0.0,DHART_D 0.0,DHART_ALPHA 90.0}",
        ),
    ],
)
def test_the_flange_stands_where_the_kinematics_have_it(
    machine_text: Callable[..., str], lines: tuple[str, ...]
) -> None:
    """At random axes both agree to 1e-9 m, whatever the senses, twists and frames of the data."""
    machine = read_machine(machine_text(*lines))
    model, data = loaded(machine)
    axes = np.random.default_rng(7).uniform(-180.0, 180.0, (200, 6))
    flanges = np.array(machine.robroot.matrix) @ kinematics_of(machine).forward(axes)
    for row, expected in zip(axes, flanges, strict=True):
        data.qpos[:] = np.radians(row)
        mujoco.mj_kinematics(model, data)
        site = data.site(FLANGE)
        np.testing.assert_allclose(site.xpos, expected[:3, 3] / 1000.0, rtol=0, atol=1e-9)
        np.testing.assert_allclose(site.xmat.reshape(3, 3), expected[:3, :3], rtol=0, atol=1e-9)


def test_external_axes(machine_text: Callable[..., str]) -> None:
    """A track slides in metres and a table turns, behind the axes of the robot."""
    machine = read_machine(
        machine_text("INT $EX_AX_NUM=2", "$AXIS_TYPE[7]=1", "$AXIS_TYPE[8]=3", "$AXIS_DIR[8]=-1")
    )
    model, data = loaded(machine)
    assert ["A6", "E1", "E2"] == [model.joint(place).name for place in (5, 6, 7)]
    before = data.body("E1").xpos.copy()
    data.qpos[6], data.qpos[7] = 0.5, 1.0
    mujoco.mj_kinematics(model, data)
    assert 0.5 == pytest.approx(float((data.body("E1").xpos - before)[0]))
    assert -np.sin(1.0) == pytest.approx(data.body("E2").xmat.reshape(3, 3)[1, 0])


def test_a_robot_on_a_linear_unit(machine_text: Callable[..., str]) -> None:
    """The unit carries the arm, and its joint is told by the column of its axis."""
    machine = read_machine(
        machine_text(
            "INT $EX_AX_NUM=1",
            "$AXIS_TYPE[7]=1",
            "DECL EX_KIN $EX_KIN={ET1 #ERSYS}",
            "DECL ET_AX $ET1_AX={TR_A1 #E1}",
            "FRAME $ET1_TA1KR={X 10.0,Y 0.0,Z 450.0,A 0.0,B 90.0,C 0.0}",
            "FRAME $ET1_TFLA3={X 0.0,Y 0.0,Z 0.0,A 0.0,B -90.0,C 0.0}",
        )
    )
    cell = Cell(machine)
    model = cell.model()
    data = mujoco.MjData(model)
    columns, units = cell.columns(model)
    assert [6, 0, 1, 2, 3, 4, 5] == columns.tolist()
    axes = np.array([*HOME, 700.0])
    data.qpos[:] = axes[columns] * units
    mujoco.mj_kinematics(model, data)
    expected = np.array(machine.foot((700.0,)).matrix) @ kinematics_of(machine).forward(HOME)
    np.testing.assert_allclose(data.site(FLANGE).xpos * 1000.0, expected[:3, 3], atol=1e-6)
    assert 710.0 == pytest.approx(machine.foot((700.0,)).position[0])


def test_an_arm_in_the_open_touches_nothing() -> None:
    """At home, stretched, and upright, the links do not touch one another."""
    for axes in (HOME, (0.0,) * 6, (0.0, -90.0, 0.0, 0.0, 0.0, 0.0), (90, -45, 120, 30, -60, 0)):
        assert 0 == touching(default_machine(), axes)


@pytest.mark.parametrize("turned", [Pose.of(z=2500.0, c=180.0), Pose.of(z=2500.0, b=90.0)])
def test_an_arm_that_hangs(turned: Pose) -> None:
    """From ceiling or wall it reaches the floor nowhere, and what holds it is behind the foot."""
    machine = replace(default_machine(), robroot=turned)
    model, data = loaded(machine)
    mujoco.mj_forward(model, data)
    holds = (turned.inverse() @ Pose.of(*data.geom("pedestal").xpos * 1000.0)).position
    assert (0.0, 0.0) == pytest.approx(holds[:2], abs=1e-6)
    assert holds[2] < 0.0
    for axes in ((0.0,) * 6, (0.0, -90.0, 0.0, 0.0, 0.0, 0.0), (0.0, 45.0, 0.0, 0.0, 0.0, 0.0)):
        assert 0 == touching(machine, axes)


def test_what_an_arm_touches() -> None:
    """Its hand touches its own foot."""
    machine = default_machine()
    assert 0 < touching(machine, (0.0, 0.0, 144.0, 0.0, 0.0, 0.0))


def test_a_larger_arm_weighs_more(machine_text: Callable[..., str]) -> None:
    """Masses grow with the cube of the reach."""
    twice = read_machine(
        machine_text(
            "REAL $LENGTH_A=50.0",
            "REAL $LENGTH_B=910.0",
            "FRAME $TX3P3={X 840.0,Y 0.0,Z 70.0,A 0.0,B 90.0,C 0.0}",
        )
    )
    masses = [loaded(machine)[0].body_mass.sum() for machine in (twice, default_machine())]
    assert 8.0 == pytest.approx(masses[0] / masses[1], rel=1e-4)
