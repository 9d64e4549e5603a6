"""The interface of a debugger's client: the stops it is told about, and the commands it returns.

The debugger calls its client at each stop, and the client returns a command. Virtual time does not
advance meanwhile, so the client may wait as long as it needs, for example for a user at an editor.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from interp.controller.state.trace import TaskName
from interp.port.requests import At
from interp.values.values import Value

#: A moment of a run: the number of statements of all programs that have begun, and the number of
#: times that a statement was about to begin since then. Moments can be compared between runs of the
#: same program with the same changes.
Position = tuple[int, int]

#: Why a program has stopped. ``refused`` follows a command that could not be executed.
Reason = Literal[
    "entry", "breakpoint", "step", "watch", "pause", "fault", "selected", "back", "refused", "ended"
]


@dataclass(frozen=True, slots=True)
class Breakpoint:
    """A breakpoint: stop before the statement that begins in this line, if the condition is TRUE.

    ``file`` is a path or its end, ignoring case. The condition is an expression over the variables
    visible there; one that cannot be evaluated counts as TRUE, so that no stop is missed. ``hits``
    selects hits by their number: ``3`` the third only, ``>=3`` from the third on, ``%3`` every
    third. With ``log`` the program does not stop: the text is logged, and expressions in braces are
    replaced by their values.
    """

    file: str
    line: int
    condition: str | None = None
    hits: str | None = None
    log: str | None = None


@dataclass(frozen=True, slots=True)
class Watch:
    """A watch: stop when the value of an expression over variables and signals has changed.

    A variable of a data list is watched wherever its name refers to it. A variable of a routine is
    watched in that routine, at the call depth at which the watch was set.
    """

    text: str


@dataclass(frozen=True, slots=True)
class Stop:
    """A program has stopped before the statement at ``at``, or at its fault or end.

    ``watch`` is the watch that changed, ``before`` and ``now`` its values. ``text`` is the fault,
    the reason of a refusal, or why the condition of the breakpoint could not be evaluated.
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
    """Continue to the next stop; after a fault or the end, end the session."""


@dataclass(frozen=True, slots=True)
class StepCommand:
    """Continue by one statement of a program, by default the program that has stopped.

    ``into`` steps into calls, ``over`` over them, ``out`` to the end of the routine. Only ``into``
    also steps into actions of interrupts and triggers that begin meanwhile. ``motion`` continues to
    the first statement of the program after a motion has ended.
    """

    way: Way = "over"
    task: TaskName | None = None


@dataclass(frozen=True, slots=True)
class Back:
    """Go back to an earlier stop; variables, outputs, arm and clock are restored.

    Go back by one step, as for `StepCommand`, or with ``go`` to the place where the program would
    last have stopped. If there is no such place, go to the first statement.
    """

    way: Way | Literal["go"] = "over"
    task: TaskName | None = None


@dataclass(frozen=True, slots=True)
class Select:
    """Block selection: continue at a line of the present routine, and stop there [ADV-14].

    No statement between the two places is executed. Refused if ``file`` is given and the line is in
    another file, or if ``task`` is given and another program has stopped.
    """

    line: int
    file: str = ""
    task: TaskName | None = None


@dataclass(frozen=True, slots=True)
class Restart:
    """Begin the run again, without the changes that were made."""


@dataclass(frozen=True, slots=True)
class Quit:
    """End the session."""


Command = Go | StepCommand | Back | Select | Restart | Quit
