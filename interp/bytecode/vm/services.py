"""Instructions that need more than cells: statement counting, requests, and trace events."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

from grammar.semantics.types import REAL
from interp.bytecode._generated.opcodes import Op
from interp.bytecode.cell_layout import shown
from interp.bytecode.program import Argument, Code, Input, Instruction, Mode, Program
from interp.bytecode.vm.marshalling import (
    Block,
    Change,
    Entry,
    RequestBuilder,
    arguments_of,
)
from interp.bytecode.vm.names import Names
from interp.bytecode.vm.state import Operation, State, computed, then
from interp.bytecode.vm.statement_budget import Counter, Pause
from interp.port import requests
from interp.port.events import Sink, wanting
from interp.port.requests import At, MoveEmily, Path, Request, Slice, StopAdvance, Value, Write
from interp.port.requests import CodeHandle as HandedOver
from interp.program.load import Guard, Limits
from interp.values.builtins import FUNCTIONS, WEIGHTS, Surroundings, call
from interp.values.faults import BudgetExhausted, LinkError
from interp.values.values import converted, text_of

#: The message if a condition does more than compute and read.
NOT_IN_CONDITIONS = "a condition can only compute and read"

_NOWHERE = At("", 0, 0)


class Services:
    """Makes the operations that go beyond cells, and knows the current place in the program.

    ``entered`` is the number of open calls that are actions. The machine sets ``leave_action`` and
    ``finish``, the operations that end an action and the program.
    """

    def __init__(
        self,
        program: Program,
        state: State,
        limits: Limits,
        sink: Sink | None,
        random: Callable[[], float],
    ) -> None:
        self._program = program
        self._state = state
        self._lines, self._assignments = wanting(sink, "line"), wanting(sink, "assign")
        self._calls, self._returns = wanting(sink, "call"), wanting(sink, "return")
        self._branches = wanting(sink, "branch")
        self._tells_nothing = sink is None or not sink.kinds
        self._names = Names(program, state)
        self._makers = RequestBuilder(program, self._handed_over)
        self._surroundings = Surroundings(random, self._names.find)
        self.counter = Counter(state, limits)
        self._limits = limits
        self.calls_are_traced = self._calls is not None
        self.returns_are_traced = self._returns is not None
        self.entered = 0
        self.leave_action: Operation = lambda: None
        self.finish: Operation = lambda: None
        self.free_slices: Callable[[bool], int] = int

    # ----------------------------------------------------------------------- places

    @property
    def depth(self) -> int:
        """The depth of calls."""
        return len(self._state.calls) - self.entered

    def code(self) -> Code:
        """Return the code object that is running."""
        return self._program.codes[self._state.code]

    def at(self) -> At:
        """Return the current place: the line of the statement that began last."""
        code, statement = self.code(), self._state.statement
        line = code.line if statement < 0 else code.instructions[statement].operands[0]
        return At(code.file, line, self.depth)

    def _handed_over(self, number: int) -> HandedOver:
        """Return the handle of an action or condition in the current frame."""
        captures = self._program.codes[number].captures
        serial = self._state.serial if captures else 0
        return HandedOver(number + serial * len(self._program.codes))

    # ----------------------------------------------------------------------- statements

    def line(self, place: int, after: Operation) -> Operation:
        """Return the operation of a `LINE` instruction."""
        state, pause = self._state, self._pause
        lines = self._lines
        begin = after if lines is None else then(lambda: lines.line(self.at()), after)

        def operation() -> Operation | None:
            state.statement = place
            state.left -= 1
            return begin if state.left else pause(begin)

        return operation

    def _pause(self, begin: Operation) -> Operation | None:
        """Count the budget, make a slice request if it is due, and begin the statement."""
        counter, state = self.counter, self._state

        def completion(_reply: object) -> Operation:
            counter.free(self._free(begins=True))
            counter.begin()
            return begin

        match counter.pause():
            case Pause.EXHAUSTED:
                raise self._limits.exhausted()
            case Pause.SLICE if state.reader is None:
                if counter.is_asking and (more := self._free(begins=False)):
                    counter.free(more + 1)
                else:
                    counter.asked()
                    state.request = Slice(self.at(), counter.passed() + 1)
                    state.completion, state.site = completion, begin
                    return None
        counter.begin()
        return begin

    def _free(self, *, begins: bool) -> int:
        """Return how many slices may pass without a request; fewer if events are traced."""
        return self.free_slices(begins) if self._tells_nothing else int(begins)

    def other_line(self, place: int, after: Operation) -> Operation:
        """Return the operation of an `AT` instruction."""
        return then(partial(setattr, self._state, "statement", place), after)

    def proceed(self, after: Operation) -> Operation:
        """Return the operation of a `PROCEED` instruction."""
        return then(partial(setattr, self.counter, "guard", Guard.NEXT), after)

    # ----------------------------------------------------------------------- requests

    def ask(self, number: int, after: Operation) -> Operation:
        """Return the operation of an `ASK` instruction; in a condition, the reader answers it."""
        ask, state = self._program.asks[number], self._state
        if ask.name == "StopAdvance":
            return self._stop_advance(after)
        is_invoked = ask.name == "Invoke"
        arguments = arguments_of(ask.parts) if is_invoked else ()
        entry = Entry(self._program, state, ask.parts, arguments, ask.result)
        make = self._makers.parts(ask.parts)
        make_paths = self._makers.paths(arguments)
        kind: Any = getattr(requests, ask.name)

        def operation() -> Operation | None:
            block = entry.take()
            values, at = entry.values(block), self.at()
            request: Any = kind(at, *make(values, at))
            if is_invoked:
                request = replace(request, paths=make_paths(values, at))

            def completion(reply: Any) -> Operation | None:
                if is_invoked:
                    result, changes = reply
                    store = self._stores(entry, block, values, changes)
                    return self._stored(store, entry, block, result, after)
                entry.put(block, reply)
                return after

            if state.reader is not None:
                if ask.name != "Read":
                    raise LinkError(NOT_IN_CONDITIONS)
                return completion(state.reader(request.path))
            state.request, state.completion = _finished(request), completion
            state.site = after, block
            self.counter.asked()
            return None

        return operation

    def _stop_advance(self, after: Operation) -> Operation:
        state, counter = self._state, self.counter

        def completion(reply: object) -> Operation:
            if isinstance(reply, int) and not self.entered:  # the end of an action is reported once
                counter.allow(reply)
            return after

        def operation() -> Operation | None:
            if state.reader is not None or counter.passes_stop():
                return after
            state.request, state.completion = StopAdvance(self.at()), completion
            state.site = after
            counter.asked()
            return None

        return operation

    def builtin(self, number: int, after: Operation) -> Operation:
        """Return the operation of a `BUILTIN` instruction."""
        builtin, state = self._program.builtins[number], self._state
        function = FUNCTIONS.get(builtin.name.upper())
        if function is not None and all(self._is_real(part) for part in builtin.parts):
            return computed(function.function, len(builtin.parts), state.stack, after)
        entry = Entry(self._program, state, builtin.parts, builtin.parts, builtin.result)
        make, name = self._makers.parts(builtin.parts), builtin.name
        weight = WEIGHTS.get(name.upper(), 0)

        def operation() -> Operation | None:
            block = entry.take()
            values = entry.values(block)
            result, changes = call(name, make(values, _NOWHERE), self._surroundings)
            self.charge(weight)
            store = self._stores(entry, block, values, changes)
            return self._stored(store, entry, block, result, after)

        return operation

    def charge(self, weight: int) -> None:
        """Count a function; raise `interp.values.faults.BudgetExhausted`."""
        self._state.functions -= weight
        if self._state.functions < 0:
            raise self.overrun()

    def overrun(self) -> BudgetExhausted:
        """Return the exception to raise when functions have taken longer than they may."""
        return self._limits.overrun()

    def _is_real(self, part: Argument) -> bool:
        return (
            isinstance(part, Input)
            and part.mode is Mode.IN
            and self._program.types[part.type] == REAL
        )

    def _stores(
        self,
        entry: Entry,
        block: Block,
        values: Sequence[Value | None],
        changes: Mapping[int, Value],
    ) -> Iterator[Request]:
        """Store changed arguments; yield a write request for each that is a system variable."""
        for change in entry.changes:
            if change.argument not in changes:
                continue
            value = changes[change.argument]
            path = change.changed.path
            if path is None:
                entry.store(block, change, value)
                self._tell_changed(change)
            else:
                made = self._makers.path(path, change.first)(values, _NOWHERE)
                kept = converted(value, shown(entry.type_of(block, change)))
                yield Write(self.at(), made, kept)

    def _stored(
        self,
        stores: Iterator[Request],
        entry: Entry,
        block: Block,
        result: Value | None,
        after: Operation,
    ) -> Operation | None:
        """Make the requests in ``stores`` one by one, then store the result."""
        request = next(stores, None)
        if request is None:
            entry.put(block, result)
            return after
        if self._state.reader is not None:
            raise LinkError(NOT_IN_CONDITIONS)
        self._state.request = request
        self._state.completion = lambda _reply: self._stored(stores, entry, block, result, after)
        self.counter.asked()
        return None

    # ----------------------------------------------------------------------- trace

    def tell(self, instruction: Instruction, after: Operation) -> Operation:
        """Return the operation of a trace instruction; ``after`` if its events are not wanted."""
        branches = self._branches
        if instruction.op is not Op.TELL_BRANCH:
            is_wanted = self._assignments is not None
            return then(partial(self._tell_assigned, instruction), after) if is_wanted else after
        (way,) = instruction.operands
        return after if branches is None else then(lambda: branches.branch(self.at(), way), after)

    def _tell_assigned(self, instruction: Instruction) -> None:
        """Trace the assignment that a trace instruction stands for."""
        state, operands, types = self._state, instruction.operands, self._program.types
        match instruction.op:
            case Op.TELL_LOCAL:
                found = self._names.assigned(state.fp + operands[0], types[operands[1]])
            case Op.TELL_DATA:
                found = self._names.assigned(operands[0], types[operands[1]])
            case Op.TELL_REF:
                found = self._names.through(operands[0], types[operands[1]], operands[2])
            case _:
                found = self._names.assigned(state.last, types[operands[0]], operands[1])
        self._tell(found)

    def _tell_changed(self, change: Change) -> None:
        """Trace that a function has changed an argument."""
        if self._assignments is None:
            return
        given, through = change.changed.given, change.changed.through
        type_ = self._program.types[given.type]
        if through is None:
            found = self._names.assigned(self._state.last, type_, given.dimensions)
        else:
            found = self._names.through(through, type_, given.dimensions)
        self._tell(found)

    def _tell(self, found: tuple[Path, Value | None] | None) -> None:
        if found is not None and self._assignments is not None:
            self._assignments.assign(self.at(), *found)

    def tell_call(self, code: int) -> None:
        """Trace the call of a routine."""
        if self._calls is not None:
            self._calls.call(self.at(), self._program.codes[code].name)

    def tell_leave(self) -> None:
        """Trace the end of the current routine."""
        if self._returns is not None:
            self._returns.leave(self.at(), self.code().name)


def _finished(request: Request) -> Request:
    """Return the request with arrays of letters converted to texts."""
    if isinstance(request, MoveEmily):
        device, action = text_of(request.device), text_of(request.action)
        return replace(request, device=device, action=action)
    return request
