"""The controller: one virtual clock, the programs on it, and the order in which things happen.

At each moment: what the arm has reached, what the script and pulses do, on a tick of the
interpolation cycle cyclic flags, cyclic signals and the conditions of interrupts [INT-18], and then
the programs, the robot's first, each until it has to wait. Then time goes on to the next moment at
which anything can happen. Nothing depends on wall-clock time, so a program has one trace.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, Final, Literal

from interp.controller.input_script import Script
from interp.controller.interrupts import Interrupts, interrupt_list
from interp.controller.profile import Profile
from interp.controller.request_handling import Answering
from interp.controller.tasks import Blocked, Task
from interp.controller.trace import TaskSink, Trace
from interp.controller.variables import Computed
from interp.controller.world import Setup
from interp.port.executor import Executor
from interp.port.requests import At, Crash, End, Fail, Request, SplineStop, Value
from interp.robot.api.control_core import ControlCore, Switch
from interp.robot.kinematics.machine_data import Machine
from interp.robot.simulation.robots import RobotFault
from interp.robot.simulation.tracking import Following
from interp.values.faults import BudgetExhausted, RuntimeFailure

__all__ = ["Controller", "Ending", "Outcome"]

#: How a run ended: at the end of the program; at a HALT that nobody ends; by a fault; because the
#: program used up its statements; because the time is over; by a defect of ours.
Ending = Literal["end", "halt", "fault", "budget", "time", "crash"]

#: A run lasts an hour of virtual time at most, unless it is told otherwise.
HOUR: Final = 3_600_000_000


@dataclass(frozen=True, slots=True)
class Outcome:
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
        return f"{self.ending} after {self.time / 1e6:g} s{place}{why}"


class Controller(Answering):
    """Runs a program, and a submit program beside it.

    ``executor`` has the program; its sink is ``sink`` (`Trace.sink`), so that its events get into
    ``trace``, and likewise for ``submit``. ``core`` makes the control core, given what switches
    outputs: ``lambda switch: ControlCore(arm, switch, cycle=1)``. The rest is as in `Setup`. Raises
    `ScriptError`.
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
        machine: Machine | None = None,
        values: Mapping[str, Value] | None = None,
        following: Following | None = None,
    ) -> None:
        script = script or Script()
        setup = Setup(profile, script, trace, machine, values or {}, following)
        super().__init__(core(self.switch), setup)
        self._stop = script.stop
        self._was_put(("$OV_PRO",), self.variables.read(("$OV_PRO",)))
        self.robot = self._task("robot", executor, sink)
        self._tasks = [self.robot]
        if submit is not None:
            self._tasks.append(self._task("submit", submit, submit_sink))
        self._outcome: Outcome | None = None
        self._failed: Outcome | None = None
        self._is_stopped = False
        self._has_halted_arm = False
        self._ticked = -1
        self._waits: tuple[Task, SplineStop] | None = None

    def _task(self, name: Any, executor: Executor, sink: TaskSink | None) -> Task:
        most = self.profile.most
        interrupts = Interrupts(most["interrupts"], most["active_interrupts"])
        if sink is not None:
            sink.left = interrupts.forget
        listed = "$RINT_LIST" if name == "robot" else "$SINT_LIST"
        self.variables.connect([listed], Computed(partial(interrupt_list, interrupts)))
        return Task(name, executor, sink, interrupts)

    # ------------------------------------------------------------------------------ the run

    def run(self, until: int | None = None) -> Outcome:
        """Run until the program ends, or halts and nobody starts it, or until a time in µs.

        After a `halt` a further call is START. Raises `ScriptError` for a value that a variable
        cannot have.
        """
        limit = min(HOUR if until is None else until, self._stop or HOUR)
        outcome = self._run_to(limit)
        if self.following is not None:
            try:
                self.following.settle(self.clock.now)
            except RobotFault as error:
                return Outcome("fault", self.clock.now, self.running, error)
        return outcome

    def _run_to(self, limit: int) -> Outcome:
        if self._outcome is not None and self._outcome.ending == "halt":
            self.press("START", None)
        self._outcome = None
        self.state = "P_ACTIVE" if self.state == "P_RESET" else self.state
        if len(self._tasks) > 1 and self.submit_state == "P_FREE":
            self.submit_state = "P_ACTIVE"
        while True:
            self._settle()
            if self._outcome is not None:
                return self._outcome
            then = self._next_time()
            if then is None or then > limit:
                self._go_to(max(limit, self.clock.now))
                self._outcome = Outcome("time", self.clock.now, _place_of(self.robot))
                return self._outcome
            self._go_to(then)

    def _settle(self) -> None:
        """All that happens now."""
        self._collect()
        if self.clock.is_tick and self._ticked != self.clock.now:
            self._ticked = self.clock.now
            self._tick()
        before = -1
        while before != self.count and self._outcome is None:
            before = self.count
            for task in self._tasks:
                self._run(task)
            self._collect()
        if self._outcome is None and self._failed is not None and self._stands:
            self._outcome = replace(self._failed, time=self.clock.now)
        if self._outcome is None and self.robot.is_halted and not self.player.awaits("START"):
            self._outcome = Outcome("halt", self.clock.now, _place_of(self.robot))

    def _tick(self) -> None:
        """What is looked at in every interpolation cycle."""
        self.refresh_flags()
        for task in self._tasks:
            if task.is_over or task.is_halted or self._is_held(task):
                continue
            if task.blocked is not None:
                for signal in list(task.signals.values()):
                    self.enter_signal(task, signal)
                    self._run(task)
            try:
                self.watch(task)
            except RuntimeFailure as error:
                self._fail(task, Fail(_place_of(task), error))

    def _go_to(self, time: int) -> None:
        self.clock.now = self.trace.now = time
        if self.following is not None:
            try:
                self.following.advance(time)
            except RobotFault as error:
                self._fail(self.robot, Fail(self.running or _place_of(self.robot), error))

    def _collect(self) -> None:
        """What the arm has done up to now, and what else is due."""
        self.collect()
        self._watch_stops()
        self.agenda.do(self.clock.now)

    def _next_time(self) -> int | None:
        ahead = self.core.next_time()
        times = [ahead, self.agenda.next_time()]
        if ahead is not None and self.following is not None and self.following.chunk is not None:
            times.append(self.clock.now + self.following.chunk)
        needs_ticks = self.has_cyclic_flags
        for task in self._tasks:
            if task.is_over:
                continue
            needs_ticks = needs_ticks or bool(task.signals) or task.interrupts.is_watched
            if task.blocked is not None and not self._is_held(task):
                times.append(task.blocked.wake)
        if needs_ticks or self._waits is not None:
            times.append(self.clock.next_tick)
        return min((time for time in times if time is not None), default=None)

    # ------------------------------------------------------------------------- the programs

    def _run(self, task: Task) -> None:
        """Let a program compute until it has to wait."""
        while not task.is_over and self._outcome is None and not self._is_held(task):
            try:
                if task.blocked is not None and not task.is_halted:
                    self.dispatch(task)
                blocked = task.blocked
                if blocked is None:
                    request = task.executor.advance(task.reply)
                    answer = self._asked(task, request)
                elif blocked.is_ready():
                    task.blocked = None
                    self.acting = task.name, blocked.request.at
                    answer = blocked.finish()
                else:
                    return
            except RuntimeFailure as error:  # of an interrupt, a trigger, a condition
                self._fail(task, Fail(_place_of(task), error))
                return
            self.count += 1
            task.blocked = answer if isinstance(answer, Blocked) else None
            task.reply = None if isinstance(answer, Blocked) else answer

    def _asked(self, task: Task, request: Request) -> Any:
        """What a request is answered; one too many in a cycle waits for the next."""
        match request:
            case End():
                return self.leave(task) if task.levels else self._end(task, request)
            case Fail():
                self._fail(task, request)
                return None
            case Crash(at, reason):
                task.is_over = True
                self._outcome = Outcome("crash", self.clock.now, at, RuntimeFailure(reason))
                return None
        if task.level is None or task.level.signal is None:
            is_robot = task is self.robot
            most = self.profile.requests if is_robot else self.profile.submit_requests
            last = self.next_slice(task)
            if task.slice_end != last:
                task.slice_end, task.spent = last, 0
            task.spent += 1
            if task.spent > most:
                return self.wait_until(request, last, lambda: self._asked(task, request))
        return self.answer(task, request)

    def _end(self, task: Task, request: End) -> Any:
        """The program has ended once the arm has come to where it left it [ADV-07]."""
        task.spared = None

        def finish() -> None:
            task.is_over = True
            self.trace.tell(task.name, "end", request.at)
            if task is self.robot:
                self.state = "P_END"
                self._outcome = Outcome("end", self.clock.now, request.at)
            else:
                self.submit_state = "P_END"

        return self.when_reached(task, request, finish)

    def _fail(self, task: Task, request: Fail) -> None:
        """A fault that nothing took: its message, and the arm stops on its path."""
        task.is_over = True
        error = request.fault
        slug = getattr(error, "slug", "budget" if isinstance(error, BudgetExhausted) else "link")
        number = getattr(error, "number", None)
        if number is not None:
            kind = "state" if task is self.robot else "notification"
            self.say(task.name, request.at, number, str(error), kind)
        self.trace.tell(task.name, "fault", request.at, slug=slug, number=number, text=str(error))
        if task is not self.robot:
            self.submit_state = "P_STOP"
            return
        self.state = "P_STOP"
        ending: Ending = "budget" if isinstance(error, BudgetExhausted) else "fault"
        self._failed = Outcome(ending, self.clock.now, request.at, error)
        self._halt_arm(is_hard=isinstance(error, RobotFault))

    def _is_held(self, task: Task) -> bool:
        """Whether the operator has stopped the program, or it waits for him."""
        return task is self.robot and (self._is_stopped or bool(self.board.waiting))

    # ------------------------------------------------------------------------- the operator

    def say(
        self, task: Any, at: At | None, number: int, text: str, kind: str = "notification"
    ) -> None:
        """Show a message; one that has to be acknowledged stops the arm [ADV-12]."""
        super().say(task, at, number, text, kind)
        if kind == "acknowledgement":
            self._halt_arm()

    def press(self, button: str, number: int | None) -> None:
        """The operator presses START, STOP or CONFIRM."""
        was_waiting = bool(self.board.waiting)
        super().press(button, number)
        if button == "STOP" and not self._is_stopped and self.state == "P_ACTIVE":
            self._is_stopped = True
            self.state = "P_STOP"
            self._halt_arm()
        elif button == "CONFIRM" and was_waiting and not self.board.waiting:
            self._free_arm()
        elif button == "START":
            for task in self._tasks:
                task.is_halted = False
            self.state = "P_ACTIVE"
            self._is_stopped = False
            self._free_arm()

    def _halt_arm(self, *, is_hard: bool = False) -> None:
        self.has_stopped = False
        if self.moves and not self._has_halted_arm:
            self._has_halted_arm = True
            self.core.brake(self.clock.now, is_hard=is_hard)

    def _free_arm(self) -> None:
        if self._has_halted_arm and not self._is_stopped and not self.board.waiting:
            self._has_halted_arm = False
            self.core.proceed(self.clock.now)

    # ------------------------------------------------------------------ STOP WHEN PATH [SPL-06]

    def _watch_stops(self) -> None:
        """A block stops while its condition holds; it is late by the way it needs to brake."""
        if self.stops and self._waits is None:
            task, stop = self.stops.pop(0)
            if self.holds(task, stop.condition):
                self._waits = task, stop
                self.say_number(_place_of(task), 3230)
                self._halt_arm()
        elif self._waits is not None and self.clock.is_tick:
            task, stop = self._waits
            if not self.holds(task, stop.condition):
                self._waits = None
                self._free_arm()


def _place_of(task: Task) -> At:
    """Where a program is."""
    if task.blocked is not None:
        return task.blocked.request.at
    return task.level.at if task.level is not None else task.last_at
