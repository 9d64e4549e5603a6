"""The writer of a random routine: its lines, what they cost, and the tables of rules for them.

The rules in `expressions`, `statements`, `control_flow` and `motions` call one another through
these tables, which `style` fills.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Final

from grammar.generation.choices import Choices, Weighted
from grammar.generation.scope import Scope
from grammar.semantics.types import Type

_INDENT: Final = "  "
#: Returns an expression; the number is the greatest depth of nesting.
ExpressionRule = Callable[["RoutineWriter", int], str]
#: Writes a statement; returns ``False`` and writes nothing if the scope lacks what it needs.
StatementRule = Callable[["RoutineWriter"], bool]


@dataclass(frozen=True, slots=True)
class Style:
    """What programs choose from, and how often.

    Every loop is bounded by its own counter, numbers are kept small, and the cost of all executed
    statements is counted, so that a program terminates without input.
    """

    #: Rules for expressions of a type other than atoms, calls and functions.
    expressions: Mapping[Type, Weighted[ExpressionRule]]
    #: Functions and variables of the controller.
    functions: Mapping[Type, Weighted[ExpressionRule]]
    relations: Weighted[ExpressionRule]
    statements: Weighted[StatementRule]
    #: Statements after ON_ERROR_PROCEED.
    risky: Weighted[StatementRule]


class Names:
    """Names that consist of a letter and a number, and a suffix that tells programs apart."""

    def __init__(self, suffix: str = "") -> None:
        self._count = 0
        self._suffix = suffix

    def new(self, letter: str = "V") -> str:
        """Return a new name."""
        self._count += 1
        return f"{letter}{self._count}{self._suffix}"


@dataclass(frozen=True, slots=True)
class Size:
    """The size of programs.

    ``budget`` is the greatest number of statements that the main routine executes, ``others`` that
    of every other routine. ``statements`` is the greatest number of statements in a block,
    ``depth`` the greatest depth of expressions, ``routines`` the greatest number of routines
    besides the main one, and ``data`` the approximate number of variables of each kind in a data
    list. ``risky`` is the percentage of programs that provoke faults.
    """

    budget: int = 700
    others: int = 100
    statements: int = 6
    depth: int = 3
    routines: int = 3
    data: int = 2
    risky: int = 60


@dataclass(frozen=True, slots=True)
class Counter:
    """An INT variable whose value is within these limits while it is listed."""

    name: str
    low: int
    high: int


@dataclass(frozen=True, slots=True)
class Part:
    """The kind of routine: main routine, interrupt or trigger action, function with its result."""

    is_main: bool = False
    is_action: bool = False
    result: Type | None = None


class RoutineWriter:
    """A routine under construction.

    ``budget`` is the number of statements it may execute, ``times`` how often the current place is
    executed at most, ``spent`` the cost of everything before it, ``risk`` the percentage of places
    at which a fault is provoked. ``passes`` are names of integers that only count loops and
    backward jumps, ``counters`` those in use here, ``interrupts`` the numbers declared so far.
    """

    def __init__(
        self,
        choices: Choices,
        style: Style,
        names: Names,
        scope: Scope,
        *,
        size: Size,
        budget: int,
        risk: int,
        part: Part,
    ) -> None:
        self.choices = choices
        self.style = style
        self.names = names
        self.scope = scope
        self.size = size
        self.budget = budget
        self.risk = risk
        self.part = part
        self.lines: list[str] = []
        self.pad = _INDENT
        self.level = 1
        self.counters: list[Counter] = []
        self.passes: list[str] = []
        self.interrupts: list[int] = []
        self.spent = 0
        self.times = 1
        self.loops = 0

    # ----------------------------------------------------------------------- writing

    def line(self, text: str) -> bool:
        """Write a line with the current indentation; returns ``True``, as most rules do."""
        self.lines.append(self.pad + text)
        return True

    def set(self, variable: str, value: str) -> bool:
        """Write an assignment."""
        return self.line(f"{variable}={value}")

    @contextmanager
    def indented(self) -> Iterator[None]:
        """Indent the lines of the context by one step."""
        pad, self.pad = self.pad, self.pad + _INDENT
        self.level += 1
        yield
        self.level -= 1
        self.pad = pad

    @contextmanager
    def block(self, opener: str, closer: str) -> Iterator[None]:
        """Write ``opener``, the indented lines of the context, and ``closer``."""
        self.line(opener)
        with self.indented():
            yield
        self.line(closer)

    def guarded(self, condition: str, text: str) -> bool:
        """Write one statement in an IF."""
        with self.block(f"IF {condition} THEN", "ENDIF"):
            return self.line(text)

    def spare(self) -> list[str]:
        """Return the counters that no enclosing loop uses."""
        used = {one.name for one in self.counters}
        return [name for name in self.passes if name not in used]

    # ----------------------------------------------------------------------- what it costs

    def spend(self, cost: int = 1) -> None:
        """Count the cost of statements at the current place."""
        self.spent += cost * self.times

    def left(self) -> int:
        """Return how many more statements each execution of the current place may take."""
        return max((self.budget - self.spent) // self.times, 0)

    @contextmanager
    def repeated(self, times: int, *, is_loop: bool = True) -> Iterator[None]:
        """Count the context as executed ``times`` times; counters added in it are removed after."""
        before, counters = self.times, len(self.counters)
        self.loops += is_loop
        self.times *= times
        yield
        self.times = before
        self.loops -= is_loop
        del self.counters[counters:]

    def risks(self) -> bool:
        """Return whether to provoke a fault here."""
        return self.risk > 0 and self.choices.chance(self.risk)
