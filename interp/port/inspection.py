"""Inspection of an executor by a debugger: read, change, stop, jump.

All is for the moment between two statements, while a `interp.port.requests.Slice` is open, and for
an executor that has ended.
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
class Seen:
    """A variable or a part of one: its type and its value, ``None`` where it has none.

    The value is a copy. ``home`` is ``MODULE.NAME`` for data of a data list, in upper case, and
    empty for parameters and local data of the routine that runs.
    """

    type: Type
    value: Value | None
    home: str


@dataclass(frozen=True, slots=True)
class Guard:
    """A relation of a variable, named as in `Inspectable.look`, to a constant.

    ``relation`` is one of `RELATIONS`. The constant is an INT, a BOOL, or the name of one of an
    enumeration in upper case.
    """

    name: str
    relation: str
    constant: int | bool | str


@dataclass(frozen=True, slots=True)
class StackFrame:
    """A routine that is open and where it is, or an action of an interrupt or a trigger in one."""

    name: str
    at: At
    is_action: bool = False


#: Files and lines, each with what has to hold there if anything has.
Breaks = Mapping[tuple[str, int], Guard | None]
RELATIONS: Final = ("==", "<>", "<", ">", "<=", ">=")


class Inspectable(Executor, Protocol):
    """An executor that can be debugged. Frames are counted from the innermost, which is 0."""

    @property
    def begun(self) -> int:
        """How many statements have begun, those of conditions included."""
        ...

    def ask_at(self, count: int) -> None:
        """Ask for time before the next statement once so many have begun, instead of later.

        It holds until the next request: then a slice is as long as the limits have it.
        """
        ...

    def break_at(self, places: Breaks) -> bool:
        """Ask for time before each statement that begins in one of these lines, and in no others.

        It need not ask where the guard of a line is FALSE. Whether it does all that: else it has to
        be asked at every statement.
        """
        ...

    def frames(self) -> tuple[StackFrame, ...]:
        """What is open, the innermost first."""
        ...

    def look(self, text: str, frame: int = 0) -> Seen | None:
        """A variable of the program, or a part of one, by what it is called in a frame.

        ``"I"``, ``"F.X"``, ``"A[2,1]"``, ``"T[]"``; ``None`` where there is no such.
        """
        ...

    def put(self, text: str, value: Value, frame: int = 0) -> None:
        """Give such a variable a value; raises `interp.values.faults.Fault`, `LinkError`."""
        ...

    def select(self, line: int) -> None:
        """Go on with the statement that begins in a line of the routine that runs.

        Raises `ValueError` where none does. Blocks around it are entered without their conditions
        being looked at; a FOR must be around the present statement as well, else its counter and
        limit are not known (`interp.debugging.selection` sees to it).
        """
        ...
