"""A controller: the parts that run a program on one virtual clock, put together."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from grammar.semantics.types import Type
from interp.controller.inputs.automatic_inputs import AutomaticInputs
from interp.controller.inputs.channels import Channels
from interp.controller.inputs.input_script import Script
from interp.controller.inputs.operator_panel import OperatorPanel
from interp.controller.inputs.script_player import ScriptPlayer
from interp.controller.interrupts.cyclic_evaluation import CyclicEvaluation
from interp.controller.interrupts.interrupt_unit import InterruptUnit
from interp.controller.interrupts.levels import Levels
from interp.controller.motion.advance_run import AdvanceRun
from interp.controller.motion.arm_control import ArmControl
from interp.controller.motion.motion_queue import MotionQueue, PlannedPoint
from interp.controller.motion.output_switch import OutputSwitch
from interp.controller.motion.positions import FramesInForce, Positions
from interp.controller.quiet_time import QuietTime
from interp.controller.requests.computed_variables import connect_computed
from interp.controller.requests.motion_requests import MotionRequests
from interp.controller.requests.predefined_routines import PredefinedRoutines
from interp.controller.requests.request_table import RequestTable
from interp.controller.requests.variable_access import VariableAccess
from interp.controller.requests.waits import Waits
from interp.controller.scheduler import HOUR, RunOutcome, Scheduler
from interp.controller.spline_stops import SplineStops
from interp.controller.state.interrupts import Interrupts, interrupt_list
from interp.controller.state.profile import Profile
from interp.controller.state.state import ControllerState
from interp.controller.state.tasks import LevelKind, Task
from interp.controller.state.trace import TaskName, TaskSink, Trace
from interp.controller.state.variables import Computed
from interp.port import requests
from interp.port.executor import Executor
from interp.port.requests import At, Path, Value
from interp.robot.api.control_core import ControlCore, Switch
from interp.robot.kinematics.machine_data import MachineData

if TYPE_CHECKING:
    from interp.robot.simulation.tracking import Tracking

#: Of all waits the longest are reported, each with its first variables.
_MOST_WAITS, _MOST_NAMES = 5, 4
#: How long a WAIT SEC has to last, in µs, for a program to count as one that pauses.
_PAUSE = 1_000_000


@dataclass(frozen=True, slots=True)
class ArmState:
    """The time in µs, the motion under way, and how many have not ended and have ended.

    ``running`` is the line of the motion that has started last, ``None`` while the arm has none.
    """

    time: int
    running: At | None
    waiting: int
    ended: int


class Controller:
    """Runs a program, and a submit program beside it.

    ``executor`` has the program; its sink is ``sink`` (`Trace.sink`), so that its events get into
    ``trace``, and likewise for ``submit``. ``core`` makes the control core, given what switches
    outputs: ``lambda switch: ControlCore(arm, switch, cycle=1)``. ``machine`` is that of the arm,
    for Status and Turn; ``values`` are those that data lists give system variables at first;
    ``tracking`` sends the set-points to a robot and measures where it is. Raises `ScriptError`.
    """

    def __init__(
        self,
        executor: Executor,
        core: Callable[[Switch], ControlCore],
        *,
        profile: Profile,
        script: Script | None = None,
        trace: Trace,
        sink: TaskSink,
        submit: Executor | None = None,
        submit_sink: TaskSink | None = None,
        machine: MachineData | None = None,
        values: Mapping[str, Value] | None = None,
        tracking: Tracking | None = None,
    ) -> None:
        script = script or Script()
        state = ControllerState(profile, trace, machine, values or {})
        outputs = OutputSwitch(state.clock, state.variables, state.signals)
        arm = ArmControl(core(outputs.switch), state.clock, state.variables)
        frames = FramesInForce(state.variables, machine, arm.core)
        positions = Positions(state, arm.core, frames, tracking)
        queue = MotionQueue(state, arm.core, outputs, positions, frames, tracking)
        connect_computed(state, arm.core, queue)
        tasks = [_task("robot", "$RINT_LIST", state, executor, sink)]
        if submit is not None:
            tasks.append(_task("submit", "$SINT_LIST", state, submit, submit_sink))
        panel = OperatorPanel(state, arm, tasks)
        channels = Channels(state.clock)
        player = ScriptPlayer(script, state, panel, channels)
        automatic = AutomaticInputs(script, state)
        advance = AdvanceRun(state, queue)
        levels = Levels(state, arm, positions, queue)
        interrupts = InterruptUnit(state, arm, positions, queue, advance, levels)
        cyclic = CyclicEvaluation(state, advance, levels)
        waits = Waits(state, queue, advance, panel, player, automatic)
        state.observers += [arm.changed, player.changed]
        state.messages.listeners += [player.shown, panel.shown]
        channels.listeners.append(player.received)
        motions = MotionRequests(state, queue)
        table = _table(
            state,
            VariableAccess(state, queue, advance, automatic),
            PredefinedRoutines(state, arm, frames, channels, advance),
            waits,
            motions,
            queue,
            interrupts,
            cyclic,
            advance,
        )
        self._scheduler = Scheduler(
            state,
            tasks,
            arm,
            queue,
            levels,
            interrupts,
            cyclic,
            SplineStops(state, arm, queue, panel),
            advance,
            waits,
            table,
            panel,
            player,
            tracking,
            QuietTime(state, queue, automatic),
            script.stop,
        )
        self.core = arm.core
        self.variables = state.variables
        self.automatic_inputs = automatic
        self.skipped = state.skipped
        self._queue = queue
        self._state = state

    @property
    def points(self) -> list[PlannedPoint]:
        """The end points of all motions that were planned and do not end where they start."""
        return self._queue.points

    @property
    def arm(self) -> ArmState:
        """What the arm does now."""
        waiting = self._queue.pending
        running = self._queue.running if waiting else None
        return ArmState(self._state.clock.now, running, waiting, self._queue.ended)

    def levels(self, task: TaskName) -> list[tuple[LevelKind, int]]:
        """What runs on top of a program, the outermost first: its kind and priority."""
        found = (one for one in self._scheduler.tasks if one.name == task)
        return [(level.kind, level.priority) for one in found for level in one.levels]

    def look(self, path: Path) -> Value:
        """The value of a system variable, without any side effect; raises `Fault`."""
        before = self.variables.has_read_changing
        try:
            return self.variables.read(path)
        finally:
            self.variables.has_read_changing = before

    def type_of(self, path: Path) -> Type:
        """The type of a system variable or a part of it, `UNKNOWN` where no table has it."""
        return self.variables.part_type(path)

    def assign(self, path: Path, value: Value) -> None:
        """Give a system variable a value from outside, an input for instance; raises `Fault`."""
        self._state.assign(path, value)

    @property
    def unfulfilled(self) -> list[str]:
        """Where the program has waited longest, and for what; only with automatic inputs."""
        waited = sorted(self.automatic_inputs.waited.items(), key=lambda one: -one[1][0])
        return [
            f"{_listed(names) or 'a condition'} at {at.file}:{at.line}, {time / 1e6:g} s"
            for at, (time, names) in waited[:_MOST_WAITS]
            if time
        ]

    @property
    def is_pausing(self) -> bool:
        """Whether the robot's program is in a WAIT SEC that lasts another second at least."""
        blocked = self._scheduler.tasks[0].blocked
        if blocked is None or not isinstance(blocked.request, requests.Wait):
            return False
        return blocked.wake is not None and blocked.wake - self._state.clock.now >= _PAUSE

    def run(self, until: int = HOUR) -> RunOutcome:
        """Run until the program ends, or halts without a later start, or until a time in µs.

        After a `halt` a further call is START. Raises `ScriptError` for a value that a variable
        cannot have.
        """
        return self._scheduler.run(until)


