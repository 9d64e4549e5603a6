"""The arm and the scene in the files of --machine, --urdf, --mjcf and --scene."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from krl.errors import InputError, as_input_errors

if TYPE_CHECKING:
    from interp.robot.kinematics.machine_data import MachineData
    from interp.robot.simulation.robot_files import RobotFile
    from interp.robot.simulation.scene import Scene


@dataclass(frozen=True, slots=True)
class OwnRobot:
    """The arm and scene from the options; ``None`` for those not given."""

    machine: "MachineData | None" = None
    file: "RobotFile | None" = None
    scene: "Scene | None" = None


def read_arm(
    machine: Path | None,
    urdf: Path | None,
    mjcf: Path | None,
    scene: Path | None,
    *,
    has_robot: bool,
) -> OwnRobot:
    """Return the arm and scene of --machine, --urdf, --mjcf, --scene. Raises `InputError`."""
    for file in (machine, urdf, mjcf, scene):
        if file is not None and file.is_dir():
            raise InputError(f"{file}: a folder, not a file")
    named = [file for file in (machine, urdf, mjcf) if file is not None]
    if len(named) > 1:
        raise InputError("--machine, --urdf and --mjcf: only one of them can be the arm")
    if scene is not None and not has_robot:
        raise InputError("--scene: the robot none has no position; say --robot kinematic or mujoco")
    made = OwnRobot()
    if machine is not None:
        made = OwnRobot(machine=_with_torques_beside(read_machine_file(machine), machine))
    elif named:
        from interp.robot.simulation.robot_files import RobotFileError, read_robot

        with as_input_errors(RobotFileError):
            made = OwnRobot(file=read_robot(named[0]))
    if scene is None:
        return made
    from interp.robot.simulation.scene import SceneError, read_scene

    with as_input_errors(SceneError):
        return OwnRobot(made.machine, made.file, read_scene(scene))


def _with_torques_beside(machine: "MachineData", path: Path) -> "MachineData":
    """Return the machine with the torques of $robcor.dat in its folder, if for the same arm."""
    from interp.robot.kinematics.data_list import DataListError
    from interp.robot.kinematics.gear_torques import with_torques
    from interp.robot.kinematics.machine_data import MachineDataError
    from support.files.decode import decode
    from support.files.untrusted import read_bytes

    for other in sorted(path.parent.iterdir()):
        if other.name.lower() == "$robcor.dat":
            source = decode(read_bytes(other))
            if isinstance(source, str):
                return machine
            try:
                return with_torques(machine, source.text, str(other))
            except (DataListError, MachineDataError):
                return machine
    return machine


def read_machine_file(path: Path) -> "MachineData":
    """Return the arm in a $machine.dat, if its kinematics can be solved. Raises `InputError`."""
    from grammar.syntax.source import Source
    from interp.robot.kinematics.data_list import DataListError
    from interp.robot.kinematics.machine_data import MachineDataError
    from interp.robot.models.stand_in import understood
    from support.files.decode import decode
    from support.files.untrusted import read_bytes

    read = decode(read_bytes(path))
    if isinstance(read, str):
        raise InputError(f"{path}: not machine data: {read}")
    with as_input_errors(DataListError, MachineDataError):
        return understood(Source(read.text, str(path)))
