"""Faults of the controller in time: the clock, outputs and inputs, pulses, timers, waits."""

from __future__ import annotations

from typing import Any, Final

from conformance.sensitivity.planted_fault import Fault, group_of, on
from interp.controller.interrupts.cyclic_evaluation import CyclicEvaluation
from interp.controller.requests.waits import Waits
from interp.controller.state.signals import Signals
from interp.controller.state.timers import Timers


def faults() -> tuple[Fault, ...]:
    """All of them."""
    return (
        *group_of("the clock", _CLOCK),
        *group_of("outputs and inputs", _SIGNALS),
        *group_of("timers and cyclic values", _TIMERS),
    )


# ------------------------------------------------------------------------------------ the clock


def _slow_polls(right: Any) -> Any:
    def later(self: Waits, task: Any) -> int:
        more = 9 * self._state.clock.cycle if task.name == "robot" else 0
        return int(right(self, task)) + more

    return later


_CLOCK: Final = (
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


_SIGNALS: Final = (
    (
        "outputs are switched a cycle late",
        ("io", "trigger", "advance"),
        on(Signals, "write", _late_outputs),
    ),
    ("groups have their bits the other way round", ("io",), on(Signals, "put", _reversed_groups)),
    ("groups have eight bits at most", ("io",), on(Signals, "read", _wide_groups)),
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
)
