"""Arms that come along: machine data in the words of a `$machine.dat`, and the MJCF made of it.

`kr6r900.dat` says where each of its values is from and what is assumed. `kr6r900.xml` is what
`interp.robot.simulation.mujoco_model` makes of it; a test fails where it is stale.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path

from interp.robot.kinematics.machine_data import MachineData, read_machine

#: The arm of whoever brings no machine data of their own.
DEFAULT = "kr6r900"


def model_file(name: str) -> Path:
    """A file of this folder, such as ``kr6r900.dat``."""
    return Path(__file__).with_name(name)


@cache
def default_machine() -> MachineData:
    """The machine of `DEFAULT`."""
    path = model_file(f"{DEFAULT}.dat")
    return read_machine(path.read_text(encoding="utf-8"), path.name)
