"""The executor as the controller sees it: it runs a program and returns requests.

The executor *is* the advance run: it runs ahead of the arm, statement by statement, and returns a
request (`interp.port.requests`) whenever it needs the controller. The controller owns the clock,
the motion queue, interrupts, triggers, the submit interpreter, inputs and outputs, and system
variables. It decides when the executor may continue. Executor and controller know nothing else of
each other.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol, runtime_checkable

from interp.port.events import Sink
from interp.port.requests import CodeHandle, Path, Request, Value
from interp.values.faults import Fault

#: Returns the value of a system variable at once, for conditions; raises
#: `interp.values.faults.Fault`.
Reader = Callable[[Path], Value]


class Executor(Protocol):
    """Runs one program, a step between two requests at a time."""

    def advance(self, reply: Value | Fault | None = None) -> Request:
        """Run the program until it needs the controller, and return the request.

        ``reply`` answers the previous request. If it is a fault, the fault is raised in the program
        at the statement that made the request, where ON_ERROR_PROCEED may catch it [TYP-13]. After
        `End` at depth 0 and after `Fail` the executor has ended and returns the same request again.
        """
        ...

    def enter(self, code: CodeHandle) -> None:
        """Push a routine or an action, which runs before the program continues.

        This is allowed only between two requests. It is also allowed after the program's `End`, as
        long as the arm still moves. When the pushed code has ended, the executor returns
        `interp.port.requests.End`; the next ``advance(None)`` then returns the request again that
        was open before.
        """
        ...

    def evaluate(self, code: CodeHandle, read: Reader) -> Value:
        """Return the value of a condition, without side effects and without a request.

        ``read`` supplies system variables. Raises `interp.values.faults.Fault`.
        """
        ...

    def unwind(self, depth: int) -> None:
        """Leave all routines deeper than ``depth``; continue after the call there [INT-10]."""
        ...

    def waited(self) -> None:
        """Count the functions that a program may call anew, because it has waited."""
        ...

    def companion(self, routine: str, sink: Sink | None = None) -> Executor:
        """Return another executor over the same data lists, for the submit interpreter [SUB-01].

        It begins with the routine of that name, which may be in any file and has no parameters. Its
        code handles are its own. The two executors take turns: neither is called while the other
        runs. Raises `LinkError`.
        """
        ...

    @property
    def depth(self) -> int:
        """The number of open calls; 0 in the routine that the program began with."""
        ...


@runtime_checkable
class StatementCounting(Protocol):
    """An executor that counts statements."""

    @property
    def begun(self) -> int:
        """The number of statements that have begun, those in conditions included."""
        ...


@runtime_checkable
class SliceScheduling(Protocol):
    """An executor that asks how many slices may pass before it makes a `Slice` for each."""

    #: How many may pass without a request: with ``True`` where a `Slice` was just answered, the one
    #: that begins included, so at least 1; with ``False`` behind the one that ends.
    free_slices: Callable[[bool], int]


@runtime_checkable
class RecurrenceDetecting(StatementCounting, Protocol):
    """An executor that can detect that its state recurs, so that idle loops can be skipped."""

    @property
    def spare(self) -> int:
        """The number of statements that may be skipped before a limit of the run is reached."""
        ...

    def recurrence_state(self) -> object | None:
        """Return the state on which all further requests depend, apart from the replies.

        If two such states are equal, equal replies lead to the same requests from both. Return
        ``None`` if the state cannot be determined.
        """
        ...

    def skip(self, statements: int) -> None:
        """Count ``statements`` as begun: the statements of a loop that led back to this state."""
        ...
