"""Speed of the simulated arm: a program of motions, without KRL, on each robot."""

from __future__ import annotations

import math
import platform
from collections.abc import Callable, Sequence
from importlib.util import find_spec
from time import process_time
from typing import Any, Final

import numpy as np

from interp.port.requests import At
from interp.robot.api.batch import BatchCore
from interp.robot.api.commands import MotionCommand, Transaction
from interp.robot.api.control_core import ControlCore
from interp.robot.arm import Approximation, Motion, Settings, Target
from interp.robot.kinematics.kinematics_choice import kinematics_of
from interp.robot.kinematics.placement import Placement
from interp.robot.models import default_machine
from interp.robot.planning.planned_arm import PlannedArm
from interp.robot.simulation.factory import ROBOTS, RobotName, make_robot
from interp.robot.simulation.tracking import Tracking
from interp.values.poses import Pose

#: The goals, in simulated seconds per second.
AIMS: Final[dict[str, float]] = {"kinematic": 200.0, "mujoco": 20.0}
#: The number of times that `measure` reports progress.
STEPS: Final = len(ROBOTS) + 2

_CYCLE = 12_000  # µs
_ADVANCE = 3
_HOME = (0.0, -90.0, 90.0, 0.0, 45.0, 0.0)
_TOOL = Pose.of(z=100.0)
_BASE = Pose.of(x=450.0, y=-150.0, z=300.0)
_POSES = 20_000  # for inverse kinematics


def motions(count: int) -> list[Motion]:
    """Return a program of ``count`` motions: handling, and small contours at 0.25 m/s.

    Each cycle is a PTP to above a contour, a LIN down to it, two LIN along it, a CIRC, and a LIN
    up. All motions are blended except the last of a cycle, after which a program would act.
    """
    settings = Settings(
        placement=Placement(base=_BASE, tool=_TOOL),
        velocity=0.25,
        axis_velocity=(80.0,) * 12,
        axis_acceleration=(80.0,) * 12,
        approximation=Approximation(cdis=10.0, cptp=30.0),
    )
    made = [Motion(1, At("bench", 1, 0), "PTP", settings, _axes(_HOME))]
    while len(made) < count:
        number = len(made) + 1
        row, place = divmod(number - 2, 6)
        x, y, z = 30.0 * (row % 4), 40.0 * (row % 5), 40.0 * (row % 3)
        kind, target, auxiliary, criteria = (
            ("PTP", _point(x, y, z + 100, row % 7), None, ("C_PTP",)),
            ("LIN", _point(x, y, z, row % 7), None, ("C_DIS",)),
            ("LIN", _point(x + 150, y, z, 0), None, ("C_DIS",)),
            ("LIN", _point(x + 150, y + 100, z, 0), None, ("C_DIS",)),
            ("CIRC", _point(x + 90, y + 160, z, 0), _point(x + 132, y + 142, z, 0), ("C_DIS",)),
            ("LIN", _point(x + 90, y + 160, z + 100, 0), None, ()),
        )[place]
        at = At("bench", number, 0)
        made.append(Motion(number, at, kind, settings, target, auxiliary, criteria=criteria))
    return made


def measure(count: int = 200, on_step: Callable[[], None] = lambda: None) -> dict[str, Any]:
    """Return the record of a benchmark of ``count`` motions.

    Seconds are processor time, so that other load on the computer matters little. Modules are
    loaded before the measurement.
    """
    program = motions(count)
    drive(program[:10], "kinematic")
    robots = []
    for name in ROBOTS:
        robots.append(_robot(name, program))
        on_step()
    batched, _ = drive(program, "none", BatchCore, thinking=_CYCLE)
    ahead, _ = drive(program, "none", thinking=_CYCLE)
    _, planning = drive(program, "none")
    on_step()
    poses, seconds = _inverse()
    on_step()
    return {
        "motions": count,
        "cycle_us": _CYCLE,
        "python": platform.python_version(),
        "robots": robots,
        "planning_ms_per_motion": 1000.0 * planning / count,
        "thinking_us": _CYCLE,
        "simulated_s_lookahead": ahead / 1e6,
        "simulated_s_batch": batched / 1e6,
        "inverse_poses": poses,
        "inverse_per_s": poses / seconds,
    }


def drive(
    program: Sequence[Motion],
    robot: RobotName,
    core_type: type[ControlCore] = ControlCore,
    *,
    thinking: int = 0,
) -> tuple[int, float]:
    """Run motions to their end, with an advance run of limited depth.

    ``thinking`` is the time in µs that passes in the program before each motion, for which a batch
    has to wait. Return the time of the last event in µs, and the seconds that planning took.
    """
    machine = default_machine()
    arm = PlannedArm(machine, _HOME)
    core = core_type(arm, lambda *_: None, _CYCLE)
    tracking = Tracking(arm, make_robot(robot, machine, _CYCLE), machine, _CYCLE, _HOME)
    planning = 0.0
    for motion in program:
        while core.pending() > _ADVANCE and (time := core.next_time()) is not None:
            core.run_until(time)
        core.run_until(core.now + thinking)
        begun = process_time()
        core.load(core.now, Transaction(MotionCommand(motion)))
        planning += process_time() - begun
        tracking.advance(core.now)
    begun = process_time()
    core.release(core.now)
    planning += process_time() - begun
    last = core.now
    while (time := core.next_time()) is not None:
        core.run_until(time)
        tracking.advance(core.now)
        last = time
    tracking.settle(last)
    return last, planning


def _robot(name: RobotName, program: Sequence[Motion]) -> dict[str, Any]:
    found: dict[str, Any] = {"robot": name, "aim": AIMS.get(name)}
    if name == "mujoco" and find_spec("mujoco") is None:
        return found | {"absent": "MuJoCo is not installed"}
    begun = process_time()
    simulated, _ = drive(program, name)
    seconds = process_time() - begun
    return found | {
        "simulated_s": simulated / 1e6,
        "seconds": seconds,
        "times_real_time": simulated / 1e6 / seconds,
    }


def _inverse() -> tuple[int, float]:
    """Return the number of poses that were solved, a thousand at once, and the seconds it took."""
    machine = default_machine()
    arm = kinematics_of(machine)
    lower = [axis.lower for axis in machine.axes]
    upper = [axis.upper for axis in machine.axes]
    poses = arm.forward(np.random.default_rng(1).uniform(lower, upper, (_POSES, 6)))
    begun = process_time()
    for first in range(0, _POSES, 1_000):
        arm.inverse(poses[first : first + 1_000])
    return _POSES, process_time() - begun


def _axes(values: Sequence[float]) -> Target:
    return {f"A{number}": value for number, value in enumerate(values, start=1)}


def _point(x: float, y: float, z: float, turned: int) -> Target:
    """Return a target with the tool pointing down, turned a little."""
    angle = 8.0 * math.sin(turned)
    return {"X": x, "Y": y, "Z": z, "A": angle, "B": 0.0, "C": 180.0, "S": 2.0, "T": 2.0}
