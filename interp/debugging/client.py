"""Clients of a debugger: what it reports when a program stops, and the commands it accepts.

A client is called where the program stops and answers with a command. It may take its time, as
virtual time stands still meanwhile, so an adapter for an editor can wait there for its user.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from interp.controller.state.trace import TaskName
from interp.port.requests import At
from interp.values.values import Value

#: A moment of a run: how many statements of all programs have begun, and how many times a statement
#: was about to begin since then. Moments of the same program and the same changes compare.
Position = tuple[int, int]

#: Why a program has stopped. ``refused`` follows a command that could not be carried out.
Reason = Literal[
    "entry", "breakpoint", "step", "watch", "pause", "fault", "selected", "back", "refused", "ended"
]


@dataclass(frozen=True, slots=True)
class Breakpoint:
    """Stop before the statement that begins in this line, if the condition is TRUE there.

    ``file`` is a path or its end, letter case aside. The condition is an expression over what is
    visible there; one that cannot be evaluated counts as TRUE, so that nothing is missed. ``hits``
    says which of its hits count: ``3`` the third only, ``>=3`` from the third on, ``%3`` each
    third. With ``log`` it does not stop: the text is reported, with values in place of what is in
    braces.
    """

    file: str
    line: int
    condition: str | None = None
    hits: str | None = None
    log: str | None = None


@dataclass(frozen=True, slots=True)
class Watch:
    """Stop where an expression has got another value: a variable, a signal, anything of these.

    Data of a data list is watched wherever it is known by that name, data of a routine in the
    routine and at the depth of calls where the watch was set.
    """

    text: str


@dataclass(frozen=True, slots=True)
class Stop:
    """A program has stopped before the statement at ``at``, or at its fault or end.

    ``watch`` is the one that changed, with the values before and now. ``text`` is the fault, what
    was refused, or why the condition of the breakpoint could not be evaluated.
    """

    reason: Reason
    task: TaskName
    at: At
    watch: Watch | None = None
    before: Value | None = None
    now: Value | None = None
    text: str = ""


# ------------------------------------------------------------------------------------- commands

Way = Literal["into", "over", "out", "motion"]


@dataclass(frozen=True, slots=True)
class Go:
    """Continue to the next stop; behind a fault and the end, end the session."""


@dataclass(frozen=True, slots=True)
class StepCommand:
    """Continue by a statement of a program, by default the one that has stopped.

    That is into calls, over them, or out of the routine.

    Actions of interrupts and triggers that come up meanwhile are stepped into only with ``into``.
    ``motion`` continues until a motion has ended, and to the next statement of the program then.
    """

    way: Way = "over"
    task: TaskName | None = None


@dataclass(frozen=True, slots=True)
class Back:
    """Go back, with all variables, outputs, the arm and the clock.

    By a step as `StepCommand` has it, or with ``go`` to where it would have stopped last. Where
    there is no such place, it is the first statement.
    """

    way: Way | Literal["go"] = "over"
    task: TaskName | None = None


@dataclass(frozen=True, slots=True)
class Select:
    """Block selection: continue at a line of the present routine, and stop there.

    No statement between here and there is executed [ADV-14]. Refused where the line is one of
    another file than ``file``, or another program than ``task`` has stopped.
    """

    line: int
    file: str = ""
    task: TaskName | None = None


@dataclass(frozen=True, slots=True)
class Restart:
    """Begin anew, without the changes that were made."""


@dataclass(frozen=True, slots=True)
class Quit:
    """End the session."""


Command = Go | StepCommand | Back | Select | Restart | Quit
