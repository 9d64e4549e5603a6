"""Torques of gears from a dynamic model, and a model that is another arm's."""

from collections.abc import Callable

import pytest

from interp.robot.kinematics.gear_torques import with_torques
from interp.robot.kinematics.machine_data import MachineDataError
from interp.robot.kinematics.machine_reader import read_machine

LENGTHS = {12: 400.0, 13: 25.0, 14: 455.0, 15: 35.0, 17: 420.0, 18: 80.0}
GEARS = (372.0, 300.0, 161.0, 42.0, 42.0, 28.0)


def robcor(**changed: float) -> str:
    values = {**LENGTHS, **{37 + place: gear for place, gear in enumerate(GEARS)}}
    values |= {int(name.removeprefix("d")): value for name, value in changed.items()}
    lines = [f"$DYN_DAT[{place}]={value}" for place, value in values.items()]
    head = ["DEFDAT $ROBCOR PUBLIC", "CHAR $MODEL_NAME[32]", '$MODEL_NAME[]="#OTHER ARM"']
    return "\n".join([*head, "REAL $DYN_DAT[500]", *lines, "ENDDAT", ""])


def test_gears_of_the_same_arm(machine_text: Callable[..., str]) -> None:
    """Where the lengths agree, the gears bear what the model says."""
    machine = read_machine(machine_text())
    assert GEARS == with_torques(machine, robcor(), "r.dat").torques


def test_a_model_of_another_arm(machine_text: Callable[..., str]) -> None:
    """Another length is one line with file, line, both figures and whose model it is."""
    machine = read_machine(machine_text())
    with pytest.raises(MachineDataError) as caught:
        with_torques(machine, robcor(d14=1200.0), "r.dat")
    said = "r.dat:7: $DYN_DAT[14] is 1200, where the machine data of TRY6R900 C4 FLR has 455: "
    assert f"{said}it is of OTHER ARM" == str(caught.value)


def test_no_gears(machine_text: Callable[..., str]) -> None:
    """A model that says nothing of gears leaves the machine as it is."""
    machine = read_machine(machine_text())
    assert machine == with_torques(machine, robcor(d39=0.0), "r.dat")
