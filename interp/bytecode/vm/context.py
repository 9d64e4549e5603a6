"""What the factories of operations share."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Final, Protocol

from interp.bytecode.program import Instruction, Program
from interp.bytecode.vm.state import OperandStack, Operation, State

#: Makes an operation from the site and the operands of an instruction.
Rule = Callable[..., Operation]


class Hooks(Protocol):
    """The services of the machine that instructions need."""

    #: Whether calls and returns are traced.
    calls_are_traced: bool
    returns_are_traced: bool
    #: The operations that end an action, and the first routine of the program.
    leave_action: Operation
    finish: Operation

    def line(self, place: int, after: Operation) -> Operation:
        """Return the operation of a `LINE` instruction."""

    def other_line(self, place: int, after: Operation) -> Operation:
        """Return the operation of an `AT` instruction."""

    def proceed(self, after: Operation) -> Operation:
        """Return the operation of a `PROCEED` instruction."""

    def ask(self, number: int, after: Operation) -> Operation:
        """Return the operation of an `ASK` instruction."""

    def builtin(self, number: int, after: Operation) -> Operation:
        """Return the operation of a `BUILTIN` instruction."""

    def charge(self, weight: int) -> None:
        """Count a function; raise `interp.values.faults.BudgetExhausted`."""

    def tell(self, instruction: Instruction, after: Operation) -> Operation:
        """Return the operation of a trace instruction."""

    def tell_call(self, code: int) -> None:
        """Trace the call of a routine."""

    def tell_leave(self) -> None:
        """Trace the end of the current routine."""


class Frame(Protocol):
    """A range of cells, which begins at ``fp``."""

    fp: int


class _DataLists:
    """The data lists as a frame: they come first."""

    fp = 0


DATA_LISTS: Final = _DataLists()


class Site:
    """The place of an instruction: its code object, its index, and the operations around it."""

    __slots__ = ("after", "body", "code", "place")

    def __init__(self, code: int, place: int, body: list[Operation], after: Operation) -> None:
        self.code = code
        self.place = place
        self.body = body
        self.after = after


@dataclass(frozen=True, slots=True)
class Runtime:
    """The program, its state, and the services around it.

    ``entries`` are the first operations of all code objects, ``frames`` their frame sizes in cells,
    and ``owners`` the numbers of those whose variables are used by actions and conditions.
    """

    program: Program
    state: State
    hooks: Hooks
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


def computed(
    compute: Callable[..., Any], count: int, stack: OperandStack, after: Operation
) -> Operation:
    """Return an operation that replaces one or two operands on the stack by a function of them."""
    if count == 1:

        def of_one() -> Operation:
            stack[-1] = compute(stack[-1])
            return after

        return of_one

    def of_two() -> Operation:
        right = stack.pop()
        stack[-1] = compute(stack[-1], right)
        return after

    return of_two
