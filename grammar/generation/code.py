"""A routine under construction, and the style in which it is generated.

The rules in `expressions`, `statements`, `control_flow` and `motions` can generate any kind of
program. A `Style` says what they may choose and how often. There are two: `closed.style` and
`cells.style`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Protocol

from grammar.generation.choices import Choices, Weighted
from grammar.generation.layout import Layout
from grammar.generation.literals import Literals
from grammar.generation.scope import Parameter, Scope
from grammar.semantics.types import Type


class Naming(Protocol):
    """A source of unique names."""

    def variable(self, type_: Type, letter: str = "V") -> str:
        """Return a name for a variable; simple implementations begin it with the letter."""

    def label(self) -> str:
        """Return a name for a label."""


#: Returns an expression; the number is the greatest depth of nesting.
ExpressionRule = Callable[["Code", int], str]
#: Writes a statement; returns ``False`` and writes nothing if the scope lacks what it needs.
StatementRule = Callable[["Code"], bool]


@dataclass(frozen=True, slots=True)
class Style:
    """What programs of a kind choose from, and how often; shares are in percent.

    In a closed style every loop is bounded by its own counter, numbers are kept small, and the cost
    of all executed statements is counted, so that a program terminates without input. Otherwise
    programs resemble those that people write, and only have to pass the check.
    """

    is_closed: bool
    layout: Layout
    literals: Literals
    #: Rules for expressions of a type other than atoms, calls and functions.
    expressions: Mapping[Type, Weighted[ExpressionRule]]
    #: Functions and variables of the controller.
    functions: Mapping[Type, Weighted[ExpressionRule]]
    relations: Weighted[ExpressionRule]
    statements: Weighted[StatementRule]
    #: Rules for motions; each routine has its own share of them.
    moving: Weighted[StatementRule]
    #: Statements after ON_ERROR_PROCEED.
    risky: Weighted[StatementRule]
    #: Draws the type of an assigned variable; see also ``selectors`` and ``compared``.
    assigned: Callable[[Code], Type]
    #: Draws a value for a place of a type.
    value: Callable[[Code, str, Type], str]
    #: Draws a parameter without a name; the flag says whether it may be an array.
    parameter: Callable[[Choices, bool], Parameter]
    selectors: Callable[[Code], Type]
    compared: Callable[[Code], Type]
    #: Draw the target and the blending criterion of a motion of a kind.
    goal: Callable[[Code, str], str]
    blend: Callable[[Code, str], str]
    motions: Weighted[str]
    #: System variables among the atoms of a type, with their share.
    atoms: Mapping[Type, tuple[int, Weighted[ExpressionRule]]]
    #: Draws a comment to put after an assignment, or an empty text.
    remark: Callable[[Choices], str] | None = None
    atom_share: int = 0
    operator_share: int = 75
    call_share: int = 9
    #: Share of variables among atoms; the rest are constants. BOOL has a share of its own.
    variable_share: int = 70
    truth_share: int = 70
    #: Shares of whole variables among places, and of a draw that gives each place the same chance.
    whole_share: int = 0
    any_place_share: int = 50
    omitted_share: int = 1
    jump_share: int = 0
    else_share: int = 50
    exit_share: int = 12
    #: Probability of one more CASE in a SWITCH, and the greatest number of labels of a CASE.
    case_share: int = 65
    case_labels: int = 3
    #: Shares of declarations without DECL, joined with the one before, and without a value.
    short_declaration_share: int = 40
    group_share: int = 0
    bare_share: int = 4
    bare_local_share: int = 5
    deepest: int = 99
    #: The least remaining budget with which a block gets another statement.
    reserve: int = 12
    has_splines: bool = True


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


class Code:
    """A routine under construction.

    ``budget`` is the number of statements it may execute; in an open style, the number of lines it
    may have. ``times`` is how often the current place is executed at most, ``spent`` the cost of
    everything before it, ``risk`` the percentage of places at which a fault is provoked, ``moving``
    that of statements that are motions. ``passes`` are names of integers that only count loops and
    backward jumps, ``counters`` those in use here, ``interrupts`` the numbers declared so far.
    """

    def __init__(
        self,
        choices: Choices,
        style: Style,
        names: Naming,
        scope: Scope,
        *,
        size: Size,
        budget: int = 0,
        risk: int = 0,
        moving: int = 0,
        part: Part | None = None,
    ) -> None:
        self.choices = choices
        self.style = style
        self.names = names
        self.scope = scope
        self.layout = style.layout
        self.size = size
        self.budget = budget
        self.risk = risk
        self.moving = moving
        self.part = part or Part()
        self.lines: list[str] = []
        self.pad = style.layout.indent
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
        remark = self.style.remark(self.choices) if self.style.remark else ""
        return self.line(f"{variable}{self.layout.eq}{value}{remark}")

    def call(self, name: str, *arguments: str) -> bool:
        """Write a call as a statement."""
        return self.line(self.layout.call(name, arguments))

    @contextmanager
    def indented(self) -> Iterator[None]:
        """Indent the lines of the context by one step."""
        pad, self.pad = self.pad, self.pad + self.layout.indent
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

    @contextmanager
    def fold(self, title: str, closer: str = "") -> Iterator[None]:
        """Write the lines of the context in a fold, without indentation."""
        self.line(f";FOLD {title}")
        yield
        self.line(f";ENDFOLD ({closer})" if closer else ";ENDFOLD")

    # ----------------------------------------------------------------------- what it costs

    def spend(self, cost: int = 1) -> None:
        """Count the cost of statements at the current place."""
        self.spent += cost * self.times

    def left(self) -> int:
        """Return how many more statements each execution of the current place may take."""
        if not self.style.is_closed:
            return self.budget - len(self.lines)
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
