"""Timers, and date and time [TIM-07], on the virtual clock.

A timer counts ms in steps of the interpolation cycle [TIM-05]. At the start all timers are 0 and
their flags FALSE [TIM-02]. Once a timer has been started or set, its flag is TRUE if the value is
zero or more [TIM-03]. A program may also write the flag: the flag keeps that value until the timer
passes zero from below or is set [TIM-04] (unconfirmed).
"""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Any

from grammar.semantics.types import BOOL
from interp.controller.state.clock import Clock
from interp.port.requests import Path, Value
from interp.values.faults import fault
from interp.values.values import StructureValue, converted, index


@dataclass(slots=True)
class _Timer:
    """A timer with the value ``base`` in ms at ``since``, the tick in µs of its start or setting.

    ``since`` is ``None`` while the timer is stopped. ``flag`` is the value written to its flag,
    ``None`` if the flag follows the timer; ``was_below`` says whether the timer was negative then.
    """

    base: int = 0
    since: int | None = None
    flag: bool | None = False
    was_below: bool = False


class Timers:
    """The variables $TIMER, $TIMER_STOP and $TIMER_FLAG [TIM-01]."""

    def __init__(self, clock: Clock, size: int) -> None:
        self._clock = clock
        self._timers: dict[Any, _Timer] = {number: _Timer() for number in range(1, size + 1)}

    def read(self, path: Path) -> Value:
        """Return the value of one of the three variables; faults ``index``."""
        timer = self._timer(path)
        match path[0]:
            case "$TIMER":
                return self._value(timer)
            case "$TIMER_STOP":
                return timer.since is None
        is_reached = self._value(timer) >= 0
        if timer.flag is None or (timer.was_below and is_reached):
            return is_reached
        return timer.flag

    def write(self, path: Path, value: Value) -> None:
        """Set, start or stop a timer, or set its flag; faults ``index``, ``inadmissible``."""
        timer = self._timer(path)
        tick = self._clock.tick
        if path[0] == "$TIMER":
            timer.base = index(value)
            timer.since = None if timer.since is None else tick
            timer.flag = None
            return
        is_true: Any = converted(value, BOOL)
        if path[0] == "$TIMER_FLAG":
            timer.flag, timer.was_below = is_true, self._value(timer) < 0
            return
        timer.base = self._value(timer)
        timer.since = None if is_true else tick
        if not is_true:
            timer.flag = None

    def _value(self, timer: _Timer) -> int:
        if timer.since is None:
            return timer.base
        return timer.base + (self._clock.tick - timer.since) // 1000

    def _timer(self, path: Path) -> _Timer:
        _, *steps = path
        if len(steps) != 1:
            raise fault("inadmissible")
        (number,) = steps
        if number not in self._timers:
            raise fault("index")
        return self._timers[number]


def date_members(start: datetime, now: int, date: StructureValue) -> StructureValue:
    """Fill a DATE with the time ``now``, in µs after ``start``, and return it."""
    at = start + timedelta(microseconds=now)
    members = {
        "CSEC": at.microsecond // 10_000,
        "SEC": at.second,
        "MIN": at.minute,
        "HOUR": at.hour,
        "DAY": at.day,
        "MONTH": at.month,
        "YEAR": at.year,
    }
    for name, value in members.items():
        date.set(name, value)
    return date
