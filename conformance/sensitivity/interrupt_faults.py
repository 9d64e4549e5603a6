"""Faults of the controller: interrupts, BRAKE and RESUME, triggers."""

from __future__ import annotations

from typing import Any, Final

from conformance.sensitivity.planted_fault import (
    Fault,
    Plant,
    constant,
    group_in,
    on,
)
from interp.controller import interrupts, motion_queue
from interp.controller.interrupt_unit import InterruptUnit
from interp.controller.interrupts import Interrupts
from interp.controller.levels import Levels
from interp.controller.motion_queue import MotionQueue
from interp.controller.motions import MotionBuilder
from interp.controller.positions import Positions
from interp.controller.tasks import PROGRAM, Task
from interp.controller.variable_access import VariableAccess
from interp.robot.api.control_core import ControlCore
from interp.values import faults as run_time

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


def _without(action: str) -> Any:
    def make(right: Any) -> Any:
        def switch(self: Interrupts, said: str, number: Any, holds: Any) -> None:
            if said != action:
                right(self, said, number, holds)

        return switch

    return make


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


def _global_forgotten(right: Any) -> Any:
    def forget(self: Interrupts, depth: int) -> None:
        right(self, depth)
        if depth:
            kept = {number: one for number, one in self._by_number.items() if one.depth < depth}
            self._by_number = kept

    return forget


def _first_declaration(right: Any) -> Any:
    def declare(self: Interrupts, request: Any) -> None:
        if request.number not in self._by_number:
            right(self, request)

    return declare


def _unlimited(right: Any) -> Any:
    return lambda self, _most, _active: right(self, 10_000, 10_000)


def _priority(compute: Any) -> Plant:
    return on(Task, "priority", lambda _right: property(compute))


_INTERRUPTS: Final = (
    ("an event is a level, not an edge", _behind("watch", _set_all("was_true", False))),
    ("an event that is there before ON counts", _behind("switch", _set_all("was_true", False))),
    ("an event is noticed once only", _behind("watch", _never_again)),
    ("the lowest priority comes first", on(Interrupts, "next", _last)),
    ("a lower priority interrupts a higher one", _priority(lambda _task: PROGRAM)),
    (
        "nothing interrupts an interrupt routine",
        _priority(lambda task: -1 if task.levels else PROGRAM),
    ),
    ("DISABLE forgets what comes", _behind("watch", _forget_held)),
    ("DISABLE does nothing", on(Interrupts, "switch", _without("DISABLE"))),
    ("ENABLE does nothing", on(Interrupts, "switch", _without("ENABLE"))),
    ("OFF does nothing", on(Interrupts, "switch", _without("OFF"))),
    ("ON without a number means the first one", on(Interrupts, "switch", _only_first)),
    ("events are looked for in every fourth cycle", on(InterruptUnit, "watch", _seldom)),
    (
        "declarations outlive their routine",
        on(Interrupts, "forget", lambda _: lambda _self, _depth: None),
    ),
    ("GLOBAL makes no difference", on(Interrupts, "forget", _global_forgotten)),
    ("a number is declared once and for all", on(Interrupts, "declare", _first_declaration)),
    ("every number may be declared", constant(interrupts, "is_usable", lambda _number: True)),
    ("any number of interrupts may be active", on(Interrupts, "__init__", _unlimited)),
)


# ------------------------------------------------------------------------------------ braking


def _always_soft(right: Any) -> Any:
    return lambda self, now, *, is_hard: right(self, now, is_hard=is_hard and False)


def _going_on(right: Any) -> Any:
    def brake(self: InterruptUnit, task: Any, request: Any) -> Any:
        right(self, task, request)

    return brake


def _tolerant(slug: str) -> Any:
    """A fault that a request has to be answered with is not raised."""

    def make(right: Any) -> Any:
        def method(self: Any, task: Any, request: Any) -> Any:
            try:
                return right(self, task, request)
            except run_time.Fault as error:
                if error.slug != slug:
                    raise
                return None

        return method

    return make


def _global_resume(right: Any) -> Any:
    def resume(self: InterruptUnit, task: Any, request: Any) -> Any:
        if task.level is not None and task.level.interrupt is not None:
            task.level.interrupt.is_global = False
        return right(self, task, request)

    return resume


def _base_stays(right: Any) -> Any:
    def pop(self: Levels, task: Any) -> None:
        task.levels[-1].base = None
        right(self, task)

    return pop


def _advance_writable(right: Any) -> Any:
    def write(self: Any, task: Any, request: Any) -> Any:
        if request.path == ("$ADVANCE",):
            return self._state.put(request.path, request.value)
        return right(self, task, request)

    return write


