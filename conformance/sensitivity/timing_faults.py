"""Faults of the controller in time: the clock, outputs and inputs, pulses, timers, waits."""

from __future__ import annotations

import math
from typing import Any, Final

from conformance.sensitivity.planted_fault import Fault, group_of, on
from interp.controller.interrupts.cyclic_evaluation import CyclicEvaluation
from interp.controller.requests.variable_access import VariableAccess
from interp.controller.requests.waits import Waits
from interp.controller.state.clock import Clock
from interp.controller.state.signals import Signals
from interp.controller.state.timers import Timers

_IO: Final = ("io", "program")


def faults() -> tuple[Fault, ...]:
    """All of them."""
    return (
        *group_of("the clock", _CLOCK),
        *group_of("outputs and inputs", _SIGNALS),
        *group_of("timers and cyclic values", _TIMERS),
    )


# ------------------------------------------------------------------------------------ the clock


def _down(_right: Any) -> Any:
    return lambda self, duration: (self.now + int(max(duration, 0))) // self.cycle * self.cycle


def _exact(_right: Any) -> Any:
    return lambda self, duration: math.ceil(self.now + max(duration, 0))


def _slow_polls(right: Any) -> Any:
    def later(self: Waits, task: Any) -> int:
        more = 9 * self._state.clock.cycle if task.name == "robot" else 0
        return int(right(self, task)) + more

    return later


_CLOCK: Final = (
    ("times to wait are rounded down to cycles", _IO, on(Clock, "tick_after", _down)),
    ("times to wait are not rounded", ("io", "control"), on(Clock, "tick_after", _exact)),
    (
        "WAIT FOR looks in every tenth cycle only",
        ("io", "control", "program"),
        on(Waits, "next_slice", _slow_polls),
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


def _clamped_analog(right: Any) -> Any:
    def put(self: Signals, name: str, place: int, value: Any) -> None:
        right(self, name, place, min(max(value, -1.0), 1.0))

    return put


def _pulse_once(right: Any) -> Any:
    def pulse(self: Signals, number: int, level: bool, seconds: float) -> None:
        if number not in self._pulses:
            right(self, number, level, seconds)

    return pulse


_SIGNALS: Final = (
    (
        "outputs are switched a cycle late",
        ("io", "trigger", "advance"),
        on(Signals, "write", _late_outputs),
    ),
    ("groups have their bits the other way round", ("io",), on(Signals, "put", _reversed_groups)),
    ("groups have eight bits at most", ("io",), on(Signals, "read", _wide_groups)),
    (
        "analog values beyond the range are cut off silently",
        ("io", "message"),
        on(Signals, "_put_analog", _clamped_analog),
    ),
    ("a pulse that runs is not restarted", ("io",), on(Signals, "pulse", _pulse_once)),
)


# ------------------------------------------------------------------------------------ timers


def _fine_timer(_right: Any) -> Any:
    def value(self: Timers, timer: Any) -> int:
        passed = 0 if timer.since is None else (self._clock.now - timer.since) // 1000
        return int(timer.base + passed)

    return value


def _starting_from_zero(right: Any) -> Any:
    def write(self: Timers, path: Any, value: Any) -> None:
        right(self, path, value)
        if path[0] == "$TIMER_STOP" and value is False:
            self._timer(path).base = 0

    return write


def _once(name: str) -> Any:
    """A cyclic signal is computed the first time only."""

    def make(right: Any) -> Any:
        def enter(self: CyclicEvaluation, task: Any, request: Any) -> None:
            done = self.__dict__.setdefault(name, set())
            if request.name not in done:
                done.add(request.name)
                right(self, task, request)

        return enter

    return make


_TIMERS: Final = (
    ("timers count between ticks as well", ("io",), on(Timers, "_value", _fine_timer)),
    (
        "a timer begins at zero when it is started",
        ("io",),
        on(Timers, "write", _starting_from_zero),
    ),
    (
        "cyclic signals are computed once",
        ("io",),
        on(CyclicEvaluation, "enter_signal", _once("_entered")),
    ),
    (
        "ANOUT ON knows no limits",
        ("io",),
        on(
            VariableAccess,
            "_put_cyclic",
            lambda _: lambda self, request, _signal: self._state.put(request.path, request.value),
        ),
    ),
)
