"""The handlers of requests that wait for time or for the operator."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from interp.controller.inputs.automatic_inputs import AutomaticInputs
from interp.controller.inputs.operator_panel import OperatorPanel
from interp.controller.inputs.script_player import ScriptPlayer
from interp.controller.motion.advance_run import AdvanceRun
from interp.controller.motion.motion_queue import MotionQueue
from interp.controller.state.clock import microseconds
from interp.controller.state.state import ControllerState
from interp.controller.state.tasks import Answer, Blocked, Task
from interp.port.requests import (
    BrakeArm,
    Confirm,
    Continue,
    EmptyError,
    Halt,
    Invoke,
    Poll,
    Read,
    Request,
    Resume,
    Slice,
    StopAdvance,
    Wait,
    Write,
)
from interp.values.faults import BudgetExhausted
from interp.values.json_form import to_json
from support.lazy_dataclass import dataclass

#: A program that has changed nothing for this time, in µs, may make only so many requests in a
#: slice. So may that of the robot after `_ENDLESS` requests without a wait: it is in an endless
#: loop. After `_MOST` it ends, if there is no script that may change something for it.
IDLE_AFTER: Final = 1_000_000
_IDLE_REQUESTS: Final = 5
_ENDLESS: Final = 100_000
_MOST: Final = 120_000
#: Requests that count as so many others, because they take as long: calls of routines, and reads or
#: writes of a system variable or a part of it. `_POSITIONS` are how names of positions begin. $ERR
#: is written when ON_ERROR_PROCEED catches a fault.
_LONG: Final = {
    "FORWARD": 5,
    "INVERSE": 30,
    "PULSE": 3,
    "SET_KRLMSG": 5,
    "SET_KRLDLG": 5,
    "$LOAD": 5,
    "$TOOL": 3,
    "$BASE": 3,
    "$DISTANCE": 3,
    "$DIST_NEXT": 3,
    "$ERR": 10,
}
_POSITIONS: Final = ("$POS_", "$AXIS_")
_LONG_POSITION: Final = 10
#: Requests that change nothing, those that always do something, and those that an executor makes
#: for several at once.
_LOOKS: Final = (Read, Slice, Continue, EmptyError)
_ACTS: Final = (Invoke, Halt, Confirm, BrakeArm, Resume)
_UNCOUNTED: Final = (Slice, StopAdvance)


@dataclass(slots=True, eq=False)
class Waits:
    """Answers waiting requests; notifies ``player`` of HALT and ``automatic`` of WAIT FOR."""

    _state: ControllerState
    _queue: MotionQueue
    _advance: AdvanceRun
    _panel: OperatorPanel
    _player: ScriptPlayer
    _automatic: AutomaticInputs

    # ------------------------------------------------------------------------------- time

    def until(self, request: Request, time: int, then: Callable[[], Answer]) -> Blocked:
        """Return a wait until a time in µs."""
        return Blocked(request, lambda: self._state.clock.now >= time, then, time)

    def next_slice(self, task: Task) -> int:
        """Return when a task that has used up its slice may run again, in µs [SUB-03, SUB-04]."""
        clock = self._state.clock
        if task.name == "robot":
            return clock.next_tick
        period = clock.cycle * self._state.profile.submit_every
        return (clock.now // period + 1) * period

    def wait(self, task: Task, request: Wait) -> Answer:
        """WAIT SEC: wait for a time; a time of zero or less is no wait [CTL-12]."""

        def begin() -> Answer:
            if request.seconds <= 0:
                return None
            self._state.trace.record(
                task.name, "wait", request.at, seconds=to_json(request.seconds)
            )
            end = self._state.clock.tick_after(microseconds(request.seconds))
            return self.until(request, end, lambda: None)

        return self._advance.when_reached(task, request, begin)

    def poll(self, task: Task, request: Poll) -> Answer:
        """WAIT FOR: let the program evaluate its condition again in the next slice."""
        self._state.trace.polled(task.name, request.at, request.is_first)
        if request.is_first:
            self._automatic.begin(task.name)
            return self._advance.when_reached(task, request, lambda: None)
        self._automatic.was_false(task.name, request.at)
        return self.until(request, self.next_slice(task), lambda: None)

    # ----------------------------------------------------------------------------- slices

    def is_one_too_many(self, task: Task, request: Request) -> bool:
        """Count a request, and return whether it must wait for the next slice.

        What computes a cyclic signal may make any number.
        """
        if task.level is not None and task.level.signal is not None:
            return False
        end = self.next_slice(task)
        if task.slice_end != end:
            task.slice_end, task.spent = end, 0
        task.spent += request.count if isinstance(request, StopAdvance) else 1
        return task.spent > self.requests_left(task)

    def postponed(self, task: Task, request: Request, then: Callable[[], Answer]) -> Blocked:
        """Return a wait until the next slice, because a request is one too many in this one."""
        late = self.until(request, task.slice_end, then)
        late.is_postponed = True
        if self.is_idle(task):
            task.executor.waited()
        return late

    def passed(self, task: Task, request: Request) -> Answer:
        """Return the reply to a request that has none.

        If it only stops the advance run, that is how many such requests the program need not make:
        nothing is ahead of it, until it makes another request.
        """
        if not isinstance(request, StopAdvance) or task.exempt_line is not None:
            return None
        return self._most(task) - task.spent

    def _most(self, task: Task) -> int:
        """Return how many requests a program may make in a slice."""
        profile = self._state.profile
        return profile.requests if task.name == "robot" else profile.submit_requests

    def requests_left(self, task: Task) -> int:
        """Return how many requests a program may make in this slice.

        These are few if it is in a loop that waits until something changes, or in an endless loop.
        """
        most = self._most(task)
        is_limited = self.is_idle(task) or task.unbroken >= _ENDLESS
        return min(most, _IDLE_REQUESTS) if is_limited and task.level is None else most

    def is_idle(self, task: Task) -> bool:
        """Return whether a program has changed nothing for some time."""
        return self._state.clock.now - task.busy_at >= IDLE_AFTER

    @property
    def changes(self) -> tuple[int, int]:
        """How often programs have changed a system variable or a signal, and where the arm goes."""
        changes = self._state.variables.activity.changes - self._automatic.count
        return changes, len(self._queue.points)

    def waited(self, task: Task, blocked: Blocked, before: tuple[int, int]) -> None:
        """Note that a program has waited: it is in no endless loop, unless it only polled.

        ``before`` are the `changes` before the request was answered.
        """
        if blocked.wake is None or isinstance(blocked.request, Wait | Poll):
            task.busy_at = self._state.clock.now
            if not blocked.is_postponed:
                task.unbroken = 0
                task.executor.waited()
        if self.changes != before:
            self.acted(task, blocked.request, before)

    def acted(self, task: Task, request: Request, before: tuple[int, int]) -> None:
        """Note that a request was answered, before which the `changes` were ``before``.

        Raises `BudgetExhausted` if the robot's program is in an endless loop.
        """
        has_changed = self.changes != before
        catches = isinstance(request, Write) and request.path[0] == "$ERR"
        if has_changed or catches or not isinstance(request, (*_LOOKS, Write)):
            task.busy_at = self._state.clock.now
        if task.name != "robot":
            return
        if has_changed or isinstance(request, _ACTS):
            self._automatic.changed(len(self._queue.points))
        self._count(task, request)

    def _count(self, task: Task, request: Request) -> None:
        if not isinstance(request, _UNCOUNTED) and not self.is_idle(task):
            task.unbroken += _weight(request)
            if task.unbroken >= _MOST and not self._player.has_steps:
                raise BudgetExhausted(f"it has not ended or waited after {_MOST:,} requests")

    def slice(self, task: Task, request: Slice) -> Answer:
        """Let a program that has used up its statements continue in the next slice."""
        more = (request.count - 1) * self._state.clock.cycle
        return self.until(request, self.next_slice(task) + more, lambda: None)

    # ----------------------------------------------------------------------- the operator

    def halt(self, task: Task, request: Halt) -> Answer:
        """HALT: wait for all planned motions, in an interrupt routine too, then halt [CTL-08]."""

        def halted() -> Blocked:
            self._state.trace.record(task.name, "halt", request.at)
            task.is_halted = True
            self._state.program_states[task.name] = "P_STOP"
            if task.name == "robot":
                self._player.halted()
            return Blocked(request, lambda: not task.is_halted, lambda: None)

        if task.name == "submit":
            return halted()
        self._queue.stop_advance()
        has_braked = any(level.has_braked for level in task.levels)

        def is_reached() -> bool:
            return not (self._queue.own_pending(task) if has_braked else self._queue.pending)

        if is_reached():
            return halted()
        self._state.trace.record(task.name, "advance_stop", request.at)
        return Blocked(request, is_reached, halted)

    def confirm(self, _task: Task, request: Confirm) -> Answer:
        """CONFIRM: acknowledge a message; the number 0 acknowledges all of them (unconfirmed)."""
        self._panel.press("CONFIRM", request.number or None)
        return None


def _weight(request: Request) -> int:
    """Return as how many requests a request counts."""
    match request:
        case Invoke(name=name):
            return _LONG.get(name, 1)
        case Read(path=(str() as name, *_)) | Write(path=(str() as name, *_)):
            return _LONG_POSITION if name.startswith(_POSITIONS) else _LONG.get(name, 1)
    return 1
