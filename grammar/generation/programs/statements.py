"""Statements: what decides which way a program goes, and what is assigned and called.

Every loop is bounded by construction: by its limits, or by a variable that only it counts with.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final

from grammar.generation.programs.kinds import COLOUR, MODE, POINT, RECORD
from grammar.generation.programs.motions import Motions
from grammar.generation.programs.scope import Variable
from grammar.semantics.types import BOOL, CHAR, INT, REAL, Array, Enumeration, Type

__all__ = ["Statements"]

#: What is too large for an INT, or for a REAL, or nearly so.
_TOO_LARGE: Final = (
    *("2147483647+?", "?-2147483647-2", "99999*99999+?", "-2147483647-1-?", "1.0E30*1.0E30+?"),
    *("46341*46341+?", "3.0E38+3.0E38+?", "-(-2147483647-1)", "2147483647.0+?", "0.5E-30*1.0E-30"),
)
#: Blocks within blocks.
_DEEPEST: Final = 5


class Statements(Motions):
    """Writes blocks of statements."""

    def statements(self, most: int | None = None) -> None:
        """A block's body."""
        choices = self.choices
        for _ in range(choices.between(1, most or self.size.statements)):
            if self.left() < 12:
                break
            if choices.chance(4):
                self._forward_jump()
            elif not choices.weighted(_STATEMENTS)(self):
                self.assignment()

    # ----------------------------------------------------------------------- assignments, calls

    def assignment(self) -> bool:
        """A variable or a part of one is assigned."""
        choices = self.choices
        self.spend()
        for _ in range(4):
            type_ = choices.weighted(_ASSIGNED)
            found = self.target(type_)
            if found is not None:
                self.write(f"{found}={self._assigned(type_)}")
                return True
        self.write("$FLAG[1]=TRUE")
        return True

    def _assigned(self, type_: Type) -> str:
        """A value for a variable of a type, converted now and then; numbers are kept small."""
        choices = self.choices
        depth = choices.between(1, self.size.depth)
        if type_ in (INT, REAL) and self.risks():
            return choices.pick(_TOO_LARGE).replace("?", self.atom(INT))
        if type_ == INT:
            way = choices.below(12)
            if way < 4:
                return f"({self.expression(INT, depth)}) B_AND {choices.pick(('255', '4095'))}"
            if way < 6:
                return f"({self.expression(INT, depth)})/{choices.pick(('10', '7', '100'))}"
            if way < 7:
                return self.expression(REAL, depth)
            if way == 7:
                return f"{self._operand(INT, 1)}/{choices.pick(('2.0', '-2.0', '4.0'))}"
            if way == 8:
                return self.read(CHAR) or self.expression(INT, 1)
            return self.expression(INT, depth)
        if type_ == REAL and choices.chance(25):
            if choices.chance(20):  # more than a REAL can hold
                return f"{self._operand(INT, 1)} B_OR 16777217"
            return self.expression(INT, depth)
        if type_ == CHAR and self.risks():
            return '""'  # the checker lets it stand for a letter
        if type_ == CHAR and choices.chance(25):
            return self.expression(INT, 1) if self.risks() else f"{self._operand(INT, 1)} B_AND 127"
        return self.expression(type_, depth)

    def call(self) -> bool:
        """A procedure is called, or a function for what it does; arguments may be left out."""
        choices = self.choices
        result = choices.weighted(((6, None), (1, INT), (1, BOOL)))
        found = self.scope.callable(result, self.left() - 2)
        if not found:
            return False
        self.spend()
        self.write(self.call_of(choices.pick(found)))
        return True

    def proceed(self) -> bool:
        """ON_ERROR_PROCEED, what may go wrong, and a look at $ERR [TYP-13]."""
        target = self.target(INT)
        if target is None:
            return False
        self.spend(3)
        before, self.risk = self.risk, 60
        self.write("ON_ERROR_PROCEED")
        self.choices.weighted(_RISKY)(self)
        self.risk = before
        self.write(f"{target}=$ERR.NUMBER")
        return True

    # ----------------------------------------------------------------------- branches

    def branch(self) -> bool:
        """IF."""
        self.spend()
        self.write(f"IF {self.truth(self.choices.between(1, 2))} THEN")
        with self.block():
            self.statements(3)
        if self.choices.chance(50):
            self.write("ELSE")
            with self.block():
                self.statements(3)
        self.write("ENDIF")
        return True

    def switch(self) -> bool:
        """SWITCH over INT, CHAR or an enumeration [CTL-03, CTL-04]."""
        choices = self.choices
        type_ = choices.pick(_SELECTORS)
        labels = _labels(type_)
        selector = f"({self.expression(INT, 1)}) B_AND 3" if type_ == INT else self.read(type_)
        if selector is None:
            return False
        names = [
            one.variable.name for one in self.scope.places(type_) if _is_constant(one.variable)
        ]
        self.spend()
        self.write(f"SWITCH {selector}")
        left = list(labels)
        while left and (len(left) == len(labels) or choices.chance(65)):
            count = choices.between(1, min(len(left), 3))
            given, left = left[:count], left[count:]
            if names and choices.chance(20):
                given.append(choices.pick(names))
            self.write(f"CASE {','.join(given)}")
            with self.block():
                self.statements(2)
        if choices.chance(60):
            self.write("DEFAULT")
            with self.block():
                self.statements(2)
        self.write("ENDSWITCH")
        return True

    # ----------------------------------------------------------------------- loops

    def _times(self) -> int:
        """How often a loop is passed; 0 where there is no room for one."""
        room = self.left() // 12
        if self.loops >= 3 or self.level > _DEEPEST or room < 1:
            return 0
        return self.choices.between(1, min(5, room))

    def _spare(self) -> list[str]:
        """Variables for counting that no loop around counts with; of a data list in one routine."""
        used = {one.name for one in self.counters}
        return [name for name in self.passes if name not in used]

    def loop_for(self) -> bool:
        """FOR, upwards or downwards, its limits constants or not [CTL-05]."""
        choices = self.choices
        times, spare = self._times(), self._spare()
        if not times or not spare:
            return False
        name = choices.pick(spare)
        first, step = choices.pick((1, 1, 1, 0, -2)), choices.pick((1, 1, 1, 2, -1, -3))
        last = (
            first + step * (times - 1) + choices.between(0, abs(step) - 1) * (1 if step > 0 else -1)
        )
        low, high = min(first, first + step * (times - 1)), max(first, first + step * (times - 1))
        begin, end = str(first), str(last)
        way = choices.below(10)
        if way == 0:
            end = f"{last}+0*({self.expression(INT, 1)} B_AND 1)"
        elif way == 1:
            begin = f"({self._operand(INT, 1)} B_AND 0)+({first})"
        elif way == 2 and step == 1:
            end, low, high = f"({self._operand(INT, 1)} B_AND {3 if times >= 3 else 1})", first, 3
            times = max(3 - first + 1, 1)
        written = "" if step == 1 and choices.chance(60) else f" STEP {step}"
        self.spend(2)
        self.write(f"FOR {name}={begin} TO {end}{written}")
        with self.block(times + 1, is_loop=True):
            self.spend()
            self.counter(name, low, high)
            self.statements(3)
            self._leave()
        self.write("ENDFOR")
        return True

    def _counted(self) -> tuple[str, int] | None:
        """A variable of its own for a loop or a jump, set to zero, and how often it goes."""
        times, spare = self._times(), self._spare()
        if not times or not spare:
            return None
        name = self.choices.pick(spare)
        self.spend()
        self.write(f"{name}=0")
        return name, times

    def loop_while(self) -> bool:
        """WHILE [CTL-01]."""
        found = self._counted()
        if found is None:
            return False
        name, times = found
        with self.block(times + 1, is_loop=True):
            self.spend()
            sign = self.choices.pick((f"{name}<{times}", f"{name}<>{times}"))
            condition = sign
            if self.choices.chance(40):
                condition = f"({sign}) AND ({self.truth(1)})"
            self.level -= 1
            self.write(f"WHILE {condition}")
            self.level += 1
            self.counter(name, 1, times)
            self._count(name)
            self.statements(3)
            self._leave()
        self.write("ENDWHILE")
        return True

    def loop_repeat(self) -> bool:
        """REPEAT [CTL-01]."""
        found = self._counted()
        if found is None:
            return False
        name, times = found
        self.write("REPEAT")
        with self.block(times, is_loop=True):
            self.spend(2)
            self.counter(name, 1, times)
            self._count(name)
            self.statements(3)
            self._leave()
            more = f" OR ({self.truth(1)})" if self.choices.chance(40) else ""
        self.write(f"UNTIL ({name}>={times}){more}")
        return True

    def loop(self) -> bool:
        """LOOP, left by EXIT [CTL-01, CTL-02]."""
        found = self._counted()
        if found is None:
            return False
        name, times = found
        self.write("LOOP")
        with self.block(times, is_loop=True):
            self.spend(4)
            self.counter(name, 1, times)
            self._count(name)
            self.statements(3)
            self.write(f"IF {name}>={times} THEN")
            self.write("  EXIT")
            self.write("ENDIF")
        self.write("ENDLOOP")
        return True

    def _count(self, name: str) -> None:
        self.spend()
        self.write(f"{name}={name}+1")

    def _leave(self) -> None:
        """EXIT, sometimes."""
        if self.choices.chance(12):
            self.spend(2)
            self.write(f"IF {self.truth(1)} THEN")
            self.write("  EXIT")
            self.write("ENDIF")

    # ----------------------------------------------------------------------- jumps

    def _label(self) -> str:
        self.labels += 1
        return f"L{self.labels}"

    def _forward_jump(self) -> None:
        """GOTO to a label further on, from the same block or out of blocks [CTL-07]."""
        label = self._label()
        self.spend(2)
        way = self.choices.below(3)
        if way == 0:
            self.write(f"GOTO {label}")
        elif way == 1:
            self.write(f"IF {self.truth()} THEN")
            self.write(f"  GOTO {label}")
            self.write("ENDIF")
        else:
            found = self._counted()
            if found is None:
                self.write(f"GOTO {label}")
            else:
                name, times = found
                self.write("LOOP")
                with self.block(times, is_loop=True):
                    self.spend(3)
                    self.counter(name, 1, times)
                    self._count(name)
                    self.write(f"IF ({name}>={times}) OR ({self.truth(1)}) THEN")
                    self.write(f"  GOTO {label}")
                    self.write("ENDIF")
                    self.statements(2)
                self.write("ENDLOOP")
        if self.left() >= 12:
            self.statements(2)
        self.write(f"{label}:")

    def backward_jump(self) -> bool:
        """GOTO to a label passed before, so often as a variable counts."""
        found = self._counted()
        if found is None:
            return False
        name, times = found
        label = self._label()
        self.write(f"{label}:")
        with self.block(times):
            self.spend(3)
            self.counter(name, 0, times)
            self.level -= 1
            self._count(name)
            self.statements(3)
            self.write(f"IF {name}<{times} THEN")
            self.write(f"  GOTO {label}")
            self.write("ENDIF")
            self.level += 1
        return True

    def give_back(self) -> bool:
        """RETURN, on some condition [CTL-09]."""
        if self.loops and self.choices.chance(50):
            return False
        self.spend(2)
        self.write(f"IF {self.truth()} THEN")
        with self.block():
            self.returned()
        self.write("ENDIF")
        return True

    def returned(self) -> None:
        """RETURN, with a value in functions."""
        result = self.part.result
        if result is None:
            self.write("RETURN")
        elif isinstance(result, Array):
            self.write(f"RETURN {self.text()}")
        elif result == INT:
            self.write(f"RETURN ({self.expression(INT, 2)}) B_AND 1023")
        else:
            self.write(f"RETURN {self.expression(result, 2)}")


