"""Robots by their names.

All of them get the same set-points at the same times, so a program has the same trace on each:
``none`` takes no set-points at all, ``kinematic`` is always at its set-point, and ``mujoco`` is an
arm with masses that follows as well as it can.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, Literal

from interp.robot.kinematics.machine_data import MachineData
from interp.robot.simulation.robot import KinematicRobot, NoRobot, Robot
from interp.robot.simulation.scene import Scene

if TYPE_CHECKING:
    from interp.robot.simulation.robot_files import RobotFile

RobotName = Literal["none", "kinematic", "mujoco"]
ROBOTS: Final[tuple[RobotName, ...]] = ("none", "kinematic", "mujoco")


def make_robot(
    name: RobotName,
    machine: MachineData,
    cycle: int,
    scene: Scene | None = None,
    file: RobotFile | None = None,
) -> Robot:
    """A robot by its name; one with masses is that of ``file``, where there is one.

    Raises `ImportError` for ``mujoco`` where MuJoCo is not installed.
    """
    if name == "mujoco":
        from interp.robot.simulation.cell import Cell
        from interp.robot.simulation.mujoco import MujocoRobot

        return MujocoRobot(Cell(machine, scene or Scene(), file))
    return KinematicRobot(cycle) if name == "kinematic" else NoRobot()
