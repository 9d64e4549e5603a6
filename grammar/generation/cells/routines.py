"""Routines: their heads, declarations and bodies, and what belongs to the main one of a program."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from grammar.generation.cells.blocks import Body
from grammar.generation.cells.chance import Chance, Weighted
from grammar.generation.cells.code import Code
from grammar.generation.cells.dialect import Dialect, Generation
from grammar.generation.cells.expressions import condition, constant_of, integer, real
from grammar.generation.cells.motions import Mover
from grammar.generation.cells.names import Names
from grammar.generation.cells.points import Taught
from grammar.generation.cells.scope import Parameter, Routine, Scope
from grammar.generation.cells.statements import lasting_condition, set_output

__all__ = ["Program"]

_KINDS = Weighted([(5.0, "INT"), (4.0, "REAL"), (3.0, "BOOL"), (1.0, "TEXT"), (1.0, "E6POS")])
_RESULTS = Weighted([(4.0, "INT"), (4.0, "REAL"), (4.0, "BOOL"), (1.0, "E6POS"), (1.0, "FRAME")])
_LOCALS = Weighted(
    [(4.0, "INT"), (3.0, "REAL"), (3.0, "BOOL"), (1.2, "E6POS"), (1.0, "FRAME"), (0.3, "CHAR")]
)
_INTERRUPTS = (*range(4, 40), *range(81, 129))


@dataclass(slots=True)
class Program:
    """The routines of one file while they are written.

    ``scope`` and ``names`` are those of the module; what the routines are called is in ``local``.
    Routines stand in the file after the main one, but are written first: each calls only such as
    are there already, so none calls itself.
    """

    name: str
    chance: Chance
    dialect: Dialect
    names: Names
    scope: Scope
    taught: Taught
    texts: list[list[str]] = field(default_factory=list)
    reactions: list[Routine] = field(default_factory=list)

    @property
    def lines(self) -> list[str]:
        """All routines, the last written first: that is the main one."""
        found = list(self.texts[-1])
        for text in self.texts[:-1]:
            found.append("")
            found += text
        return found

    # ------------------------------------------------------------------------ heads

    def _code(self) -> Code:
        return Code(self.chance, self.dialect, self.names.inner(), self.scope.inner())

    def _head(self, code: Code, routine: Routine, *, is_global: bool = False) -> None:
        """The first line."""
        is_krc1 = self.dialect.generation is Generation.KRC1
        mode = " " if self.chance.real() < 0.7 else ""
        parameters = self.dialect.comma.join(
            one.name
            + ("[]" if one.kind == "TEXT" or one.kind.endswith("[]") else "")
            + (f"{mode}:IN" if one.is_in else "" if is_krc1 else f"{mode}:OUT")
            for one in routine.parameters
        )
        kind = f"DEFFCT {routine.returns}" if routine.returns else "DEF"
        scope = "GLOBAL " if is_global else ""
        close = " )" if self.chance.real() < 0.6 else ")"
        code.lines.append(f"{scope}{kind} {routine.name}{self.dialect.before}({parameters}{close}")
        code.pad = self.dialect.indent

    def _declare(self, code: Code, routine: Routine, count: int) -> None:
        """The parameters, some variables and their first values."""
        chance, names, scope = self.chance, code.names, code.scope
        declared: dict[str, list[str]] = {}
        for one in routine.parameters:
            kind, suffix = one.kind, ""
            if kind.endswith("[]"):
                kind, suffix = kind[:-2], "[]"
            elif kind == "TEXT":
                kind, suffix = "CHAR", "[]"
                scope.texts.append((one.name, 24))
            else:
                scope.add_variable(kind, one.name)
            declared.setdefault(kind, []).append(one.name + suffix)
        for letter in ("I", "K", "N")[: 1 + count // 2]:
            code.counters.append(names.take(letter if chance.real() < 0.7 else f"NR_{letter}"))
        declared.setdefault("INT", []).extend(code.counters)
        fresh: list[tuple[str, str]] = []
        for _ in range(count):
            kind = chance.draw(_LOCALS)
            name = names.variable(kind)
            fresh.append((name, kind))
            declared.setdefault(kind, []).append(name)
        for kind, variables in declared.items():
            self._declaration(code, kind, variables)
        if chance.real() < 0.3:
            code.lines.append("")
        for name, kind in fresh:
            code.set(name, self._value(code, kind))
            scope.add_variable(kind, name)

    def _declaration(self, code: Code, kind: str, variables: Sequence[str]) -> None:
        decl = "DECL " if self.chance.real() < 0.72 else ""
        if self.chance.real() < 0.5:
            code.line(f"{decl}{kind} {self.dialect.comma.join(variables)}")
        else:
            for name in variables:
                code.line(f"{decl}{kind} {name}")

    def _value(self, code: Code, kind: str) -> str:
        """A first value, often one that is there already."""
        drawn = self.chance.real()
        if kind == "INT" and drawn < 0.3:
            return integer(code)
        if kind == "REAL" and drawn < 0.4:
            return real(code)
        if kind == "E6POS" and drawn < 0.5:
            return "$POS_ACT"
        if kind == "FRAME" and drawn < 0.4:
            return "$NULLFRAME"
        return constant_of(kind)

    def _parameters(self, names: Names, count: int, *, outs: bool) -> tuple[Parameter, ...]:
        chance = self.chance
        found = []
        for _ in range(count):
            kind = chance.draw(_KINDS)
            is_in = kind == "TEXT" or not outs or chance.real() < 0.9
            name = names.variable("CHAR" if kind == "TEXT" else kind)
            found.append(Parameter(name, kind, is_in))
        return tuple(found)

    # ------------------------------------------------------------------------ kinds of routines

    def add_quick(self) -> None:
        """A short routine for triggers and interrupts, without motions."""
        code = self._code()
        code.scope.routines.clear()
        routine = Routine(self.names.routine(self._station()), is_quick=True)
        self._head(code, routine)
        for _ in range(self.chance.between(1, 4)):
            set_output(code)
        self._end(code, routine)
        self.reactions.append(routine)

    def add_brake(self) -> None:
        """A routine that stops the robot and waits for what was missing."""
        code, chance = self._code(), self.chance
        routine = Routine(self.names.routine(self._station()))
        self._head(code, routine)
        code.line(chance.pick(("BRAKE", "BRAKE", "BRAKE", "BRAKE F")))
        code.set("$OUT[1]", "FALSE")
        with code.block("REPEAT", f"UNTIL {lasting_condition(code)}"):
            code.line("HALT")
        code.set("$OUT[1]", "TRUE")
        self._end(code, routine, is_called=False)
        self.reactions.append(routine)

    def add_function(self, *, is_global: bool = False) -> Routine:
        """A function that calculates something."""
        code, chance = self._code(), self.chance
        code.scope.routines.clear()
        returns = chance.draw(_RESULTS)
        name = self.names.function(returns)
        parameters = self._parameters(code.names, chance.between(0, 3), outs=False)
        routine = Routine(name, parameters, returns)
        self._head(code, routine, is_global=is_global)
        self._declare(code, routine, chance.between(1, 3))
        if chance.real() < 0.4:
            with code.block(f"IF {condition(code)} THEN", "ENDIF"):
                code.line(f"RETURN {self._result(code, returns)}")
        Body(code, None).write(chance.between(1, 10))
        code.line(f"RETURN {self._result(code, returns)}")
        self._end(code, routine)
        return routine

    def _result(self, code: Code, kind: str) -> str:
        if kind == "INT":
            return integer(code, 1)
        if kind == "REAL":
            return real(code, 2)
        if kind == "BOOL":
            return condition(code)
        names = code.scope.reads[kind]
        return self.chance.pick(names) if names else constant_of(kind)

    def add_array_function(self) -> Routine:
        """A function over the elements of an array."""
        code, chance, eq = self._code(), self.chance, self.dialect.eq
        name = self.names.take(self.names.joined((chance.pick(("mean", "sum", "most")), "of_all")))
        values, count = code.names.variable("REAL"), code.names.variable("INT")
        routine = Routine(
            name, (Parameter(values, "REAL[]", False), Parameter(count, "INT")), "REAL"
        )
        self._head(code, routine)
        result, index = code.names.variable("REAL"), code.names.take("K")
        code.line(f"REAL {values}[]{self.dialect.comma}{result}")
        code.line(f"INT {count}{self.dialect.comma}{index}")
        code.set(result, "0.0")
        gap = self.dialect.gap
        with code.block(f"FOR {index}{eq}1 TO {count}", "ENDFOR"):
            code.set(result, f"{result}{gap}+{gap}{values}[{index}]")
        code.line(f"RETURN {result}{gap}/{gap}{count}")
        self._end(code, routine)
        return routine

    def add_procedure(
        self, lines: int, *, moving: float, is_global: bool = False, name: str | None = None
    ) -> Routine:
        """A procedure with some parameters that others call."""
        code, chance = self._code(), self.chance
        name = name or self.names.routine(self._station())
        parameters = self._parameters(code.names, chance.below(4), outs=True)
        routine = Routine(name, parameters)
        self._head(code, routine, is_global=is_global)
        self._declare(code, routine, chance.below(5))
        mover = Mover(code, self.taught) if moving else None
        self._body(code, mover, lines, moving)
        self._end(code, routine)
        return routine

    def add_main(self, lines: int, *, moving: float) -> None:
        """The routine with the name of the file, as it is selected and started."""
        code, chance = self._code(), self.chance
        routine = Routine(self.name)
        self._head(code, routine)
        if chance.real() < 0.5:
            with code.fold("DECLARATIONS", "DECLARATIONS"):
                self._declare(code, routine, chance.between(1, 5))
        else:
            self._declare(code, routine, chance.between(0, 4))
        numbers = chance.few(_INTERRUPTS, len(self.reactions))
        mover = Mover(code, self.taught) if moving else None
        if mover or numbers or chance.real() < 0.2:
            self._initialise(code, dict(zip(numbers, self.reactions, strict=True)))
        if mover:
            mover.home()
            code.lines.append("")
        self._body(code, mover, lines, moving)
        for number in numbers:
            if chance.real() < 0.4:
                code.line(f"INTERRUPT {chance.pick(('OFF', 'OFF', 'DISABLE', 'ENABLE'))} {number}")
        if mover:
            mover.home()
        self._end(code, routine, is_called=False)

    def add_empty_main(self) -> None:
        """A main routine that only carries the name of the file."""
        code, routine = self._code(), Routine(self.name)
        self._head(code, routine)
        code.remark()
        self._end(code, routine, is_called=False)

    def _initialise(self, code: Code, interrupts: dict[int, Routine]) -> None:
        """The fold INI: the reaction to a stop, the defaults, and interrupts of its own."""
        is_krc4 = self.dialect.generation.is_krc4
        word = "GLOBAL " if is_krc4 or self.chance.real() < 0.2 else ""
        inner = self.dialect.indent
        pad = code.pad
        with code.fold("INI;%{PE}" if self.dialect.inline_forms else "INI", "INI"):
            with code.fold("BASISTECH INI", "BASISTECH INI"):
                code.pad = pad + inner
                stop = self.dialect.call("IR_STOPM", ())
                code.line(f"{word}INTERRUPT DECL 3 WHEN $STOPMESS==TRUE DO {stop}")
                code.line("INTERRUPT ON 3")
                code.call("BAS", "#INITMOV", "0")
                code.pad = pad
            with code.fold("USER INI", "USER INI"):
                code.pad = pad + inner
                for number, routine in interrupts.items():
                    event = lasting_condition(code)
                    if self.chance.real() < 0.6:
                        event = f"$IN[{self.chance.between(1, 512)}]==FALSE"
                    action = self.dialect.call(routine.name, ())
                    code.line(f"INTERRUPT DECL {number} WHEN {event} DO {action}")
                    code.line(f"INTERRUPT ON {number}")
                code.pad = pad

    def _body(self, code: Code, mover: Mover | None, lines: int, moving: float) -> None:
        """The statements, at times with a label to come back to."""
        body = Body(code, mover, moving)
        if self.chance.real() < 0.13:
            with code.block(f"IF {condition(code)} THEN", "ENDIF"):
                code.line("RETURN")
        if self.chance.real() < 0.88:
            body.write(lines)
            return
        label = code.names.label()
        indented = code.pad if self.chance.real() < 0.5 else ""
        code.lines.append(f"{indented}{label}:")
        body.write(lines)
        with code.block(f"IF {condition(code)} THEN", "ENDIF"):
            code.line(f"GOTO {label}")

    def _end(self, code: Code, routine: Routine, *, is_called: bool = True) -> None:
        code.lines.append("ENDFCT" if routine.returns else "END")
        self.texts.append(code.lines)
        if is_called:
            self.scope.add_routine(routine)

    def _station(self) -> str:
        return self.chance.pick(self.names.vocabulary.stations)
