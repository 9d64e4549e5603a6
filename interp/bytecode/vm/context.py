"""Context shared by the factories of operations."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

from interp.bytecode.program import Instruction, Program
from interp.bytecode.vm.state import Operation, State

#: Makes an operation of the place of an instruction and its operands.
Rule = Callable[..., Operation]


class Hooks(Protocol):
    """What instructions need of the machine around them."""

    #: Whether calls, and their ends, are traced.
    calls_are_traced: bool
    returns_are_traced: bool
    #: What ends an action, and what ends the routine that the program began with.
    leave_action: Operation
    finish: Operation

    def line(self, place: int, after: Operation) -> Operation:
        """What `LINE` does at a place of its code object."""

    def other_line(self, place: int, after: Operation) -> Operation:
        """What `AT` does."""

    def proceed(self, after: Operation) -> Operation:
        """What `PROCEED` does."""

    def ask(self, number: int, after: Operation) -> Operation:
        """What `ASK` does."""

    def builtin(self, number: int, after: Operation) -> Operation:
        """What `BUILTIN` does."""

    def tell(self, instruction: Instruction, after: Operation) -> Operation:
        """What an instruction for the trace does."""

    def tell_call(self, code: int) -> None:
        """A routine is about to be called."""

    def tell_leave(self) -> None:
        """The routine that runs is about to end."""


class Site:
    """Where an instruction stands: its code object, place, and the operations around it."""

    __slots__ = ("after", "body", "code", "place")

    def __init__(self, code: int, place: int, body: list[Operation], after: Operation) -> None:
        self.code = code
        self.place = place
        self.body = body
        self.after = after


@dataclass(frozen=True, slots=True)
class Runtime:
    """The program, the state it works on, and what is around it.

    ``entries`` are the first operations of code objects, ``frames`` the sizes of their frames,
    ``owners`` those whose variables actions and conditions use.
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
    compute: Callable[..., Any], count: int, stack: list[Any], after: Operation
) -> Operation:
    """An operation that puts the value of a function in place of its one or two operands."""
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
