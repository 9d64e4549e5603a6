"""Faults of the advance run: how far ahead, what stops it, what holds in the main run only."""

from __future__ import annotations

from typing import Any, Final

from conformance.sensitivity.planted_fault import Fault, group_of, on
from interp.controller.motion.advance_run import AdvanceRun
from interp.controller.motion.motion_queue import MotionQueue
from interp.controller.requests.motion_requests import MotionRequests
from interp.controller.requests.waits import Waits
from interp.controller.scheduler import Scheduler
from interp.controller.state.messages import Messages
from interp.controller.state.tasks import Blocked

_AHEAD: Final = ("advance", "program")


def faults() -> tuple[Fault, ...]:
    """All of them."""
    return group_of("the advance run", _ADVANCE)


def _zero_is_one(right: Any) -> Any:
    def move(self: MotionRequests, task: Any, request: Any) -> Any:
        answer = right(self, task, request)
        if not isinstance(answer, Blocked) or self._state.variables.read(("$ADVANCE",)) != 0:
            return answer
        return Blocked(request, lambda: self._queue.own_pending(task) <= 1, answer.finish)

    return move


class _Everywhere(tuple[str, int]):
    """A line that every line is equal to."""

    __hash__ = tuple.__hash__

    def __eq__(self, _other: object) -> bool:
        return True

    def __ne__(self, _other: object) -> bool:
        return False


def _continue_holds(_right: Any) -> Any:
    def spare(_self: AdvanceRun, task: Any, _request: Any) -> None:
        task.exempt_line = _Everywhere(("", 0))

    return spare


def _standing(right: Any) -> Any:
    """A method finds the arm standing, whatever it does."""

    def method(self: Any, *given: Any) -> Any:
        queue: Any = self.queue if isinstance(self, Scheduler) else self._queue
        queue.own_pending = lambda _task: 0
        queue._core.pending = lambda: 0
        try:
            return right(self, *given)
        finally:
            del queue.own_pending, queue._core.pending

    return method


def _submit_waits(right: Any) -> Any:
    def when(self: AdvanceRun, task: Any, request: Any, then: Any) -> Any:
        if task.name == "submit" and self._queue.pending:
            return Blocked(request, lambda: not self._queue.pending, then)
        return right(self, task, request, then)

    return when


def _at_once(_right: Any) -> Any:
    def put(self: MotionQueue, task: Any, at: Any, path: Any, value: Any) -> None:
        self._state.put_at(task.name, at, ("$OUT", *path[1:]), value)

    return put


def _unacknowledged(right: Any) -> Any:
    def say(
        self: Messages, task: Any, at: Any, number: int, text: str, kind: str = "notification"
    ) -> None:
        right(self, task, at, number, text, "notification" if kind == "acknowledgement" else kind)

    return say


_ADVANCE: Final = (
    ("$ADVANCE=0 lets the program run ahead", _AHEAD, on(MotionRequests, "move", _zero_is_one)),
    (
        "CONTINUE does nothing",
        _AHEAD,
        on(AdvanceRun, "exempt", lambda _: lambda _self, _task, _request: None),
    ),
    ("CONTINUE holds for all that follows", _AHEAD, on(AdvanceRun, "exempt", _continue_holds)),
    ("the program ends before the arm stands", _AHEAD, on(Scheduler, "_end", _standing)),
    (
        "HALT does not wait for the arm",
        ("advance", "interrupt", "control"),
        on(Waits, "halt", _standing),
    ),
    (
        "the submit program waits for the arm",
        ("submit", "program"),
        on(AdvanceRun, "when_reached", _submit_waits),
    ),
    (
        "$OUT_C is switched in the advance run",
        ("advance", "io"),
        on(MotionQueue, "output_in_main_run", _at_once),
    ),
    (
        "messages to be acknowledged stop nothing",
        ("advance", "message"),
        on(Messages, "post", _unacknowledged),
    ),
)
