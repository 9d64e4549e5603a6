"""State shared by all routines of a running program, and the frame of each routine.

The execution of a routine is a generator: it yields a request and receives the reply, and it yields
a `Call` and receives the result. So calls do not nest on Python's stack, however deep they are in
KRL (a trampoline).
"""

from __future__ import annotations

from collections.abc import Callable, Generator
from dataclasses import dataclass
from typing import Any, NamedTuple, TypeVar

from grammar.semantics.scopes import Scope
from grammar.semantics.symbols import Symbol
from grammar.semantics.types import Type
from grammar.syntax import ast
from interp.port.events import Sink, wanting
from interp.port.requests import At, CodeHandle, Request, Slice
from interp.program.load import CheckedProgram, Guard, Limits, Routine, Unit
from interp.program.variables import MOST_CELLS, cells_of_routine
from interp.tree.places import LocalPlace, Place, SystemPlace
from interp.values.builtins import WEIGHTS, Randomness
from interp.values.faults import LinkError
from interp.values.values import ArrayValue, StructureValue, Value


@dataclass(frozen=True, slots=True, eq=False)
class Call:
    """A call of a routine with the places of its parameters; the reply is the result."""

    routine: Routine
    variables: dict[Symbol, Place]


_T = TypeVar("_T")
#: An execution: it yields requests and calls, and returns a result.
Steps = Generator[Request | Call, Any, _T]


@dataclass(slots=True, eq=False)
class Frame:
    """The frame of a running routine, or of an action or condition that was defined in one.

    ``variables`` are the parameters and local data. ``line`` is that of the statement that began
    last, ``cells`` the number of scalars in the variables.
    """

    unit: Unit
    name: str
    scope: Scope
    variables: dict[Symbol, Place]
    result: Type | None
    line: int
    cells: int = 0
    has_begun: bool = False

    def forget(self) -> None:
        """Remove the variables when the routine ends: an action that outlives it must not use them.

        A parameter that refers to a system variable stays, unless an index was computed for it.
        """
        for symbol, place in list(self.variables.items()):
            if not isinstance(place, SystemPlace) or place.is_indexed:
                del self.variables[symbol]

    def for_code(self, line: int) -> Frame:
        """Return a frame for an action or condition defined in this routine."""
        return Frame(self.unit, self.name, self.scope, self.variables, None, line)


@dataclass(frozen=True, slots=True)
class DeferredCode:
    """The code that a `CodeHandle` refers to, with the frame in which it was defined."""

    node: ast.Expression | ast.Assignment | ast.CallStatement | ast.Brake
    frame: Frame


class Round(NamedTuple):
    """The state when a loop, or a GOTO to a label, comes back to its place."""

    place: object
    changes: int
    guard: Guard
    begun: int


