"""State of the running machine: cells, the operand stack, open calls."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Optional

from interp.bytecode.cell_layout import Raw
from interp.port.executor import Reader
from interp.port.requests import Request

#: An instruction made ready to run. It gives the next one, or ``None`` where the machine stops.
Operation = Callable[[], Optional["Operation"]]
#: Takes the reply to a request and gives the operation to continue with.
Completion = Callable[[Any], Operation | None]
#: The frame to return to: the operation to continue with there, then ``code``, ``fp``, ``base``,
#: ``statement`` and ``serial`` of the state. A tuple, as calls are frequent and a tuple is made in
#: a third of the time of any object.
Call = tuple[Operation, int, int, int, int, int]


class State:
    """What instructions work on. The first five describe the frame that runs.

    ``code`` is the number of its code object, ``fp`` its first cell, ``base`` the height of the
    stack of operands when it began, ``statement`` the place of the LINE that began last, -1 before.
    ``serial`` distinguishes activations whose actions and conditions may be handed over, else it is
    0. ``left`` is how many statements may begin before something has to be done, out of ``quota``;
    ``whole`` is ``left`` where a slice begins, as it does with each
    `interp.port.requests.StopAdvance`, of which ``stops`` may pass without being asked for.
    ``most_calls`` is how many calls may be open, ``most_cells`` where the frames have to end,
    ``last`` the cell that was written last through a reference.

    When the machine stops, ``request`` is why, and ``completion`` takes the reply. ``reader`` is
    there while a condition is evaluated, which does not stop. ``site`` is where the program
    continues with behind the request, where nothing else is to be remembered.
    """

    __slots__ = (
        "base",
        "calls",
        "cells",
        "code",
        "completion",
        "fp",
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
        #: Values, references as addresses, views as an address and sizes; ``None`` is an argument
        #: that was left out.
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
        self.last = 0
        self.reader: Reader | None = None
        self.request: Request | None = None
        self.completion: Completion | None = None
        self.site: object = None
