"""Inspection of an executor by a debugger: read, change, stop, jump.

All of it is allowed only between two statements, while an `interp.port.requests.Slice` is open, and
after the executor has ended.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final, Protocol

from grammar.semantics.types import Type
from interp.port.executor import Executor
from interp.port.requests import At
from interp.values.values import Value
from support.lazy_dataclass import dataclass


@dataclass(frozen=True, slots=True)
class InspectedValue:
    """A variable, or a part of one: its type and a copy of its value.

    ``value`` is ``None`` if the variable has none. ``home`` is ``MODULE.NAME`` in upper case for
    data of a data list; it is empty for parameters and local data of a routine.
    """

    type: Type
    value: Value | None
    home: str


@dataclass(frozen=True, slots=True)
class Guard:
    """A comparison of a variable with a constant, as the condition of a breakpoint.

    ``name`` is the variable as `Inspectable.look` names it, ``relation`` one of `RELATIONS`. The
    constant is an INT, a BOOL, or the name of an enumeration constant in upper case.
    """

    name: str
    relation: str
    constant: int | bool | str


@dataclass(frozen=True, slots=True)
class StackFrame:
    """An open routine, or an open action of an interrupt or trigger, and the place it has reached.

    ``is_action`` is set for an action.
    """

    name: str
    at: At
    is_action: bool = False


#: Breakpoints by file and line, each with its condition or ``None``.
Breaks = Mapping[tuple[str, int], Guard | None]
RELATIONS: Final = ("==", "<>", "<", ">", "<=", ">=")


class Inspectable(Executor, Protocol):
    """An executor that can be debugged. Frame 0 is the innermost frame."""

    @property
    def begun(self) -> int:
        """The number of statements that have begun, those in conditions included."""
        ...

    def ask_at(self, count: int) -> None:
        """Return a slice before the statement that follows the first ``count`` statements.

        This replaces the usual end of the present slice. It applies until the next request; the
        slices after that have the length that the limits say.
        """
        ...

    def break_at(self, places: Breaks) -> bool:
        """Return a slice before each statement that begins in one of these lines, and at no other.

        The executor may skip a line while the condition of its breakpoint is FALSE. Return whether
        it supports all this; if not, the debugger has to stop it at every statement.
        """
        ...

    def frames(self) -> tuple[StackFrame, ...]:
        """Return the call stack, innermost frame first."""
        ...

    def look(self, text: str, frame: int = 0) -> InspectedValue | None:
        """Return the variable of the program, or its part, that ``text`` denotes in a frame.

        ``text`` is for example ``"I"``, ``"F.X"``, ``"A[2,1]"`` or ``"T[]"``. Return ``None`` if
        there is no such variable.
        """
        ...

    def put(self, text: str, value: Value, frame: int = 0) -> None:
        """Assign a value to a variable that is named as for `look`.

        Raises `interp.values.faults.Fault` and `LinkError`.
        """
        ...

    def select(self, line: int) -> None:
        """Continue with the statement that begins in a line of the running routine.

        Raises `ValueError` if no statement begins there. The blocks around the statement are
        entered without evaluating their conditions. If one of them is a FOR, it must also surround
        the present statement: otherwise its counter and limit are unknown
        (`interp.debugging.debugger` checks this).
        """
        ...
