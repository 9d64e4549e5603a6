"""The types of cells: looks up what a cell of a frame or of the data lists holds."""

from __future__ import annotations

from bisect import bisect_right

from grammar.semantics.types import Array, Type
from interp.bytecode.cell_layout import kind_at, path_to
from interp.bytecode.program import Code, Mode, Parameter, Program, Slot
from interp.bytecode.verifier.stack_types import Refused, StackItem, item_of


class CellTypes:
    """The cells that a code object can access; methods raise `Refused` for a missing cell."""

    def __init__(self, program: Program, code: Code) -> None:
        self._program = program
        self._types = program.types
        self._slots = program.slots(code)
        self._starts = [slot.offset for slot in self._slots]
        self._numbers = {type_: number for number, type_ in enumerate(program.types)}

    def _value(self, type_: Type) -> StackItem:
        return StackItem(Mode.IN, self._numbers[type_])

    def slot(self, place: int) -> Slot:
        """Return the parameter or local variable to which a cell of the frame belongs."""
        number = bisect_right(self._starts, place) - 1
        if number < 0 or place >= self._slots[number].offset + self._slots[number].cells:
            raise Refused("the frame has no such cell")
        return self._slots[number]

    def _variable(self, place: int) -> tuple[Type, int]:
        """Return the type of the variable to which a cell belongs, and the cell's offset in it."""
        slot = self.slot(place)
        if isinstance(slot.variable, Parameter) and slot.variable.mode is not Mode.IN:
            raise Refused("the cell holds a reference")
        return self._types[slot.variable.type], place - slot.offset

    def _data_variable(self, address: int) -> tuple[Type, int]:
        number = self._program.data_at(address)
        if number is None:
            raise Refused("the data lists have no such cell")
        type_ = self._types[self._program.data[number].type]
        return type_, address - self._program.addresses[number]

    def local(self, place: int) -> StackItem:
        """Return the value type of a cell of the frame."""
        return self._value(kind_at(*self._variable(place)))

    def data(self, address: int) -> StackItem:
        """Return the value type of a cell of the data lists."""
        return self._value(kind_at(*self._data_variable(address)))

    def check_local(self, place: int, number: int) -> None:
        """Check that a part of this type begins at a cell of the frame."""
        self.check_part(*self._variable(place), number)

    def check_data(self, address: int, number: int) -> None:
        """Check that a part of this type begins at a cell of the data lists."""
        self.check_part(*self._data_variable(address), number)

    def check_part(self, whole: Type, offset: int, number: int) -> None:
        """Check that a part of this type begins at an offset in a type."""
        if path_to(whole, offset, self._types[number]) is None:
            raise Refused(f"no part of this type begins here: {self._types[number]}")

    def parameter(self, place: int, mode: Mode) -> StackItem:
        """Return the reference or view that is passed for the parameter at a cell."""
        slot = self.slot(place)
        parameter = slot.variable
        if slot.offset != place or not isinstance(parameter, Parameter):
            raise Refused("no parameter begins at this cell")
        if parameter.mode is not mode:
            raise Refused("the parameter is passed in another way")
        return item_of(parameter)

    def array(self, number: int) -> Array:
        """Return the array type with this number."""
        type_ = self._types[number]
        if not isinstance(type_, Array):
            raise Refused(f"an array is required: {type_}")
        return type_

    def element(self, array: Array) -> int:
        """Return the number of the element type of an array."""
        return self._numbers[array.element]
