"""The order in which things happen on the virtual clock, and how a run ends.

At each moment: what the arm has reached, what the script and pulses do, on a tick of the
interpolation cycle cyclic flags, cyclic signals and the conditions of interrupts [INT-18], and then
the programs, the robot's first, each until it has to wait. Then time goes on to the next moment at
which anything can happen. Nothing depends on wall-clock time, so a program has one trace.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, Final, Literal

from interp.controller.inputs.operator_panel import OperatorPanel
from interp.controller.inputs.script_player import ScriptPlayer
from interp.controller.interrupts.cyclic_evaluation import CyclicEvaluation
from interp.controller.interrupts.interrupt_unit import InterruptUnit
from interp.controller.interrupts.levels import Levels
from interp.controller.motion.advance_run import AdvanceRun
from interp.controller.motion.arm_control import ArmControl
from interp.controller.motion.follower import Follower
from interp.controller.motion.motion_queue import MotionQueue
from interp.controller.quiet_time import QuietTime
from interp.controller.requests.waits import Waits
from interp.controller.spline_stops import SplineStops
from interp.controller.state.state import ControllerState
from interp.controller.state.tasks import Answer, Blocked, Task
from interp.port.executor import SliceScheduling
from interp.port.requests import At, Crash, End, Fail, Request, Slice
from interp.robot.simulation.robot import RobotFault
from interp.values.faults import BudgetExhausted, Fault, LinkError, RuntimeFailure
from support.lazy_dataclass import dataclass

#: How a run ended: at the end of the program; at a HALT without a later start; by a fault; because
#: the program used up its statements; because the time is over; by a defect of ours.
Ending = Literal["end", "halt", "fault", "budget", "time", "crash"]

#: The handlers of all requests but those that end a program; they may raise `Fault`.
Handlers = dict[type[Request], Callable[[Task, Any], Answer]]

#: A run lasts an hour of virtual time at most, by default.
HOUR: Final = 3_600_000_000


@dataclass(frozen=True, slots=True)
class RunOutcome:
    """How a run ended, when in µs, and where and why if a program did it."""

    ending: Ending
    time: int
    at: At | None = None
    error: Exception | None = None

    def __str__(self) -> str:
        place = "" if self.at is None else f" at {self.at.file}:{self.at.line}"
        why = "" if self.error is None else f": {self.error}"
        number = getattr(self.error, "number", None)
        why += "" if number is None else f" (message {number})"
        ending = {"time": "time limit", "budget": "statement limit"}.get(self.ending, self.ending)
        return f"{ending} after {self.time / 1e6:g} s{place}{why}"


@dataclass(slots=True)
class Scheduler:
    """Runs the programs of a controller; the first of ``tasks`` is that of the robot.

    ``stop`` is the time in µs at which the script ends a run, if it does.
    """

    state: ControllerState
    tasks: Sequence[Task]
    arm: ArmControl
    queue: MotionQueue
    levels: Levels
    interrupts: InterruptUnit
    cyclic: CyclicEvaluation
    spline_stops: SplineStops
    advance: AdvanceRun
    waits: Waits
    handlers: Handlers
    panel: OperatorPanel
    player: ScriptPlayer
    follower: Follower
    quiet: QuietTime
    stop: int | None
    _outcome: RunOutcome | None = None
    _failed: RunOutcome | None = None
    _ticked: int = -1
    _limit: int = 0
    _has_acted: bool = False
    _free_until: int = 0

    def __post_init__(self) -> None:
        if isinstance(executor := self._robot.executor, SliceScheduling):
            executor.free_slices = self._free_slices

    def run(self, until: int) -> RunOutcome:
        """Run until the program ends, or halts without a later start, or until a time in µs.

        Raises `ScriptError` for a value that a variable cannot have.
        """
        outcome = self._run_until(until if self.stop is None else min(until, self.stop))
        try:
            self.follower.settle(self.state.clock.now)
        except RobotFault as error:
            return RunOutcome("fault", self.state.clock.now, self.queue.running, error)
        return outcome

    @property
    def _robot(self) -> Task:
        return self.tasks[0]

    def _run_until(self, limit: int) -> RunOutcome:
        clock = self.state.clock
        self._outcome, self._limit = None, limit
        self._begin()
        while True:
            self._settle()
            if self._outcome is not None:
                return self._outcome
            then = self._next_time()
            if then is None or then > limit:
                self._go_to(max(limit, clock.now))
                self._outcome = RunOutcome("time", clock.now, self._robot.at)
                return self._outcome
            self._pass(then)

    # ----------------------------------------------------------------------------------- time

    def _pass(self, then: int) -> None:
        """Go on to the next time at which anything can happen, and beyond what is quiet."""
        self._go_to(self.quiet.end(self.tasks, then, self._limit, self._needs_every_tick))
        self._begin()

    def _begin(self) -> None:
        """Do what happens at this time before the programs run."""
        clock = self.state.clock
        self.quiet.begin_tick(self._robot)
        self._collect()
        if clock.is_tick and self._ticked != clock.now:
            self._ticked = clock.now
            self._tick()

    def _settle(self) -> None:
        """Do all that happens at this time."""
        clock = self.state.clock
        self._has_acted = True
        while self._has_acted and self._outcome is None:
            self._has_acted = False
            for task in self.tasks:
                self._run(task)
        if self._outcome is not None:
            return
        failed = self._failed
        if failed is not None and self.arm.is_standing and not self._is_finishing(failed):
            self._outcome = replace(failed, time=clock.now)
        elif self._robot.is_halted and not self.player.awaits("START"):
            self._outcome = RunOutcome("halt", clock.now, self._robot.at)

    def _tick(self) -> None:
        """Evaluate what is evaluated in every interpolation cycle."""
        self.cyclic.refresh_flags()
        for task in self.tasks:
            if task.is_over or task.is_halted or self.panel.is_holding(task):
                continue
            for signal in list(task.signals.values()):
                if task.blocked is not None:  # the program may have ended meanwhile
                    self.cyclic.enter_signal(task, signal)
                    self._run(task)
            try:
                self.interrupts.watch(task)
            except RuntimeFailure as error:
                self._fail(task, Fail(task.at, error))

    def _go_to(self, time: int) -> None:
        self.state.clock.now = self.state.trace.now = time
        try:
            self.follower.advance(time)
        except RobotFault as error:
            self._fail(self._robot, Fail(self.queue.running or self._robot.at, error))

    def _collect(self) -> None:
        """Handle what the arm has done up to now, and do what else is due."""
        self.queue.collect()
        self.spline_stops.watch()
        self.state.actions.run_until(self.state.clock.now)

    @property
    def _needs_every_tick(self) -> bool:
        return self.cyclic.has_flags or self.spline_stops.is_waiting

    def _next_time(self) -> int | None:
        clock = self.state.clock
        times = [
            self.queue.next_time(),
            self.state.actions.next_time(),
            self.follower.next_time(clock.now),
        ]
        needs_ticks = self._needs_every_tick
        for task in self.tasks:
            if task.is_over:
                continue
            needs_ticks = needs_ticks or bool(task.signals) or task.interrupts.is_watched
            if task.blocked is not None and not self.panel.is_holding(task):
                times.append(task.blocked.wake)
        if needs_ticks:
            times.append(clock.next_tick)
        return min((time for time in times if time is not None), default=None)

    # ------------------------------------------------------------------------- the programs

    def _run(self, task: Task) -> None:
        """Run a program until it has to wait."""
        while not task.is_over and self._outcome is None and not self.panel.is_holding(task):
            try:
                if task.blocked is not None and not task.is_halted:
                    self.interrupts.dispatch(task)
                blocked = task.blocked
                if blocked is None:
                    answer = self._answer(task, task.executor.advance(task.reply))
                elif blocked.is_ready():
                    task.blocked = None
                    self.state.trace.origin = task.name, blocked.request.at
                    before = self.waits.changes
                    answer = _outcome_of(blocked.finish)
                    self.waits.waited(task, blocked, before)
                else:
                    return
            except RuntimeFailure as error:  # of an interrupt, a trigger, a condition
                self._fail(task, Fail(task.at, error))
                return
            self._has_acted = True
            task.blocked = answer if isinstance(answer, Blocked) else None
            task.reply = None if isinstance(answer, Blocked) else answer
            self._pass_free_slices(task)

    def _pass_free_slices(self, task: Task) -> None:
        """Go on to when the slices of a program are over that have passed."""
        free_until, self._free_until = self._free_until, 0
        blocked = task.blocked
        if free_until and blocked is not None and isinstance(blocked.request, Slice):
            assert blocked.wake is not None, "the end of a slice"
            if blocked.wake < free_until:
                self._pass(blocked.wake)

    def _free_slices(self, begins: bool) -> int:
        """The slices of the robot's program in which nothing can happen before the last begins.

        The first one ``begins`` now, as all is done for this time, or at the next tick.
        """
        robot, *others = self.tasks
        is_alone = not self.queue.pending and all(task.is_over for task in others)
        left = self.waits.requests_left(robot)
        is_spent = robot.slice_end == self.waits.next_slice(robot) and robot.spent >= left
        if robot.levels or not (begins or (is_alone and not is_spent)):
            return int(begins)
        clock = self.state.clock
        times = [self._limit + 1, self._next_time()]
        end = min(time for time in times if time is not None)
        if not begins:
            self._free_until = end
        first = clock.now if begins else clock.next_tick
        return max(-(-(end - first) // clock.cycle), int(begins))

    def _answer(self, task: Task, request: Request) -> Answer:
        """Return the answer to a request; one too many in a slice waits for the next slice."""
        task.at = request.at
        match request:
            case End():
                level = task.level
                return self._end(task, request) if level is None else self.levels.leave(task, level)
            case Fail():
                self._fail(task, request)
                return None
            case Crash(at, reason):
                self._outcome = RunOutcome(
                    "crash", self.state.clock.now, at, RuntimeFailure(reason)
                )
                return None
        if self.waits.is_one_too_many(task, request):
            return self.waits.postponed(task, request, lambda: self._answer(task, request))
        if task.exempt_line != (request.at.file, request.at.line):
            task.exempt_line = None
        self.state.trace.origin = task.name, request.at
        self.quiet.asked(request)
        before = self.waits.changes
        answer = _outcome_of(lambda: self.handlers[type(request)](task, request))
        self.waits.acted(task, request, before)
        return self.waits.passed(task, request) if answer is None else answer

    def _end(self, task: Task, request: End) -> Answer:
        """The program has ended once the arm has come to where it left it [ADV-07]."""
        task.exempt_line = None

        def finish() -> None:
            task.is_over = True
            self.state.trace.record(task.name, "end", request.at)
            self.state.program_states[task.name] = "P_END"
            if task is self._robot:
                self._outcome = RunOutcome("end", self.state.clock.now, request.at)

        return self.advance.when_reached(task, request, finish)

    def _is_finishing(self, failed: RunOutcome) -> bool:
        """Return whether the arm still does what came before a line that can never be run."""
        return isinstance(failed.error, LinkError) and bool(self.queue.pending)

    def _fail(self, task: Task, request: Fail) -> None:
        """A fault that the program did not catch: its message, and the arm stops on its path.

        A line that no controller would have begun with, for it needs what no file has, is no fault
        of the run: the motions before it are finished.
        """
        task.is_over = True
        error, state = request.fault, self.state
        slug = getattr(error, "slug", "budget" if isinstance(error, BudgetExhausted) else "link")
        number = getattr(error, "number", None)
        if number is not None:
            kind = "state" if task is self._robot else "notification"
            state.messages.post(task.name, request.at, number, str(error), kind)
        state.trace.record(
            task.name, "fault", request.at, slug=slug, number=number, text=str(error)
        )
        state.program_states[task.name] = "P_STOP"
        if task is not self._robot:
            return
        ending: Ending = "budget" if isinstance(error, BudgetExhausted) else "fault"
        self._failed = RunOutcome(ending, state.clock.now, request.at, error)
        if isinstance(error, LinkError):
            self.queue.stop_advance()
        else:
            self.arm.halt(is_hard=isinstance(error, RobotFault))


def _outcome_of(act: Callable[[], Answer]) -> Answer:
    """Return what an action returns, or the fault that it raises, for the program to catch."""
    try:
        return act()
    except Fault as error:
        return error