def _outside(right: Any) -> Any:
    """Done as if no interrupt routine ran."""

    def method(self: Any, task: Any, request: Any) -> Any:
        levels, task.levels = task.levels, []
        try:
            return right(self, task, request)
        finally:
            task.levels = levels

    return method


def _not_kept(word: str) -> Plant:
    def make(right: Any) -> Any:
        def keep(self: Positions, which: Any, *more: Any) -> None:
            if which != word:
                right(self, which, *more)

        return keep

    return on(Positions, "keep", make)


_BRAKING: Final = (
    (
        "BRAKE does nothing",
        on(InterruptUnit, "brake", lambda _: lambda _self, _task, _request: None),
    ),
    ("BRAKE F is no harder than BRAKE", on(ControlCore, "brake", _always_soft)),
    ("the routine goes on before the arm stands", on(InterruptUnit, "brake", _going_on)),
    (
        "BRAKE is allowed everywhere",
        on(InterruptUnit, "brake", _tolerant("brake_place")),
    ),
    (
        "the arm stands for ever after BRAKE",
        on(ControlCore, "proceed", lambda _: lambda _self, _now: None),
    ),
    (
        "after a motion of its own the routine does not come back to the path",
        on(Levels, "_return", lambda _: lambda self, task, _end: self._left(task)),
    ),
    (
        "RESUME keeps what was planned",
        on(ControlCore, "discard", lambda _: lambda _self, _now: None),
    ),
    ("RESUME does nothing", on(InterruptUnit, "resume", lambda _: lambda _s, _t, _r: None)),
    ("RESUME is allowed for global interrupts", on(InterruptUnit, "resume", _global_resume)),
    (
        "RESUME is allowed on the declaring level",
        on(InterruptUnit, "resume", _tolerant("resume_level")),
    ),
    ("$BASE stays as the routine left it", on(Levels, "pop", _base_stays)),
    ("$ADVANCE may be changed in a routine", on(VariableAccess, "write", _advance_writable)),
    ("splines are allowed in a routine", on(MotionQueue, "plan", _outside)),
    ("$POS_INT is not kept", _not_kept("INT")),
    ("$POS_RET is not kept", _not_kept("RET")),
)


# ------------------------------------------------------------------------------------ triggers


def _placed(alter: Any) -> Plant:
    """Triggers are placed elsewhere; ``alter`` has kind, position, on_start, delay in ms."""
    return on(MotionBuilder, "_place", lambda right: lambda self, *row: right(self, *alter(*row)))


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


def _uncounted(right: Any) -> Any:
    def place(self: MotionQueue, task: Any, request: Any) -> Any:
        outputs, calls, self._outputs, self._calls = self._outputs, self._calls, {}, {}
        waiting, task.triggers = task.triggers, []
        try:
            right(self, task, request)
            waiting += task.triggers
        finally:
            self._outputs, self._calls, task.triggers = outputs, calls, waiting

    return place


_TRIGGERS: Final = (
    ("DELAY has the other sign", _placed(lambda k, p, s, d: (k, p, s, -d))),
    ("DELAY counts nothing", _placed(lambda k, p, s, _d: (k, p, s, 0.0))),
    ("DELAY is in hundredths of a second", _placed(lambda k, p, s, d: (k, p, s, 10 * d))),
    ("triggers come a cycle late", _placed(lambda k, p, s, d: (k, p, s, d + 12))),
    (
        "PATH has the other sign",
        _placed(lambda k, p, s, d: (k, -p if k == "PATH" else p, s, d)),
    ),
    ("PATH counts from the start", _placed(lambda k, p, _s, d: (k, p, True, d))),
    ("ONSTART counts nothing", _placed(lambda k, p, _s, d: (k, p, False, d))),
    (
        "DISTANCE 0 and 1 are exchanged",
        _placed(lambda k, p, s, d: (k, 1 - p if k == "DISTANCE" else p, s, d)),
    ),
    ("a trigger is for every motion that follows", on(MotionQueue, "plan", _kept)),
    ("only the last trigger counts", on(MotionQueue, "plan", _dropped)),
    (
        "every priority is allowed",
        constant(motion_queue, "_PRIORITIES", frozenset(range(-1, 1000))),
    ),
    ("a trigger may be as far away as one likes", constant(motion_queue, "_FARTHEST", 1e12)),
    ("any number of triggers may wait", on(MotionQueue, "set_trigger", _uncounted)),
    ("triggers are allowed in interrupt routines", on(MotionQueue, "set_trigger", _outside)),
    (
        "routines of triggers are never called",
        on(MotionQueue, "_fire", lambda _: lambda self, command: self._calls.pop(command, None)),
    ),
)
