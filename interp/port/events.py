"""Events that an executor reports for the trace: lines, branches, calls, returns and assignments.

The controller writes all other events of a trace itself.

- *line*: a statement begins. A loop reports its line again at each pass: WHILE, FOR and LOOP their
  first line, REPEAT the line of its UNTIL. The statement after the DO of an interrupt, a trigger or
  a cyclic signal reports the line in which it is written.
- *branch*: IF, WHILE and UNTIL report 1 for TRUE and 0 for FALSE. SWITCH reports the number of the
  chosen CASE, counted from 1, or 0 if no CASE was chosen.
- *call*: reported before the routine begins, with the line of the caller.
- *return*: reported with the last line of the routine, if the routine ends by itself and not by
  RESUME or a fault.
- *assign*: besides assignment statements, this covers the counter of a FOR and the variables that a
  function changes through its arguments.
"""

from __future__ import annotations

from dataclasses import field
from typing import Final, Literal, Protocol

from interp.port.requests import At, Path, Value
from support.lazy_dataclass import dataclass

#: The kinds of events, as the trace names them.
Kind = Literal["line", "assign", "call", "return", "branch"]
EVERY_KIND: Final = frozenset[Kind](("line", "assign", "call", "return", "branch"))


class Sink(Protocol):
    """Receives the events of an executor.

    ``kinds`` names the kinds that the sink receives. It is constant over the lifetime of the sink:
    the executor does not compute events of any other kind.
    """

    @property
    def kinds(self) -> frozenset[Kind]:
        """The kinds of events that the sink receives."""

    def line(self, at: At) -> None:
        """A statement begins."""

    def assign(self, at: At, path: Path, value: Value | None) -> None:
        """A variable of the program, or a part of a variable, was assigned."""

    def call(self, at: At, name: str) -> None:
        """A routine is called."""

    def leave(self, at: At, name: str) -> None:
        """A routine has ended."""

    def branch(self, at: At, way: int) -> None:
        """A statement chose the branch ``way``; see the module's docstring for the numbers."""


def wanting(sink: Sink | None, kind: Kind) -> Sink | None:
    """Return ``sink`` if there is one and it receives events of this kind, else ``None``."""
    return sink if sink is not None and kind in sink.kinds else None


@dataclass(frozen=True, slots=True)
class ExecutorEvent:
    """One event of an executor.

    ``name`` is the routine of a call or return, and ``way`` the number of a branch. ``path`` and
    ``value`` belong to an assignment; ``value`` is a copy of the variable's value.
    """

    kind: Kind
    at: At
    name: str = ""
    way: int = 0
    path: Path = ()
    value: Value | None = None


@dataclass(slots=True)
class Recorder:
    """A sink that stores the events it receives, by default of all kinds, in their order."""

    events: list[ExecutorEvent] = field(default_factory=list)
    kinds: frozenset[Kind] = EVERY_KIND

    def line(self, at: At) -> None:
        """A statement begins."""
        self.events.append(ExecutorEvent("line", at))

    def assign(self, at: At, path: Path, value: Value | None) -> None:
        """A variable, or a part of one, was assigned."""
        self.events.append(ExecutorEvent("assign", at, path=path, value=value))

    def call(self, at: At, name: str) -> None:
        """A routine is called."""
        self.events.append(ExecutorEvent("call", at, name))

    def leave(self, at: At, name: str) -> None:
        """A routine has ended."""
        self.events.append(ExecutorEvent("return", at, name))

    def branch(self, at: At, way: int) -> None:
        """A statement chose a branch."""
        self.events.append(ExecutorEvent("branch", at, way=way))
