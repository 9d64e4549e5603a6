"""The controller: all its parts, connected to run a program on one virtual clock."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

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
from interp.controller.motion.follower import Follower, Nobody
from interp.controller.motion.motion_queue import MotionQueue, PlannedPoint
from interp.controller.motion.output_switch import OutputSwitch
from interp.controller.motion.positions import FramesInForce, Positions
from interp.controller.quiet_time import QuietTime
from interp.controller.requests.computed_variables import connect_computed
from interp.controller.requests.motion_requests import MotionRequests
from interp.controller.requests.predefined_routines import PredefinedRoutines
from interp.controller.requests.variable_access import VariableAccess
from interp.controller.requests.waits import Waits
from interp.controller.scheduler import HOUR, Handlers, RunOutcome, Scheduler
from interp.controller.spline_stops import SplineStops
from interp.controller.state.declared_interrupts import Interrupts, interrupt_list
from interp.controller.state.error_variable import ErrorVariable
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

#: The number of longest waits that are reported, and of variables that each shows.
_MOST_WAITS, _MOST_NAMES = 5, 4
#: A WAIT SEC that lasts at least this long, in µs, counts as a pause of the program.
_PAUSE = 1_000_000


@dataclass(frozen=True, slots=True)
class ArmState:
    """The state of the arm, as a debugger shows it.

    ``time`` is in µs. ``running`` is the line of the motion that started last, ``None`` if the arm
    has no motion. ``waiting`` and ``ended`` are the numbers of motions that have not ended and that
    have ended.
    """

    time: int
    running: At | None
    waiting: int
    ended: int


class Controller:
    """Runs a program, with a submit program beside it if there is one.

    ``executor`` runs the program and reports its events to ``sink`` (`Trace.sink`), which writes
    them to ``trace``; likewise ``submit``. ``core`` creates the control core from the function that
    switches outputs: ``lambda switch: ControlCore(arm, switch, cycle=1)``. ``machine`` has the
    machine data of the arm, for Status and Turn. ``values`` are the initial values that data lists
    give to system variables. ``follower`` receives the set-points, by default nobody.

    Raises `ScriptError`.
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
        machine: MachineData,
        values: Mapping[str, Value] | None = None,
        follower: Follower | None = None,
    ) -> None:
        script = script or Script()
        state = ControllerState(profile, trace, machine, values or {})
        outputs = OutputSwitch(state.variables, state.signals)
        arm = ArmControl(core(outputs.switch), state.clock, state.variables)
        frames = FramesInForce(state.variables, machine, arm.core)
        follower = follower or Nobody(arm.core.arm)
        positions = Positions(state, arm.core, frames, follower)
        queue = MotionQueue(state, arm.core, outputs, positions, frames, follower)
        channels = Channels(state.clock)
        connect_computed(state, arm.core, queue, channels)
        errors = ErrorVariable(state)
        tasks = [_task("robot", "$RINT_LIST", state, errors, executor, sink)]
        if submit is not None:
            tasks.append(_task("submit", "$SINT_LIST", state, errors, submit, submit_sink))
            state.program_states["submit"] = "P_ACTIVE"  # [SUB-02]
        panel = OperatorPanel(state, arm, tasks)
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
        variables = VariableAccess(state, queue, advance, automatic, errors)
        routines = PredefinedRoutines(state, arm, frames, channels, advance)
        motions = MotionRequests(state, queue)
        handlers: Handlers = {
            requests.Read: variables.read,
            requests.Write: variables.write,
            requests.EmptyError: variables.empty_error,
            requests.Invoke: routines.call,
            requests.Wait: waits.wait,
            requests.Poll: waits.poll,
            requests.Slice: waits.slice,
            requests.Skip: lambda task, one: state.skip(task.name, one.at, one.fault),
            requests.Halt: waits.halt,
            requests.Confirm: waits.confirm,
            requests.Continue: advance.exempt,
            requests.StopAdvance: advance.stop_here,
            requests.Move: motions.move,
            requests.MoveSpline: motions.move,
            requests.MoveEmily: motions.move_emily,
            requests.SetTrigger: queue.set_trigger,
            requests.DeclareInterrupt: interrupts.declare,
            requests.SwitchInterrupt: interrupts.switch,
            requests.BrakeArm: interrupts.brake,
            requests.Resume: interrupts.resume,
            requests.SetCyclicFlag: cyclic.set_flag,
            requests.SwitchSignal: cyclic.switch_signal,
        }
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
            handlers,
            panel,
            player,
            follower,
            QuietTime(state, queue, automatic),
            script.stop,
        )
        self.core = arm.core
        self.variables = state.variables
        self.automatic_inputs = automatic
        self._queue = queue
        self._state = state

    @property
    def points(self) -> list[PlannedPoint]:
        """The end points of all planned motions, except those that end where they start."""
        return self._queue.points

    @property
    def skipped(self) -> Mapping[tuple[str, int], Exception]:
        """Statements that failed and were skipped, each with the reason of its first failure."""
        return self._state.skipped

    @property
    def arm(self) -> ArmState:
        """The present state of the arm."""
        waiting = self._queue.pending
        running = self._queue.running if waiting else None
        return ArmState(self._state.clock.now, running, waiting, self._queue.ended)

    def levels(self, task: TaskName) -> list[tuple[LevelKind, int]]:
        """Return what runs on top of a program, outermost first, each as (kind, priority)."""
        found = (one for one in self._scheduler.tasks if one.name == task)
        return [(level.kind, level.priority) for one in found for level in one.levels]

    def look(self, path: Path) -> Value:
        """Return the value of a system variable, without side effects; raise `Fault`."""
        activity = self.variables.activity
        before = activity.has_read_changing
        try:
            return self.variables.read(path)
        finally:
            activity.has_read_changing = before

    def type_of(self, path: Path) -> Type:
        """Return the type of a system variable or of a part of it; `UNKNOWN` if not in a table."""
        return self.variables.part_type(path)

    def assign(self, path: Path, value: Value) -> None:
        """Assign a value to a system variable, such as an input, from outside; raise `Fault`."""
        self._state.assign(path, value)

    @property
    def unfulfilled(self) -> list[str]:
        """The longest waits of the program, as text; empty without automatic inputs."""
        waited = sorted(self.automatic_inputs.waited.items(), key=lambda one: -one[1][0])
        return [
            f"{_listed(names) or 'a condition'} at {at.file}:{at.line}, {time / 1e6:g} s"
            for at, (time, names) in waited[:_MOST_WAITS]
            if time
        ]

    @property
    def is_pausing(self) -> bool:
        """Whether the robot's program is in a WAIT SEC of which at least a second remains."""
        blocked = self._scheduler.tasks[0].blocked
        if blocked is None or not isinstance(blocked.request, requests.Wait):
            return False
        return blocked.wake is not None and blocked.wake - self._state.clock.now >= _PAUSE

    def run(self, until: int = HOUR) -> RunOutcome:
        """Run until the program ends, halts without a later START, or until a time in µs.

        Raises `ScriptError` for a value that a variable cannot have.
        """
        return self._scheduler.run(until)


def _listed(names: Sequence[str]) -> str:
    """Return the first variables of a condition as text, inputs before the others."""
    shown = sorted(names, key=lambda name: not name.startswith("$IN["))
    more = [f"{len(shown) - _MOST_NAMES} more"] if len(shown) > _MOST_NAMES else []
    return ", ".join(shown[:_MOST_NAMES] + more)


def _task(
    name: TaskName,
    list_name: str,
    state: ControllerState,
    errors: ErrorVariable,
    executor: Executor,
    sink: TaskSink | None,
) -> Task:
    most = state.profile.most
    interrupts = Interrupts(most["interrupts"], most["active_interrupts"])
    if sink is not None:
        sink.left = [interrupts.forget, partial(errors.forget, name)]
    state.variables.connect([list_name], Computed(partial(interrupt_list, interrupts)))
    return Task(name, executor, sink, interrupts)
