"""The abstract operand stack of the verifier: values, references and views with their types."""

from __future__ import annotations

from dataclasses import dataclass

from interp.bytecode.program import Input, Mode, Variable


class Refused(Exception):
    """An instruction does not fit its operands or the stack; the message gives the reason only."""


@dataclass(frozen=True, slots=True)
class StackItem:
    """The type of one item on the stack.

    ``mode`` is ``IN`` for a value of one cell. ``type`` is the number of a type of the program; -1
    is an argument that was left out, and ``is_missing`` marks a view that may be left out.
    ``cells`` is the number of cells that the item takes.
    """

    mode: Mode
    type: int
    cells: int = 1
    is_missing: bool = False


NOTHING = StackItem(Mode.IN, -1)


class Stack:
    """An immutable stack: the item ``top`` on the stack ``below``; that is ``None`` if it is empty.

    ``cells`` is the size of the whole stack. Stacks are interned: two equal stacks that grew from
    one empty stack are the same object. So the stacks of all instructions share their items, and a
    comparison of two stacks takes constant time.
    """

    __slots__ = ("_above", "below", "cells", "top")

    def __init__(self, top: StackItem = NOTHING, below: Stack | None = None) -> None:
        self.top = top
        self.below = below
        self.cells: int = 0 if below is None else below.cells + top.cells
        self._above: dict[tuple[str, int, int, bool], Stack] = {}

    def with_item(self, item: StackItem) -> Stack:
        """Return the stack with one more item on top."""
        key = item.mode.value, item.type, item.cells, item.is_missing
        found = self._above.get(key)
        if found is None:
            found = self._above[key] = Stack(item, self)
        return found


def value_of(type_: int) -> StackItem:
    """Return a value of this type."""
    return StackItem(Mode.IN, type_)


def reference_to(type_: int) -> StackItem:
    """Return a reference to a place of this type."""
    return StackItem(Mode.REF, type_)


def view_of(type_: int, dimensions: int) -> StackItem:
    """Return a view of an array with elements of this type."""
    return StackItem(Mode.VIEW, type_, 1 + dimensions)


def item_of(given: Variable | Input) -> StackItem:
    """Return the stack item for an argument."""
    return StackItem(given.mode, given.type, 1 + given.dimensions)
