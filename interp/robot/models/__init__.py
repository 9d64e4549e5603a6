"""The built-in arms: machine data in the form of a `$machine.dat`, and the MJCF generated from it.

`kr6r900.dat` names the source of each value and says what is assumed. `kr6r900.xml` is the output
of `interp.robot.simulation.mujoco_model`; a test fails if it is stale.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path

from interp.robot.kinematics.machine_data import MachineData
from interp.robot.kinematics.machine_reader import read_machine

#: The arm that is used if a project has no machine data.
DEFAULT = "kr6r900"


def model_file(name: str) -> Path:
    """Return the path of a file in this folder, such as ``kr6r900.dat``."""
    return Path(__file__).with_name(name)


@cache
def default_machine() -> MachineData:
    """Return the machine data of `DEFAULT`."""
    path = model_file(f"{DEFAULT}.dat")
    return read_machine(path.read_text(encoding="utf-8"), path.name)
