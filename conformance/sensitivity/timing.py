"""Faults of the controller in time: the clock, outputs, waits, timers, pulses, the advance run."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any, Final

from conformance.sensitivity.planting import Fault, constant, entry, on, several
from interp.controller import answering, signals
from interp.controller.answering import Answering
from interp.controller.clock import Clock
from interp.controller.controller import Controller
from interp.controller.entering import Entering
from interp.controller.motions import MotionBuilder
from interp.controller.moving import Moving
from interp.controller.signals import ALWAYS_TRUE, Signals
from interp.controller.tasks import Blocked
from interp.controller.timers import Timers
from interp.controller.variables import Variables
from interp.controller.world import World
from interp.requests import Continue, Halt, Move, MoveSpline

__all__ = ["faults"]

_IO: Final = ("io", "program")
_AHEAD: Final = ("advance", "program")
_ANSWERS: Final = vars(answering)["_ANSWERS"]


def faults() -> tuple[Fault, ...]:
    """All of them."""
    return (
        *_of("the clock", _CLOCK),
        *_of("outputs and inputs", _SIGNALS),
        *_of("timers and cyclic values", _TIMERS),
        *_of("the advance run", _ADVANCE),
    )


def _of(group: str, rows: Any) -> list[Fault]:
    return [Fault(group, words, suites, plant) for words, suites, plant in rows]


# ------------------------------------------------------------------------------------ the clock


def _down(_right: Any) -> Any:
    return lambda self, duration: (self.now + int(max(duration, 0))) // self.cycle * self.cycle


def _exact(_right: Any) -> Any:
    return lambda self, duration: math.ceil(self.now + max(duration, 0))


def _slow_polls(right: Any) -> Any:
    def later(self: Answering, task: Any) -> int:
        more = 9 * self.clock.cycle if task.name == "robot" else 0
        return int(right(self, task)) + more

    return later


def _slow_submit(right: Any) -> Any:
    def later(self: Answering, task: Any) -> int:
        more = 49 * self.clock.cycle if task.name == "submit" else 0
        return int(right(self, task)) + more

    return later


_CLOCK: Final = (
    ("times to wait are rounded down to cycles", _IO, on(Clock, "tick_after", _down)),
    ("times to wait are not rounded", ("io", "control"), on(Clock, "tick_after", _exact)),
    (
        "times to wait end a cycle late",
        _IO,
        on(Clock, "tick_after", lambda right: lambda self, t: right(self, t) + self.cycle),
    ),
    (
        "times to wait are half as long",
        _IO,
        on(Clock, "tick_after", lambda right: lambda self, t: right(self, t / 2)),
    ),
    (
        "WAIT FOR looks in every tenth cycle only",
        ("io", "control", "program"),
        on(Answering, "next_slice", _slow_polls),
    ),
    (
        "the submit program runs once in half a second",
        ("submit", "program"),
        on(Answering, "next_slice", _slow_submit),
    ),
)


# ------------------------------------------------------------------------------------ signals


def _late_outputs(right: Any) -> Any:
    def late(self: Signals, path: Any, value: Any) -> None:
        self.read(path)
        self._later(self._clock.now + self._clock.cycle, lambda: right(self, path, value))

    return late


def _backwards(bits: int, number: int) -> int:
    return sum((number >> place & 1) << (bits - 1 - place) for place in range(bits))


def _reversed_groups(right: Any) -> Any:
    def put(self: Signals, path: Any, value: Any) -> None:
        if len(path) == 4 and type(value) is int:
            value = _backwards(path[3] - path[1] + 1, value)
        right(self, path, value)

    return put


def _wide_groups(right: Any) -> Any:
    def read(self: Signals, path: Any) -> Any:
        value = right(self, path)
        return value & 0xFF if len(path) == 4 else value

    return read


def _without_input_1025(right: Any) -> Any:
    def made(self: Signals, *given: Any) -> None:
        right(self, *given)
        self._digital["$IN"][ALWAYS_TRUE] = False

    return made


def _clamped_analog(right: Any) -> Any:
    def put(self: Signals, name: str, place: int, value: Any) -> None:
        right(self, name, place, min(max(value, -1.0), 1.0))

    return put


def _pulse_once(right: Any) -> Any:
    def pulse(self: Signals, number: int, level: bool, seconds: float) -> None:
        if number not in self._pulses:
            right(self, number, level, seconds)

    return pulse


def _unending_pulse(_right: Any) -> Any:
    def put_bit(self: Signals, name: str, place: int, value: bool) -> None:
        pulses, self._pulses = self._pulses, {}
        try:
            _PUT_BIT(self, name, place, value)
        finally:
            self._pulses = pulses

    return put_bit


_PUT_BIT: Final = Signals._put_bit


_SIGNALS: Final = (
    (
        "outputs are switched a cycle late",
        ("io", "trigger", "advance"),
        on(Signals, "write", _late_outputs),
    ),
    ("groups have their bits the other way round", ("io",), on(Signals, "put", _reversed_groups)),
    ("groups have eight bits at most", ("io",), on(Signals, "read", _wide_groups)),
    ("input 1025 is FALSE", ("io",), on(Signals, "__init__", _without_input_1025)),
    (
        "analog values beyond the range are cut off silently",
        ("io", "message"),
        on(Signals, "_put_analog", _clamped_analog),
    ),
    (
        "a pulse is half as long",
        ("io",),
        on(Signals, "pulse", lambda right: lambda self, n, v, t: right(self, n, v, t / 2)),
    ),
    (
        "a pulse is a tenth of a second longer",
        ("io",),
        on(Signals, "pulse", lambda right: lambda self, n, v, t: right(self, n, v, t + 0.1)),
    ),
    (
        "a pulse has no end",
        ("io",),
        on(Signals, "pulse", lambda _: lambda self, n, v, _t: self.put(("$OUT", n), v)),
    ),
    ("a pulse may be as short as one likes", ("io",), constant(signals, "_SHORTEST", 0.0)),
    ("a pulse that runs is not restarted", ("io",), on(Signals, "pulse", _pulse_once)),
    ("the other level does not end a pulse", ("io",), on(Signals, "_put_bit", _unending_pulse)),
)


# ------------------------------------------------------------------------------------ timers


def _slow_timer(right: Any) -> Any:
    return lambda self, timer: timer.base + (right(self, timer) - timer.base) // 2


def _fine_timer(_right: Any) -> Any:
    def value(self: Timers, timer: Any) -> int:
        passed = 0 if timer.since is None else (self._clock.now - timer.since) // 1000
        return int(timer.base + passed)

    return value


def _timer_read(otherwise: Callable[[Timers, Any, Any], Any]) -> Any:
    def make(right: Any) -> Any:
        def read(self: Timers, path: Any) -> Any:
            value = right(self, path)
            return otherwise(self, path, value) if path[0] == "$TIMER_FLAG" else value

        return read

    return make


def _timer_write(drops: Callable[[Any, Any], bool]) -> Any:
    """Writes of some kind are lost."""

    def make(right: Any) -> Any:
        def write(self: Timers, path: Any, value: Any) -> None:
            if not drops(path, value):
                right(self, path, value)

        return write

    return make


def _starting_from_zero(right: Any) -> Any:
    def write(self: Timers, path: Any, value: Any) -> None:
        right(self, path, value)
        if path[0] == "$TIMER_STOP" and value is False:
            self._timer(path).base = 0

    return write


def _once(name: str) -> Any:
    """A cyclic signal is computed the first time only."""

    def make(right: Any) -> Any:
        def enter(self: Entering, task: Any, request: Any) -> None:
            done = self.__dict__.setdefault(name, set())
            if request.name not in done:
                done.add(request.name)
                right(self, task, request)

        return enter

    return make


_TIMERS: Final = (
    ("timers run at half the speed", ("io",), on(Timers, "_value", _slow_timer)),
    ("timers count between ticks as well", ("io",), on(Timers, "_value", _fine_timer)),
    (
        "a timer begins at zero when it is started",
        ("io",),
        on(Timers, "write", _starting_from_zero),
    ),
    (
        "timers are not stopped",
        ("io",),
        on(Timers, "write", _timer_write(lambda p, v: p[0] == "$TIMER_STOP" and v is True)),
    ),
    (
        "the value of a timer cannot be set",
        ("io",),
        on(Timers, "write", _timer_write(lambda p, _: p[0] == "$TIMER")),
    ),
    (
        "the flag of a timer tells the contrary",
        ("io",),
        on(Timers, "read", _timer_read(lambda _self, _path, value: not value)),
    ),
    (
        "the flag of a timer is always TRUE",
        ("io",),
        on(Timers, "read", _timer_read(lambda _self, _path, _value: True)),
    ),
    (
        "cyclic flags keep their first value",
        ("io", "interrupt"),
        on(Entering, "refresh_flags", lambda _: lambda _self: None),
    ),
    ("cyclic signals are computed once", ("io",), on(Entering, "enter_signal", _once("_entered"))),
    (
        "ANOUT ON knows no limits",
        ("io",),
        on(
            Answering,
            "_put_cyclic",
            lambda _: lambda self, _task, request: self.put(request.path, request.value),
        ),
    ),
)


# ------------------------------------------------------------------------------------ ahead


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
