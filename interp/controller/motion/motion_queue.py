"""The motion queue: it plans KRL motions as transactions of the control core [ADV-12].

A transaction consists of one motion, an `OutputCommand` at its place for each trigger that switches
an output, and a `CallCommand` for each other trigger [TRG-01 to TRG-08]. So the core switches
outputs at their exact time. Actions that need the program are entered by the controller after the
core has reported them. The queue also posts the messages of blends that fail.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from typing import Any, Final, Protocol, runtime_checkable

from grammar.motion_kinds import AXIS_MOTIONS, SPLINE_MOTIONS, WITHOUT_PATH
from interp.controller.motion.follower import Follower
from interp.controller.motion.motion_builder import MotionBuilder, PlannedMotion
from interp.controller.motion.output_switch import OutputSwitch
from interp.controller.motion.positions import FramesInForce, Positions, constant_text
from interp.controller.state.messages import message_fault, own_fault
from interp.controller.state.state import ControllerState
from interp.controller.state.tasks import Task
from interp.port.requests import (
    At,
    Move,
    MoveSpline,
    Path,
    SetTrigger,
    SplineStop,
    Value,
    path_text,
)
from interp.robot.api.commands import (
    CallCommand,
    CoreEvent,
    MotionCommand,
    OutputCommand,
    Transaction,
)
from interp.robot.api.control_core import ControlCore
from interp.robot.arm import Motion, Position
from interp.values.faults import Fault
from interp.values.json_form import to_json
from interp.values.poses import Pose
from support.lazy_dataclass import dataclass

#: The values that PRIO may have for triggers that call a routine [TRG-06].
_PRIORITIES: Final = frozenset({1, 2, *range(4, 40), *range(81, 129)})
#: The largest distance in mm, and delay in ms, of a trigger from its point [TRG-03, TRG-04].
_FARTHEST: Final = 10_000_000
_STATUS_BITS: Final = 7
#: The message for a motion to the present position [MOT-11].
_LENGTH_ZERO: Final = 3171
_KINDS: Final = {
    "started": "motion_start",
    "ended": "motion_end",
    "blend_start": "blend_start",
    "apex": "blend_apex",
    "blend_end": "blend_end",
}


@dataclass(slots=True, eq=False)
class _QueuedMotion:
    """A motion that has not ended, with its end point if the arm knows it.

    ``stops_advance`` is set once a statement after it has stopped the advance run.
    """

    planned: PlannedMotion
    task: Task
    target: Position | None
    stops_advance: bool = False


@dataclass(frozen=True, slots=True)
class PlannedPoint:
    """The end point of a motion as planned, if the arm knows it.

    ``tool`` is the value of $TOOL at that time.
    """

    number: int
    kind: str
    at: At
    position: Position | None
    tool: Pose


@runtime_checkable
class _HasTarget(Protocol):
    """An arm that knows the end point of the motion that was planned last."""

    def target(self) -> Position: ...


class MotionQueue:
    """Plans motions, and follows their execution by the control core.

    ``follower`` is told each motion that starts.
    """

    def __init__(
        self,
        state: ControllerState,
        core: ControlCore,
        outputs: OutputSwitch,
        positions: Positions,
        frames: FramesInForce,
        follower: Follower,
    ) -> None:
        self._state = state
        self._core = core
        self._output_switch = outputs
        self._positions = positions
        self._follower = follower
        self._builder = MotionBuilder(state, frames)
        self._queued: dict[int, _QueuedMotion] = {}
        #: The triggers that are set, by the commands of their actions.
        self._triggers: dict[OutputCommand | CallCommand, SetTrigger] = {}
        #: $OUT_C: the assignments to make at the end of a motion, by the motion's number.
        self._at_end: dict[int, list[tuple[Task, At, Path, Value]]] = defaultdict(list)
        #: Actions of triggers that have fired and have not been entered.
        self.fired: list[CallCommand] = []
        #: STOP WHEN PATH places that the arm has passed and whose conditions were not evaluated,
        #: with whether a stop there is late.
        self.passed_stops: list[tuple[Task, SplineStop, bool]] = []
        #: All planned motions, in order, except those that end where they start.
        self.points: list[PlannedPoint] = []
        #: The line of the motion that started last.
        self.running: At | None = None
        #: The number of motions that have ended.
        self.ended = 0
        #: Whether the arm is on its way to the first point of the program [ADV-14].
        self.is_coincidence_run = False

    # ---------------------------------------------------------------------------- planning

    def plan(self, task: Task, request: Move | MoveSpline, *, is_replaced: bool = False) -> None:
        """Plan a motion with the triggers before it. Raises `Fault`; then nothing is planned.

        No spline motion is planned for an interrupt routine [SPL-11]. With ``is_replaced``, plan a
        PTP to the same point with any Status instead.
        """
        triggers, task.triggers = task.triggers, []
        if task.levels and (isinstance(request, MoveSpline) or request.kind in SPLINE_MOTIONS):
            raise own_fault("spline_place")
        if isinstance(request, MoveSpline):
            for item in request.items:
                if isinstance(item, SetTrigger):
                    self._check_trigger(item)
            planned = self._builder.block(request, triggers)
        else:
            has_path = any(trigger.place_kind == "PATH" for trigger in triggers)
            # With stand-ins, PATH is measured along the path of the tool, for a PTP too.
            if has_path and request.kind in WITHOUT_PATH and not self._state.profile.is_tolerant:
                raise own_fault("trigger_path")
            planned = self._builder.build(request, triggers, is_replaced=is_replaced)
        self._load(task, planned)

    def plan_return(self, task: Task, at: At, axes: Sequence[float]) -> None:
        """Plan the motion back to where an interrupt routine has braked. Raises `Fault`."""
        self._load(task, self._builder.back_to(at, axes))

    @property
    def is_unused(self) -> bool:
        """Whether no motion was planned yet."""
        return self._builder.count == 0

    def _load(self, task: Task, planned: PlannedMotion) -> None:
        """Load a motion into the core. Raises `Fault`."""
        motion = planned.motion
        command = MotionCommand(motion)
        transaction = Transaction(command)
        triggers = self._link(planned, command, transaction)
        try:
            self._core.load(self._state.clock.now, transaction)
        except Fault:
            self._builder.forget()
            raise
        self._triggers |= triggers
        arm = self._core.arm
        target = arm.target() if isinstance(arm, _HasTarget) else None
        self._queued[motion.number] = _QueuedMotion(planned, task, target)
        if _LENGTH_ZERO in command.notices:
            self._spend(task)
        else:
            self.points.append(
                PlannedPoint(
                    motion.number,
                    motion.kind,
                    motion.at,
                    target,
                    motion.settings.placement.tool,
                )
            )
        if task.level is not None:
            task.level.motions.add(motion.number)
            task.level.has_moved = True
        kind = motion.kind
        self._state.trace.record(
            task.name, "motion_planned", motion.at, motion=motion.number, motion_kind=kind
        )
        for number in command.notices:
            self._state.messages.post_number(motion.at, number)
        self.collect()

    @staticmethod
    def _link(
        planned: PlannedMotion, command: MotionCommand, transaction: Transaction
    ) -> dict[OutputCommand | CallCommand, SetTrigger]:
        """Add the action of each trigger to a transaction, and return the triggers by it."""
        motion = command.motion
        triggers: dict[OutputCommand | CallCommand, SetTrigger] = {}
        for place in (*motion.places, *(each for part in motion.parts for each in part.places)):
            trigger = planned.triggers[place.key]
            output = trigger.output
            then = CallCommand(trigger) if output is None else OutputCommand(*output)
            triggers[then] = trigger
            transaction.add(then).link(command.reached(place), "start", then)
        return triggers

    def set_trigger(self, task: Task, request: SetTrigger) -> None:
        """Set a trigger for the next motion. Raises `Fault` [TRG-09]."""
        if task.levels or task.name == "submit":
            raise message_fault(1409)
        self._check_trigger(request)
        if len(task.triggers) + len(self._triggers) >= self._state.profile.most["triggers"]:
            raise message_fault(1524)
        task.triggers.append(request)

    @staticmethod
    def _check_trigger(request: SetTrigger) -> None:
        """Check the priority of a trigger, and its distance and delay [TRG-03 to TRG-06]."""
        if request.priority not in (None, -1) and request.priority not in _PRIORITIES:
            raise own_fault("trigger_priority")
        if max(abs(request.place), abs(request.delay)) > _FARTHEST:
            raise own_fault("trigger_range")

    def output_in_main_run(self, task: Task, at: At, path: Path, value: Value) -> None:
        """$OUT_C: write at the end or the apex of the motion that was planned last [ADV-11]."""
        plain: Path = ("$OUT", *path[1:])
        own = self._queued if task.level is None else task.level.motions
        number = max(own, default=0)
        if number and task.name == "robot":
            self._state.variables.read(plain)  # faults if there is no such output
            self._at_end[number].append((task, at, plain, value))
        else:
            self._state.put_at(task.name, at, plain, value)

    def own_pending(self, task: Task) -> int:
        """Return the number of motions that the robot's program, or its routine, waits for.

        These are the motions that have not ended. The motions of the interrupted program continue
        while an interrupt routine runs, so they do not block the routine [INT-08] (unconfirmed for
        advance stops in the routine).
        """
        return self._core.pending() if task.level is None else len(task.level.motions)

    def is_ahead(self, task: Task) -> bool:
        """Let the arm execute all motions, and return whether own ones have not ended."""
        self._core.release(self._state.clock.now)
        return self.own_pending(task) > 0

    @property
    def pending(self) -> int:
        """The number of motions that have not ended."""
        return self._core.pending()

    def next_time(self) -> int | None:
        """Return the time of the next event of the core in µs, according to the present plan."""
        return self._core.next_time()

    def stop_advance(self) -> None:
        """Note that the advance run stops after the last planned motion, which has no successor.

        The message of an earlier motion that is not blended is 1123 instead of 1442 [ADV-12].
        """
        self._core.release(self._state.clock.now)
        if self._queued:
            self._queued[max(self._queued)].stops_advance = True

    # ------------------------------------------------------------------ events of the core

    def collect(self) -> None:
        """Handle all events of the arm and the core up to now."""
        for event in self._core.run_until(self._state.clock.now):
            self._handle(event)

    def _handle(self, event: CoreEvent) -> None:
        match event.command:
            case MotionCommand() as command:
                self._handle_motion(event, command.motion.number)
            case OutputCommand() as command if event.what != "started":
                self._handle_output(event, command, self._triggers.pop(command))
            case CallCommand() as command if event.what in ("started", "cancelled"):
                trigger = self._triggers.pop(command)
                if event.what == "started":
                    self._fire(command, trigger)

    def _handle_motion(self, event: CoreEvent, number: int) -> None:
        queued = self._queued.get(number)
        if queued is None:
            return
        motion, task = queued.planned.motion, queued.task
        if event.what in _KINDS:
            fields: dict[str, Any] = {"motion": number}
            if event.what == "started":
                fields["motion_kind"] = motion.kind
            self._state.trace.record(task.name, _KINDS[event.what], motion.at, **fields)
        match event.what:
            case "started":
                self._started(queued)
            case "reached" if event.key in queued.planned.stops:
                assert event.arm is not None, "the path is passed by the arm"
                self.passed_stops.append((task, queued.planned.stops[event.key], event.arm.is_late))
            case "ended":
                self._ended(event, queued)
            case "cancelled":
                self._remove(number, task)

    def _started(self, queued: _QueuedMotion) -> None:
        planned = queued.planned
        self._state.variables.main = planned.snapshot
        self.running = planned.motion.at
        self._positions.keep("BACK")
        if queued.target is not None:
            self._positions.keep("FOR", queued.target)
        self._follower.begun(self._state.clock.now, planned.motion)

    def _ended(self, event: CoreEvent, queued: _QueuedMotion) -> None:
        state = self._state
        motion = queued.planned.motion
        self.ended += 1
        self._remove(motion.number, queued.task)
        for owner, at, path, value in self._at_end.pop(motion.number, ()):
            state.put_at(owner.name, at, path, value)
        if self._has_other_posture(motion):
            state.messages.post_number(motion.at, 2936)
        assert event.arm is not None, "a motion ends where the arm is"
        if event.arm.is_exact_unwanted:
            number = 1442 if queued.stops_advance else 1123  # [ADV-12, BLD-10, BLD-14]
            stops = state.variables.read(("$STOPNOAPROX",)) is True
            state.messages.post_number(
                motion.at, number, "acknowledgement" if stops else "notification"
            )

    def _spend(self, task: Task) -> None:
        """Spend half of a slice on a motion that takes no time: a loop of them must wait."""
        task.spent += self._state.profile.requests // 2

    def _has_other_posture(self, motion: Motion) -> bool:
        """Return whether a path motion ended with another Status or Turn than programmed [POS-10].

        Bits 3 and 4 of Status have no meaning [POS-06].
        """
        if motion.kind in AXIS_MOTIONS:
            return False
        checks = constant_text(self._state.variables.read(("$CP_STATMON",)))
        status, turn = self._positions.status_turn(self._positions.actual().axes)
        is_other = "S" in motion.target and (int(motion.target["S"]) ^ status) & _STATUS_BITS != 0
        has_turned = "T" in motion.target and int(motion.target["T"]) != turn
        return (checks != "#NONE" and is_other) or (checks == "#CHECK_TS" and has_turned)

    def _remove(self, number: int, task: Task) -> None:
        del self._queued[number]
        for level in task.levels:
            level.motions.discard(number)

    def _handle_output(self, event: CoreEvent, command: OutputCommand, trigger: SetTrigger) -> None:
        state, fault = self._state, event.fault
        if fault is not None:
            state.messages.post("robot", trigger.at, fault.number or 0, fault.text)
        if event.what != "ended":
            return
        state.trace.record(
            "robot",
            "trigger",
            trigger.at,
            sets=path_text(command.path),
            value=to_json(command.value),
        )
        with state.trace.attributed("robot", trigger.at):
            for name, place, value in self._output_switch.next_changes():
                state.signal_changed(name, place, value)
        state.changed(command.path, command.value)

    def _fire(self, command: CallCommand, trigger: SetTrigger) -> None:
        self._state.trace.record("robot", "trigger", trigger.at, priority=trigger.priority)
        self.fired.append(command)
