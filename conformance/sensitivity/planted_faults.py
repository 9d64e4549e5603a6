"""Planted faults: mistakes that no mutation operator makes in one place.

`mutation_operators` leaves statements out and changes operators, conditions and constants. It adds
no statement, exchanges no order and reads no other value than the code does; the faults here do.
A fault that an operator makes too is not in the table, nor a second one of its kind.

Faults are planted into the running process: an attribute of a class or module is replaced for as
long as a case runs.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager
from dataclasses import dataclass, replace
from typing import Any, Final
from unittest.mock import patch

from interp.controller.motion.advance_run import AdvanceRun
from interp.controller.motion.motion_queue import MotionQueue
from interp.controller.motion.motions import MotionBuilder
from interp.controller.requests.waits import Waits
from interp.controller.state.interrupts import Interrupts
from interp.controller.state.signals import Signals
from interp.robot.kinematics.placement import Placement
from interp.robot.path import targets_in_force
from interp.robot.path.targets_in_force import Programmed
from interp.robot.planning.planned_arm import PlannedArm
from interp.robot.planning.timeline import Timeline

#: Plants a fault for as long as the context lasts.
Plant = Callable[[], AbstractContextManager[object]]


@dataclass(frozen=True, slots=True)
class Fault:
    """A fault that can be planted; ``suites`` have to find it, all of them where it is empty."""

    group: str
    words: str
    suites: tuple[str, ...]
    plant: Plant


def on(owner: Any, name: str, make: Callable[[Any], Any]) -> Plant:
    """Replace an attribute that a class or module itself has by what is made from it."""
    return lambda: patch.object(owner, name, make(vars(owner)[name]))


# ------------------------------------------------------------------------------------ controller


class _EveryLine(tuple[str, int]):
    """A line that every line is equal to."""

    __hash__ = tuple.__hash__

    def __eq__(self, _other: object) -> bool:
        return True

    def __ne__(self, _other: object) -> bool:
        return False


def _exempt_always(_right: Any) -> Any:
    def exempt(_self: AdvanceRun, task: Any, _request: Any) -> None:
        task.exempt_line = _EveryLine(("", 0))

    return exempt


def _poll_seldom(right: Any) -> Any:
    def next_slice(self: Waits, task: Any) -> int:
        more = 9 * self._state.clock.cycle if task.name == "robot" else 0
        return int(right(self, task)) + more

    return next_slice


def _write_late(right: Any) -> Any:
    def write(self: Signals, path: Any, value: Any) -> None:
        self.read(path)
        self._later(self._clock.now + self._clock.cycle, lambda: right(self, path, value))

    return write


def _put_reversed(right: Any) -> Any:
    def put(self: Signals, path: Any, value: Any) -> None:
        if len(path) == 4 and type(value) is int:
            bits = path[3] - path[1] + 1
            value = sum((value >> place & 1) << (bits - 1 - place) for place in range(bits))
        right(self, path, value)

    return put


def _lowest_priority(_right: Any) -> Any:
    def chosen(self: Interrupts) -> Any:
        ready = [one for one in self if one.has_come and one.state == "on"]
        return ready[-1] if ready else None

    return chosen


def _switch_first(right: Any) -> Any:
    def switch(self: Interrupts, action: str, number: Any, holds: Any) -> None:
        numbers = [one.number for one in self]
        right(self, action, numbers[0] if number is None and numbers else number, holds)

    return switch


def _declare_once(right: Any) -> Any:
    def declare(self: Interrupts, request: Any) -> None:
        if request.number not in self._by_number:
            right(self, request)

    return declare


def _last_trigger(right: Any) -> Any:
    def plan(self: MotionQueue, task: Any, request: Any) -> Any:
        task.triggers = task.triggers[-1:]
        return right(self, task, request)

    return plan


# ------------------------------------------------------------------------------------ arm


def _sample_late(right: Any) -> Any:
    return lambda self, times: right(self, times - 12_000)


def _override_squared(right: Any) -> Any:
    return lambda self, now, percent: right(self, now, percent * percent / 100)


def _without_status(right: Any) -> Any:
    return lambda *given, **more: right(*given, **{**more, "status": None})


def _zero_where_missing(right: Any) -> Any:
    def components(self: Programmed, target: Any, placement: Placement, *more: Any) -> Any:
        whole = dict.fromkeys("XYZABC", 0.0)
        is_plain = not (more and more[0]) and not any(
            name[0] == "A" and name != "A" for name in target
        )
        return right(self, {**whole, **target} if is_plain else target, placement, *more)

    return components


def _without_values(right: Any) -> Any:
    return lambda self, item, *more: right(self, replace(item, values=()), *more)


_MOVING: Final = ("motion", "posture", "spline", "interrupt", "blending", "message")
_TARGETS: Final = ("motion", "posture", "data")
_INTERRUPTS: Final = ("interrupt", "program")

FAULTS: Final = tuple(
    Fault(group, words, suites, on(owner, name, make))
    for group, words, suites, owner, name, make in (
        (
            "the clock",
            "WAIT FOR looks in every tenth cycle only",
            ("io", "control", "program"),
            *(Waits, "next_slice", _poll_seldom),
        ),
        (
            "outputs",
            "outputs are switched a cycle late",
            ("io", "trigger", "advance"),
            *(Signals, "write", _write_late),
        ),
        (
            "outputs",
            "groups have their bits the other way round",
            ("io",),
            *(Signals, "put", _put_reversed),
        ),
        (
            "the advance run",
            "CONTINUE holds for all that follows",
            ("advance", "program"),
            *(AdvanceRun, "exempt", _exempt_always),
        ),
        (
            "interrupts",
            "the lowest priority comes first",
            _INTERRUPTS,
            *(Interrupts, "next", _lowest_priority),
        ),
        (
            "interrupts",
            "ON without a number means the first one",
            _INTERRUPTS,
            *(Interrupts, "switch", _switch_first),
        ),
        (
            "interrupts",
            "a number is declared once and for all",
            _INTERRUPTS,
            *(Interrupts, "declare", _declare_once),
        ),
        (
            "triggers",
            "only the last trigger counts",
            ("trigger", "spline"),
            *(MotionQueue, "plan", _last_trigger),
        ),
        (
            "motions",
            "the override counts twice",
            _MOVING,
            *(PlannedArm, "override", _override_squared),
        ),
        ("motions", "set-points come a cycle late", _MOVING, Timeline, "sample", _sample_late),
        (
            "motions",
            "values behind WITH count nothing",
            ("spline",),
            *(MotionBuilder, "_part", _without_values),
        ),
        (
            "targets",
            "the Status of a target counts nothing",
            _TARGETS,
            *(targets_in_force, "ptp_target", _without_status),
        ),
        (
            "targets",
            "$TOOL counts nothing",
            _TARGETS,
            *(Placement, "flange", lambda _: lambda self, point: self.before @ point),
        ),
        (
            "targets",
            "components left out are zero",
            _TARGETS,
            *(Programmed, "components_of", _zero_where_missing),
        ),
    )
)
