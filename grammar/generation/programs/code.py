"""A routine in the making: its lines, what it can name, what it costs."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from grammar.generation.programs.choices import Choices
from grammar.generation.programs.scope import Routine, Scope
from grammar.semantics.types import Array, Type

__all__ = ["Code", "Counter", "Size"]


@dataclass(frozen=True, slots=True)
class Size:
    """How large programs become.

    ``budget`` is how many statements the main routine executes at most, ``others`` how many each
    of the others does; ``statements`` is how many stand in a block at most, ``depth`` how deep
    expressions nest, ``routines`` how many there are besides the main one at most, ``data`` how
    many variables of a kind a data list has about. Of a hundred programs, ``risky`` are such that
    provoke faults.
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
    """An INT that has a value within these limits wherever it is known."""

    name: str
    low: int
    high: int


@dataclass(frozen=True, slots=True)
class Part:
    """Which routine is made: the main one, what an interrupt calls, and what a function gives."""

    is_main: bool = False
    is_for_interrupts: bool = False
    result: Type | None = None


class Code(ABC):
    """A routine in the making.

    ``times`` is how often what is written now is executed at most, ``spent`` what all before costs,
    ``risk`` the percentage of places at which a fault is provoked. ``passes`` are names of integers
    that only jumps backwards count with, ``interrupts`` the numbers declared so far.
    """

    def __init__(
        self, choices: Choices, size: Size, scope: Scope, budget: int, risk: int, part: Part
    ) -> None:
        self.choices = choices
        self.size = size
        self.scope = scope
        self.budget = budget
        self.risk = risk
        self.part = part
        self.lines: list[str] = []
        self.counters: list[Counter] = []
        self.passes: list[str] = []
        self.interrupts: list[int] = []
        self.spent = 0
        self.times = 1
        self.level = 1
        self.loops = 0
        self.labels = 0

    # ----------------------------------------------------------------------- writing

    def write(self, text: str) -> None:
        """A line."""
        self.lines.append("  " * self.level + text)

    def spend(self, cost: int = 1) -> None:
        """So many statements are executed whenever the program comes here."""
        self.spent += cost * self.times

    def left(self) -> int:
        """How many statements may still be executed whenever the program comes here."""
        return max((self.budget - self.spent) // self.times, 0)

    @contextmanager
    def block(self, times: int = 1, *, is_loop: bool = False) -> Iterator[None]:
        """A block that is executed so often each time the program comes to it."""
        before, counters = self.times, len(self.counters)
        self.level += 1
        self.loops += is_loop
        self.times *= times
        yield
        self.times = before
        self.level -= 1
        self.loops -= is_loop
        del self.counters[counters:]

    def risks(self) -> bool:
        """Whether a fault is provoked here."""
        return self.risk > 0 and self.choices.chance(self.risk)

    # ----------------------------------------------------------------------- expressions

    @abstractmethod
    def expression(self, type_: Type, depth: int) -> str:
        """An expression of a type; ``depth`` is how deep it may nest."""

    @abstractmethod
    def target(self, type_: Type, *, is_local: bool = True) -> str | None:
        """A place that can be assigned, ``None`` where there is none."""

    @abstractmethod
    def array(self, type_: Array) -> str:
        """A whole array, or a row of one of more dimensions; empty where there is none."""

    @abstractmethod
    def text(self) -> str:
        """A text: a variable, a row of a table, or a text as written."""

    @abstractmethod
    def call_of(self, routine: Routine) -> str:
        """A call, whose cost is charged to the place it stands in."""
