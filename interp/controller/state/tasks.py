"""Tasks: a running program with its executor, the request it waits for, and its stack of levels.

A level is an interrupt routine, the action of a trigger, or the computation of a cyclic signal.
Only the top level runs [INT-05].
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import field
from typing import Final, Literal

from interp.controller.state.declared_interrupts import Interrupt, Interrupts
from interp.controller.state.trace import TaskName, TaskSink
from interp.port.executor import Executor, Reader, RecurrenceDetecting, StatementCounting
from interp.port.requests import At, CodeHandle, Request, SetTrigger, SwitchSignal, Value
from interp.robot.api.commands import CallCommand
from interp.values.faults import Fault
from support.lazy_dataclass import dataclass

#: The priority of what cannot be interrupted: plain actions of triggers, and cyclic signals.
ALWAYS: Final = 0
#: The priority of a program without levels.
PROGRAM: Final = sys.maxsize

LevelKind = Literal["interrupt", "trigger", "cycle"]


@dataclass(slots=True, eq=False)
class Blocked:
    """A request that waits for its answer.

    Once ``is_ready`` is true, ``finish`` returns the reply, or what to wait for next. ``wake`` is a
    time in µs at which to check; without it, check whenever something has happened. ``is_open`` is
    set if the executor waits for the reply. It is not set after a RESUME, nor for a routine that
    has ended before its motions. ``is_postponed`` is set if it has not been handled, being one too
    many for its slice.
    """

    request: Request
    is_ready: Callable[[], bool]
    finish: Callable[[], Answer]
    wake: int | None = None
    is_open: bool = True
    is_postponed: bool = False


#: The answer to a request: a reply, a `Fault` to be raised in the program, or a wait.
Answer = Value | Fault | Blocked | None


@dataclass(slots=True, eq=False)
class Level:
    """A level on top of a program.

    ``depth`` is the call depth of the interrupted program, and ``saved`` what it waited for.
    ``motions`` are the numbers of the level's own motions that have not ended. ``base`` is the
    value of $BASE before; a routine changes it only for itself [INT-13]. ``braked_at`` are the axes
    at which BRAKE stopped the arm.
    """

    kind: LevelKind
    priority: int
    at: At
    depth: int
    saved: Blocked
    base: Value | None = None
    interrupt: Interrupt | None = None
    call: CallCommand | None = None
    signal: SwitchSignal | None = None
    motions: set[int] = field(default_factory=set)
    has_moved: bool = False
    has_braked: bool = False
    braked_at: tuple[float, ...] | None = None


@dataclass(slots=True, eq=False)
class Task:
    """One program with its interrupts; each program has its own [INT-17].

    ``exempt_line`` is the line after a CONTINUE, whose requests do not stop the advance run.
    ``spent`` is the number of requests in the slice that ends at ``slice_end``. ``unbroken`` is the
    number of requests since the program last waited for time, a condition or the arm. ``triggers``
    wait for the next motion. ``busy_at`` is the time in µs at which the program last did more than
    read variables and write the values that they had. ``at`` is the place that the program has
    reached. ``counting`` and ``recurrent`` are the
    executor if it has that protocol; checking each time would take longer than a slice.
    """

    name: TaskName
    executor: Executor
    sink: TaskSink | None
    interrupts: Interrupts
    levels: list[Level] = field(default_factory=list)
    blocked: Blocked | None = None
    reply: Value | Fault | None = None
    exempt_line: tuple[str, int] | None = None
    spent: int = 0
    unbroken: int = 0
    slice_end: int = -1
    at: At = field(default_factory=lambda: At("", 0, 0))
    busy_at: int = 0
    triggers: list[SetTrigger] = field(default_factory=list)
    signals: dict[str, SwitchSignal] = field(default_factory=dict)
    is_over: bool = False
    is_halted: bool = False
    counting: StatementCounting | None = field(init=False)
    recurrent: RecurrenceDetecting | None = field(init=False)

    def __post_init__(self) -> None:
        self.counting = self.executor if isinstance(self.executor, StatementCounting) else None
        self.recurrent = self.executor if isinstance(self.executor, RecurrenceDetecting) else None

    @property
    def level(self) -> Level | None:
        """The top level, ``None`` if there is none."""
        return self.levels[-1] if self.levels else None

    @property
    def routine(self) -> str:
        """The name of the running routine; "" for the one with which the program began."""
        return "" if self.sink is None else self.sink.routine(self.executor.depth)

    @property
    def priority(self) -> int:
        """The priority of what runs; only a lower number interrupts it."""
        return PROGRAM if self.level is None else self.level.priority

    def holds(self, condition: CodeHandle, read: Reader) -> bool:
        """Return whether a condition is TRUE; ``read`` reads system variables. Raises `Fault`."""
        return self.executor.evaluate(condition, read) is True