class ProgramState:
    """The state of a running program apart from its frames.

    ``depth`` is the number of open calls, ``cells`` the number of scalars in all variables. The
    attributes ``lines``, ``assignments``, ``calls``, ``returns`` and ``branches`` are the sink if
    it receives that kind of event, else ``None``. ``begun`` is the number of statements that have
    begun; the slice ends when it reaches ``due``. ``functions`` is the weight of functions that may
    be called before the program waits. ``changes`` counts everything that makes one pass of a loop
    differ from the previous one: new values, requests, random numbers, functions, events.
    """

    def __init__(
        self,
        program: CheckedProgram,
        limits: Limits | None = None,
        sink: Sink | None = None,
        random: Callable[[], float] | None = None,
    ) -> None:
        self.program = program
        self.limits = limits or Limits()
        self.lines, self.assignments = wanting(sink, "line"), wanting(sink, "assign")
        self.calls, self.returns = wanting(sink, "call"), wanting(sink, "return")
        self.branches = wanting(sink, "branch")
        self._random = random or Randomness()
        self.data: dict[Symbol, LocalPlace] = {}
        self.depth = 0
        self.cells = 0
        self.guard = Guard.OFF
        self.skips = self.limits.skips_failures
        self.begun = 0
        self.due = self.limits.per_slice
        self.functions = self.limits.functions
        self.changes = 0
        self._sizes: dict[Routine, int] = {}
        self._codes: list[DeferredCode] = []
        self._numbers: dict[tuple[ast.Node, Frame], int] = {}

    def at(self, frame: Frame) -> At:
        """Return the place that the program has reached in a frame."""
        return At(frame.unit.module.path, frame.line, self.depth)

    def begin(self, frame: Frame, line: int) -> Steps[None]:
        """Count and report a statement that begins; request a `Slice` first if one is due."""
        frame.line, frame.has_begun = line, True
        self.guard = Guard.NOW if self.guard is Guard.NEXT else Guard.OFF
        if self.begun >= self.limits.statements:
            raise self.limits.exhausted()
        if self.begun >= self.due:
            yield Slice(self.at(frame))
        self.begun += 1
        if self.lines is not None:
            self.lines.line(self.at(frame))

    def changed(self) -> None:
        """Note that this pass of a loop differs from the one before."""
        self.changes += 1

    def charge(self, function: str) -> None:
        """Count a predefined function, or the operator ``:``; raise `BudgetExhausted`."""
        if weight := WEIGHTS.get(function, 0):
            self.changed()
            self.functions -= weight
            if self.functions < 0:
                raise self.limits.overrun()

    def asked(self) -> None:
        """Begin a new slice, after any request."""
        self.due = self.begun + self.limits.per_slice
        self.changed()

    def stored(self, old: Value | None, new: Value | None) -> None:
        """Note that a value was stored in place of another."""
        # Compared as text, because 1, 1.0 and TRUE are equal in Python, and so are 0.0 and -0.0.
        if isinstance(new, StructureValue | ArrayValue) or repr(old) != repr(new):
            self.changed()

    def random(self) -> float:
        """Return the next random number, in [0, 1)."""
        self.changed()
        return self._random()

    def again(self, place: object, last: Round | None) -> Round:
        """Note that a loop is back at a place, and skip the passes that would change nothing.

        If nothing has changed since ``last``, no later pass changes anything before the slice ends.
        All whole passes that fit into the slice are counted as begun, so that the requests stay the
        same, and so does the statement at which the budget ends.
        """
        is_shown = self.lines is not None or self.assignments is not None
        now = Round(place, self.changes, self.guard, self.begun)
        if last is not None and last[:-1] == now[:-1] and not is_shown:
            size = self.begun - last.begun
            free = min(self.due, self.limits.statements) - self.begun
            self.begun += max(free, 0) // size * size
        return now

    def size_of(self, routine: Routine) -> int:
        """Return the number of scalars in the parameters and local data of a routine."""
        size = self._sizes.get(routine)
        if size is None:
            size = self._sizes[routine] = cells_of_routine(self.program, routine)
        return size

    def has_room(self, routine: Routine) -> bool:
        """Return whether the variables of a routine fit into the memory that is left."""
        return self.cells + self.size_of(routine) <= MOST_CELLS

    def defer(
        self, node: ast.Expression | ast.Assignment | ast.CallStatement | ast.Brake, frame: Frame
    ) -> CodeHandle:
        """Return the handle of code that is to run later in this frame; equal for equal code."""
        number = self._numbers.setdefault((node, frame), len(self._codes))
        if number == len(self._codes):
            self._codes.append(DeferredCode(node, frame))
        return CodeHandle(number)

    def deferred(self, code: CodeHandle) -> DeferredCode:
        """Return the code that a handle refers to."""
        return self._codes[code.number]


def at_once(steps: Steps[_T]) -> _T:
    """Return the result of an execution without requests; raise `LinkError` if it makes one."""
    try:
        next(steps)
    except StopIteration as done:
        result: _T = done.value
        return result
    raise LinkError("an initial value needs a running program")
