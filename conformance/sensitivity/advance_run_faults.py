"""Faults of the advance run: how far ahead, what stops it, what holds in the main run only."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Final

from conformance.sensitivity.planted_fault import Fault, entry, group_of, on, several
from interp.controller import request_handling
from interp.controller.controller import Controller
from interp.controller.motion_queue import Moving
from interp.controller.motions import MotionBuilder
from interp.controller.request_handling import Answering
from interp.controller.tasks import Blocked
from interp.controller.variables import Variables
from interp.controller.world import World
from interp.port.requests import Continue, Halt, Move, MoveSpline

__all__ = ["faults"]

_AHEAD: Final = ("advance", "program")
_ANSWERS: Final = vars(request_handling)["_ANSWERS"]


def faults() -> tuple[Fault, ...]:
    """All of them."""
    return group_of("the advance run", _ADVANCE)


def _ahead(more: int) -> Any:
    """The program waits until another number of motions is pending."""

    def make(right: Any) -> Any:
        def move(self: Answering, task: Any, request: Any) -> Any:
            answer = right(self, task, request)
            if not isinstance(answer, Blocked):
                return answer
            advance: Any = self.variables.read(("$ADVANCE",))
            return Blocked(
                request, lambda: self.own_pending(task) <= max(0, advance + more), answer.finish
            )

        return move

    return make


def _zero_is_one(right: Any) -> Any:
    def move(self: Answering, task: Any, request: Any) -> Any:
        answer = right(self, task, request)
        if not isinstance(answer, Blocked) or self.variables.read(("$ADVANCE",)) != 0:
            return answer
        return Blocked(request, lambda: self.own_pending(task) <= 1, answer.finish)

    return move


def _motions(make: Any) -> Any:
    """Both requests that ask for a motion."""
    return several(entry(_ANSWERS, Move, make), entry(_ANSWERS, MoveSpline, make))


class _Everywhere(tuple[str, int]):
    """A line that every line is equal to."""

    __hash__ = tuple.__hash__

    def __eq__(self, _other: object) -> bool:
        return True

    def __ne__(self, _other: object) -> bool:
        return False


def _continue_holds(_right: Any) -> Any:
    def spare(_self: Answering, task: Any, _request: Any) -> None:
        task.spared = _Everywhere(("", 0))

    return spare


def _standing(right: Any) -> Any:
    """A method finds the arm standing, whatever it does."""

    def method(self: Any, *given: Any) -> Any:
        self.own_pending = lambda _task: 0
        self.core.pending = lambda: 0
        try:
            return right(self, *given)
        finally:
            del self.own_pending, self.core.pending

    return method


def _submit_waits(right: Any) -> Any:
    def when(self: Answering, task: Any, request: Any, then: Any) -> Any:
        if task.name == "submit" and self.core.pending():
            return Blocked(request, lambda: not self.core.pending(), then)
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
    def put(self: Moving, task: Any, at: Any, path: Any, value: Any) -> None:
        self.put_at(task.name, at, ("$OUT", *path[1:]), value)

    return put


def _stale(right: Any) -> Any:
    def begins(self: Moving, way: Any) -> None:
        main = self.variables.main
        right(self, way)
        self.variables.main = main

    return begins


def _quiet(*numbers: int) -> Any:
    def make(right: Any) -> Any:
        def say(self: World, at: Any, number: int, kind: str = "notification") -> None:
            if number not in numbers:
                right(self, at, number, kind)

        return say

    return make


def _unacknowledged(right: Any) -> Any:
    def say(
        self: Controller, task: Any, at: Any, number: int, text: str, kind: str = "notification"
    ) -> None:
        right(self, task, at, number, text, "notification" if kind == "acknowledgement" else kind)

    return say


_NO_OVERRIDE: Final = on(
    World,
    "_was_put",
    lambda right: (
        lambda self, path, value: None if path[0] == "$OV_PRO" else right(self, path, value)
    ),
)

_ADVANCE: Final = (
    ("the advance run is a motion shorter", _AHEAD, _motions(_ahead(-1))),
    ("the advance run is a motion longer", _AHEAD, _motions(_ahead(1))),
    ("$ADVANCE=0 lets the program run ahead", _AHEAD, _motions(_zero_is_one)),
    (
        "nothing stops the advance run",
        _AHEAD,
        on(Answering, "when_reached", lambda _: lambda _self, _task, _request, then: then()),
    ),
    ("writing never stops the advance run", _AHEAD, on(Variables, "stops", _stops(None, False))),
    ("reading never stops the advance run", _AHEAD, on(Variables, "stops", _stops(False, None))),
    ("all writing stops the advance run", _AHEAD, on(Variables, "stops", _stops(None, True))),
    ("all reading stops the advance run", _AHEAD, on(Variables, "stops", _stops(True, None))),
    (
        "CONTINUE does nothing",
        _AHEAD,
        entry(_ANSWERS, Continue, lambda _: lambda _self, _task, _request: None),
    ),
    ("CONTINUE holds for all that follows", _AHEAD, entry(_ANSWERS, Continue, _continue_holds)),
    ("the program ends before the arm stands", _AHEAD, on(Controller, "_end", _standing)),
    (
        "HALT does not wait for the arm",
        ("advance", "interrupt", "control"),
        entry(_ANSWERS, Halt, _standing),
    ),
    (
        "the submit program waits for the arm",
        ("submit", "program"),
        on(Answering, "when_reached", _submit_waits),
    ),
    (
        "$OUT_C is switched in the advance run",
        ("advance", "io"),
        on(Moving, "output_in_main_run", _at_once),
    ),
    ("values of the main run are those of the start", _AHEAD, on(Moving, "_begins", _stale)),
    (
        "a blend that fails is never the fault of an advance stop",
        ("advance", "message"),
        on(Moving, "hold_up", lambda _: lambda _self: None),
    ),
    (
        "a blend that fails is not told",
        ("advance", "message"),
        on(World, "say_number", _quiet(1123, 1442)),
    ),
    (
        "a point reached by the coincidence run is not told",
        ("advance", "message"),
        on(World, "say_number", _quiet(1350)),
    ),
    (
        "messages to be acknowledged stop nothing",
        ("advance", "message"),
        on(Controller, "say", _unacknowledged),
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
