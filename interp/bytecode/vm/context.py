"""What the factories of operations share."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final, Protocol

from interp.bytecode.program import Program
from interp.bytecode.vm.services import Services
from interp.bytecode.vm.state import Operation, State

#: Makes an operation from the site and the operands of an instruction.
Rule = Callable[..., Operation]


class Frame(Protocol):
    """A range of cells, which begins at ``fp``."""

    fp: int


class _DataLists:
    """The data lists as a frame: they come first."""

    fp = 0


DATA_LISTS: Final = _DataLists()


@dataclass(slots=True, eq=False)
class Site:
    """The place of an instruction: its code object, its index, and the operations around it."""

    code: int
    place: int
    body: list[Operation]
    after: Operation


@dataclass(frozen=True, slots=True)
class Runtime:
    """The program, its state, and the services around it.

    ``entries`` are the first operations of all code objects, ``frames`` their frame sizes in cells,
    and ``owners`` the numbers of those whose variables are used by actions and conditions.
    """

    program: Program
    state: State
    hooks: Services
    entries: list[Operation]
    frames: Sequence[int]
    owners: frozenset[int | None]


class Rules:
    """Makes the operations of some instructions."""

    def __init__(self, runtime: Runtime) -> None:
        self._runtime = runtime
        self._program = runtime.program
        self._types = runtime.program.types
        self._state = runtime.state
        self._cells = runtime.state.cells
        self._stack = runtime.state.stack
