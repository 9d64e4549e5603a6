"""The instructions for statements, jumps, calls and loops."""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

from interp.bytecode._generated.opcodes import Op
from interp.bytecode.cell_layout import Plain, size
from interp.bytecode.program import CodeKind, Mode, Variable, stack_cells
from interp.bytecode.vm.context import DATA_LISTS, Frame, Rule, Rules, Site
from interp.bytecode.vm.state import Operation, raising
from interp.values.faults import FAULTS, LinkError, fault


class ControlRules(Rules):
    """Makes the operations of control flow instructions."""

    def rules(self) -> Mapping[Op, Rule]:
        """Return the factory of each opcode."""
        hooks, texts = self._runtime.hooks, self._program.texts
        return {
            Op.LINE: lambda site, _line, _to: hooks.line(site.place, site.after),
            Op.PROCEED: lambda site: hooks.proceed(site.after),
            Op.ASK: lambda site, number: hooks.ask(number, site.after),
            Op.BUILTIN: lambda site, number: hooks.builtin(number, site.after),
            Op.JUMP: _jump,
            Op.JUMP_IF: self._jump_if,
            Op.JUMP_UNLESS: self._jump_unless,
            Op.CASE: self._case,
            Op.CALL: self._call,
            Op.RETURN: self._return,
            Op.RETURN_VALUE: self._return,
            Op.FAIL: lambda _site, code: raising(lambda: fault(_SLUGS[code])),
            Op.UNLINKED: lambda _site, number: raising(lambda: LinkError(texts[number])),
            Op.AT: lambda site, _line, _to: hooks.other_line(site.place, site.after),
            Op.FOR_LOCAL: partial(self._for, self._state),
            Op.FOR_DATA: partial(self._for, DATA_LISTS),
        }

    def _jump_if(self, site: Site, target: int) -> Operation:
        pop, after, body = self._stack.pop, site.after, site.body
        return lambda: body[target] if pop() else after

    def _jump_unless(self, site: Site, target: int) -> Operation:
        pop, after, body = self._stack.pop, site.after, site.body
        return lambda: after if pop() else body[target]

    def _case(self, site: Site, constant: int, target: int) -> Operation:
        stack, after, body = self._stack, site.after, site.body

        def operation() -> Operation:
            if stack[-1] != constant:
                return after
            stack.pop()
            return body[target]

        return operation

    def _call(self, site: Site, number: int) -> Operation:
        state, stack, cells, after = self._state, self._stack, self._cells, site.after
        calls, entries = state.calls, self._runtime.entries
        callee = self._program.codes[number]
        own, frame = self._runtime.frames[site.code], self._runtime.frames[number]
        count = sum(map(stack_cells, callee.parameters))
        blank: list[Any] = [None] * (frame - sum(map(self._program.width, callee.parameters)))
        receive = self._receiver(callee.parameters)
        hooks = self._runtime.hooks
        is_owner = number in self._runtime.owners
        is_traced = hooks.calls_are_traced

        def operation() -> Operation:
            first = state.fp + own
            if len(calls) >= state.most_calls or first + frame > state.most_cells:
                raise fault("stack")
            if is_traced:
                hooks.tell_call(number)
            if count:
                arguments = stack[-count:]
                del stack[-count:]
                cells[first : first + frame] = (
                    receive(arguments) if receive else arguments
                ) + blank
            else:
                cells[first : first + frame] = blank
            calls.append((after, state.code, state.fp, state.base, state.statement, state.serial))
            state.code = number
            state.fp = first
            state.base = len(stack)
            state.statement = -1
            if is_owner:
                state.serials += 1
                state.serial = state.serials
            else:
                state.serial = 0
            return entries[number]

        return operation

    def _receiver(self, parameters: Sequence[Variable]) -> Callable[[list[Any]], list[Any]] | None:
        """Return a function that copies structures among arguments; ``None`` without any."""
        cells = self._cells
        widths = [
            (stack_cells(parameter), size(self._types[parameter.type]))
            if parameter.mode is Mode.IN and not isinstance(self._types[parameter.type], Plain)
            else (stack_cells(parameter), 0)
            for parameter in parameters
        ]
        if not any(copied for _, copied in widths):
            return None

        def receive(arguments: list[Any]) -> list[Any]:
            received: list[Any] = []
            place = 0
            for count, copied in widths:
                given = arguments[place : place + count]
                received += cells[given[0] : given[0] + copied] if copied else given
                place += count
            return received

        return receive

    def _return(self, site: Site) -> Operation:
        state, calls, hooks = self._state, self._state.calls, self._runtime.hooks
        kind = self._program.codes[site.code].kind
        if kind is CodeKind.ACTION:
            return hooks.leave_action
        is_traced = hooks.returns_are_traced and kind is CodeKind.ROUTINE

        def operation() -> Operation | None:
            if is_traced:
                hooks.tell_leave()
            if not calls:
                return hooks.finish()
            after, state.code, state.fp, state.base, state.statement, state.serial = calls.pop()
            return after

        return operation

    def _for(
        self, frame: Frame, site: Site, counter: int, limit: int, step: int, target: int
    ) -> Operation:
        """Return the operation of a loop whose counter is in ``frame``; its limit is local."""
        state, cells, after, body = self._state, self._cells, site.after, site.body
        goes_on = operator.le if step > 0 else operator.ge

        def operation() -> Operation:
            place = frame.fp + counter
            value, last = cells[place], cells[state.fp + limit]
            if value is None or last is None:
                raise fault("uninitialised")
            value += step
            if not -0x80000000 <= value <= 0x7FFFFFFF:
                raise fault("overflow")
            cells[place] = value
            return body[target] if goes_on(value, last) else after

        return operation


_SLUGS = {kind.code: slug for slug, kind in FAULTS.items()}


def _jump(site: Site, target: int) -> Operation:
    body = site.body
    if target > site.place:  # made ready already
        return body[target]
    return lambda: body[target]
