"""The instructions for elements, rows, views and whole arrays."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any

from grammar.semantics.types import Array
from interp.bytecode._generated.opcodes import Op
from interp.bytecode.cell_layout import array_sizes, size
from interp.bytecode.program import slot_at
from interp.bytecode.vm.context import DATA_LISTS, Frame, Rule, Rules, Site
from interp.bytecode.vm.data_movement import load
from interp.bytecode.vm.state import Operation, then
from interp.values.faults import fault


class ArrayRules(Rules):
    """Makes the operations of array instructions."""

    def rules(self) -> Mapping[Op, Rule]:
        """Return the factory of each opcode."""
        return {
            Op.INDEX: self._index,
            Op.INDEX_LOCAL: partial(self._index_in, self._state),
            Op.INDEX_DATA: partial(self._index_in, DATA_LISTS),
            Op.INDEX_VIEW: self._index_view,
            Op.ELEMENT_LOCAL: partial(self._element_in, self._state),
            Op.ELEMENT_DATA: partial(self._element_in, DATA_LISTS),
            Op.PUSH_NO_VIEW: self._push_no_view,
            Op.VIEW: self._view,
            Op.LOAD_VIEW: self._load_view,
            Op.PASS_VIEW: self._pass_view,
            Op.ROW: self._row,
            Op.ROW_VIEW: self._row_view,
            Op.FILL_ARRAY: self._fill_array,
            Op.COPY_VIEW: self._copy_view,
            Op.SET_TEXT: self._set_text,
        }

    def _index(self, site: Site, number: int) -> Operation:
        sizes, width = self._array(number)
        stack, after = self._stack, site.after

        def operation() -> Operation:
            place = _flat(stack, sizes) * width
            stack[-1] += place
            return after

        return operation

    def _index_in(self, frame: Frame, site: Site, place: int, number: int) -> Operation:
        sizes, width = self._array(number)
        stack, after = self._stack, site.after
        if len(sizes) > 1:

            def general() -> Operation:
                stack.append(_flat(stack, sizes) * width + frame.fp + place)
                return after

            return general
        length, before = sizes[0], place - width

        def operation() -> Operation:
            index = stack[-1]
            if not 1 <= index <= length:
                raise fault("index")
            stack[-1] = frame.fp + before + index * width
            return after

        return operation

    def _element_in(self, frame: Frame, site: Site, place: int, number: int) -> Operation:
        sizes, _ = self._array(number)
        if len(sizes) > 1:
            return self._index_in(frame, self._before(site, load(self._state, site)), place, number)
        cells, stack, after = self._cells, self._stack, site.after
        length, before = sizes[0], place - 1

        def operation() -> Operation:
            index = stack[-1]
            if not 1 <= index <= length:
                raise fault("index")
            raw = cells[frame.fp + before + index]
            if raw is None:
                raise fault("uninitialised")
            stack[-1] = raw
            return after

        return operation

    def _before(self, site: Site, after: Operation) -> Site:
        """Return the site of an operation that precedes another one of the same instruction."""
        return Site(site.code, site.place, site.body, after)

    def _index_view(self, site: Site, place: int) -> Operation:
        state, cells, stack, after = self._state, self._cells, self._stack, site.after
        dimensions, width = self._view_at(site, place)

        def operation() -> Operation:
            base, *sizes = _view(cells, state.fp + place, dimensions)
            stack.append(base + _flat(stack, sizes) * width)
            return after

        return operation

    def _push_no_view(self, site: Site, _type: int, dimensions: int) -> Operation:
        return then(partial(self._stack.extend, (None, *[0] * dimensions)), site.after)

    def _view(self, site: Site, number: int) -> Operation:
        return then(partial(self._stack.extend, self._array(number)[0]), site.after)

    def _load_view(self, site: Site, place: int) -> Operation:
        state, cells, stack, after = self._state, self._cells, self._stack, site.after
        dimensions, _ = self._view_at(site, place)

        def operation() -> Operation:
            stack.extend(_view(cells, state.fp + place, dimensions))
            return after

        return operation

    def _pass_view(self, site: Site, place: int) -> Operation:
        state, cells, stack, after = self._state, self._cells, self._stack, site.after
        dimensions, _ = self._view_at(site, place)

        def operation() -> Operation:
            first = state.fp + place
            view = cells[first : first + 1 + dimensions]
            if view[1] is None:  # what was left out has sizes
                raise fault("uninitialised")
            stack.extend(view)
            return after

        return operation

    def _row(self, site: Site, number: int, count: int) -> Operation:
        sizes, width = self._array(number)
        stack, after = self._stack, site.after
        given, rest = sizes[:count], sizes[count:]
        for one in rest:
            width *= one

        def operation() -> Operation:
            place = _flat(stack, given) * width
            stack[-1] += place
            stack.extend(rest)
            return after

        return operation

    def _row_view(self, site: Site, place: int, count: int) -> Operation:
        state, cells, stack, after = self._state, self._cells, self._stack, site.after
        dimensions, width = self._view_at(site, place)

        def operation() -> Operation:
            base, *sizes = _view(cells, state.fp + place, dimensions)
            row = width
            for one in sizes[count:]:
                row *= one
            stack.append(base + _flat(stack, sizes[:count]) * row)
            stack.extend(sizes[count:])
            return after

        return operation

    def _fill_array(self, site: Site, number: int, dimensions: int) -> Operation:
        state, cells, stack, after = self._state, self._cells, self._stack, site.after
        width = size(self._types[number])

        def operation() -> Operation:
            source, *given = stack[-1 - dimensions :]
            target, *sizes = stack[-2 - 2 * dimensions : -1 - dimensions]
            del stack[-2 - 2 * dimensions :]
            if dimensions > 1 and given != sizes:
                raise fault("inadmissible")
            length, rest = sizes[0] * width, (sizes[0] - given[0]) * width
            for one in sizes[1:]:
                length *= one
            state.last = target
            found = cells[source : source + (length if dimensions > 1 else length - max(rest, 0))]
            cells[target : target + length] = found + [None] * (length - len(found))
            return after

        return operation

    def _copy_view(self, site: Site, place: int, number: int) -> Operation:
        state, cells, stack, after = self._state, self._cells, self._stack, site.after
        type_ = self._types[number]
        assert isinstance(type_, Array), "verified"
        width, room = size(type_.element), size(type_)
        dimensions = len(type_.sizes)

        def operation() -> Operation:
            source, *sizes = stack[-1 - dimensions :]
            length = width
            for one in sizes:
                length *= one
            if length > room:
                raise fault("stack")
            target = stack[-1 - dimensions] = state.fp + place
            cells[target : target + length] = cells[source : source + length]
            return after

        return operation

    def _set_text(self, site: Site, number: int) -> Operation:
        state, cells, pop, after = self._state, self._cells, self._stack.pop, site.after
        codes: list[Any] = [ord(letter) for letter in self._program.texts[number]]

        def operation() -> Operation:
            length = pop()
            state.last = target = pop()
            cells[target : target + length] = codes[:length] + [None] * (length - len(codes))
            return after

        return operation

    def _array(self, number: int) -> tuple[tuple[int, ...], int]:
        """Return the sizes of an array type and the width of an element in cells."""
        type_ = self._types[number]
        assert isinstance(type_, Array), "verified"
        return array_sizes(type_), size(type_.element)

    def _view_at(self, site: Site, place: int) -> tuple[int, int]:
        """Return the number of dimensions of an array parameter and the width of its elements."""
        slot = slot_at(self._program.slots(self._program.codes[site.code]), place)
        assert slot is not None, "verified"
        return slot.variable.dimensions, size(self._types[slot.variable.type])


def _view(cells: list[Any], first: int, dimensions: int) -> list[Any]:
    """Return the address and sizes of an array parameter; raises ``uninitialised``."""
    view = cells[first : first + 1 + dimensions]
    if view[0] is None:
        raise fault("uninitialised")
    return view


def _flat(stack: list[Any], sizes: Sequence[Any]) -> int:
    """Pop one index for each dimension; return the offset of the element. Raises ``index``."""
    count = len(sizes)
    place = 0
    for index, one in zip(stack[-count:], sizes, strict=True):
        if not 1 <= index <= one:
            raise fault("index")
        place = place * one + index - 1
    del stack[-count:]
    return place
