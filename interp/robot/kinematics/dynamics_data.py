"""Torques of gears, from the dynamic model in a `$robcor.dat`.

$DYN_DAT is not documented. Its places 12 to 15, 17 and 18 repeat the lengths of the machine data;
37 to 42 are read as what the gears of the axes bear, in Nm (unconfirmed: in four archives they are
of that size, and a half to a tenth of motor torque by gear ratio).
"""

from __future__ import annotations

import math
from dataclasses import replace

from interp.robot.kinematics.data_list import read_data_list
from interp.robot.kinematics.machine_data import ROBOT_AXES, MachineData, MachineDataError

_GEARS = 37
_CLOSE = 0.5  # mm


def with_torques(machine: MachineData, text: str, path: str) -> MachineData:
    """The machine with the torques that its gears bear; as it is where the file has none.

    Raises `MachineDataError` where the file is of another arm, and
    `interp.robot.kinematics.data_list.DataListError` for no data list.
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
            line = next(
                (
                    number
                    for number, line in enumerate(text.splitlines(), start=1)
                    if line.replace(" ", "").upper().startswith(f"$DYN_DAT[{place}]=")
                ),
                1,
            )
            name = values.get(("$MODEL_NAME",))
            other = name.strip().removeprefix("#") if isinstance(name, str) else "another arm"
            raise MachineDataError(
                f"{path}:{line}: $DYN_DAT[{place}] is {datum(place):g}, where the machine data of "
                f"{machine.name} has {length:g}: it is of {other}"
            )
    return replace(machine, torques=tuple(gears))
