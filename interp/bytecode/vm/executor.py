"""The bytecode machine: runs a verified program behind the port of `interp.port.executor`.

It runs operation after operation (see `interp.bytecode.vm.threaded_code`) until one of them stores
a request in the state and returns no next operation.

If ON_ERROR_PROCEED is active, a fault is stored in ``$ERR.NUMBER`` by a write request: the number
of its message, or 1 if it has none. The routine then continues after the failed statement. RESUME
continues in the same way after the statement to which it returns.
"""

from __future__ import annotations

import marshal
from collections.abc import Callable

from interp.bytecode._generated.opcodes import Op
from interp.bytecode.cell_layout import Raw
from interp.bytecode.instruction_set.table import MAX_CELLS
from interp.bytecode.program import CodeKind, Program
from interp.bytecode.verifier.verify import Verified
from interp.bytecode.vm.frames import Frames
from interp.bytecode.vm.names import InFrame, Names
from interp.bytecode.vm.services import NOT_IN_CONDITIONS, Services
from interp.bytecode.vm.state import Completion, Operation, State
from interp.bytecode.vm.threaded_code import ThreadedCode
from interp.port.events import Sink
from interp.port.executor import Reader
from interp.port.inspection import Breaks, InspectedValue, StackFrame
from interp.port.requests import (
    At,
    CodeHandle,
    Crash,
    End,
    Fail,
    Request,
    Skip,
    Slice,
    StopAdvance,
    Value,
    Write,
)
from interp.program.load import Guard, Limits
from interp.values.builtins import Randomness
from interp.values.faults import Fault, LinkError, RuntimeFailure
from support.lazy_dataclass import dataclass


@dataclass(frozen=True, slots=True)
class _Open:
    """How the machine continues: with an operation, or after the reply to a request.

    ``is_asked`` says whether the request was made again since the last interruption of the program.
    """

    operation: Operation | None = None
    request: Request | None = None
    completion: Completion | None = None
    is_asked: bool = False


@dataclass(frozen=True, slots=True)
class _Entered:
    """What `Machine.enter` has interrupted, and the number of open calls at that time.

    ``final`` is the final request if the program has ended already; the arm may still move then.
    """

    calls: int
    open: _Open
    guard: Guard
    final: Request | None


