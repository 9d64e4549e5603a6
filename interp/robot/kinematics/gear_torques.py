"""The torques of gears, read from the dynamic model in a `$robcor.dat`.

$DYN_DAT is undocumented. Its elements 12 to 15, 17 and 18 repeat lengths of the machine data.
Elements 37 to 42 are read as the torques that the gears of the axes can bear, in Nm (unconfirmed:
in four archives they are of that size, and between a half and a tenth of motor torque times gear
ratio).
"""

from __future__ import annotations

import math
from dataclasses import replace

from interp.robot.kinematics.data_list import line_of, read_data_list
from interp.robot.kinematics.machine_data import ROBOT_AXES, MachineData, MachineDataError

_GEARS = 37
_CLOSE = 0.5  # mm


def with_torques(machine: MachineData, text: str, path: str) -> MachineData:
    """Return the machine with the torques that its gears can bear; unchanged if the file has none.

    Raises `MachineDataError` if the file belongs to another arm, and
    `interp.robot.kinematics.data_list.DataListError` if it is not a data list.
    """
    values = read_data_list(text, path)

    def datum(place: int) -> float:
        value = values.get(("$DYN_DAT", place))
        return float(value) if isinstance(value, int | float) else math.nan

    forward, _, up = machine.tx3p3.position
    lengths = {
        12: machine.tiroro.position[2],
        13: machine.length_a,
        14: machine.length_b,
        15: up,
        17: forward,
        18: machine.tflwp.position[2],
    }
    gears = [datum(_GEARS + place) for place in range(ROBOT_AXES)]
    if not all(0.0 < gear < math.inf for gear in gears):
        return machine
    for place, length in lengths.items():
        if not abs(datum(place) - length) < _CLOSE:
            line = line_of(text, f"$DYN_DAT[{place}]") or 1
            name = values.get(("$MODEL_NAME",))
            other = name.strip().removeprefix("#") if isinstance(name, str) else "another arm"
            raise MachineDataError(
                f"{path}:{line}: $DYN_DAT[{place}] is {datum(place):g}, where the machine data of "
                f"{machine.name} has {length:g}: it is of {other}"
            )
    return replace(machine, torques=tuple(gears))
