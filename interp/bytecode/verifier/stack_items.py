"""What operands denote on the abstract stack: the items that are popped and pushed.

The table of the instruction set names these items in the effects of instructions, see
`interp.bytecode.instruction_set.effects`. Each is a method with the same name here.
"""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import replace

from grammar.semantics.types import Array, Type
from interp.bytecode.cell_layout import Plain, kind_at, path_to
from interp.bytecode.instruction_set.effects import SCALARS
from interp.bytecode.program import Code, Mode, Parameter, Program, Slot
from interp.bytecode.verifier.stack_types import (
    NOTHING,
    Refused,
    StackItem,
    item_of,
    reference_to,
    view_of,
)


class StackItems:
    """The items of a code object; methods raise `Refused` for what is not there."""

    def __init__(self, program: Program, code: Code) -> None:
        self._program = program
        self._types = program.types
        self._slots = program.slots(code)
        self._starts = [slot.offset for slot in self._slots]
        self._numbers = {type_: number for number, type_ in enumerate(program.types)}

    # ----------------------------------------------------------------------- values

    def value(self, type_: int) -> StackItem:
        """Return a value of this type."""
        return StackItem(Mode.IN, type_)

    def nothing(self) -> StackItem:
        """Return the item for an argument that was left out."""
        return NOTHING

    def local(self, cell: int) -> StackItem:
        """Return a value of the type of a cell in the frame."""
        return self.value(self._numbers[kind_at(*self.variable(cell))])

    def missing_local(self, cell: int) -> StackItem:
        """The same where it may be missing."""
        return replace(self.local(cell), is_missing=True)

    def data(self, cell: int) -> StackItem:
        """Return a value of the type of a cell in the data lists."""
        return self.value(self._numbers[kind_at(*self.data_variable(cell))])

    def element_value(self, array: int) -> StackItem:
        """Return the value of an element of an array type."""
        return self.cell_of(self.element(array))

    # ----------------------------------------------------------------------- references and views

    def reference(self, type_: int) -> StackItem:
        """Return a reference to this type."""
        return reference_to(type_)

    def parameter(self, place: int) -> StackItem:
        """Return the reference that is passed for a parameter by reference."""
        return self._passed(place, Mode.REF)

    def element(self, array: int) -> StackItem:
        """Return a reference to an element of an array type."""
        return reference_to(self._element(array))

    def view(self, element: int, dimensions: int) -> StackItem:
        """Return a view of an array with elements of this type."""
        return view_of(element, dimensions)

    def missing_view(self, element: int, dimensions: int) -> StackItem:
        """Return such a view that may be missing because the argument was left out."""
        return replace(view_of(element, dimensions), is_missing=True)

    def letters(self) -> StackItem:
        """Return a one-dimensional view of CHARs."""
        return view_of(SCALARS.index("CHAR"), 1)

    def array_view(self, array: int) -> StackItem:
        """Return a view of a whole array of this type."""
        return self.row(array, 0)

    def row(self, array: int, count: int) -> StackItem:
        """Return a view of the row of an array that ``count`` leading indices select."""
        return view_of(self._element(array), self.rank(array) - count)

    def view_parameter(self, place: int) -> StackItem:
        """Return the view that is passed for an array parameter."""
        return self._passed(place, Mode.VIEW)

    def missing_view_parameter(self, place: int) -> StackItem:
        """Return the view for an array parameter whose argument may be left out."""
        return replace(self.view_parameter(place), is_missing=True)

    def view_element(self, place: int) -> StackItem:
        """Return a reference to an element of an array parameter."""
        return reference_to(self.view_parameter(place).type)

    def view_row(self, place: int, count: int) -> StackItem:
        """Return a view of the row of an array parameter that ``count`` leading indices select."""
        whole = self.view_parameter(place)
        return view_of(whole.type, whole.cells - 1 - count)

    def _passed(self, place: int, mode: Mode) -> StackItem:
        slot = self.slot(place)
        parameter = slot.variable
        if slot.offset != place or not isinstance(parameter, Parameter):
            raise Refused("no parameter begins at this cell")
        if parameter.mode is not mode:
            raise Refused("the parameter is passed in another way")
        return item_of(parameter)

    # ----------------------------------------------------------------------- cells and types

    def cell_of(self, item: StackItem) -> StackItem:
        """Return the value in the cell that a reference refers to."""
        if item.mode is not Mode.REF or not isinstance(self._types[item.type], Plain):
            raise Refused("a reference to a single cell is required")
        return self.value(item.type)

    def slot(self, place: int) -> Slot:
        """Return the parameter or local variable to which a cell of the frame belongs."""
        number = bisect_right(self._starts, place) - 1
        if number < 0 or place >= self._slots[number].offset + self._slots[number].cells:
            raise Refused("the frame has no such cell")
        return self._slots[number]

    def variable(self, place: int) -> tuple[Type, int]:
        """Return the type of the variable of a cell of the frame, and the cell's offset in it."""
        slot = self.slot(place)
        if isinstance(slot.variable, Parameter) and slot.variable.mode is not Mode.IN:
            raise Refused("the cell holds a reference")
        return self._types[slot.variable.type], place - slot.offset

    def data_variable(self, address: int) -> tuple[Type, int]:
        """Return the type of the variable of a cell of the data lists, and the cell's offset."""
        number = self._program.data_at(address)
        if number is None:
            raise Refused("the data lists have no such cell")
        type_ = self._types[self._program.data[number].type]
        return type_, address - self._program.addresses[number]

    def check_part(self, whole: Type, offset: int, number: int) -> None:
        """Check that a part of this type begins at an offset in a type."""
        if path_to(whole, offset, self._types[number]) is None:
            raise Refused(f"no part of this type begins here: {self._types[number]}")

    def array(self, number: int) -> Array:
        """Return the array type with this number."""
        type_ = self._types[number]
        if not isinstance(type_, Array):
            raise Refused(f"an array is required: {type_}")
        return type_

    def rank(self, array: int) -> int:
        """Return the number of dimensions of an array type."""
        return len(self.array(array).sizes)

    def _element(self, array: int) -> int:
        return self._numbers[self.array(array).element]
