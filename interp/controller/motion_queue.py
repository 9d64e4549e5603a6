"""Motions on their way: planned as transactions of the control core, and what becomes of them.

Each KRL motion is one transaction: the motion, for each trigger that switches an output an
`OutputCommand` at its place, for each other trigger a `CallCommand` [TRG-01 to TRG-08]. So outputs
are switched inside the core at their exact time, and what has to be computed is entered by the
controller when the core tells it.
"""

from __future__ import annotations

from collections import defaultdict, deque
from dataclasses import dataclass
from typing import Any, Final, Protocol, runtime_checkable

from interp.controller.messages import message_fault, own_fault
from interp.controller.motions import Built, MotionBuilder
from interp.controller.tasks import Task
from interp.controller.trace import path_text
from interp.controller.world import Setup, World
from interp.port.requests import At, Code, Move, MoveSpline, Path, SetTrigger, Value
from interp.robot.api.commands import (
    CallCommand,
    CoreEvent,
    MotionCommand,
    OutputCommand,
    Transaction,
)
from interp.robot.api.control_core import ControlCore
from interp.robot.arm import Motion, Place, Position
from interp.robot.kinematics.frames import Pose
from interp.values.faults import Fault
from interp.values.json_form import to_json
from interp.values.values import EnumValue

__all__ = ["Call", "Moving", "PlannedPoint"]

#: What triggers that call a routine may have as PRIO [TRG-06].
_PRIORITIES: Final = frozenset({1, 2, *range(4, 40), *range(81, 129)})
#: The most in mm or ms that a trigger may be away from its point [TRG-03, TRG-04].
_FARTHEST: Final = 10_000_000
_PATHS: Final = frozenset({"LIN", "CIRC", "SLIN", "SCIRC"})
_STATUS_BITS: Final = 7
#: The message that a motion leads to where the arm is [MOT-11].
_LENGTH_ZERO: Final = 3171
_KINDS: Final = {
    "started": "motion_start",
    "ended": "motion_end",
    "blend_start": "blend_start",
    "apex": "blend_apex",
    "blend_end": "blend_end",
}


@dataclass(frozen=True, slots=True, eq=False)
class Call:
    """What a trigger does that is more than switching an output."""

    trigger: SetTrigger
    action: Code


@dataclass(slots=True, eq=False)
class _Way:
    """A motion on its way, and where it leads, if the arm tells that.

    ``is_held_up`` once something has stopped the advance run behind it.
    """

    built: Built
    task: Task
    target: Position | None
    is_held_up: bool = False


@dataclass(frozen=True, slots=True)
class PlannedPoint:
    """A motion as it was planned, and where it leads, if the arm tells that.

    ``tool`` is $TOOL as it was then.
    """

    number: int
    kind: str
    at: At
    position: Position | None
    tool: Pose
    is_blended: bool


@runtime_checkable
class _Aiming(Protocol):
    """An arm that knows where the motion planned last leads."""

    def target(self) -> Position: ...


