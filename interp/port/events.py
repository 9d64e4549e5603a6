"""Events of executors for the trace: lines, branches, calls, assignments.

All else in a trace comes from the controller. A statement reports its line when it begins; a loop
begins anew at each pass: WHILE, FOR and LOOP at their first line, REPEAT at its UNTIL. What stands
behind the DO of an interrupt, a trigger or a cyclic signal is a statement at the line it stands in.
IF, WHILE and UNTIL report their branch as 1 for TRUE and 0 for FALSE, SWITCH as the number of its
CASE from 1, or 0 where none is chosen. A call is reported before its routine begins, at the line of
the caller; its end at the last line of the routine, if it ends by itself and not by RESUME or a
fault. What a FOR gives its counter, and what a function changes in its arguments, is assigned too.
"""

from __future__ import annotations

from dataclasses import field
from typing import Final, Literal, Protocol

from interp.port.requests import At, Path, Value
from support.lazy_dataclass import dataclass

#: The words of the trace.
Kind = Literal["line", "assign", "call", "return", "branch"]
EVERY_KIND: Final = frozenset[Kind](("line", "assign", "call", "return", "branch"))


class Sink(Protocol):
    """Takes the events of an executor.

    ``kinds`` are those that it receives, constant over its lifetime: what it does not want is not
    even worked out.
    """

    @property
    def kinds(self) -> frozenset[Kind]:
        """The kinds of events it receives."""

    def line(self, at: At) -> None:
        """A statement begins."""

    def assign(self, at: At, path: Path, value: Value | None) -> None:
        """A variable of the program, or a part of one, was assigned."""

    def call(self, at: At, name: str) -> None:
        """A routine is called."""

    def leave(self, at: At, name: str) -> None:
        """A routine has ended."""

    def branch(self, at: At, way: int) -> None:
        """A way was taken."""


def wanting(sink: Sink | None, kind: Kind) -> Sink | None:
    """The sink if there is one and it wants events of this kind."""
    return sink if sink is not None and kind in sink.kinds else None


@dataclass(frozen=True, slots=True)
class ExecutorEvent:
    """An event; ``name`` is that of a routine, ``way`` that of a branch, the rest of assignments.

    ``value`` shares nothing with the program's variables.
    """

    kind: Kind
    at: At
    name: str = ""
    way: int = 0
    path: Path = ()
    value: Value | None = None


@dataclass(slots=True)
class Recorder:
    """A sink that keeps events, all by default, in their order."""

    events: list[ExecutorEvent] = field(default_factory=list)
    kinds: frozenset[Kind] = EVERY_KIND

    def line(self, at: At) -> None:
        """A statement begins."""
        self.events.append(ExecutorEvent("line", at))

    def assign(self, at: At, path: Path, value: Value | None) -> None:
        """A variable was assigned."""
        self.events.append(ExecutorEvent("assign", at, path=path, value=value))

    def call(self, at: At, name: str) -> None:
        """A routine is called."""
        self.events.append(ExecutorEvent("call", at, name))

    def leave(self, at: At, name: str) -> None:
        """A routine has ended."""
        self.events.append(ExecutorEvent("return", at, name))

    def branch(self, at: At, way: int) -> None:
        """A way was taken."""
        self.events.append(ExecutorEvent("branch", at, way=way))
