"""Planted faults: mistakes that no mutation operator makes in one place.

`mutation_operators` leaves statements out and changes operators, conditions and constants. It adds
no statement, exchanges no order and reads no other value than the code does; the faults here do.
A fault that an operator makes too is not in the table, nor a second one of its kind.

Faults are planted into the running process: a function of a class or module is replaced.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager
from dataclasses import dataclass, replace
from typing import Any, Final
from unittest.mock import patch

from interp.controller.motion.advance_run import AdvanceRun
from interp.controller.motion.motion_builder import MotionBuilder
from interp.controller.motion.motion_queue import MotionQueue
from interp.controller.requests.waits import Waits
from interp.controller.state.declared_interrupts import Interrupts
from interp.controller.state.signals import Signals
from interp.robot.kinematics.placement import Placement
from interp.robot.path import programmed_targets
from interp.robot.path.programmed_targets import Programmed
from interp.robot.planning.planned_arm import PlannedArm
from interp.robot.planning.timeline import Timeline


@dataclass(frozen=True, slots=True)
class Fault:
    """A function that a class or module ``owner`` has, replaced by what ``make`` makes from it."""

    group: str
    words: str
    owner: Any
    attribute: str
    make: Callable[[Any], Any]

    def plant(self) -> AbstractContextManager[object]:
        """Have the fault in the running process while the context lasts."""
        return patch.object(self.owner, self.attribute, self.make(self._right))

    @property
    def _right(self) -> Any:
        """The function as it is without the fault."""
        return vars(self.owner)[self.attribute]

    @property
    def name(self) -> str:
        """Its identity: group and words."""
        return f"{self.group}: {self.words}"

    @property
    def module(self) -> str:
        """The module of the function."""
        return str(self._right.__module__)

    @property
    def function(self) -> str:
        """The qualified name of the function."""
        return str(self._right.__qualname__)

    @property
    def lines(self) -> tuple[int, int]:
        """The first and last line of the function; a case that runs none cannot notice it."""
        code = self._right.__code__
        return code.co_firstlineno, max(line for _, _, line in code.co_lines() if line)

    @property
    def is_module_level(self) -> bool:
        """Whether it changes the value of a name; only functions are replaced."""
        return False

    def __reduce__(self) -> tuple[Any, ...]:
        """Another process finds it in `FAULTS`, since functions made here cannot be sent."""
        return _named, (self.name,)


def _named(name: str) -> Fault:
    return next(one for one in FAULTS if one.name == name)


# ------------------------------------------------------------------------------------ controller


class _EveryLine(tuple[str, int]):
    """A line that is equal to every line."""

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


#: All planted faults.
FAULTS: Final = (
    Fault(
        "the clock", "WAIT FOR looks in every tenth cycle only", Waits, "next_slice", _poll_seldom
    ),
    Fault("outputs", "outputs are switched a cycle late", Signals, "write", _write_late),
    Fault("outputs", "groups have their bits the other way round", Signals, "put", _put_reversed),
    Fault(
        "the advance run",
        "CONTINUE holds for all that follows",
        AdvanceRun,
        "exempt",
        _exempt_always,
    ),
    Fault("interrupts", "the lowest priority comes first", Interrupts, "next", _lowest_priority),
    Fault(
        "interrupts", "ON without a number means the first one", Interrupts, "switch", _switch_first
    ),
    Fault(
        "interrupts", "a number is declared once and for all", Interrupts, "declare", _declare_once
    ),
    Fault("triggers", "only the last trigger counts", MotionQueue, "plan", _last_trigger),
    Fault("motions", "the override counts twice", PlannedArm, "override", _override_squared),
    Fault("motions", "values behind WITH count nothing", MotionBuilder, "_part", _without_values),
    Fault(
        "targets",
        "the Status of a target counts nothing",
        programmed_targets,
        "ptp_target",
        _without_status,
    ),
    Fault(
        "targets",
        "$TOOL counts nothing",
        Placement,
        "flange",
        lambda _: lambda self, point: self.before @ point,
    ),
    Fault(
        "targets", "components left out are zero", Programmed, "components_of", _zero_where_missing
    ),
    Fault("motions", "set-points come a cycle late", Timeline, "sample", _sample_late),
)
