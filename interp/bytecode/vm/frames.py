"""The frames of a running machine: the open ones, and those of actions and conditions.

A handle of an action or condition has the serial of the frame in which it was created. Its code
gets references to the variables of that frame which it captures.
"""

from __future__ import annotations

from typing import Any

from interp.bytecode.program import CodeKind, Mode, Program, slot_at, stack_cells
from interp.bytecode.vm.state import Operation, State
from interp.port.requests import CodeHandle
from interp.values.faults import fault


class Frames:
    """The frames in a state; calls of routines open theirs themselves, as they are frequent."""

    def __init__(self, program: Program, state: State) -> None:
        self._program = program
        self._state = state

    def at(self, number: int) -> tuple[int, int, int]:
        """Return code object, first cell and statement of a frame; 0 is the innermost frame."""
        state = self._state
        if number == 0:
            return state.code, state.fp, state.statement
        _, code, first, _, statement, _ = state.calls[-number]
        return code, first, statement

    def begin(self, number: int) -> None:
        """Create the first frame."""
        state = self._state
        state.code, first, frame = number, state.fp, self._program.frames[number]
        state.cells[first : first + frame] = [None] * frame
        state.serials = state.serial = 1

    def close(self) -> None:
        """Drop the current frame."""
        state = self._state
        call = state.calls.pop()
        _, state.code, state.fp, state.base, state.statement, state.serial = call

    def of_handle(self, code: CodeHandle, kind: CodeKind) -> tuple[int, int]:
        """Return the number of a code object and the serial of the frame of its handle."""
        serial, number = divmod(code.number, len(self._program.codes))
        if self._program.codes[number].kind is not kind:
            raise ValueError(f"{code} is no {kind.value}")
        return number, serial

    def open(self, number: int, serial: int, after: Operation) -> None:
        """Create a frame for an action or a condition; raises the fault ``stack``."""
        state, frames = self._state, self._program.frames
        first = state.fp + frames[state.code]
        if first + frames[number] > state.most_cells:
            raise fault("stack")
        found = self.captures(number, serial)
        found += [None] * (frames[number] - len(found))
        state.cells[first : first + frames[number]] = found
        state.calls.append((after, state.code, state.fp, state.base, state.statement, state.serial))
        state.code, state.fp, state.base = number, first, len(state.stack)
        state.statement, state.serial = -1, 0

    def captures(self, number: int, serial: int) -> list[Any]:
        """Return the arguments of an action or condition; none if the owner's frame has ended."""
        code = self._program.codes[number]
        owner = self.first_cell(serial) if code.captures else None
        if owner is None:
            return []
        assert code.owner is not None, "only what has an owner captures"
        slots = self._program.slots(self._program.codes[code.owner])
        found: list[Any] = []
        for parameter, place in zip(code.parameters, code.captures, strict=True):
            first, slot = owner + place, slot_at(slots, place)
            is_reference = slot is not None and slot.variable.mode is not Mode.IN
            cells = self._state.cells[first : first + stack_cells(parameter)]
            found += cells if is_reference else [first]
        return found

    def first_cell(self, serial: int) -> int | None:
        """Return the first cell of the frame with this serial, or ``None`` if it has ended."""
        state = self._state
        if state.serial == serial:
            return state.fp
        for call in reversed(state.calls):
            if call[5] == serial:
                return call[2]
        return None