class Moving(World):
    """A controller's motions."""

    def __init__(self, core: ControlCore, setup: Setup) -> None:
        super().__init__(core, setup)
        self.builder = MotionBuilder(self.variables, self.robroot, lambda: self.mode == "T1")
        self._ways: dict[int, _Way] = {}
        self._outputs: dict[OutputCommand, SetTrigger] = {}
        self._calls: dict[CallCommand, SetTrigger] = {}
        #: Outputs that were switched inside the core and are not told yet, in their order.
        self._switched: deque[list[tuple[str, int, Value]]] = deque()
        self._is_switching = False
        #: $OUT_C: what is written at the end of a motion, by its number.
        self._at_end: dict[int, list[tuple[Task, At, Path, Value]]] = defaultdict(list)
        #: Calls of triggers that have fired and were not entered yet.
        self.fired: list[CallCommand] = []
        self.has_stopped = False
        #: Every motion that was planned and leads anywhere, in order.
        self.points: list[PlannedPoint] = []
        #: Where the motion stands in the program that started last.
        self.running: At | None = None
        #: How much has happened, so that one can see whether anything did.
        self.count = 0
        self.stops: list[tuple[Task, Any]] = []

    # ---------------------------------------------------------------------------- planning

    def plan(self, task: Task, request: Move | MoveSpline) -> Built:
        """Plan a motion with the triggers before it. Raises `Fault`; then nothing is planned."""
        triggers, task.triggers = task.triggers, []
        if isinstance(request, MoveSpline):
            if task.levels:
                raise own_fault("spline_place")
            for item in request.items:
                if isinstance(item, SetTrigger):
                    self._check_trigger(item)
            built = self.builder.block(request, triggers)
        else:
            built = self.builder.build(request, triggers)
        self.load(task, built)
        return built

    def load(self, task: Task, built: Built) -> None:
        """Load what was built into the core. Raises `Fault`."""
        motion = built.motion
        command = MotionCommand(motion)
        transaction = Transaction(command)
        places = [*motion.places, *(place for part in motion.parts for place in part.places)]
        outputs, calls = self._link(built, command, transaction, places)
        try:
            self.core.load(self.clock.now, transaction)
        except Fault:
            self.builder.forget()
            raise
        self._outputs |= outputs
        self._calls |= calls
        arm = self.core.arm
        target = arm.target() if isinstance(arm, _Aiming) else None
        self._ways[motion.number] = _Way(built, task, target)
        if _LENGTH_ZERO not in command.notices:
            self.points.append(
                PlannedPoint(
                    motion.number,
                    motion.kind,
                    motion.at,
                    target,
                    motion.settings.placement.tool,
                    bool(motion.criteria),
                )
            )
        if task.level is not None:
            task.level.motions.add(motion.number)
            task.level.has_moved = True
        kind = motion.kind
        self.trace.tell(
            task.name, "motion_planned", motion.at, motion=motion.number, motion_kind=kind
        )
        for number in command.notices:
            self.say_number(motion.at, number)
        self.collect()

    def _link(
        self,
        built: Built,
        command: MotionCommand,
        transaction: Transaction,
        places: list[Place],
    ) -> tuple[dict[OutputCommand, SetTrigger], dict[CallCommand, SetTrigger]]:
        outputs: dict[OutputCommand, SetTrigger] = {}
        calls: dict[CallCommand, SetTrigger] = {}
        for place in places:
            trigger = built.triggers[place.key]
            then: OutputCommand | CallCommand
            if trigger.output is not None:
                then = OutputCommand(*trigger.output)
                outputs[then] = trigger
            else:
                then = CallCommand(Call(trigger, trigger.action))
                calls[then] = trigger
            transaction.add(then).link(command.reached(place), "start", then)
        return outputs, calls

    def set_trigger(self, task: Task, request: SetTrigger) -> None:
        """A trigger for the next motion. Raises `Fault`."""
        if task.levels or task.name == "submit":
            raise message_fault(1409)
        self._check_trigger(request)
        waiting = len(task.triggers) + len(self._outputs) + len(self._calls)
        if waiting >= self.profile.most["triggers"]:
            raise message_fault(1524)
        task.triggers.append(request)

    @staticmethod
    def _check_trigger(request: SetTrigger) -> None:
        """Its priority, and that it lies within 10,000,000 ms and mm [TRG-03 to TRG-06]."""
        if request.priority not in (None, -1) and request.priority not in _PRIORITIES:
            raise own_fault("trigger_priority")
        if max(abs(request.place), abs(request.delay)) > _FARTHEST:
            raise own_fault("trigger_range")

    def output_in_main_run(self, task: Task, at: At, path: Path, value: Value) -> None:
        """$OUT_C: written when the motion planned last ends or is at its apex [ADV-11]."""
        plain: Path = ("$OUT", *path[1:])
        own = self._ways if task.level is None else task.level.motions
        number = max(own, default=0)
        if number and task.name == "robot":
            self.variables.read(plain)  # whether there is such an output
            self._at_end[number].append((task, at, plain, value))
        else:
            self.put_at(task.name, at, plain, value)

    def own_pending(self, task: Task) -> int:
        """How many motions of the program, or of the routine that interrupted it, have not ended.

        An interrupt routine runs while the program's motions go on, so these do not hold it up
        [INT-08] (unconfirmed for its advance stops).
        """
        if task.name == "submit":
            return 0
        return self.core.pending() if task.level is None else len(task.level.motions)

    @property
    def moves(self) -> bool:
        """Whether the arm is on its way, and not standing behind a brake."""
        return self.core.arm.next_event() is not None

    def hold_up(self) -> None:
        """The advance run has been stopped behind the motion planned last, which has no next one.

        Why an earlier one does not blend is told by 1123 and not by 1442 [ADV-12].
        """
        if self._ways:
            self._ways[max(self._ways)].is_held_up = True

    # ------------------------------------------------------------------------ what happens

    def switch(self, path: Path, value: Value, time: int) -> None:
        """The core switches an output. Raises `Fault`."""
        before, self._is_switching = self._is_switching, True
        self._switched.append([])
        now, self.clock.now = self.clock.now, time
        try:
            self.variables.write(path, value)
        except Fault:
            self._switched.pop()
            raise
        finally:
            self.clock.now = now
            self._is_switching = before

    def _signal_changed(self, name: str, place: int, value: Value) -> None:
        if self._is_switching:
            self._switched[-1].append((name, place, value))
        else:
            super()._signal_changed(name, place, value)

    def collect(self) -> None:
        """Take what the arm and the core have done up to now."""
        for event in self.core.run_until(self.clock.now):
            self.count += 1
            self._happened(event)

    def _happened(self, event: CoreEvent) -> None:
        """Something that the core tells."""
        command = event.command
        if isinstance(command, MotionCommand):
            self._moved(event, command.motion.number)
        elif isinstance(command, OutputCommand):
            self._put_out(event, command)
        elif isinstance(command, CallCommand) and event.what == "started":
            self._fire(command)
        elif isinstance(command, CallCommand) and event.what == "cancelled":
            self._calls.pop(command, None)
        elif event.what == "stopped":
            self.has_stopped = True

    def _moved(self, event: CoreEvent, number: int) -> None:
        way = self._ways.get(number)
        if way is None:
            return
        motion, task = way.built.motion, way.task
        if event.what in _KINDS:
            fields: dict[str, Any] = {"motion": number}
            if event.what == "started":
                fields["motion_kind"] = motion.kind
            self.trace.tell(task.name, _KINDS[event.what], motion.at, **fields)
        match event.what:
            case "started":
                self._begins(way)
            case "reached" if event.key in way.built.stops:
                self.stops.append((task, way.built.stops[event.key]))
            case "ended":
                self._ended(event, way)
            case "cancelled" | "failed":
                self._gone(number, task)

    def _begins(self, way: _Way) -> None:
        self.variables.main = way.built.snapshot
        self.running = way.built.motion.at
        self.positions.keep("BACK")
        if way.target is not None:
            self.positions.keep("FOR", (way.target.axes, way.target.flange))
        if self.following is not None:
            self.following.placed(self.clock.now, way.built.motion.settings.placement)

    def _ended(self, event: CoreEvent, way: _Way) -> None:
        motion, task, command = way.built.motion, way.task, event.command
        self._gone(motion.number, task, keeps=True)
        if isinstance(command, MotionCommand) and _LENGTH_ZERO in command.notices:
            task.spent += self.profile.requests // 2  # it took no time: a loop of such has to wait
        for owner, at, path, value in self._at_end.pop(motion.number, ()):
            self.put_at(owner.name, at, path, value)
        if self._is_other_way(motion):
            self.say_number(motion.at, 2936)
        if event.arm is not None and event.arm.is_exact_unwanted:
            number = 1442 if way.is_held_up else 1123  # [ADV-12]
            stops = self.variables.read(("$STOPNOAPROX",)) is True
            self.say_number(motion.at, number, "acknowledgement" if stops else "notification")

    def _is_other_way(self, motion: Motion) -> bool:
        """Whether a path motion has ended with another Status or Turn than programmed [POS-10].

        Bits 3 and 4 of the Status mean nothing [POS-06].
        """
        checks = self.variables.read(("$CP_STATMON",))
        if not isinstance(checks, EnumValue) or motion.kind not in _PATHS or self.machine is None:
            return False
        status, turn = self.positions.status_turn(self.where()[0])
        is_other = "S" in motion.target and (int(motion.target["S"]) ^ status) & _STATUS_BITS != 0
        has_turned = "T" in motion.target and int(motion.target["T"]) != turn
        word = checks.name.upper()
        return (word != "NONE" and is_other) or (word == "CHECK_TS" and has_turned)

    def _gone(self, number: int, task: Task, *, keeps: bool = False) -> None:
        del self._ways[number]
        for level in task.levels:
            level.motions.discard(number)
        if not keeps:
            self._at_end.pop(number, None)

    def _put_out(self, event: CoreEvent, command: OutputCommand) -> None:
        trigger = self._outputs.get(command)
        if trigger is None or event.what == "started":
            return
        del self._outputs[command]
        if event.what != "ended":
            if event.fault is not None:
                self.say("robot", trigger.at, event.fault.number or 0, event.fault.text)
            return
        self.trace.tell(
            "robot",
            "trigger",
            trigger.at,
            sets=path_text(command.path),
            value=to_json(command.value),
        )
        before, self.acting = self.acting, ("robot", trigger.at)
        for name, place, value in self._switched.popleft():
            super()._signal_changed(name, place, value)
        self.acting = before
        self._was_put(command.path, command.value)

    def _fire(self, command: CallCommand) -> None:
        trigger = self._calls.pop(command, None)
        if trigger is None:
            return
        self.trace.tell("robot", "trigger", trigger.at, priority=trigger.priority)
        self.fired.append(command)
