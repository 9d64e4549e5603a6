"""Who decides when a program has stopped: what a debugger tells, and what it can be told.

A client is called where the program stops and answers with a command. It may take its time, as
virtual time stands still meanwhile, so an adapter for an editor can wait there for its user.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from interp.port.requests import At
from interp.values.values import Value

__all__ = [
    "Backward",
    "Breakpoint",
    "Command",
    "Go",
    "Select",
    "StackFrame",
    "StepCommand",
    "Stop",
    "Watch",
]

#: Why a program has stopped. ``refused`` follows a command that could not be carried out.
Reason = Literal["entry", "breakpoint", "step", "watch", "pause", "selected", "backward", "refused"]


@dataclass(frozen=True, slots=True)
class Breakpoint:
    """Stop before the statement that begins in this line, if the condition is TRUE there.

    ``file`` is a path or its end, letter case aside. The condition is an expression over what is
    visible there; one that cannot be evaluated counts as TRUE, so that nothing is missed.
    """

    file: str
    line: int
    condition: str | None = None


@dataclass(frozen=True, slots=True)
class Watch:
    """Stop where an expression has got another value.

    Data of a data list is watched wherever it is known by that name, data of a routine in the
    activation that the watch was set in; with that it ends.
    """

    text: str


@dataclass(frozen=True, slots=True)
class StackFrame:
    """A routine that is open: its name, and where it is."""

    name: str
    at: At


@dataclass(frozen=True, slots=True)
class Stop:
    """A program has stopped before the statement at ``at``.

    ``watch`` is the one that changed, with the values before and now. ``text`` tells what was
    refused, or which breakpoint's condition could not be evaluated.
    """

    reason: Reason
    at: At
    watch: Watch | None = None
    before: Value | None = None
    now: Value | None = None
    text: str = ""


# ------------------------------------------------------------------------------------- commands


@dataclass(frozen=True, slots=True)
class Go:
    """Go on to the next stop."""


@dataclass(frozen=True, slots=True)
class StepCommand:
    """Go on by a statement: into calls, over them, or out of the routine.

    Actions of interrupts and triggers that come up meanwhile are stepped into only with ``into``.
    """

    way: Literal["into", "over", "out"] = "over"


@dataclass(frozen=True, slots=True)
class Select:
    """Block selection: go on at a line of the present routine, and stop there.

    No statement between here and there is executed [ADV-14].
    """

    line: int


@dataclass(frozen=True, slots=True)
class Backward:
    """Travel the motion back that was travelled last, execute nothing else, and stop again.

    When the program goes on, the motions that were travelled back are travelled forwards first.
    """


Command = Go | StepCommand | Select | Backward
