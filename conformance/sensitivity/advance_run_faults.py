"""Faults of the advance run: how far ahead, what stops it, what holds in the main run only."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Final

from conformance.sensitivity.planted_fault import Fault, group_of, on
from interp.controller.advance_run import AdvanceRun
from interp.controller.arm_control import ArmControl
from interp.controller.messages import Messages
from interp.controller.motion_queue import MotionQueue
from interp.controller.motion_requests import MotionRequests
from interp.controller.motions import MotionBuilder
from interp.controller.scheduler import Scheduler
from interp.controller.tasks import Blocked
from interp.controller.variables import Variables
from interp.controller.waits import Waits

_AHEAD: Final = ("advance", "program")


def faults() -> tuple[Fault, ...]:
    """All of them."""
    return group_of("the advance run", _ADVANCE)


def _ahead(more: int) -> Any:
    """The program waits until another number of motions is pending."""

    def make(right: Any) -> Any:
        def move(self: MotionRequests, task: Any, request: Any) -> Any:
            answer = right(self, task, request)
            if not isinstance(answer, Blocked):
                return answer
            advance: Any = self._state.variables.read(("$ADVANCE",))
            return Blocked(
                request,
                lambda: self._queue.own_pending(task) <= max(0, advance + more),
                answer.finish,
            )

        return move

    return make


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


def _stops(reading: bool | None, writing: bool | None) -> Any:
    def make(right: Any) -> Any:
        def stops(self: Variables, name: str, *, is_write: bool) -> bool:
            wanted = writing if is_write else reading
            return bool(right(self, name, is_write=is_write)) if wanted is None else wanted

        return stops

    return make


def _at_once(_right: Any) -> Any:
    def put(self: MotionQueue, task: Any, at: Any, path: Any, value: Any) -> None:
        self._state.put_at(task.name, at, ("$OUT", *path[1:]), value)

    return put


def _stale(right: Any) -> Any:
    def begins(self: MotionQueue, queued: Any) -> None:
        variables = self._state.variables
        main = variables.main
        right(self, queued)
        variables.main = main

    return begins


def _quiet(*numbers: int) -> Any:
    def make(right: Any) -> Any:
        def say(self: Messages, at: Any, number: int, kind: str = "notification") -> None:
            if number not in numbers:
                right(self, at, number, kind)

        return say

    return make


def _unacknowledged(right: Any) -> Any:
    def say(
        self: Messages, task: Any, at: Any, number: int, text: str, kind: str = "notification"
    ) -> None:
        right(self, task, at, number, text, "notification" if kind == "acknowledgement" else kind)

    return say


_NO_OVERRIDE: Final = on(ArmControl, "changed", lambda _: lambda _self, _path, _value: None)

_ADVANCE: Final = (
    ("the advance run is a motion shorter", _AHEAD, on(MotionRequests, "move", _ahead(-1))),
    ("the advance run is a motion longer", _AHEAD, on(MotionRequests, "move", _ahead(1))),
    ("$ADVANCE=0 lets the program run ahead", _AHEAD, on(MotionRequests, "move", _zero_is_one)),
    (
        "nothing stops the advance run",
        _AHEAD,
        on(AdvanceRun, "when_reached", lambda _: lambda _self, _task, _request, then: then()),
    ),
    ("writing never stops the advance run", _AHEAD, on(Variables, "stops", _stops(None, False))),
    ("reading never stops the advance run", _AHEAD, on(Variables, "stops", _stops(False, None))),
    ("all writing stops the advance run", _AHEAD, on(Variables, "stops", _stops(None, True))),
    ("all reading stops the advance run", _AHEAD, on(Variables, "stops", _stops(True, None))),
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
    ("values of the main run are those of the start", _AHEAD, on(MotionQueue, "_started", _stale)),
    (
        "a blend that fails is never the fault of an advance stop",
        ("advance", "message"),
        on(MotionQueue, "stop_advance", lambda _: lambda _self: None),
    ),
    (
        "a blend that fails is not told",
        ("advance", "message"),
        on(Messages, "post_number", _quiet(1123, 1442)),
    ),
    (
        "a point reached by the coincidence run is not told",
        ("advance", "message"),
        on(Messages, "post_number", _quiet(1350)),
    ),
    (
        "messages to be acknowledged stop nothing",
        ("advance", "message"),
        on(Messages, "post", _unacknowledged),
    ),
    ("the override has no effect", ("motion", "blending", "spline"), _NO_OVERRIDE),
    (
        "T1 is no slower",
        ("motion",),
        on(
            MotionBuilder,
            "_settings",
            lambda right: lambda self, values: replace(right(self, values), is_reduced=False),
        ),
    ),
)
