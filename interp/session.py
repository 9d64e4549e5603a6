"""A session: combines a program, an executor, the controller and a robot, and runs them.

Everything on which a run depends is in its `RunSetup`; the same program and setup give the same
trace, bit for bit, on every executor and with every robot.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import field, replace
from typing import TYPE_CHECKING, Any, Literal

from grammar.check.analysis.context import placed
from grammar.syntax import ast
from grammar.syntax.walk import walk
from interp.controller.controller import Controller
from interp.controller.inputs.input_script import Script
from interp.controller.scheduler import HOUR, RunOutcome
from interp.controller.state.profile import Profile
from interp.controller.state.trace import WORLD_KINDS, TaskSink, Trace, TraceEvent
from interp.executors import Prepared
from interp.machine_choice import (
    ChosenMachine,
    machine_or_stand_in,
    own_machine,
    with_own_torques,
)
from interp.port.events import EVERY_KIND, Kind
from interp.port.executor import Executor
from interp.port.requests import Value
from interp.program.load import CheckedProgram, Limits, Routine, Unit
from interp.program.variables import data_lists
from interp.robot.api.batch import BatchCore
from interp.robot.api.control_core import ControlCore, Switch
from interp.robot.kinematics.machine_data import ROBOT_AXES, MachineData
from interp.robot.planning.deferred_arm import deferred_arm
from interp.robot.simulation.factory import RobotName, make_robot
from interp.robot.simulation.robot import Robot
from interp.robot.simulation.scene import Scene
from interp.standins.uses import FOLDER
from interp.values.faults import Fault, LinkError
from interp.values.values import StructureValue
from support.lazy_dataclass import dataclass

if TYPE_CHECKING:
    from interp.debugging.debugger import Debugger
    from interp.robot.planning.planned_arm import PlannedArm
    from interp.robot.simulation.observations import Observation, Observer
    from interp.robot.simulation.robot_files import RobotFile
    from interp.robot.simulation.tracking import PathRecord, Tracking


#: Where the arm stands at first, in degrees, where the project says nothing of it: upright, its
#: forearm level. Where something stands in its hand is bent, so that a line may lead away from
#: there: a program may have lost the PTP that it begins with.
_UPRIGHT = (0.0, -90.0, 90.0, 0.0, 0.0, 0.0)
_BENT = (0.0, -90.0, 90.0, 0.0, 45.0, 0.0)
#: What depends on which routines are open: interrupts end with them, $ERR.UP_NAME is one.
_NEED_CALLS = (ast.InterruptDeclaration, ast.OnErrorProceed)


@dataclass(frozen=True, slots=True)
class RunSetup:
    """What a program is run with.

    ``routine`` is the one to begin with, by default the first of the first file; ``submit`` that of
    a submit program in the same project. ``machine`` is the arm, by default that of the project's
    ``$machine.dat``, else that of the profile. ``start`` are the axes at the beginning in degrees
    or mm, by default those of $H_POS if the project has it. ``is_full`` has every line and
    assignment traced; without ``is_traced`` executors report nothing that the run does not need,
    which leaves calls and branches out of the trace, without ``is_submit_traced`` those of the
    submit program. ``motion`` is how motions are planned: as they become known, or in batches.
    ``until`` is the most virtual time in µs, ``patience`` how long the arm may stand outside of a
    WAIT SEC before it counts as over; ``limits`` are the most statements and calls.
    ``make_robot`` makes another robot than ``robot`` names, of the machine and the cycle in µs.
    ``scene`` is what stands around the arm, ``robot_file`` an arm in place of that of the project.
    ``is_tolerant``: where another arm stands in for one whose machine data is not understood, or a
    declaration for one that the project lacks, the controller skips motions that cannot be planned
    and predefined routines that are not simulated, and where it ``skips_failures`` also all other
    statements that fail.
    """

    executor: str = "tree"
    robot: RobotName = "none"
    profile: Profile = field(default_factory=Profile.load)
    script: Script = field(default_factory=Script)
    routine: str | None = None
    submit: str | None = None
    machine: MachineData | None = None
    start: tuple[float, ...] | None = None
    is_full: bool = False
    is_traced: bool = True
    is_submit_traced: bool = True
    motion: Literal["lookahead", "batch"] = "lookahead"
    until: int = HOUR
    patience: int = HOUR
    limits: Limits | None = None
    make_robot: Callable[[MachineData, int], Robot] | None = None
    scene: Scene | None = None
    robot_file: RobotFile | None = None
    is_tolerant: bool = False
    skips_failures: bool = False


@dataclass(frozen=True, slots=True)
class RunResult:
    """The result of a run: how it ended, the trace, and the path of the arm.

    ``executor`` is the executor after the run; a companion can inspect its data lists.

    ``path`` is ``None`` with the robot ``none``, which receives no set-points. ``machine`` and
    ``start`` are those that were used; ``observations`` are contacts of the arm, with a scene or
    MuJoCo, and torques beyond its limits; ``torque_note`` says why torques of the project were left
    out; ``machine_note`` says why the machine is not the project's own, if that had to be reported.
    """

    outcome: RunOutcome
    events: Sequence[TraceEvent]
    path: PathRecord | None
    machine: MachineData
    start: tuple[float, ...]
    controller: Controller
    executor: Executor
    machine_note: str = ""
    observations: tuple[Observation, ...] = ()
    torque_note: str = ""


def run_program(
    prepared: Prepared | CheckedProgram,
    setup: RunSetup,
    *,
    take: Callable[[TraceEvent], None] | None = None,
    on_time: Callable[[int], None] = lambda _now: None,
    debugger: Debugger | None = None,
) -> RunResult:
    """Run a program to its end, its fault or the end of its time.

    ``take`` receives each event as it happens, in place of being kept; ``on_time`` receives the
    virtual time now and then. A ``debugger`` calls this as often as it needs
    (`interp.debugging.debugger.Debugger.run`). Raises `LinkError` for a program that cannot begin,
    `interp.controller.inputs.input_script.ScriptError` for a script about what does not exist, and
    `ImportError` for a robot that is not installed.
    """
    if isinstance(prepared, CheckedProgram):
        prepared = Prepared(prepared, setup.routine, [setup.submit])
    program = prepared.program
    starts = program.starts(prepared.routine, setup.submit)  # says what is wrong with them
    chosen, is_incomplete = _chosen_machine(program, starts, setup)
    machine, profile, torque_note = chosen.machine, setup.profile, ""
    if setup.is_tolerant:
        profile = replace(profile, is_tolerant=is_incomplete, brings_arm=setup.skips_failures)
    if setup.robot == "mujoco" and setup.machine is None and setup.robot_file is None:
        machine, torque_note = with_own_torques(machine, program)
    values = _system_values(program)
    start = setup.start or _home(values, machine, _BENT if is_incomplete else _UPRIGHT)
    arm = _arm(machine, start, setup.robot_file)
    if setup.make_robot is not None:
        robot = setup.make_robot(machine, profile.cycle)
    else:
        robot = make_robot(setup.robot, machine, profile.cycle, setup.scene, setup.robot_file)
    tracking = _tracking(arm, robot, machine, start, setup)
    arguments = _stand_in_arguments(program.reached(*starts)) if setup.is_traced else None
    trace = Trace(take, kinds=_kinds(program, setup), arguments=arguments)
    sink, submit_sink = _sinks(trace, program, setup)
    limits = replace(
        setup.limits or Limits(per_slice=profile.statements),
        skips_failures=setup.skips_failures and is_incomplete,
    )
    executor = prepared.executor(setup.executor, limits, sink)
    if debugger is not None:
        executor = debugger.around(executor, limits.per_slice)
    submit = executor.companion(setup.submit, submit_sink) if setup.submit else None
    kind = BatchCore if setup.motion == "batch" else ControlCore

    def core(switch: Switch) -> ControlCore:
        return kind(arm, switch, 1)

    controller = Controller(
        executor,
        core,
        profile=profile,
        script=setup.script,
        trace=trace,
        sink=sink,
        submit=submit,
        submit_sink=submit_sink,
        machine=machine,
        values={**values, "$EX_AX_NUM": len(machine.externals)},  # of the arm that runs
        follower=tracking,
    )
    if debugger is not None:
        debugger.attach(controller)
    outcome = _run(controller, setup, on_time)
    return RunResult(
        outcome,
        trace.events,
        tracking.record() if tracking is not None and robot.step else None,
        machine,
        tuple(start),
        controller,
        executor,
        chosen.note,
        tracking.observations() if tracking is not None else (),
        torque_note,
    )


def _chosen_machine(
    program: CheckedProgram, starts: Sequence[Routine], setup: RunSetup
) -> tuple[ChosenMachine, bool]:
    """Return the arm of a run, and whether the run must tolerate what the project lacks."""
    used = program.used_stand_ins(*starts)
    lacks_files = setup.is_tolerant and any(one.origin != "argument" for one in used)
    given = setup.robot_file.machine if setup.robot_file is not None else setup.machine
    if given is not None:
        return ChosenMachine(given), lacks_files
    if not setup.is_tolerant:
        return ChosenMachine(own_machine(program, setup.profile)), False
    chosen = machine_or_stand_in(
        program,
        setup.profile,
        program.reached(*starts),
        lacks_files=lacks_files,
        skips_failures=setup.skips_failures,
    )
    return chosen, lacks_files or chosen.is_other


def _system_values(program: CheckedProgram) -> Mapping[str, Value]:
    """Return the values of system variables in data lists; fast if there are none."""
    if next(data_lists(program), None) is None:
        return {}
    from interp.tree.memory import system_values

    return system_values(program)


def _arm(machine: MachineData, start: Sequence[float], file: RobotFile | None) -> PlannedArm:
    """Return the arm; raises `LinkError` if its start position is impossible.

    The masses of a robot from a ``file`` are known, so that its torques limit its motions.
    """

    def made() -> PlannedArm:
        from interp.robot.planning.planned_arm import PlannedArm

        if file is None or not machine.torques:
            return PlannedArm(machine, start)
        from interp.robot.simulation.cell import Cell
        from interp.robot.simulation.inverse_dynamics import InverseDynamics

        return PlannedArm(machine, start, InverseDynamics(Cell(machine, robot=file)))

    arm = deferred_arm(made)
    every = zip(machine.every_axis, machine.standing(start), strict=True)
    stands = all(axis.lower <= value <= axis.upper for axis, value in every)
    if not stands or machine.palletising is not None or not machine.is_wrist_central:
        try:  # what is impossible is reported before the program runs
            arm.target()
        except Fault as fault:
            raise LinkError(f"the arm cannot stand at its start: {fault}") from fault
    return arm


def _tracking(
    arm: PlannedArm,
    robot: Robot,
    machine: MachineData,
    start: Sequence[float],
    setup: RunSetup,
) -> Tracking | None:
    """Return who sends set-points, where there is somebody to take them."""
    if not robot.step and setup.scene is None:
        return None
    from interp.robot.simulation.tracking import Tracking

    return Tracking(arm, robot, machine, setup.profile.cycle, start, _observer(machine, setup))


def _kinds(program: CheckedProgram, setup: RunSetup) -> frozenset[Kind]:
    """Return events that executors report; at least the calls that interrupts and $ERR need."""
    if setup.is_full:
        return EVERY_KIND
    return WORLD_KINDS if setup.is_traced else _needed_kinds(program)


def _sinks(trace: Trace, program: CheckedProgram, setup: RunSetup) -> tuple[TaskSink, TaskSink]:
    """Return the sinks of both programs, without calls that only serve interrupts and $ERR."""
    is_traced = setup.is_full or setup.is_traced
    silent = None if setup.is_submit_traced else _needed_kinds(program)
    return trace.sink(keeps_calls=is_traced), trace.sink(
        "submit", silent, keeps_calls=is_traced and setup.is_submit_traced
    )


def _stand_in_arguments(units: Sequence[Unit]) -> dict[tuple[str, int, str], str]:
    """Return the calls of stand-ins with their arguments as written, for the trace."""
    names = {unit.module.name.upper() for unit in units if unit.module.folder == FOLDER}
    found: dict[tuple[str, int, str], str] = {}
    for unit in units if names else ():
        module = unit.module
        if module.syntax is None or module.suffix == ".dat" or module.folder == FOLDER:
            continue
        for node in walk(module.syntax):
            if isinstance(node, ast.Call) and node.name.key in names:
                text = unit.source.text[slice(*node.span)].partition("(")[2].rpartition(")")[0]
                found.setdefault((module.path, unit.line(node), node.name.key), text.strip())
    return found


def _needed_kinds(program: CheckedProgram) -> frozenset[Kind]:
    routines = (routine.node for routine in program.routines.values())
    statements = (one.statement for routine in routines for one in placed(routine.body))
    needs_calls = any(isinstance(one, _NEED_CALLS) for one in statements)
    return frozenset({"call", "return"}) if needs_calls else frozenset()


def _observer(machine: MachineData, setup: RunSetup) -> Observer | None:
    """Return who looks for contacts, where there is something to touch."""
    if setup.scene is None and (setup.robot != "mujoco" or setup.make_robot is not None):
        return None
    from interp.robot.simulation.cell import Cell
    from interp.robot.simulation.contacts import ContactCheck

    return ContactCheck(Cell(machine, setup.scene or Scene(), setup.robot_file))


#: Virtual time in µs from one report of progress to the next, while the arm moves and when it
#: has come to stand: the longer it stands the longer that is.
_REPORT, _LONG_REPORT = 1_000_000, 5_000_000


def _run(controller: Controller, setup: RunSetup, on_time: Callable[[int], None]) -> RunOutcome:
    now = moved = known = 0
    while True:
        report = _REPORT if moved == now else max(_LONG_REPORT, now - moved)
        now = min(now + report, max(moved + setup.patience, now + _REPORT), setup.until)
        outcome = controller.run(now)
        on_time(outcome.time)
        if outcome.ending != "time" or now >= setup.until or outcome.time < now:
            return outcome
        if controller.core.pending() or len(controller.points) > known:
            moved, known = now, len(controller.points)
        if now - moved >= setup.patience and not controller.is_pausing:
            return outcome


def _home(
    values: Mapping[str, Value], machine: MachineData, upright: tuple[float, ...]
) -> tuple[float, ...]:
    """$H_POS where the project has it and the arm can stand there, else ``upright``."""
    home: Any = values.get("$H_POS")
    axes = upright
    if isinstance(home, StructureValue):
        found = [home.get(f"A{number}") for number in range(1, ROBOT_AXES + 1)]
        known = [float(value) for value in found if isinstance(value, int | float)]
        axes = tuple(known) if len(known) == ROBOT_AXES else axes
    fits = all(
        axis.lower <= value <= axis.upper for axis, value in zip(machine.axes, axes, strict=True)
    )
    if fits:
        return axes
    return tuple(
        min(max(value, axis.lower), axis.upper)
        for axis, value in zip(machine.axes, upright, strict=True)
    )
