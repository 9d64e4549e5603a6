"""A program that runs: its executor, what it waits for, and the stack of what interrupted it.

Of all levels only the top one runs [INT-05]. A level is an interrupt routine, the action of a
trigger, or a cyclic signal that is computed.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import field
from typing import Final, Literal

from interp.controller.state.interrupts import Interrupt, Interrupts
from interp.controller.state.trace import TaskName, TaskSink
from interp.port.executor import Counting, Executor, Reader, Recurrent
from interp.port.requests import At, CodeHandle, Request, SetTrigger, SwitchSignal, Value
from interp.robot.api.commands import CallCommand
from interp.values.faults import Fault
from support.lazy_dataclass import dataclass

#: The priority of what nothing interrupts: plain actions of triggers, cyclic signals.
ALWAYS: Final = 0
#: The priority of a program that no interrupt has interrupted.
PROGRAM: Final = 1 << 16

LevelKind = Literal["interrupt", "trigger", "cycle"]


@dataclass(slots=True, eq=False)
class Blocked:
    """A request that waits to be answered.

    ``finish`` gives the reply once ``is_ready``, or what is to be waited for next. ``wake`` is a
    time at which to look again; else it is looked at whenever something happened. ``is_open``: the
    executor waits for the reply. It does not where a routine has ended whose motions have not, nor
    behind a RESUME.
    """

    request: Request
    is_ready: Callable[[], bool]
    finish: Callable[[], Answer]
    wake: int | None = None
    is_open: bool = True


#: What a request is answered: a reply, a `Fault` to be raised in the program, or a wait.
Answer = Value | Fault | Blocked | None


@dataclass(slots=True, eq=False)
class Level:
    """Something that interrupted the program.

    ``depth`` is that of the program then, ``saved`` what it waited for. ``motions`` are the numbers
    of its own motions that have not ended. ``base`` is $BASE as it was, which the routine changes
    for itself only [INT-13]. ``braked_at`` are the axes at which its BRAKE stopped the arm.
    """

    kind: LevelKind
    priority: int
    at: At
    depth: int
    saved: Blocked | None
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
    """One program with its interrupts, which are its own [INT-17].

    ``exempt_line`` is the line whose requests do not stop the advance run, behind a CONTINUE.
    ``spent`` are the requests in the slice that ends at ``slice_end``. ``triggers`` wait for the
    next motion. ``busy_at`` is the time in µs at which it last did more than to read variables,
    ``idle_at`` where it was when it had only read them for long. ``polling`` is where a WAIT FOR
    waits, ``last_at`` the place of the last request. ``counting`` and ``recurrent`` are its
    executor where it is one: to look each time would take longer than a slice.
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
    slice_end: int = -1
    polling: At | None = None
    last_at: At = field(default_factory=lambda: At("", 0, 0))
    busy_at: int = 0
    idle_at: At | None = None
    triggers: list[SetTrigger] = field(default_factory=list)
    signals: dict[str, SwitchSignal] = field(default_factory=dict)
    is_over: bool = False
    is_halted: bool = False
    counting: Counting | None = field(init=False)
    recurrent: Recurrent | None = field(init=False)

    def __post_init__(self) -> None:
        self.counting = self.executor if isinstance(self.executor, Counting) else None
        self.recurrent = self.executor if isinstance(self.executor, Recurrent) else None

    @property
    def level(self) -> Level | None:
        """What runs on top of the program, if anything does."""
        return self.levels[-1] if self.levels else None

    @property
    def routine(self) -> str:
        """The name of the routine that runs; "" for the one the program began with."""
        return "" if self.sink is None else self.sink.routine(self.executor.depth)

    @property
    def priority(self) -> int:
        """The priority of what runs: only a lower number interrupts it."""
        return self.levels[-1].priority if self.levels else PROGRAM

    @property
    def at(self) -> At:
        """Where the program is."""
        if self.blocked is not None:
            return self.blocked.request.at
        return self.level.at if self.level is not None else self.last_at

    def holds(self, condition: CodeHandle, read: Reader) -> bool:
        """Whether a condition is TRUE now; ``read`` reads system variables. Raises `Fault`."""
        return self.executor.evaluate(condition, read) is True
