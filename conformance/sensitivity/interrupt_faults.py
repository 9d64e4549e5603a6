"""Faults of the controller: interrupts, BRAKE and RESUME, triggers."""

from __future__ import annotations

from typing import Any, Final

from conformance.sensitivity.planted_fault import (
    Fault,
    Plant,
    group_in,
    on,
)
from interp.controller.interrupts.interrupt_unit import InterruptUnit
from interp.controller.interrupts.levels import Levels
from interp.controller.motion.motion_queue import MotionQueue
from interp.controller.state.interrupts import Interrupts
from interp.controller.state.tasks import PROGRAM, Task

_SUITES: Final = ("interrupt", "program")


def faults() -> tuple[Fault, ...]:
    """All of them."""
    return (
        *group_in("interrupts", _SUITES, _INTERRUPTS),
        *group_in("BRAKE and RESUME", (*_SUITES, "spline"), _BRAKING),
        *group_in("triggers", ("trigger", "spline"), _TRIGGERS),
    )


# ------------------------------------------------------------------------------------ interrupts


def _behind(name: str, act: Any) -> Plant:
    """Something is done to the interrupts when a method has done its work."""

    def make(right: Any) -> Any:
        def method(self: Interrupts, *given: Any) -> Any:
            found = right(self, *given)
            act(self, *given)
            return found

        return method

    return on(Interrupts, name, make)


def _set_all(name: str, value: bool) -> Any:
    def act(self: Interrupts, *_given: Any) -> None:
        for one in self:
            setattr(one, name, value)

    return act


def _never_again(self: Interrupts, *_given: Any) -> None:
    """What was TRUE once counts as TRUE from then on."""
    seen = self.__dict__.setdefault("_seen", set())
    for one in self:
        if one.was_true:
            seen.add(id(one))
        one.was_true = id(one) in seen


def _forget_held(self: Interrupts, *_given: Any) -> None:
    for one in self:
        if one.state == "held":
            one.has_come = False


def _only_first(right: Any) -> Any:
    def switch(self: Interrupts, action: str, number: Any, holds: Any) -> None:
        numbers = [one.number for one in self]
        right(self, action, numbers[0] if number is None and numbers else number, holds)

    return switch


def _last(_right: Any) -> Any:
    def chosen(self: Interrupts) -> Any:
        ready = [one for one in self if one.has_come and one.state == "on"]
        return ready[-1] if ready else None

    return chosen


def _seldom(right: Any) -> Any:
    def watch(self: InterruptUnit, task: Any) -> None:
        clock = self._state.clock
        if clock.now // clock.cycle % 4 == 0:
            right(self, task)

    return watch


def _first_declaration(right: Any) -> Any:
    def declare(self: Interrupts, request: Any) -> None:
        if request.number not in self._by_number:
            right(self, request)

    return declare


def _priority(compute: Any) -> Plant:
    return on(Task, "priority", lambda _right: property(compute))


_INTERRUPTS: Final = (
    ("an event is a level, not an edge", _behind("watch", _set_all("was_true", False))),
    ("an event that is there before ON counts", _behind("switch", _set_all("was_true", False))),
    ("an event is noticed once only", _behind("watch", _never_again)),
    ("the lowest priority comes first", on(Interrupts, "next", _last)),
    ("a lower priority interrupts a higher one", _priority(lambda _task: PROGRAM)),
    ("DISABLE forgets what comes", _behind("watch", _forget_held)),
    ("ON without a number means the first one", on(Interrupts, "switch", _only_first)),
    ("events are looked for in every fourth cycle", on(InterruptUnit, "watch", _seldom)),
    ("a number is declared once and for all", on(Interrupts, "declare", _first_declaration)),
)


# ------------------------------------------------------------------------------------ braking


def _going_on(right: Any) -> Any:
    def brake(self: InterruptUnit, task: Any, request: Any) -> Any:
        right(self, task, request)

    return brake


def _base_stays(right: Any) -> Any:
    def pop(self: Levels, task: Any) -> None:
        task.levels[-1].base = None
        right(self, task)

    return pop


_BRAKING: Final = (
    ("the routine goes on before the arm stands", on(InterruptUnit, "brake", _going_on)),
    ("$BASE stays as the routine left it", on(Levels, "pop", _base_stays)),
)


# ------------------------------------------------------------------------------------ triggers


def _kept(right: Any) -> Any:
    def plan(self: MotionQueue, task: Any, request: Any) -> Any:
        triggers = list(task.triggers)
        found = right(self, task, request)
        task.triggers = triggers
        return found

    return plan


def _dropped(right: Any) -> Any:
    def plan(self: MotionQueue, task: Any, request: Any) -> Any:
        task.triggers = task.triggers[-1:]
        return right(self, task, request)

    return plan


_TRIGGERS: Final = (
    ("a trigger is for every motion that follows", on(MotionQueue, "plan", _kept)),
    ("only the last trigger counts", on(MotionQueue, "plan", _dropped)),
)
