"""A routine in the making, and the style it is made in.

The rules of `expressions`, `statements`, `control_flow` and `motions` write any kind of program.
A `Style` holds what they may choose and how often; two exist: `programs.closed` and `cells.style`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Protocol

from grammar.generation.choices import Choices, Weighted
from grammar.generation.literals import Literals
from grammar.generation.scope import Parameter, Scope
from grammar.semantics.types import Type


class Naming(Protocol):
    """Makes names that are not taken yet."""

    def variable(self, type_: Type, letter: str = "V") -> str:
        """A name for a variable; plain styles begin it with the letter."""

    def label(self) -> str:
        """A name for a label."""


@dataclass(frozen=True, slots=True)
class Spelling:
    """White space: what stands around operators and assignments, behind commas, before calls."""

    indent: str = "  "
    eq: str = "="
    gap: str = " "
    comma: str = ", "
    before: str = ""

    def call(self, name: str, arguments: Iterable[str]) -> str:
        """A call as a statement or as part of an expression."""
        return f"{name}{self.before}({self.comma.join(arguments)})"

    def binary(self, left: str, operator: str, right: str) -> str:
        """Two operands with an operator between them; one that is a word stands apart."""
        gap = " " if operator[0].isalpha() else self.gap
        return f"{left}{gap}{operator}{gap}{right}"


#: Writes an expression that may nest so deep.
ExpressionRule = Callable[["Code", int], str]
#: Writes a statement; whether the place had what it takes.
StatementRule = Callable[["Code"], bool]


@dataclass(frozen=True, slots=True)
class Style:
    """What programs of a kind choose from, and how often; shares are in percent.

    ``is_closed``: every loop is bounded by a variable that only it counts with, numbers are kept
    small, and the cost of all that is executed is accounted for, so that a program runs to its end
    alone. Where it is not, programs are as people write them, and only have to check.
    """

    is_closed: bool
    spelling: Spelling
    literals: Literals
    #: What an expression of a type is made by where it is not an atom, a call or a function.
    expressions: Mapping[Type, Weighted[ExpressionRule]]
    #: Functions and variables of the controller.
    functions: Mapping[Type, Weighted[ExpressionRule]]
    relations: Weighted[ExpressionRule]
    statements: Weighted[StatementRule]
    #: Motions, in a share that each routine has.
    moving: Weighted[StatementRule]
    #: What stands under ON_ERROR_PROCEED.
    risky: Weighted[StatementRule]
    #: Types of what is assigned, selected by, compared.
    assigned: Callable[[Code], Type]
    #: A value for a place of a type.
    value: Callable[[Code, str, Type], str]
    #: A parameter without its name, of an array only where that may be.
    parameter: Callable[[Choices, bool], Parameter]
    selectors: Callable[[Code], Type]
    compared: Callable[[Code], Type]
    #: Where a motion goes: its kind, and whether it is a direction of an arc; and how it blends.
    goal: Callable[[Code, str], str]
    blend: Callable[[Code, str], str]
    motions: Weighted[str]
    #: Variables of the controller among atoms, with their share.
    atoms: Mapping[Type, tuple[int, Weighted[ExpressionRule]]]
    #: Puts a remark behind an assignment at times.
    remark: Callable[[Choices], str] | None = None
    atom_share: int = 0
    operator_share: int = 75
    call_share: int = 9
    #: Of atoms: variables of the program; the others are constants. Truth values have their own.
    variable_share: int = 70
    truth_share: int = 70
    #: Of places: variables as a whole; then each place alike, or each variable alike.
    whole_share: int = 0
    any_place_share: int = 50
    omitted_share: int = 1
    jump_share: int = 0
    else_share: int = 50
    exit_share: int = 12
    #: Whether a SWITCH has another CASE, and how many labels one has at most.
    case_share: int = 65
    case_labels: int = 3
    #: Declarations: without DECL, together with the one before, and with a value.
    short_declaration_share: int = 40
    group_share: int = 0
    bare_share: int = 4
    bare_local_share: int = 5
    deepest: int = 99
    #: What has to be left of the budget for another statement of a block.
    reserve: int = 12
    has_splines: bool = True


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
    is_action: bool = False
    result: Type | None = None


class Code:
    """A routine in the making.

    ``budget`` is how many statements it may execute; in an open style, how many lines it may have.
    ``times`` is how often what is written now is executed at most, ``spent`` what all before costs,
    ``risk`` the percentage of places at which a fault is provoked, ``moving`` that of statements
    that are motions. ``passes`` are names of integers
    that only loops and jumps backwards count with, ``counters`` those that do here, ``interrupts``
    the numbers declared so far.
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
        self.spelling = style.spelling
        self.size = size
        self.budget = budget
        self.risk = risk
        self.moving = moving
        self.part = part or Part()
        self.lines: list[str] = []
        self.pad = style.spelling.indent
        self.level = 1
        self.counters: list[Counter] = []
        self.passes: list[str] = []
        self.interrupts: list[int] = []
        self.spent = 0
        self.times = 1
        self.loops = 0

    # ----------------------------------------------------------------------- writing

    def line(self, text: str) -> bool:
        """A line at the depth of the moment; gives `True`, as most statements do."""
        self.lines.append(self.pad + text)
        return True

    def set(self, variable: str, value: str) -> bool:
        """An assignment."""
        remark = self.style.remark(self.choices) if self.style.remark else ""
        return self.line(f"{variable}{self.spelling.eq}{value}{remark}")

    def call(self, name: str, *arguments: str) -> bool:
        """A call as a statement."""
        return self.line(self.spelling.call(name, arguments))

    @contextmanager
    def indented(self) -> Iterator[None]:
        """Lines a step further in."""
        pad, self.pad = self.pad, self.pad + self.spelling.indent
        self.level += 1
        yield
        self.level -= 1
        self.pad = pad

    @contextmanager
    def block(self, opener: str, closer: str) -> Iterator[None]:
        """The lines of a block, a step further in than its opener and closer."""
        self.line(opener)
        with self.indented():
            yield
        self.line(closer)

    def guarded(self, condition: str, text: str) -> bool:
        """One statement under a condition."""
        with self.block(f"IF {condition} THEN", "ENDIF"):
            return self.line(text)

    @contextmanager
    def fold(self, title: str, closer: str = "") -> Iterator[None]:
        """The lines of a fold, no further in."""
        self.line(f";FOLD {title}")
        yield
        self.line(f";ENDFOLD ({closer})" if closer else ";ENDFOLD")

    # ----------------------------------------------------------------------- what it costs

    def spend(self, cost: int = 1) -> None:
        """So many statements are executed whenever the program comes here."""
        self.spent += cost * self.times

    def left(self) -> int:
        """How many statements may still be executed whenever the program comes here."""
        if not self.style.is_closed:
            return self.budget - len(self.lines)
        return max((self.budget - self.spent) // self.times, 0)

    @contextmanager
    def repeated(self, times: int, *, is_loop: bool = True) -> Iterator[None]:
        """What is executed so often each time the program comes to it; its counter ends there."""
        before, counters = self.times, len(self.counters)
        self.loops += is_loop
        self.times *= times
        yield
        self.times = before
        self.loops -= is_loop
        del self.counters[counters:]

    def risks(self) -> bool:
        """Whether a fault is provoked here."""
        return self.risk > 0 and self.choices.chance(self.risk)
