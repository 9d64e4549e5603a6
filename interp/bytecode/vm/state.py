"""The state of a running machine: cells, operand stack, open calls."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Optional, Protocol

from interp.bytecode.cell_layout import Raw
from interp.port.executor import Reader
from interp.port.requests import Request

#: A translated instruction. It returns the next one, or ``None`` if the machine stops.
Operation = Callable[[], Optional["Operation"]]
#: Takes the reply to a request and returns the next operation.
Completion = Callable[[Any], Operation | None]
#: The frame to return to: the operation to continue with there, then ``code``, ``fp``, ``base``,
#: ``statement`` and ``serial`` of the state. A tuple, because calls are frequent and creating any
#: other object takes three times as long.
Call = tuple[Operation, int, int, int, int, int]


class OperandStack(Protocol):
    """What requests and functions do with the operand stack, whatever machine it is of."""

    def __getitem__(self, where: int, /) -> Any: ...
    def __setitem__(self, where: int, value: Any, /) -> None: ...
    def append(self, value: Any, /) -> None:
        """Push an item."""

    def pop(self) -> Any:
        """Take the item at the top off, and return it."""


class State:
    """The registers and the memory of a machine. The first five describe the current frame.

    ``code`` is the number of its code object, ``fp`` its first cell, ``base`` the height of the
    operand stack when it began, ``statement`` the index of the last LINE, or -1. ``serial``
    identifies an activation for which handles of actions or conditions can exist, otherwise it is
    0.

    ``left`` is how many statements may begin before `statement_budget` has work, out of ``quota``.
    ``functions`` is the weight of functions that may still be called. ``whole`` is the value of
    ``left`` at the beginning of a slice; each
    `interp.port.requests.StopAdvance` begins one, and ``stops`` of them may pass without a request.
    ``most_calls`` is the maximum number of open calls, ``most_cells`` the end of the memory for
    frames, ``last`` the cell that was last written through a reference.

    When the machine stops, ``request`` is the reason, and ``completion`` takes the reply.
    ``reader`` is set while a condition is evaluated, which never stops. ``site`` identifies how the
    program continues after the request, if nothing else determines that.
    """

    __slots__ = (
        "base",
        "calls",
        "cells",
        "code",
        "completion",
        "fp",
        "functions",
        "last",
        "left",
        "most_calls",
        "most_cells",
        "quota",
        "reader",
        "request",
        "serial",
        "serials",
        "site",
        "stack",
        "statement",
        "stops",
        "whole",
    )

    def __init__(
        self, cells: list[Raw | None], most_calls: int, first: int, most_cells: int
    ) -> None:
        self.cells = cells
        #: Values, references as addresses, views as an address and sizes; ``None`` is a missing
        #: argument.
        self.stack: list[Any] = []
        self.calls: list[Call] = []
        self.most_calls = most_calls
        self.most_cells = most_cells
        self.code = 0
        self.fp = first
        self.base = 0
        self.statement = -1
        self.serial = 0
        self.serials = 0
        self.left = self.quota = self.whole = 1
        self.stops = 0
        self.functions = 0
        self.last = 0
        self.reader: Reader | None = None
        self.request: Request | None = None
        self.completion: Completion | None = None
        self.site: object = None


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


def then(act: Callable[[], object], after: Operation) -> Operation:
    """Return an operation that does something and continues with ``after``."""

    def operation() -> Operation:
        act()
        return after

    return operation


def raising(make: Callable[[], Exception]) -> Operation:
    """Return an operation that raises an error."""

    def operation() -> Operation:
        raise make()

    return operation
