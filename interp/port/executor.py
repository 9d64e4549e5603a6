"""The port between whoever executes a program and whoever owns the world it acts on.

The executor *is* the advance run: it runs ahead of the arm, statement by statement, and hands over
a request whenever it needs the world (`interp.port.requests`). The controller owns clock, motion
queue, interrupts, triggers, submit, inputs and outputs and system variables, and decides when the
executor may continue. Neither knows more of the other than this.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol, runtime_checkable

from interp.port.events import Sink
from interp.port.requests import CodeHandle, Path, Request, Value
from interp.values.faults import Fault

#: Reads a system variable at once, for conditions; raises `interp.values.faults.Fault`.
Reader = Callable[[Path], Value]


class Executor(Protocol):
    """Runs one program."""

    def advance(self, reply: Value | Fault | None = None) -> Request:
        """Compute until the controller is needed.

        ``reply`` answers the request before; a fault as reply is raised in the program at the
        statement that asked, where ON_ERROR_PROCEED may take it [TYP-13]. After `End` at depth 0
        and after `Fail` the executor has ended and returns the same request again.
        """
        ...

    def enter(self, code: CodeHandle) -> None:
        """Push a routine or action, which runs before the program continues.

        Allowed between two requests only, and behind the End of the program as well, as long as the
        arm is on its way. Its end is reported by `interp.port.requests.End`, after which the
        request that was open before is asked again by the next ``advance(None)``.
        """
        ...

    def evaluate(self, code: CodeHandle, read: Reader) -> Value:
        """The value of a condition, without side effects and without a request.

        Raises `interp.values.faults.Fault`.
        """
        ...

    def unwind(self, depth: int) -> None:
        """Leave all routines deeper than ``depth``; the program continues behind the call there.

        [INT-10]
        """
        ...

    def companion(self, routine: str, sink: Sink | None = None) -> Executor:
        """Another executor over the same data lists, as the submit interpreter is [SUB-01].

        It begins with the routine of that name in any file, which has no parameters. Its codes are
        its own. The two take turns: neither is called while the other computes. Raises `LinkError`.
        """
        ...

    @property
    def depth(self) -> int:
        """How many calls deep the program is; 0 in the routine it began with."""
        ...


@runtime_checkable
class Counting(Protocol):
    """An executor that counts statements."""

    @property
    def begun(self) -> int:
        """How many statements have begun, those of conditions included."""
        ...


@runtime_checkable
class Recurrent(Counting, Protocol):
    """An executor that can say whether its state recurs."""

    @property
    def spare(self) -> int:
        """How many statements may be skipped before the limits have a say."""
        ...

    def standing(self) -> object | None:
        """All that its next requests depend on, but for the replies; ``None`` if it is unknown.

        Where two are equal, equal replies lead from both through the same requests.
        """
        ...

    def skip(self, statements: int) -> None:
        """Count so many statements as begun that have led back to here."""
        ...
