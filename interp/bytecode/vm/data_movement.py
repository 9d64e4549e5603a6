"""The instructions for constants, cells, references and structures."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from interp.bytecode._generated.opcodes import Op
from interp.bytecode.cell_layout import real_of, shared_cells, size
from interp.bytecode.vm.context import Rule, Rules, Site
from interp.bytecode.vm.state import Operation, State
from interp.values.faults import fault


class MovementRules(Rules):
    """Makes the operations of instructions that move data."""

    def rules(self) -> Mapping[Op, Rule]:
        """Return the factory of each opcode."""
        return {
            Op.PUSH_INT: self._push,
            Op.PUSH_REAL: lambda site, bits: self._push(site, real_of(bits)),
            Op.PUSH_BOOL: lambda site, word: self._push(site, bool(word)),
            Op.PUSH_CHAR: self._push,
            Op.PUSH_ENUM: lambda site, _type, place: self._push(site, place),
            Op.PUSH_NOTHING: lambda site: self._push(site, None),
            Op.DROP: self._drop,
            Op.LOAD_LOCAL: self._load_local,
            Op.PASS_LOCAL: self._pass_local,
            Op.LOAD_DATA: self._load_data,
            Op.STORE_LOCAL: self._store_local,
            Op.STORE_DATA: self._store_data,
            Op.REF_LOCAL: lambda site, place, _type: self._ref_local(site, place),
            Op.REF_DATA: lambda site, place, _type: self._push(site, place),
            Op.LOAD_REF: self._load_local,
            Op.LOAD: lambda site: load(self._state, site),
            Op.STORE: self._store,
            Op.MEMBER: self._member,
            Op.COPY: self._copy,
            Op.CLEAR: self._clear,
            Op.FILL_POSE: self._fill_pose,
        }

    def _push(self, site: Site, raw: Any) -> Operation:
        push, after = self._stack.append, site.after

        def operation() -> Operation:
            push(raw)
            return after

        return operation

    def _drop(self, site: Site) -> Operation:
        pop, after = self._stack.pop, site.after

        def operation() -> Operation:
            pop()
            return after

        return operation

    def _load_local(self, site: Site, place: int) -> Operation:
        state, cells, push, after = self._state, self._cells, self._stack.append, site.after

        def operation() -> Operation:
            raw = cells[state.fp + place]
            if raw is None:
                raise fault("uninitialised")
            push(raw)
            return after

        return operation

    def _pass_local(self, site: Site, place: int) -> Operation:
        state, cells, push, after = self._state, self._cells, self._stack.append, site.after

        def operation() -> Operation:
            push(cells[state.fp + place])
            return after

        return operation

    def _load_data(self, site: Site, place: int) -> Operation:
        cells, push, after = self._cells, self._stack.append, site.after

        def operation() -> Operation:
            raw = cells[place]
            if raw is None:
                raise fault("uninitialised")
            push(raw)
            return after

        return operation

    def _store_local(self, site: Site, place: int) -> Operation:
        state, cells, pop, after = self._state, self._cells, self._stack.pop, site.after

        def operation() -> Operation:
            cells[state.fp + place] = pop()
            return after

        return operation

    def _store_data(self, site: Site, place: int) -> Operation:
        cells, pop, after = self._cells, self._stack.pop, site.after

        def operation() -> Operation:
            cells[place] = pop()
            return after

        return operation

    def _ref_local(self, site: Site, place: int) -> Operation:
        state, push, after = self._state, self._stack.append, site.after

        def operation() -> Operation:
            push(state.fp + place)
            return after

        return operation

    def _store(self, site: Site) -> Operation:
        state, cells, pop, after = self._state, self._cells, self._stack.pop, site.after

        def operation() -> Operation:
            raw = pop()
            state.last = address = pop()
            cells[address] = raw
            return after

        return operation

    def _member(self, site: Site, offset: int, _type: int) -> Operation:
        stack, after = self._stack, site.after
        if offset == 0:
            return after

        def operation() -> Operation:
            stack[-1] += offset
            return after

        return operation

    def _copy(self, site: Site, number: int) -> Operation:
        state, cells, pop, after = self._state, self._cells, self._stack.pop, site.after
        width = size(self._types[number])

        def operation() -> Operation:
            source = pop()
            state.last = target = pop()
            cells[target : target + width] = cells[source : source + width]
            return after

        return operation

    def _clear(self, site: Site, number: int) -> Operation:
        cells, pop, after = self._cells, self._stack.pop, site.after
        width = size(self._types[number])
        blank = [None] * width

        def operation() -> Operation:
            target = pop()
            cells[target : target + width] = blank
            return after

        return operation

    def _fill_pose(self, site: Site, to: int, of: int) -> Operation:
        state, cells, pop, after = self._state, self._cells, self._stack.pop, site.after
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


def load(state: State, site: Site) -> Operation:
    """Return the operation of `LOAD`: it replaces the reference on top of the stack by its cell."""
    cells, stack, after = state.cells, state.stack, site.after

    def operation() -> Operation:
        raw = cells[stack[-1]]
        if raw is None:
            raise fault("uninitialised")
        stack[-1] = raw
        return after

    return operation