class Machine:
    """Runs a verified program, beginning with a routine that has no parameters.

    The routine is given by its name or by the number of its code object. ``beside`` is a machine
    that runs the same program and shares its data lists: one list of cells begins with the data
    lists, and the frames of each machine follow in a range of their own. Raises `LinkError` if the
    routine is missing or has parameters.
    """

    def __init__(
        self,
        verified: Verified,
        routine: str | int,
        limits: Limits | None = None,
        sink: Sink | None = None,
        random: Callable[[], float] | None = None,
        *,
        beside: Machine | None = None,
    ) -> None:
        program = verified.program
        self._verified = verified
        self._limits = limits = limits or Limits()
        self._random = random or Randomness()
        self._sink = sink
        self._program = program
        self._together: list[Machine] = [] if beside is None else beside._together
        self._state = self._made_state(limits)
        self._together.append(self)
        self._services = Services(program, self._state, limits, sink, self._random)
        self._services.leave_action, self._services.finish = self._leave_action, self._finish
        self._threaded = self._made_ready(program)
        self._frames = self._made_frames()
        self._entered: list[_Entered] = []
        self._final: Request | None = None
        number = _routine(program, routine.upper() if isinstance(routine, str) else routine)
        self._begin(number)
        self._first = self._state.fp
        self._open = _Open(self._threaded.entries[number])

    # ----------------------------------------------------------------------- parts

    def _made_state(self, limits: Limits) -> State:
        """Return the state; ``self._together`` are the machines that share the data lists."""
        program = self._program
        count, data = len(self._together), program.addresses[-1]
        if count == 0:
            return State(list(program.cells), limits.depth, data, MAX_CELLS)
        cells = self._together[0]._state.cells
        first = count * MAX_CELLS
        cells += [None] * (first - len(cells))
        return State(cells, limits.depth, first, first + MAX_CELLS - data)

    def _made_frames(self) -> Frames:
        return Frames(self._program, self._state)

    def _begin(self, number: int) -> None:
        self._frames.begin(number)

    def _made_ready(self, program: Program) -> ThreadedCode:
        return ThreadedCode(program, self._state, self._services)

    # ----------------------------------------------------------------------- the port

    @property
    def free_slices(self) -> Callable[[bool], int]:
        """See `interp.port.executor.SliceScheduling`."""
        return self._services.free_slices

    @free_slices.setter
    def free_slices(self, asked: Callable[[bool], int]) -> None:
        self._services.free_slices = asked

    @property
    def depth(self) -> int:
        """The depth of calls; 0 in the first routine."""
        return self._services.depth

    def data(self) -> list[Raw | None]:
        """Return the contents of the cells of the data lists."""
        return self._state.cells[: self._program.addresses[-1]]

    def advance(self, reply: Value | Fault | None = None) -> Request:
        """Run until the next request; see `interp.port.executor.Executor`."""
        if self._final is not None:
            return self._final
        now, state = self._open, self._state
        if now.request is not None and not now.is_asked:
            self._open = _Open(None, now.request, now.completion, is_asked=True)
            return now.request
        state.request = state.completion = state.site = None
        try:
            self._run(now.operation if now.completion is None else _given(now.completion, reply))
        except Exception as error:  # a defect of ours, reported as one
            state.completion = None
            state.request = Crash(self._services.at(), f"{type(error).__name__}: {error}")
        request = state.request
        assert request is not None, "a machine stops for a request"
        passed = self._passed(request.at)
        if state.completion is not None:
            self._open = _Open(None, request, state.completion, is_asked=passed is None)
        elif isinstance(request, Fail | Crash):
            self._final = request
        return passed or request

    def _passed(self, at: At) -> Request | None:
        """Return the request that reports slices or advance stops that have passed, if any."""
        counter = self._services.counter
        if stops := counter.stopped():
            return StopAdvance(at, stops)
        slices = counter.passed()
        return Slice(at, slices) if slices else None

    def enter(self, code: CodeHandle) -> None:
        """Start an action, which runs before the program continues.

        If the routine that created the action has ended, the action finds no variables.
        """
        state, counter, before = self._state, self._services.counter, self._open
        if before.request is not None:  # it will be asked again
            before = _Open(None, before.request, before.completion)
        number, serial = self._frames.of_handle(code, CodeKind.ACTION)
        self._frames.open(number, serial, self._threaded.entries[number])
        self._entered.append(_Entered(len(state.calls), before, counter.guard, self._final))
        self._final = None
        self._services.entered += 1
        state.most_calls += 1
        counter.guard = Guard.OFF
        self._open = _Open(self._threaded.entries[number])

    def evaluate(self, code: CodeHandle, read: Reader) -> Value:
        """Return the value of a condition; raises `interp.values.faults.Fault`."""
        state = self._state
        number, serial = self._frames.of_handle(code, CodeKind.CONDITION)
        height, calls, guard = len(state.stack), len(state.calls), self._services.counter.guard
        functions = state.functions
        operation: Operation | None = self._threaded.entries[number]
        self._frames.open(number, serial, lambda: None)
        self._services.counter.guard = Guard.OFF  # it holds for a statement, and this is none
        state.reader = read
        state.most_calls += 1
        self._services.entered += 1
        try:
            while operation is not None:
                operation = operation()
            return bool(state.stack[-1])
        except Fault:
            if self._services.counter.guard is Guard.NOW:  # it would be noted, which is to write
                raise LinkError(NOT_IN_CONDITIONS) from None
            raise
        finally:
            state.reader, state.functions = None, functions
            self._services.counter.guard = guard
            state.most_calls -= 1
            self._services.entered -= 1
            del state.stack[height:]
            while len(state.calls) > calls:
                self._frames.close()

    def companion(self, routine: str, sink: Sink | None = None) -> Machine:
        """Return another machine with the same data lists; see `interp.port.executor.Executor`."""
        return type(self)(
            self._verified, routine, self._limits, sink, self._random, beside=self._together[0]
        )

    def waited(self) -> None:
        """Count functions anew; see `interp.port.executor.Executor`."""
        self._services.counter.waited()

    def unwind(self, depth: int) -> None:
        """Leave all routines deeper than ``depth``, with the actions entered in them [INT-10]."""
        while self.depth > depth or self._is_in_action():
            self._leave_frame()
        self._services.counter.guard = Guard.OFF
        self._open = _Open(self._behind_statement())

    # ----------------------------------------------------------------------- skipping

    def recurrence_state(self) -> object | None:
        """Return everything that determines the continuation; see `interp.port.executor`."""
        now, state, counter, random = self._open, self._state, self._services.counter, self._random
        counted = counter.recurrence_state
        is_known = state.site is not None and now.request is not None and not self._entered
        if counted is None or not is_known or not isinstance(random, Randomness):
            return None
        return counted, state.site, repr(now.request), now.is_asked, random.state, self._memory()

    def _memory(self) -> object:
        """Return the current frame, the open calls, the data lists and the cells of all frames."""
        state, data = self._state, self._program.addresses[-1]
        end = state.fp + self._program.frames[state.code]
        cells = state.cells[:data], state.cells[self._first : end], state.stack
        frame = state.code, state.fp, state.base, state.statement, state.serial, state.serials
        counts = state.left, state.quota, state.whole, state.stops
        # As bytes, because 1, 1.0 and TRUE are equal in Python, and so are 0.0 and -0.0.
        return frame, counts, tuple(state.calls), marshal.dumps(cells, 2)

    @property
    def spare(self) -> int:
        """The number of statements that may be skipped."""
        return self._services.counter.spare

    def skip(self, statements: int) -> None:
        """Count this number of statements as begun."""
        self._services.counter.skip(statements)

    # ----------------------------------------------------------------------- inspection

    @property
    def begun(self) -> int:
        """The number of statements that have begun."""
        return self._services.counter.begun

    def ask_at(self, count: int) -> None:
        """End the current slice when this number of statements has begun in all."""
        self._services.counter.ask_at(count)

    def break_at(self, places: Breaks) -> bool:
        """Return whether there are no breakpoints: this machine cannot stop before statements."""
        return not places

    def frames(self) -> tuple[StackFrame, ...]:
        """Return the open frames; see `interp.port.inspection`."""
        found: list[StackFrame] = []
        depth, actions = self.depth, {one.calls for one in self._entered}
        for number in range(len(self._state.calls) + 1):
            code, _, statement = self._frames.at(number)
            code_object = self._program.codes[code]
            line = code_object.line
            if statement >= 0:
                line = code_object.instructions[statement].operands[0]
            is_action = len(self._state.calls) - number in actions
            owner = (
                code_object if code_object.owner is None else self._program.codes[code_object.owner]
            )
            found.append(StackFrame(owner.name, At(code_object.file, line, depth), is_action))
            depth -= not is_action
        return tuple(found)

    def look(self, text: str, frame: int = 0) -> InspectedValue | None:
        """Return a variable as seen from a frame; see `interp.port.inspection`."""
        return self._names(frame).look(text)

    def put(self, text: str, value: Value, frame: int = 0) -> None:
        """Assign a value to a variable; see `interp.port.inspection`."""
        self._names(frame).put(text, value)

    def _names(self, number: int) -> Names:
        code, first, _ = self._frames.at(number)
        return Names(self._program, InFrame(self._state.cells, code, first))

    def select(self, line: int) -> None:
        """Continue at a line of the current routine; see `interp.port.inspection`."""
        state = self._state
        instructions = self._program.codes[state.code].instructions
        for place, one in enumerate(instructions):
            if one.op is Op.LINE and one.operands[0] == line:
                del state.stack[state.base :]
                self._services.counter.guard = Guard.OFF
                self._open = _Open(self._threaded.body(state.code)[place])
                return
        raise ValueError(f"no statement begins in line {line}")

    # ----------------------------------------------------------------------- running

    def _run(self, operation: Operation | None) -> None:
        """Run operations until one stops for a request."""
        try:
            while operation is not None:
                operation = operation()
        except RuntimeFailure as error:
            self._failed(error)

    def _failed(self, error: RuntimeFailure) -> None:
        """Handle a failure: record or skip the fault if allowed, otherwise end the program."""
        state, services = self._state, self._services
        is_fault = isinstance(error, Fault)
        # Behind the last statement of a function.
        is_late = isinstance(error, Fault) and error.slug == "no_result" and state.statement >= 0
        is_noted = is_fault and services.counter.guard is Guard.NOW and not is_late
        is_skipped = not is_noted and self._limits.skips_failures and error.is_of_statement
        if is_late and is_skipped and self.depth:
            self._leave_frame()
            is_late = False
        if is_late or not (is_noted or is_skipped):
            state.request, state.completion = Fail(services.at(), error), None
            return
        if is_noted:
            services.counter.guard = Guard.OFF
        while state.statement < 0:  # a routine in which no statement has begun
            self._leave_frame()
        state.request = (
            Write(services.at(), ("$ERR", "NUMBER"), getattr(error, "number", None) or 1)
            if is_noted
            else Skip(services.at(), error)
        )
        state.completion = lambda _reply: self._behind_statement()
        services.counter.asked()

    def _behind_statement(self) -> Operation:
        """Return the operation after the last statement that began in the current frame."""
        state = self._state
        del state.stack[state.base :]
        _, target = self._program.codes[state.code].instructions[state.statement].operands
        return self._threaded.body(state.code)[target]

    # ----------------------------------------------------------------------- actions

    def _is_in_action(self) -> bool:
        return bool(self._entered) and self._entered[-1].calls == len(self._state.calls)

    def _leave_frame(self) -> None:
        """Drop the current frame and, if it is an action, what the action has interrupted."""
        if self._is_in_action():
            self._forget_entered()
        self._frames.close()

    def _forget_entered(self) -> _Entered:
        self._services.entered -= 1
        self._state.most_calls -= 1
        return self._entered.pop()

    def _leave_action(self) -> None:
        """End an action: what it has interrupted continues, or makes its request again."""
        self._state.request = End(self._services.at())
        self._frames.close()
        entered = self._forget_entered()
        self._services.counter.guard = entered.guard
        self._open, self._final = entered.open, entered.final

    def _finish(self) -> None:
        """End the program, because its first routine has ended."""
        self._state.request = self._final = End(self._services.at())


def _given(completion: Completion, reply: Value | Fault | None) -> Operation:
    """Return the operation that passes a reply to a completion."""

    def operation() -> Operation | None:
        if isinstance(reply, Fault):
            raise reply
        return completion(reply)

    return operation


def _routine(program: Program, routine: str | int) -> int:
    """Return the number of the first routine with this name; raises `LinkError`."""
    for number, code in enumerate(program.codes):
        if routine not in (number, code.name.upper()) or code.kind is not CodeKind.ROUTINE:
            continue
        if code.parameters:
            raise LinkError(f"{code.name} has parameters, so a program cannot begin with it")
        return number
    raise LinkError(f"there is no routine {routine}")