def _listed(names: Sequence[str]) -> str:
    """The first variables of a condition, its inputs before the others."""
    shown = sorted(names, key=lambda name: not name.startswith("$IN["))
    more = [f"{len(shown) - _MOST_NAMES} more"] if len(shown) > _MOST_NAMES else []
    return ", ".join(shown[:_MOST_NAMES] + more)


def _task(
    name: TaskName,
    list_name: str,
    state: ControllerState,
    executor: Executor,
    sink: TaskSink | None,
) -> Task:
    most = state.profile.most
    interrupts = Interrupts(most["interrupts"], most["active_interrupts"])
    if sink is not None:
        sink.left = interrupts.forget
    state.variables.connect([list_name], Computed(partial(interrupt_list, interrupts)))
    return Task(name, executor, sink, interrupts)


def _table(
    state: ControllerState,
    variables: VariableAccess,
    routines: PredefinedRoutines,
    waits: Waits,
    motions: MotionRequests,
    queue: MotionQueue,
    interrupts: InterruptUnit,
    cyclic: CyclicEvaluation,
    advance: AdvanceRun,
) -> RequestTable:
    """The handlers of all requests but those that end a program, which the scheduler handles."""
    table = RequestTable()
    table.add(requests.Read, variables.read)
    table.add(requests.Write, variables.write)
    table.add(requests.Invoke, routines.call)
    table.add(requests.Wait, waits.wait)
    table.add(requests.Poll, waits.poll)
    table.add(requests.Slice, waits.slice)
    table.add(requests.Skip, lambda task, one: state.skip(task.name, one.at, one.fault))
    table.add(requests.Halt, waits.halt)
    table.add(requests.Confirm, waits.confirm)
    table.add(requests.Continue, advance.exempt)
    table.add(requests.StopAdvance, advance.stop_here)
    table.add(requests.Move, motions.move)
    table.add(requests.MoveSpline, motions.move)
    table.add(requests.MoveEmily, motions.move_emily)
    table.add(requests.SetTrigger, queue.set_trigger)
    table.add(requests.DeclareInterrupt, interrupts.declare)
    table.add(requests.SwitchInterrupt, interrupts.switch)
    table.add(requests.BrakeArm, interrupts.brake)
    table.add(requests.Resume, interrupts.resume)
    table.add(requests.SetCyclicFlag, cyclic.set_flag)
    table.add(requests.SwitchSignal, cyclic.switch_signal)
    return table
