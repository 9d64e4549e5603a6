"""The creation of robots by their names.

All robots receive the same set-points at the same times, so a program has the same trace on each.
``none`` ignores set-points, ``kinematic`` is always at its set-point, and ``mujoco`` is an arm with
masses that follows its set-points as well as it can.
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
    """Return a robot by its name; one with masses uses the model ``file``, if there is one.

    Raises `ImportError` for ``mujoco`` if MuJoCo is not installed.
    """
    if name == "mujoco":
        from interp.robot.simulation.cell import Cell
        from interp.robot.simulation.mujoco import MujocoRobot

        return MujocoRobot(Cell(machine, scene or Scene(), file))
    return KinematicRobot(cycle) if name == "kinematic" else NoRobot()
