"""State shared by all routines of a running program, and the frame of each.

Executing a routine is a generator: it yields a request and is sent the reply, and it yields a
`Call` and is sent the result. So calls do not nest in Python, however deep they are in KRL.
"""

from __future__ import annotations

from collections.abc import Callable, Generator
from dataclasses import dataclass
from enum import Enum
from typing import Any, NamedTuple, TypeVar

from grammar.semantics.scopes import Scope
from grammar.semantics.symbols import Symbol
from grammar.semantics.types import Type
from grammar.syntax import ast
from interp.port.events import Sink, wanting
from interp.port.requests import At, CodeHandle, Request, Slice
from interp.program.load import CheckedProgram, Limits, Routine, Unit
from interp.program.variables import cells_of_routine
from interp.tree.places import LocalPlace, Place, SystemPlace
from interp.values.builtins import Randomness
from interp.values.faults import LinkError


@dataclass(frozen=True, slots=True, eq=False)
class Call:
    """A routine is to be called with its parameters; what is sent back is its result."""

    routine: Routine
    variables: dict[Symbol, Place]


_T = TypeVar("_T")
#: What execution is: asks and calls on the way, and has a result.
Steps = Generator[Request | Call, Any, _T]


@dataclass(slots=True, eq=False)
class Frame:
    """A routine that runs, or an action or condition in the frame it was made in.

    ``variables`` are parameters and local data. ``line`` is that of the statement that began last.
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
        """The routine ends, so that an action that outlives it does not find its variables.

        Parameters that stand for a system variable do so still, if no index was worked out for it.
        """
        for symbol, place in list(self.variables.items()):
            if not isinstance(place, SystemPlace) or place.is_indexed:
                del self.variables[symbol]

    def for_code(self, line: int) -> Frame:
        """A frame for a piece of this routine that is run apart."""
        return Frame(self.unit, self.name, self.scope, self.variables, None, line)


@dataclass(frozen=True, slots=True)
class Handed:
    """What a `CodeHandle` stands for."""

    node: ast.Expression | ast.Assignment | ast.CallStatement | ast.Brake
    frame: Frame


class Guard(Enum):
    """Whether ON_ERROR_PROCEED holds: for the statement that begins next, or for the one now."""

    OFF = 0
    NEXT = 1
    NOW = 2


class Round(NamedTuple):
    """What holds where a loop, or a GOTO to a label, is back at its place."""

    place: object
    changes: int
    guard: Guard
    begun: int


class ProgramState:
    """The state of a program apart from its frames.

    ``depth`` is how many calls deep it is, ``cells`` how many scalars its variables can hold. The
    sink is there once for each kind of event, where it wants that kind. ``begun`` are the
    statements that have begun, ``due`` is when as many have begun as end the slice. ``changes``
    counts what sets a round of a loop apart from the last: new values, requests, chance, events.
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
        self.changes = 0
        self._sizes: dict[Routine, int] = {}
        self._codes: list[Handed] = []
        self._numbers: dict[tuple[ast.Node, Frame], int] = {}

    def at(self, frame: Frame) -> At:
        """Where the program is."""
        return At(frame.unit.module.path, frame.line, self.depth)

    def begin(self, frame: Frame, line: int) -> Steps[None]:
        """A statement begins: it is counted and reported, and time may pass before it."""
        frame.line, frame.has_begun = line, True
        self.guard = Guard.NOW if self.guard is Guard.NEXT else Guard.OFF
        if self.begun >= self.limits.statements:
            raise self.limits.exhausted()
        if self.begun >= self.due:
            yield Slice(self.at(frame))
        self.begun += 1
        if self.lines is not None:
            self.lines.line(self.at(frame))

    def asked(self) -> None:
        """A request was made: a new slice begins."""
        self.due = self.begun + self.limits.per_slice
        self.changes += 1

    def random(self) -> float:
        """The next number by chance."""
        self.changes += 1
        return self._random()

    def again(self, place: object, last: Round | None) -> Round:
        """A loop is back at a place: where a round has changed nothing, neither will the next.

        All whole rounds that are left in the slice then count as begun, so that the requests and
        the statement at which the budget ends are the same.
        """
        is_shown = self.lines is not None or self.assignments is not None
        now = Round(place, self.changes, self.guard, self.begun)
        if last is not None and last[:-1] == now[:-1] and not is_shown:
            size = self.begun - last.begun
            free = min(self.due, self.limits.statements) - self.begun
            self.begun += max(free, 0) // size * size
        return now

    def size_of(self, routine: Routine) -> int:
        """How many cells the parameters and local data of a routine have."""
        size = self._sizes.get(routine)
        if size is None:
            size = self._sizes[routine] = cells_of_routine(self.program, routine)
        return size

    def hand(
        self, node: ast.Expression | ast.Assignment | ast.CallStatement | ast.Brake, frame: Frame
    ) -> CodeHandle:
        """A piece of program to be run later, in this frame; always the same for the same."""
        number = self._numbers.setdefault((node, frame), len(self._codes))
        if number == len(self._codes):
            self._codes.append(Handed(node, frame))
        return CodeHandle(number)

    def handed(self, code: CodeHandle) -> Handed:
        """What a `CodeHandle` stands for."""
        return self._codes[code.number]


def at_once(steps: Steps[_T]) -> _T:
    """The result of what needs no world; raises `LinkError` where it does."""
    try:
        next(steps)
    except StopIteration as done:
        result: _T = done.value
        return result
    raise LinkError("an initial value needs a running program")