def _labels(type_: Type) -> Sequence[str]:
    if isinstance(type_, Enumeration):
        return [f"#{name}" for name in type_.constants]
    if type_ == CHAR:
        return ['"A"', '"Z"', '"a"', '" "', '"x"', '"0"']
    return ["0", "1", "-1", "2", "3", "'HF'", "100"]


def _is_constant(variable: Variable) -> bool:
    return not variable.is_writable and not isinstance(variable.type, Array)


_Rule = Callable[[Statements], bool]
_STATEMENTS: Final[tuple[tuple[int, _Rule], ...]] = (
    (20, Statements.assignment),
    (6, Statements.assign_whole),
    (5, Statements.assign_text),
    (6, Statements.call),
    (7, Statements.branch),
    (4, Statements.switch),
    (5, Statements.loop_for),
    (3, Statements.loop_while),
    (3, Statements.loop_repeat),
    (3, Statements.loop),
    (2, Statements.backward_jump),
    (1, Statements.give_back),
    (4, Statements.proceed),
    (5, Statements.set_variable),
    (1, Statements.cyclic_flag),
    (2, Statements.pulse),
    (2, Statements.wait),
    (2, Statements.halt),
    (1, Statements.invoke),
    (2, Statements.cyclic_signal),
    (3, Statements.format_text),
    (2, Statements.scan_text),
    (5, Statements.motion),
    (2, Statements.spline_motion),
    (1, Statements.emily_motion),
    (2, Statements.spline_block),
    (2, Statements.trigger),
    (4, Statements.interrupt),
    (2, Statements.brake),
)
_RISKY: Final[tuple[tuple[int, _Rule], ...]] = (
    (6, Statements.assignment),
    (2, Statements.set_variable),
    (2, Statements.call),
    (2, Statements.branch),
    (1, Statements.assign_whole),
    (1, Statements.motion),
    (1, Statements.switch),
)
_SELECTORS: Final[tuple[Type, ...]] = (INT, CHAR, COLOUR, MODE, INT)
_ASSIGNED: Final[tuple[tuple[int, Type], ...]] = (
    (8, INT),
    (6, REAL),
    (4, BOOL),
    (3, CHAR),
    (2, COLOUR),
    (1, MODE),
    (1, POINT),
    (1, RECORD),
)
