"""Blocks of statements, as deep as a budget of lines goes."""

from __future__ import annotations

from collections.abc import Callable

from grammar.generation.cells.chance import Weighted
from grammar.generation.cells.code import Code
from grammar.generation.cells.expressions import condition, integer
from grammar.generation.cells.motions import Mover
from grammar.generation.cells.statements import a_statement, wait_for

__all__ = ["Body"]

_DEEPEST = 5


class Body:
    """Writes the statements of a routine; without a mover, none of them is a motion.

    ``moving`` is how likely the next thing is a motion.
    """

    def __init__(self, code: Code, mover: Mover | None, moving: float = 0.0) -> None:
        self.code = code
        self.mover = mover
        self.moving = moving if mover else 0.0

    def write(self, lines: int, depth: int = 0) -> None:
        """Statements and blocks of about so many lines."""
        code, chance = self.code, self.code.chance
        end = len(code.lines) + max(lines, 1)
        while len(code.lines) < end:
            drawn = chance.real()
            left = end - len(code.lines)
            if self.mover and drawn < self.moving:
                self.mover.move()
            elif left > 3 and depth < _DEEPEST and drawn > 0.84:
                chance.draw(_BLOCKS)(self, min(left, 24), depth + 1)
            else:
                a_statement(code)

    def _some(self, lines: int, depth: int, most: int = 6) -> None:
        """The lines within a block: some of those that are left."""
        self.write(min(self.code.chance.between(1, most), lines - 2), depth)

    # ------------------------------------------------------------------------------ blocks

    def _if(self, lines: int, depth: int) -> None:
        code, chance = self.code, self.code.chance
        with code.block(f"IF {condition(code)} THEN", "ENDIF"):
            self._some(lines, depth)
            drawn = chance.real()
            if drawn < 0.34:
                code.middle("ELSE")
                self._some(lines, depth)
            elif drawn < 0.36:
                code.middle("ELSE")

    def _for(self, lines: int, depth: int) -> None:
        code, chance, scope = self.code, self.code.chance, self.code.scope
        if not code.counters:
            self._if(lines, depth)
            return
        name, largest = code.counters.pop(), chance.between(2, 12)
        step = ""
        bounds = f"1 TO {largest}"
        drawn = chance.real()
        if drawn < 0.1:
            bounds, step = f"{largest} TO 1", " STEP -1"
        elif drawn < 0.18:
            step = f" STEP {chance.between(2, 4)}"
        elif drawn < 0.3:
            bounds = f"1 TO {chance.pick(scope.reads['INT'] or ['$NUM_AX'])}"
            largest = 10_000  # nobody knows, so it is no index
        scope.counters.append((name, largest))
        head = f"FOR {name}{code.dialect.eq}{bounds}{step}"
        with code.block(head, "ENDFOR"):
            self._some(lines, depth)
        scope.counters.pop()
        code.counters.append(name)

    def _while(self, lines: int, depth: int) -> None:
        code = self.code
        with code.block(f"WHILE {condition(code)}", "ENDWHILE"):
            if code.chance.real() < 0.2:
                return
            wait_for(code)
            self._some(lines, depth)

    def _repeat(self, lines: int, depth: int) -> None:
        code = self.code
        with code.block("REPEAT", f"UNTIL {condition(code)}"):
            wait_for(code)
            self._some(lines, depth)

    def _loop(self, lines: int, depth: int) -> None:
        code = self.code
        with code.block("LOOP", "ENDLOOP"):
            self._some(lines, depth)
            with code.block(f"IF {condition(code)} THEN", "ENDIF"):
                code.line("EXIT")

    def _switch(self, lines: int, depth: int) -> None:
        code, chance = self.code, self.code.chance
        scope = code.scope
        drawn = chance.real()
        if scope.enumerations and drawn < 0.35:
            name, enumeration = chance.pick(scope.enumerations)
            values = [f"#{constant}" for constant in enumeration.constants]
        elif drawn < 0.4 and scope.reads["CHAR"]:
            name, values = chance.pick(scope.reads["CHAR"]), [f'"{letter}"' for letter in "ABCDEFX"]
        elif drawn < 0.75 and scope.reads["INT"]:
            name = chance.pick(scope.reads["INT"])
            values = [str(number) for number in range(1, chance.between(3, 9))]
        else:
            name = integer(code, 1)
            values = [str(10 * number) for number in range(chance.between(3, 7))]
        code.line(f"SWITCH {name}")
        pad = code.pad
        while values:
            count = min(len(values), 1 if chance.real() < 0.9 else chance.between(2, 3))
            code.line(f"CASE {code.dialect.comma.join(values[:count])}")
            del values[:count]
            code.pad = pad + code.dialect.indent
            self._some(lines, depth, 4)
            code.pad = pad
        if chance.real() < 0.7:
            code.line("DEFAULT")
            code.pad = pad + code.dialect.indent
            self._some(lines, depth, 3)
            code.pad = pad
        code.line("ENDSWITCH")

    def _fold(self, lines: int, depth: int) -> None:
        code = self.code
        with code.fold(code.names.remark()):
            self._some(lines, depth, 8)


_BLOCKS: Weighted[Callable[[Body, int, int], None]] = Weighted(
    [
        (100.0, Body._if),
        (17.0, Body._for),
        (2.5, Body._while),
        (3.2, Body._repeat),
        (1.8, Body._loop),
        (12.0, Body._switch),
        (16.0, Body._fold),
    ]
)
