"""Constants, cells, references, structures: what each of these instructions does."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from interp.bytecode._generated.opcodes import Op
from interp.bytecode.cell_layout import real_of, shared_cells, size
from interp.bytecode.vm.context import Here, Kit, Rule
from interp.bytecode.vm.state import Operation, State
from interp.values.faults import fault

__all__ = ["Moving", "load"]


class Moving:
    """Makes the operations that move what lies in cells."""

    def __init__(self, kit: Kit) -> None:
        self._types = kit.program.types
        self._state = kit.state
        self._cells = kit.state.cells
        self._stack = kit.state.stack

    def rules(self) -> Mapping[Op, Rule]:
        """The makers of operations by opcode."""
        return {
            Op.PUSH_INT: self._push,
            Op.PUSH_REAL: lambda here, bits: self._push(here, real_of(bits)),
            Op.PUSH_BOOL: lambda here, word: self._push(here, bool(word)),
            Op.PUSH_CHAR: self._push,
            Op.PUSH_ENUM: lambda here, _type, place: self._push(here, place),
            Op.PUSH_NOTHING: lambda here: self._push(here, None),
            Op.DROP: self._drop,
            Op.LOAD_LOCAL: self._load_local,
            Op.LOAD_DATA: self._load_data,
            Op.STORE_LOCAL: self._store_local,
            Op.STORE_DATA: self._store_data,
            Op.REF_LOCAL: lambda here, place, _type: self._ref_local(here, place),
            Op.REF_DATA: lambda here, place, _type: self._push(here, place),
            Op.LOAD_REF: self._load_local,
            Op.LOAD: lambda here: load(self._state, here),
            Op.STORE: self._store,
            Op.MEMBER: self._member,
            Op.COPY: self._copy,
            Op.CLEAR: self._clear,
            Op.FILL_POSE: self._fill_pose,
        }

    def _push(self, here: Here, raw: Any) -> Operation:
        push, after = self._stack.append, here.after

        def operation() -> Operation:
            push(raw)
            return after

        return operation

    def _drop(self, here: Here) -> Operation:
        pop, after = self._stack.pop, here.after

        def operation() -> Operation:
            pop()
            return after

        return operation

    def _load_local(self, here: Here, place: int) -> Operation:
        state, cells, push, after = self._state, self._cells, self._stack.append, here.after

        def operation() -> Operation:
            raw = cells[state.fp + place]
            if raw is None:
                raise fault("uninitialised")
            push(raw)
            return after

        return operation

    def _load_data(self, here: Here, place: int) -> Operation:
        cells, push, after = self._cells, self._stack.append, here.after

        def operation() -> Operation:
            raw = cells[place]
            if raw is None:
                raise fault("uninitialised")
            push(raw)
            return after

        return operation

    def _store_local(self, here: Here, place: int) -> Operation:
        state, cells, pop, after = self._state, self._cells, self._stack.pop, here.after

        def operation() -> Operation:
            cells[state.fp + place] = pop()
            return after

        return operation

    def _store_data(self, here: Here, place: int) -> Operation:
        cells, pop, after = self._cells, self._stack.pop, here.after

        def operation() -> Operation:
            cells[place] = pop()
            return after

        return operation

    def _ref_local(self, here: Here, place: int) -> Operation:
        state, push, after = self._state, self._stack.append, here.after

        def operation() -> Operation:
            push(state.fp + place)
            return after

        return operation

    def _store(self, here: Here) -> Operation:
        state, cells, pop, after = self._state, self._cells, self._stack.pop, here.after

        def operation() -> Operation:
            raw = pop()
            state.last = address = pop()
            cells[address] = raw
            return after

        return operation

    def _member(self, here: Here, offset: int, _type: int) -> Operation:
        stack, after = self._stack, here.after
        if offset == 0:
            return after

        def operation() -> Operation:
            stack[-1] += offset
            return after

        return operation

    def _copy(self, here: Here, number: int) -> Operation:
        state, cells, pop, after = self._state, self._cells, self._stack.pop, here.after
        width = size(self._types[number])

        def operation() -> Operation:
            source = pop()
            state.last = target = pop()
            cells[target : target + width] = cells[source : source + width]
            return after

        return operation

    def _clear(self, here: Here, number: int) -> Operation:
        cells, pop, after = self._cells, self._stack.pop, here.after
        width = size(self._types[number])
        blank = [None] * width

        def operation() -> Operation:
            target = pop()
            cells[target : target + width] = blank
            return after

        return operation

    def _fill_pose(self, here: Here, to: int, of: int) -> Operation:
        state, cells, pop, after = self._state, self._cells, self._stack.pop, here.after
        shared = shared_cells(self._types[to], self._types[of])
        assert shared is not None, "verified"
        width = size(self._types[to])
        blank: list[Any] = [None] * (width - shared)

        def operation() -> Operation:
            source = pop()
            state.last = target = pop()
            cells[target : target + width] = cells[source : source + shared] + blank
            return after

        return operation


def load(state: State, here: Here) -> Operation:
    """What `LOAD` does: the cell that the reference on top leads to."""
    cells, stack, after = state.cells, state.stack, here.after

    def operation() -> Operation:
        raw = cells[stack[-1]]
        if raw is None:
            raise fault("uninitialised")
        stack[-1] = raw
        return after

    return operation
