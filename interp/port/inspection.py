"""What a debugger needs of an executor besides running: to look at variables, and to jump.

Both are for the moment between two statements, while a `interp.port.requests.Slice` is open.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from grammar.semantics.types import Type
from interp.port.executor import Executor
from interp.values.values import Value

__all__ = ["Inspectable", "Seen"]


@dataclass(frozen=True, slots=True)
class Seen:
    """A variable or a part of one: its type and its value, ``None`` where it has none.

    The value is a copy. ``home`` is ``MODULE.NAME`` for data of a data list, in upper case, and
    empty for parameters and local data of the routine that runs.
    """

    type: Type
    value: Value | None
    home: str


class Inspectable(Executor, Protocol):
    """An executor that can be debugged."""

    def look(self, text: str) -> Seen | None:
        """A variable of the program, or a part of one, by what it is called where the program is.

        ``"I"``, ``"F.X"``, ``"A[2,1]"``, ``"T[]"``; ``None`` where there is no such.
        """
        ...

    def select(self, line: int) -> None:
        """Go on with the statement that begins in a line of the routine that runs.

        Raises `ValueError` where none does. Blocks around it are entered without their conditions
        being looked at; a FOR must be around the present statement as well, else its counter and
        limit are not known (`interp.debugging.selection` sees to it).
        """
        ...
