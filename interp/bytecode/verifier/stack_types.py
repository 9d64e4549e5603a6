"""The types of what lies on the stack of operands: values, references, views."""

from __future__ import annotations

from dataclasses import dataclass

from interp.bytecode.program import Input, Mode, Parameter


class Refused(Exception):
    """An instruction does not fit what it works on; the message says why, but not where."""


@dataclass(frozen=True, slots=True)
class StackItem:
    """What lies on the stack.

    ``mode`` is ``IN`` for a value of one cell. ``type`` is a number of the program; -1 stands for
    a value that was left out, ``is_missing`` for such a view. ``cells`` is how many cells it takes.
    """

    mode: Mode
    type: int
    cells: int = 1
    is_missing: bool = False


NOTHING = StackItem(Mode.IN, -1)


class Stack:
    """Items on what lies ``below``, ``None`` for the empty stack; ``cells`` is the size of all.

    Stacks that began as one and hold the same are one object: a long stack at each of many
    instructions costs an object each, and whether two are the same takes no look at their items.
    """

    __slots__ = ("_above", "below", "cells", "top")

    def __init__(self, top: StackItem = NOTHING, below: Stack | None = None) -> None:
        self.top = top
        self.below = below
        self.cells: int = 0 if below is None else below.cells + top.cells
        self._above: dict[tuple[str, int, int, bool], Stack] = {}

    def with_item(self, item: StackItem) -> Stack:
        """The stack with one item more."""
        key = item.mode.value, item.type, item.cells, item.is_missing
        found = self._above.get(key)
        if found is None:
            found = self._above[key] = Stack(item, self)
        return found


def reference(type_: int) -> StackItem:
    """A reference to a place of this type."""
    return StackItem(Mode.REF, type_)


def view_of(type_: int, dimensions: int) -> StackItem:
    """A view of an array that has elements of this type."""
    return StackItem(Mode.VIEW, type_, 1 + dimensions)


def item_of(given: Parameter | Input) -> StackItem:
    """An argument, as it lies on the stack."""
    return StackItem(given.mode, given.type, 1 + given.dimensions)
