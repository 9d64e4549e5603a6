"""The laws of an arm whose masses are known, on programs drawn by seed (`make blends`)."""

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

pytest.importorskip("mujoco")
pytest.importorskip("scipy")
pytest.importorskip("ruckig")

from interp.port.requests import At
from interp.robot.arm import Load, Motion, Settings
from interp.robot.kinematics.kinematics import Array
from interp.robot.models import default_machine
from interp.robot.planning.planned_arm import PlannedArm
from interp.robot.simulation.cell import Cell
from interp.robot.simulation.inverse_dynamics import InverseDynamics
from interp.values.faults import Fault
from interp.values.poses import Pose
from tests.interp.robot.planning.blend_programs import draw, exact, travel
from tests.interp.robot.planning.test_blend_laws import FEW, SEEDS

_MS = 1e-3
STRONG = default_machine()
DYNAMICS = InverseDynamics(Cell(STRONG))
#: The largest torques that gravity needs anywhere, and a little for axes that it does not turn.
HELD = np.array([2.0, 80.0, 32.0, 2.0, 2.0, 2.0])


def _needed(arm: PlannedArm, loads: Mapping[str, Load] = {}) -> Array:
    """The largest torque of each axis in Nm, by differences of the axes at every millisecond."""
    end = math.ceil(arm.path()[-1].ends * 1e6)
    axes = arm.sample(np.arange(0, end + 20_000, 1_000)).axes
    speeds = np.diff(axes, axis=0, prepend=axes[:1]) / _MS
    accelerations = np.diff(speeds, axis=0) / _MS
    torques = DYNAMICS.torques(axes[1:], speeds[1:], accelerations, loads)
    largest: Array = np.abs(torques).max(axis=0)
    return largest


@FEW
@given(seed=SEEDS, spare=st.sampled_from((1.3, 2.0, 6.0)))
def test_no_torque_exceeds_its_limit(seed: int, spare: float) -> None:
    """Nor does a blend make a program slower than its exact stops."""
    weak = replace(STRONG, torques=tuple(HELD * spare))
    program = draw(seed)
    try:
        blended, arm = travel(program, machine=weak, dynamics=DYNAMICS)
        stopped, _ = travel(exact(program), machine=weak, dynamics=DYNAMICS)
    except Fault:
        assume(False)
    assert (_needed(arm) <= HELD * spare).all()
    assert blended.seconds <= stopped.seconds * 1.001


def test_an_arm_uses_the_torque_that_it_has() -> None:
    """A PTP of A1 takes nearly all of a small torque; a load makes it slower and counts, too."""
    weak = replace(STRONG, torques=(20.0, *HELD[1:] * 3.0))
    seconds = []
    for loads in ({}, {"$LOAD": Load(6.0, Pose.of(z=100.0))}):
        settings = Settings(loads=loads)
        moves = [
            Motion(number, At("bench", number, 0), "PTP", settings, target={"A1": place})
            for number, place in enumerate((-60.0, 60.0), start=1)
        ]
        travelled, arm = travel(moves, machine=weak, dynamics=DYNAMICS)
        assert 0.85 * 20.0 < _needed(arm, loads)[0] <= 20.0
        seconds.append(travelled.seconds)
    strong, _ = travel(moves)
    assert 1.2 * strong.seconds < seconds[0] < 0.9 * seconds[1]
