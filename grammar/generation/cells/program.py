"""The routines of a program file: reactions, functions, procedures, and the main routine."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

from grammar.generation.cells.dialect import Dialect, Generation
from grammar.generation.cells.inline_forms import Forms
from grammar.generation.cells.names import Names
from grammar.generation.cells.points import Taught
from grammar.generation.cells.statements import remark, set_output
from grammar.generation.cells.style import LOCALS, RESULTS
from grammar.generation.choices import Choices
from grammar.generation.code import Code, Part, Size, Style
from grammar.generation.control_flow import give_back, returned, statement
from grammar.generation.expressions import truth
from grammar.generation.patterns import pattern
from grammar.generation.routines import begin, declare, declare_parameters, parameters, routine_text
from grammar.generation.scope import Parameter, Routine, Scope
from grammar.semantics.types import INT, REAL, Array

_INTERRUPTS: Final = (*range(4, 40), *range(81, 129))
_LASTING: Final = pattern("<lasting> <AND|OR|AND NOT> $IN[<1-512>]")
_SIZE: Final = Size(statements=6, depth=2)
#: How many elements of a local array a routine initialises at most.
_MOST_FIRST_VALUES: Final = 12


class Program:
    """The routines of one file while they are generated.

    ``scope`` and ``names`` are those of the module. The other routines follow the main one in the
    file but are generated first. Each calls only earlier ones, so there is no recursion.
    """

    def __init__(
        self,
        name: str,
        choices: Choices,
        dialect: Dialect,
        style: Style,
        names: Names,
        scope: Scope,
    ) -> None:
        self.name = name
        self.choices = choices
        self.dialect = dialect
        self.names = names
        self.scope = scope
        self.taught = Taught(choices, dialect)
        self.forms = Forms(dialect, self.taught)
        self.style = replace(
            style, moving=self.forms.rules, goal=self.forms.goal, blend=self.forms.blend
        )
        self._texts: list[list[str]] = []
        self._reactions: list[Routine] = []

    @property
    def lines(self) -> list[str]:
        """The lines of all routines, with the main routine first."""
        main, *others = self._texts[-1:] + self._texts[:-1]
        return [*main, *(line for text in others for line in ("", *text))]

    def code(self, *, moving: int = 0, part: Part | None = None) -> Code:
        """Return an empty routine."""
        return Code(
            self.choices,
            self.style,
            self.names.inner(),
            self.scope.inner(),
            size=_SIZE,
            moving=moving,
            part=part,
        )

    def end(
        self, code: Code, routine: Routine, *, is_global: bool = False, is_called: bool = True
    ) -> Routine:
        """Complete a routine and return it; from now on others can call it."""
        close = " )" if self.choices.chance(60) else ")"
        self._texts.append(routine_text(code, routine, is_global=is_global, close=close))
        if is_called:
            self.scope.add_routine(routine)
        return routine

    def _declare(self, code: Code, given: Sequence[Parameter], count: int) -> None:
        """Write the parameters, some variables and their initial values."""
        choices = self.choices
        declare_parameters(code, given)
        names = code.names
        assert isinstance(names, Names)
        for letter in ("I", "K", "N")[: 1 + count // 2]:
            code.passes.append(names.take(letter if choices.chance(70) else f"NR_{letter}"))
        code.line(f"INT {self.dialect.comma.join(code.passes)}")
        types = sorted((choices.weighted(LOCALS) for _ in range(count)), key=str)
        variables = declare(code, types, names.variable)
        if choices.chance(30):
            code.lines.append("")
        begin(code, variables, _MOST_FIRST_VALUES)

    def fill(self, code: Code, lines: int) -> None:
        """Write about ``lines`` lines of statements."""
        code.budget = len(code.lines) + max(lines, 1)
        while code.left() > 0:
            statement(code)

    def _parameters(self, names: Names, count: int) -> tuple[Parameter, ...]:
        is_krc1 = self.dialect.generation is Generation.KRC1
        return tuple(
            Parameter(one.name, one.type, one.is_out, not (one.is_out and is_krc1))
            for one in parameters(self.choices, self.style, names, count)
        )

    # ------------------------------------------------------------------------ kinds of routines

    def add_quick(self) -> None:
        """Add a short routine without motions, for triggers and interrupts."""
        code = self.code()
        for _ in range(self.choices.between(1, 4)):
            set_output(code)
        routine = Routine(self.names.routine(self._station()), is_quick=True)
        self._reactions.append(self.end(code, routine))

    def add_brake(self) -> None:
        """Add a routine that stops the robot and waits for a condition."""
        code = self.code()
        code.line(self.choices.pick(("BRAKE", "BRAKE", "BRAKE", "BRAKE F")))
        code.set("$OUT[1]", "FALSE")
        with code.block("REPEAT", f"UNTIL {_LASTING(code, 1)}"):
            code.line("HALT")
        code.set("$OUT[1]", "TRUE")
        routine = Routine(self.names.routine(self._station()))
        self._reactions.append(self.end(code, routine, is_called=False))

    def add_function(self, *, is_global: bool = False) -> Routine:
        """Add a function and return it."""
        choices = self.choices
        result = choices.weighted(RESULTS)
        name = self.names.function(result)
        code = self.code(part=Part(result=result))
        code.scope.forget_routines()
        given = self._parameters(_inner(code), choices.between(0, 3))
        given = tuple(Parameter(one.name, one.type, is_out=False) for one in given)
        self._declare(code, given, choices.between(1, 3))
        if choices.chance(40):
            give_back(code)
        self.fill(code, choices.between(1, 10))
        returned(code)
        return self.end(code, Routine(name, given, result), is_global=is_global)

    def add_array_function(self) -> Routine:
        """Add a function over the elements of an array and return it."""
        choices, binary = self.choices, self.dialect.binary
        name = self.names.take(self.names.joined((choices.pick(("mean", "sum", "most")), "of_all")))
        code = self.code()
        names = _inner(code)
        values, count = names.variable(REAL), names.variable(INT)
        result, index = names.variable(REAL), names.take("K")
        given = (
            Parameter(values, Array(REAL, (None,)), is_out=True),
            Parameter(count, INT, is_out=False),
        )
        code.line(f"REAL {values}[]{self.dialect.comma}{result}")
        code.line(f"INT {count}{self.dialect.comma}{index}")
        code.set(result, "0.0")
        with code.block(f"FOR {index}{self.dialect.eq}1 TO {count}", "ENDFOR"):
            code.set(result, binary(result, "+", f"{values}[{index}]"))
        code.line(f"RETURN {binary(result, '/', count)}")
        return self.end(code, Routine(name, given, REAL))

    def add_procedure(self, lines: int, *, moving: int, is_global: bool = False) -> Routine:
        """Add a procedure with some parameters and return it."""
        choices = self.choices
        name = self.names.routine(self._station())
        code = self.code(moving=moving)
        given = self._parameters(_inner(code), choices.below(4))
        self._declare(code, given, choices.below(5))
        self._body(code, lines)
        return self.end(code, Routine(name, given), is_global=is_global)

    def add_main(self, lines: int, *, moving: int) -> None:
        """Add the main routine, which has the name of the file."""
        code, choices = self.code(moving=moving), self.choices
        if choices.chance(50):
            with code.fold("DECLARATIONS", "DECLARATIONS"):
                self._declare(code, (), choices.between(1, 5))
        else:
            self._declare(code, (), choices.between(0, 4))
        numbers = choices.few(_INTERRUPTS, len(self._reactions))
        if moving or numbers or choices.chance(20):
            self._initialise(code, dict(zip(numbers, self._reactions, strict=True)))
        if moving:
            self.forms.home(code)
            code.lines.append("")
        self._body(code, lines)
        for number in numbers:
            if choices.chance(40):
                word = choices.pick(("OFF", "OFF", "DISABLE", "ENABLE"))
                code.line(f"INTERRUPT {word} {number}")
        if moving:
            self.forms.home(code)
        self.end(code, Routine(self.name), is_called=False)

    def add_empty_main(self) -> None:
        """Add a main routine without statements."""
        code = self.code()
        remark(code)
        self.end(code, Routine(self.name), is_called=False)

    def _initialise(self, code: Code, interrupts: dict[int, Routine]) -> None:
        """Write the fold INI: the reaction to a stop, defaults, the program's interrupts."""
        choices, call = self.choices, self.dialect.call
        word = "GLOBAL " if self.dialect.generation.is_krc4 or choices.chance(20) else ""

        def interrupt(number: int, event: str, action: str, word: str = "") -> None:
            code.line(f"{word}INTERRUPT DECL {number} WHEN {event} DO {call(action, ())}")
            code.line(f"INTERRUPT ON {number}")

        with code.fold("INI;%{PE}" if self.dialect.inline_forms else "INI", "INI"):
            with code.fold("BASISTECH INI", "BASISTECH INI"), code.indented():
                interrupt(3, "$STOPMESS==TRUE", "IR_STOPM", word)
                code.call("BAS", "#INITMOV", "0")
            with code.fold("USER INI", "USER INI"), code.indented():
                for number, routine in interrupts.items():
                    event = _LASTING(code, 1)
                    if choices.chance(60):
                        event = f"$IN[{choices.between(1, 512)}]==FALSE"
                    interrupt(number, event, routine.name)

    def _body(self, code: Code, lines: int) -> None:
        """Write the statements, sometimes with a backward jump around them."""
        if self.choices.chance(13):
            code.guarded(truth(code), "RETURN")
        is_repeated = self.choices.chance(12)
        label = code.names.label() if is_repeated else ""
        if is_repeated:
            code.lines.append(f"{code.pad if self.choices.chance(50) else ''}{label}:")
        self.fill(code, lines)
        if is_repeated:
            code.guarded(truth(code), f"GOTO {label}")

    def _station(self) -> str:
        return self.choices.pick(self.names.vocabulary.stations)


def _inner(code: Code) -> Names:
    assert isinstance(code.names, Names)
    return code.names
