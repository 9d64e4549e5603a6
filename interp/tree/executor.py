"""The tree interpreter as an executor: a stack of running routines, each a generator.

A call or an interrupt pushes a routine, and RESUME pops routines. Python's own stack grows only
with the nesting of blocks and expressions within one routine.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from interp.port.events import Sink
from interp.port.executor import Reader
from interp.port.inspection import Breaks, InspectedValue, StackFrame
from interp.port.requests import (
    At,
    CodeHandle,
    Crash,
    End,
    Fail,
    Read,
    Request,
    Slice,
    StopAdvance,
    Value,
)
from interp.program.load import CheckedProgram, Guard, Limits
from interp.program.statement_paths import routine_at, way_to
from interp.program.variables import too_large
from interp.tree.memory import fill_data
from interp.tree.program_state import Call, Frame, ProgramState, Steps
from interp.tree.statements import Resumed, Selected, Statements
from interp.values.faults import Fault, LinkError, RuntimeFailure, fault


@dataclass(frozen=True, slots=True)
class _Interrupted:
    """The state of the executor that an action has interrupted and that its end restores.

    ``request`` is the open request, ``resumed`` a pending RESUME or block selection, and ``guard``
    the state of ON_ERROR_PROCEED. ``final`` is set if the program had ended, and
    ``resumed_at_end`` if RESUME had returned to its end: actions may still run then, because the
    arm may still move.
    """

    request: Request | None
    resumed: Resumed | Selected | None
    guard: Guard
    final: Request | None
    resumed_at_end: Request | None


@dataclass(slots=True, eq=False)
class _Active:
    """A routine or an action on the stack; ``interrupted`` is set for an action."""

    steps: Steps[Any]
    frame: Frame
    interrupted: _Interrupted | None = None


class TreeExecutor:
    """Runs a checked program from a routine of its main file (`interp.port.executor.Executor`).

    ``routine`` defaults to the first routine. ``beside`` is an executor of the same program, whose
    data lists this one shares. Raises `LinkError` if the program cannot begin.
    """

    def __init__(
        self,
        program: CheckedProgram,
        routine: str | None = None,
        limits: Limits | None = None,
        sink: Sink | None = None,
        random: Callable[[], float] | None = None,
        *,
        beside: TreeExecutor | None = None,
    ) -> None:
        self._run = ProgramState(program, limits, sink, random)
        if beside is not None:
            self._run.data, self._run.cells = beside._run.data, beside._data_cells
        else:
            fill_data(self._run)
        self._data_cells: int = self._run.cells
        start = program.start(routine)
        is_large = not self._run.has_room(start)
        self._stack = [self._active(Call(start, {}))]
        self._open: Request | None = None
        self._is_asked = False
        self._resumed: Resumed | Selected | None = None
        self._resumed_at_end: Request | None = None
        self._final: Request | None = Fail(self._at(), too_large(start)) if is_large else None

    # ----------------------------------------------------------------------- the port

    @property
    def depth(self) -> int:
        """The number of open calls; 0 in the routine that the program began with."""
        return self._run.depth

    def advance(self, reply: Value | Fault | None = None) -> Request:
        """Run until the controller is needed; see `interp.port.executor.Executor`."""
        if self._resumed_at_end is not None:
            if self._run.returns is not None:
                self._run.returns.leave(self._at(), self._top.frame.name)
            self._final, self._resumed_at_end = self._resumed_at_end, None
        if self._final is not None:
            return self._final
        if self._open is not None and not self._is_asked:
            self._is_asked = True
            return self._open
        answer: Any = self._resumed or reply
        self._open, self._resumed = None, None
        try:
            request = self._advanced(answer)
        except RuntimeFailure as error:  # a routine failed before its generator began
            request = Fail(self._at(), error)
        except Exception as error:  # a defect of this interpreter, reported as one
            request = Crash(self._at(), f"{type(error).__name__}: {error}")
        if isinstance(request, Fail | Crash):
            self._final = request
        elif not isinstance(request, End):
            self._run.asked()
            self._open, self._is_asked = request, True
        return request

    def enter(self, code: CodeHandle) -> None:
        """Push an action, which runs before the program continues."""
        deferred, run = self._run.deferred(code), self._run
        frame = deferred.frame.for_code(deferred.frame.unit.line(deferred.node))
        node: Any = deferred.node
        steps = Statements(run, frame).action(node)
        interrupted = _Interrupted(
            self._open, self._resumed, run.guard, self._final, self._resumed_at_end
        )
        self._stack.append(_Active(steps, frame, interrupted))
        self._open, self._resumed, run.guard = None, None, Guard.OFF
        self._final = self._resumed_at_end = None

    def evaluate(self, code: CodeHandle, read: Reader) -> Value:
        """Return the value of a condition; raise `interp.values.faults.Fault`.

        A function called in the condition may only compute and read; anything else raises
        `LinkError`.
        """
        deferred, guard = self._run.deferred(code), self._run.guard
        depth, cells, skips = self._run.depth, self._run.cells, self._run.skips
        functions = self._run.functions  # how often a condition is evaluated differs
        self._run.skips = False
        frame = deferred.frame.for_code(deferred.frame.unit.line(deferred.node))
        node: Any = deferred.node
        stack = [_Active(Statements(self._run, frame).truth(node), frame)]
        reply: Any = None
        try:
            while stack:
                try:
                    asked = _resume(stack[-1].steps, reply)
                except StopIteration as done:
                    done_with = stack.pop()
                    if stack:
                        self._popped(done_with)
                    reply = done.value
                    continue
                reply = self._reply_to_condition(asked, read, stack)
        finally:
            self._run.guard, self._run.depth, self._run.cells = guard, depth, cells
            self._run.skips, self._run.functions = skips, functions
        value: Value = reply
        return value

    def waited(self) -> None:
        """Count functions anew; see `interp.port.executor.Executor`."""
        self._run.functions = self._run.limits.functions

    def companion(self, routine: str, sink: Sink | None = None) -> TreeExecutor:
        """Return another executor over the same data lists."""
        run = self._run
        return TreeExecutor(run.program, routine, run.limits, sink, run.random, beside=self)

    def unwind(self, depth: int) -> None:
        """Leave all routines deeper than ``depth``, and the actions that were entered there.

        A program that had already ended then ends again.
        """
        while self._run.depth > depth or self._top.interrupted is not None:
            active = self._stack.pop()
            self._popped(active)
            below = active.interrupted
            self._resumed_at_end = (below.final or below.resumed_at_end) if below else None
        self._open, self._resumed = None, Resumed()

    # ----------------------------------------------------------------------- inspection

    @property
    def begun(self) -> int:
        """The number of statements that have begun."""
        return self._run.begun

    def ask_at(self, count: int) -> None:
        """End the present slice once ``count`` statements have begun; see `Inspectable`."""
        self._run.due = count

    def break_at(self, places: Breaks) -> bool:
        """Return whether there are no breakpoints: this interpreter does not support them."""
        return not places

    def frames(self) -> tuple[StackFrame, ...]:
        """Return the call stack; see `interp.port.inspection`."""
        found: list[StackFrame] = []
        depth = self._run.depth
        for active in reversed(self._stack):
            frame, is_action = active.frame, active.interrupted is not None
            at = At(frame.unit.module.path, frame.line, depth)
            found.append(StackFrame(frame.name, at, is_action))
            depth -= not is_action
        return tuple(found)

    def look(self, text: str, frame: int = 0) -> InspectedValue | None:
        """Look up a variable in a frame; see `interp.port.inspection`."""
        return Statements(self._run, self._stack[-1 - frame].frame).look(text)

    def put(self, text: str, value: Value, frame: int = 0) -> None:
        """Assign a value to a variable; see `interp.port.inspection`."""
        place = Statements(self._run, self._stack[-1 - frame].frame).place_of(text)
        if place is None:
            raise LinkError(f"{text} is not known here")
        place.set(value)

    def select(self, line: int) -> None:
        """Continue at a line of the running routine; see `interp.port.inspection`."""
        frame = self._top.frame
        routine = routine_at(self._run.program, frame.unit.module.path, frame.name)
        way = () if routine is None else way_to(routine, line)
        if not way:
            raise ValueError(f"no statement begins in line {line}")
        self._run.guard = Guard.OFF
        self._open, self._resumed = None, Selected(way)

    # ----------------------------------------------------------------------- the stack

    @property
    def _top(self) -> _Active:
        return self._stack[-1]

    def _advanced(self, reply: Any) -> Request:
        """Run the routine on top of the stack until it makes a request or the stack has ended."""
        while True:
            active = self._top
            try:
                asked = _resume(active.steps, reply)
            except StopIteration as done:
                if active.interrupted is not None or len(self._stack) == 1:
                    return self._ended(active)
                self._popped(self._stack.pop())
                reply = done.value
                continue
            except RuntimeFailure as error:
                if not self._fails_in_caller(active, error):
                    return Fail(self._at(), error)
                self._popped(self._stack.pop())
                reply = error
                continue
            if not isinstance(asked, Call):
                return asked
            reply = self._called(asked, self._stack)

    def _called(self, call: Call, stack: list[_Active]) -> Fault | None:
        """Push a routine; return ``None``, or a fault if the stack or the memory is full."""
        run = self._run
        if run.depth >= run.limits.depth or not run.has_room(call.routine):
            return fault("stack")
        if run.calls is not None:
            run.changed()
            run.calls.call(self._run.at(stack[-1].frame), call.routine.name)
        stack.append(self._active(call))
        self._run.depth += 1
        return None

    def _active(self, call: Call) -> _Active:
        routine = call.routine
        line = routine.unit.line(routine.node)
        frame = Frame(
            *(routine.unit, routine.name, routine.scope, call.variables),
            self._run.program.result_of(routine),
            line,
            self._run.size_of(routine),
        )
        self._run.cells += frame.cells
        return _Active(Statements(self._run, frame).routine(routine.node), frame)

    def _fails_in_caller(self, active: _Active, error: RuntimeFailure) -> bool:
        """Return whether a failure of a called routine is a failure of the calling statement.

        This is so if the routine faults before its first statement. If failures are skipped, it is
        also so for a function that ends without a result.
        """
        run = self._run
        if not isinstance(error, Fault) or active.interrupted is not None or len(self._stack) == 1:
            return False
        is_taken = run.guard is Guard.NOW or run.skips
        return (is_taken and not active.frame.has_begun) or (
            run.skips and error.slug == "no_result"
        )

    def _popped(self, active: _Active) -> None:
        """Update the state after a routine or an action was popped from the stack."""
        if active.interrupted is None:
            self._run.depth -= 1
            self._run.cells -= active.frame.cells
            active.frame.forget()

    def _ended(self, active: _Active) -> Request:
        """Return the `End` of an action or the program; restore what an action interrupted."""
        end = End(self._at())
        if active.interrupted is None:
            self._final = end
            return end
        self._stack.pop()
        self._run.guard = active.interrupted.guard
        self._open, self._is_asked = active.interrupted.request, False
        self._resumed = active.interrupted.resumed
        self._resumed_at_end = active.interrupted.resumed_at_end
        return end

    def _at(self) -> At:
        return self._run.at(self._top.frame)

    def _reply_to_condition(self, asked: Request | Call, read: Reader, stack: list[_Active]) -> Any:
        """Return the reply to a request, or start the call, that a condition makes."""
        match asked:
            case Call():
                return self._called(asked, stack)
            case Read():
                try:
                    return read(asked.path)
                except Fault as error:
                    return error
            case Slice() | StopAdvance():
                return None
        raise LinkError("a condition can only compute and read")


def _resume(steps: Steps[Any], reply: Any) -> Request | Call:
    """Resume a generator with a reply, or with an exception to be raised in it."""
    return steps.throw(reply) if isinstance(reply, Exception) else steps.send(reply)
