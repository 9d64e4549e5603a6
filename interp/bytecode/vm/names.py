"""Names of variables and their parts, for the trace, VARSTATE and the debugger."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import PurePosixPath
from typing import Any

from grammar.semantics.types import Array, Type
from interp.bytecode.cell_layout import (
    Raw,
    array_at,
    cells_of,
    offset_of,
    path_to,
    shown,
    size,
    value_at,
)
from interp.bytecode.program import Mode, Program, Slot, slot_at
from interp.bytecode.vm.state import State
from interp.port.inspection import InspectedValue
from interp.port.requests import Path, path_of
from interp.values.faults import LinkError
from interp.values.values import Value


@dataclass(frozen=True, slots=True)
class InFrame:
    """An open frame: all cells, the number of its code object, and its first cell."""

    cells: list[Raw | None]
    code: int
    fp: int
    last: int = 0


class Names:
    """Maps addresses to names and names to addresses and values.

    The trace reports an assignment by its address. An address outside of all variables in sight has
    no name.
    """

    def __init__(self, program: Program, state: State | InFrame) -> None:
        self._program = program
        self._state = state
        self._slots: dict[int, tuple[Slot, ...]] = {}
        self._by_name: dict[str, list[int]] = {}
        for number, variable in enumerate(program.data):
            self._by_name.setdefault(variable.name.upper(), []).append(number)
        self._imports = {
            (one.module.upper(), one.routine.upper(), one.name.upper()): one.number
            for one in program.imports
        }

    def slots(self, code: int) -> tuple[Slot, ...]:
        """Return the parameters and locals of a code object."""
        if code not in self._slots:
            self._slots[code] = self._program.slots(self._program.codes[code])
        return self._slots[code]

    def assigned(
        self, address: int, type_: Type, dimensions: int = 0
    ) -> tuple[Path, Value | None] | None:
        """Return the path and the value at an address, or ``None`` if no variable is there.

        With ``dimensions`` it is an array, or a row of one, with elements of this type.
        """
        program, state = self._program, self._state
        number = program.data_at(address)
        if number is not None:
            variable = program.data[number]
            start, whole = program.addresses[number], program.types[variable.type]
            return self._part(variable.name, whole, start, address, type_, dimensions)
        slot = slot_at(self.slots(state.code), address - state.fp)
        if slot is None or self._is_reference(slot):
            return None
        start, whole = state.fp + slot.offset, program.types[slot.variable.type]
        return self._part(slot.variable.name, whole, start, address, type_, dimensions)

    def through(
        self, offset: int, type_: Type, dimensions: int
    ) -> tuple[Path, Value | None] | None:
        """Return path and value of what was last written through a parameter.

        ``offset`` is that of the parameter in the frame.
        """
        state = self._state
        slot = slot_at(self.slots(state.code), offset)
        assert slot is not None, "verified"
        whole, start = self.referred(slot)
        if start is None:
            return None
        return self._part(slot.variable.name, whole, start, state.last, type_, dimensions)

    def referred(self, slot: Slot) -> tuple[Type, int | None]:
        """Return the type and the address of a parameter's target; ``None`` if left out."""
        state, program = self._state, self._program
        first = state.fp + slot.offset
        variable = slot.variable
        type_ = program.types[variable.type]
        if variable.mode is Mode.IN:
            return type_, first
        start = state.cells[first]
        if variable.mode is Mode.VIEW:
            sizes: list[Any] = state.cells[first + 1 : first + slot.cells]
            type_ = Array(type_, tuple(sizes) if start is not None else (None,) * len(sizes))
        return type_, None if start is None else int(start)

    def find(self, text: str) -> tuple[Type, Value | None] | None:
        """Return type and value of what a text denotes here, or ``None`` if it is unknown.

        An array may have empty brackets. Variables of the own module have priority over those of
        others.
        """
        place = self._place(text)
        if place is None:
            return None
        type_, address = place
        if address is None:
            return type_, None
        return shown(type_), value_at(self._state.cells, address, type_)

    def put(self, text: str, value: Value) -> None:
        """Assign a value to the variable in a text.

        Raises `LinkError` if it is unknown, and `interp.values.faults.Fault` for a wrong value.
        """
        type_, address = self._place(text) or (None, None)
        if type_ is None or address is None:
            raise LinkError(f"{text} is not known here")
        self._state.cells[address : address + size(type_)] = cells_of(value, type_)

    def _place(self, text: str) -> tuple[Type, int | None] | None:
        """Return type and address of what a text denotes; the address is ``None`` if left out."""
        path = path_of(text)
        if path is None:
            return None
        root, *steps = path
        place = self._variable(str(root))
        if place is None or place[1] is None:
            return None if steps else place
        part = offset_of(place[0], steps)
        return None if part is None else (part[1], place[1] + part[0])

    def fixed(self, text: str) -> tuple[Type, int, bool] | None:
        """Return type and address of a variable that does not move, and whether it is local.

        The address of a local variable is its distance from the first cell of the frame.
        """
        slot = self._slot(_root(text))
        if slot is not None and self._is_reference(slot):
            return None
        type_, address = self._place(text) or (None, None)
        return None if type_ is None or address is None else (type_, address, slot is not None)

    def look(self, text: str) -> InspectedValue | None:
        """Return type, value and further facts for a debugger; see `interp.port.inspection`."""
        found = self.find(text)
        if found is None:
            return None
        root = _root(text)
        number = None if self._slot(root) else self._number(root)
        if number is None:
            return InspectedValue(*found, "")
        data = self._program.data[number]
        return InspectedValue(*found, f"{data.module.upper()}.{data.name.upper()}")

    def _variable(self, name: str) -> tuple[Type, int | None] | None:
        slot = self._slot(name)
        if slot is not None:
            return None if self._has_gone(slot) else self.referred(slot)
        number = self._number(name)
        if number is None:
            return None
        variable = self._program.data[number]
        return self._program.types[variable.type], self._program.addresses[number]

    def _has_gone(self, slot: Slot) -> bool:
        """Return whether a reference leads to a variable of a routine that has ended.

        An omitted view leads nowhere either, but it has sizes.
        """
        last = self._state.fp + slot.offset + slot.cells - 1
        return self._is_reference(slot) and self._state.cells[last] is None

    @staticmethod
    def _is_reference(slot: Slot) -> bool:
        return slot.variable.mode is not Mode.IN

    def _slot(self, name: str) -> Slot | None:
        """Return the parameter or local with this name."""
        slots = self.slots(self._state.code)
        return next((one for one in slots if one.variable.name.upper() == name), None)

    def _number(self, name: str) -> int | None:
        """Return the index of the variable of the data lists that a name denotes here."""
        module = PurePosixPath(self._program.codes[self._state.code].file).stem.upper()
        numbers = self._by_name.get(name, ())
        own = [n for n in numbers if self._program.data[n].module.upper() == module]
        seen = own or [n for n in numbers if self._program.data[n].is_global]
        routine = self._program.codes[self._state.code].name.upper()
        imported = self._imports.get((module, routine, name))
        if imported is None and not own:
            imported = self._imports.get((module, "", name))
        return imported if imported is not None else seen[0] if seen else None

    def _part(
        self, name: str, whole: Type, start: int, address: int, type_: Type, dimensions: int
    ) -> tuple[Path, Value | None] | None:
        if dimensions:
            array = array_at(whole, address - start, type_, dimensions)
            if array is None:
                return None
            type_ = array
        path = path_to(whole, address - start, type_)
        if path is None:
            return None
        return (name.upper(), *path), value_at(self._state.cells, address, type_)


def _root(text: str) -> str:
    """Return the name with which the text of a variable begins."""
    path = path_of(text)
    return str(path[0]) if path else ""
