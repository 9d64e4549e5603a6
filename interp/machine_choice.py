"""Which arm a program runs on: its project's, that of the profile, or a stand-in."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from interp.program.load import CheckedProgram, Unit
from interp.robot.kinematics.data_list import DataListError
from interp.robot.kinematics.gear_torques import with_torques
from interp.robot.kinematics.machine_data import MachineData, MachineDataError
from interp.robot.kinematics.machine_reader import read_machine
from interp.robot.models import default_machine, model_file
from interp.robot.models.stand_in import (
    NO_MACHINE,
    arm_or_stand_in,
    machine_data_of,
    reaching,
    understood,
    with_assumed_limits,
)
from interp.standins.uses import FOLDER
from interp.values.faults import LinkError
from support.lazy_dataclass import dataclass

if TYPE_CHECKING:
    from grammar.syntax.source import Source
    from interp.controller.state.profile import Profile


@dataclass(frozen=True, slots=True)
class ChosenMachine:
    """The arm of a run.

    ``note`` says why it is not that of the project, if that has to be reported. ``is_other``: the
    project has machine data of an arm that is not understood.
    """

    machine: MachineData
    note: str = ""
    is_other: bool = False


def own_machine(program: CheckedProgram, profile: Profile) -> MachineData:
    """Return the arm in the project's machine data, or that of the profile.

    Raises `LinkError` if the project has machine data of an arm that is not understood.
    """
    source = machine_data_of(_own_sources(program.units.values()))
    if source is None:
        return _named_by(profile)
    try:
        return understood(source)
    except (DataListError, MachineDataError) as error:
        raise LinkError(str(error)) from error


def machine_or_stand_in(
    program: CheckedProgram,
    profile: Profile,
    reached: Sequence[Unit],
    *,
    lacks_files: bool,
    skips_failures: bool,
) -> ChosenMachine:
    """Return the arm in the project's machine data, or another one with the reason.

    Without machine data it is an arm that reaches the points of the files that are ``reached``. Its
    limits are assumed where other files are lacking as well, or where it had to be moved and the
    run ``skips_failures``.
    """
    sources = _own_sources(program.units.values())
    machine, note = arm_or_stand_in(sources, _named_by(profile), _own_sources(reached))
    if not note or machine_data_of(sources) is not None:
        return ChosenMachine(machine, note, is_other=bool(note))
    fitting = reaching(machine, (one.source.text for one in reached))
    if lacks_files or (fitting is not machine and skips_failures):
        machine = with_assumed_limits(fitting)
        note = f"{NO_MACHINE}: {machine.name} is used instead, without axis limits"
    return ChosenMachine(machine, note)


def with_own_torques(machine: MachineData, program: CheckedProgram) -> tuple[MachineData, str]:
    """Return the machine with the torques in the project's $robcor.dat, or why it has none."""
    for unit in program.units.values():
        if unit.module.name == "$ROBCOR" and unit.module.suffix == ".dat":
            try:
                return with_torques(machine, unit.source.text, unit.source.path), ""
            except (DataListError, MachineDataError) as error:
                return machine, str(error)
    return machine, ""


def _own_sources(units: Iterable[Unit]) -> list[Source]:
    """Return the files of the project itself, without stand-ins."""
    return [unit.source for unit in units if unit.module.folder != FOLDER]


def _named_by(profile: Profile) -> MachineData:
    """Return the arm that a profile names; raises `LinkError` if there is none."""
    if profile.machine == default_machine().name.lower():
        return default_machine()
    path = model_file(f"{profile.machine}.dat")
    try:
        return read_machine(path.read_text(encoding="utf-8"), path.name)
    except OSError as error:
        raise LinkError(f"the profile names an unknown arm: {profile.machine}") from error
    except (DataListError, MachineDataError) as error:
        raise LinkError(str(error)) from error
