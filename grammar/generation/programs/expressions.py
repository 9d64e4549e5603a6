"""Expressions of a type that is asked for, from what a place can name.

Relations bind weakest in KRL and stand in parentheses where they are operands [ARI-05]. Numbers are
kept small as a rule, so that most programs go on; now and then one is not.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Final

from grammar.generation.programs.code import Counter
from grammar.generation.programs.functions import Functions
from grammar.generation.programs.kinds import (
    CASES,
    COLOUR,
    MODE,
    POSES,
    VAR_STATE,
    VAR_TYPE,
    constant,
    predefined,
)
from grammar.generation.programs.scope import Place, Routine
from grammar.semantics.types import BOOL, CHAR, INT, REAL, Array, Structure, Type

__all__ = ["Expressions"]

_ORDERS: Final = ("==", "<>", "<", ">", "<=", ">=", "=>", "=<")
_EQUAL: Final = ("==", "<>")
#: Deep enough for the program stack to overflow.
_TOO_DEEP: Final = 70


class Expressions(Functions):
    """Makes expressions, places, calls."""

    # ----------------------------------------------------------------------- places

    def index(self, size: int) -> str:
        """An index for a dimension of so many elements: nearly always one that it has."""
        choices = self.choices
        if self.risks() and choices.chance(30):
            # The checker finds what lies outside if it is a constant.
            wrong = choices.pick(("-1", "0", str(size + 1), "100"))
            return f"{wrong}+0*{self.passes[0]}"
        way = choices.below(20)
        fitting = [one.name for one in self.counters if one.low >= 1 and one.high <= size]
        if 10 <= way < 16 and fitting:
            return choices.pick(fitting)
        if 16 <= way < 18 and size >= 2:
            return f"({self._operand(INT, 1)} B_AND {3 if size >= 4 else 1})+1"
        if way == 18:
            return f"{choices.between(1, size)}.{choices.pick('04')}"
        return str(choices.between(1, size))

    def written(self, place: Place) -> str:
        """A place as text, with indices drawn for it."""
        way = (self.index(one) if isinstance(one, int) else one for one in place.pieces)
        return "".join([place.variable.name, *way])

    def target(self, type_: Type, *, is_local: bool = True) -> str | None:
        """A place that can be assigned, ``None`` where there is none."""
        places = self.scope.places(type_, is_written=True, is_local=is_local)
        return self.written(self._one_of(places)) if places else None

    def _one_of(self, places: Sequence[Place]) -> Place:
        """A place: of one as likely as of the other, or of each variable alike."""
        if self.choices.chance(50):
            return self.choices.pick(places)
        variable = self.choices.pick(list(dict.fromkeys(one.variable for one in places)))
        return self.choices.pick([one for one in places if one.variable is variable])

    def read(self, type_: Type) -> str | None:
        """A place that has a value, ``None`` where there is none."""
        places = self.scope.places(type_, is_bare=self.risks())
        if type_ == CHAR and self.choices.chance(92):
            places = [one for one in places if not one.is_letter_of_text]
        return self.written(self._one_of(places)) if places else None

    def atom(self, type_: Type) -> str:
        """A variable or a constant."""
        choices = self.choices
        if choices.chance(70):
            if type_ == INT and self.counters and choices.chance(25):
                return choices.pick(self.counters).name
            found = self.read(type_)
            if found is not None:
                return found
        return constant(choices, type_, is_signed=False)

    def counter(self, name: str, low: int, high: int) -> None:
        """In this block a variable has a value within limits."""
        self.counters.append(Counter(name, low, high))

    # ----------------------------------------------------------------------- calls

    def call_of(self, routine: Routine) -> str:
        """A call, whose cost is charged to the place it stands in."""
        if not routine.deepest:
            self.spend(routine.cost)
            given = [self.argument(one.type, is_out=one.is_out) for one in routine.parameters]
            return f"{routine.name}({', '.join(given)})"
        deepest = max(min(self.left() // routine.cost - 1, routine.deepest), 1)
        bound = self.choices.between(1, min(deepest, 6))
        if deepest > _TOO_DEEP and self.risks():
            bound = _TOO_DEEP
        self.spend(routine.cost * (bound + 1))
        given = [self.argument(one.type, is_out=one.is_out) for one in routine.parameters[1:]]
        return f"{routine.name}({', '.join([str(bound), *given])})"

    def argument(self, type_: Type, *, is_out: bool) -> str:
        """An argument; for a parameter :OUT a variable nearly always."""
        choices = self.choices
        if choices.chance(1):
            return ""  # left out [SCO-13]
        if isinstance(type_, Array):
            is_text = not is_out and type_ == Array(CHAR, (None,))
            return self.text() if is_text else self.array(type_)
        if is_out and choices.chance(95):
            place = self.target(type_)
            if place is not None:
                return place
        if is_out or type_ not in (INT, REAL):
            return self.expression(type_, 1)
        return self.expression(choices.weighted(((4, type_), (1, INT), (1, REAL))), 1)

    def array(self, type_: Array) -> str:
        """A whole array, or a row of one of more dimensions; empty where there is none."""
        rank, choices = len(type_.sizes), self.choices
        found = []
        whole = self.scope.arrays(type_.element, rank, is_written=True)
        if whole:
            found.append(f"{self.written(choices.pick(whole))}[{',' * (rank - 1)}]")
        for more in range(rank + 1, 4):
            wider = self.scope.arrays(type_.element, more, is_written=True)
            if wider and choices.chance(40):
                found.append(self._row(choices.pick(wider), more - rank))
        return choices.pick(found) if found else ""

    def _row(self, place: Place, given: int) -> str:
        """A part of an array: its first dimensions have an index [TYP-11]."""
        assert isinstance(place.type, Array)
        sizes = [size or 2 for size in place.type.sizes]
        first = ",".join(self.index(size) for size in sizes[:given])
        return f"{self.written(place)}[{first}{',' * (len(sizes) - given)}]"

    def text(self) -> str:
        """A text: a variable, a row of a table, or a text as written."""
        found = self.array(Array(CHAR, (None,))) if self.choices.chance(60) else ""
        return found or constant(self.choices, Array(CHAR, (None,)))

    # ----------------------------------------------------------------------- expressions

    def expression(self, type_: Type, depth: int) -> str:
        """An expression of a type; ``depth`` is how deep it may nest."""
        if depth <= 0:
            return self.atom(type_)
        way = self.choices.below(100)
        if 75 <= way < 84:
            found = self.scope.callable(type_, self.left() - 1)
            if found:
                return self.call_of(self.choices.pick(found))
        elif way >= 84:
            value = self.function_value(type_, depth - 1)
            if value is not None:
                return value
        maker = _MAKERS.get(type_)
        if maker is not None:
            return maker(self, depth)
        if isinstance(type_, Structure) and type_ in POSES:
            return self._pose(type_, depth)
        return self.atom(type_)

    def truth(self, depth: int = 2) -> str:
        """A condition."""
        return self.expression(BOOL, depth)

    def _operand(self, type_: Type, depth: int) -> str:
        found = self.expression(type_, depth)
        return found if _is_atom(found) else f"({found})"

    def _integer(self, depth: int) -> str:
        choices = self.choices
        way = choices.below(20)
        if way < 3:
            return self.atom(INT)
        if way < 6:
            return self._chain(INT, depth)
        left = self._operand(INT, depth - 1)
        if way < 9:
            return f"{left} {choices.pick('+-')} {self._operand(INT, depth - 1)}"
        if way < 11:
            return f"{left} * ({choices.pick(('2', '3', '7', '-1', '0', self.atom(INT)))})"
        if way < 13:
            return f"{left} / {self._divisor(INT)}"
        if way < 17:
            sign = choices.pick(("B_AND", "B_OR", "B_EXOR", "B_AND"))
            return (
                f"{left} {sign} {self._operand(choices.weighted(((5, INT), (1, CHAR))), depth - 1)}"
            )
        return f"B_NOT {left}" if way < 18 else f"{choices.pick('-+')}{left}"

    def _real(self, depth: int) -> str:
        choices = self.choices
        way = choices.below(20)
        if way < 3:
            return self.atom(REAL)
        if way < 5:
            return self._chain(REAL, depth)
        mixed = choices.weighted(((3, REAL), (1, INT)))
        left = self._operand(REAL, depth - 1)
        if way < 10:
            return f"{left} {choices.pick('+-')} {self._operand(mixed, depth - 1)}"
        if way < 13:
            return f"{left} * ({choices.pick(('0.5', '1.1', '-2.0', self.atom(REAL)))})"
        if way < 15:
            return f"{self._operand(mixed, depth - 1)} * {left}"
        return f"{left} / {self._divisor(REAL)}" if way < 18 else f"{choices.pick('-+')}{left}"

    def _chain(self, type_: Type, depth: int) -> str:
        """Sums and products without parentheses, so that precedence is at work [ARI-05]."""
        choices = self.choices
        found = self.atom(type_)
        for _ in range(choices.between(1, depth + 1)):
            sign = choices.pick("+-*/")
            if sign == "/":
                found += f"/{self._divisor(type_)}"
            elif sign == "*":
                found += f"*{choices.between(0, 4)}"
            else:
                found += f"{sign}{self.atom(type_)}"
        return found

    def _divisor(self, type_: Type) -> str:
        choices = self.choices
        if self.risks():
            return choices.pick(("0", self.atom(type_)))
        if choices.chance(30):
            return f"(({self.atom(INT)} B_AND 7)+1)"
        return choices.pick(("2", "3", "(-2)", "7") if type_ == INT else ("2.0", "0.3", "4", "1.5"))

    def _truth(self, depth: int) -> str:
        choices = self.choices
        way = choices.below(20)
        if way < 2:
            return self.atom(BOOL)
        if way < 11:
            return self._relation(depth)
        if way < 18:
            operands = [self._operand(BOOL, depth - 1) for _ in range(choices.between(2, 3))]
            return f" {choices.pick(('AND', 'OR', 'EXOR'))} ".join(operands)
        return f"NOT {self._operand(BOOL, depth - 1)}"

    def _relation(self, depth: int) -> str:
        """A comparison; numbers of both kinds and letters, or two values of one type [ARI-10]."""
        choices = self.choices
        way = choices.below(10)
        if way >= 8:
            return self._of_constants(depth)
        if way < 4:
            return self._near(choices.pick((INT, REAL)))
        if way < 6:
            left, right = choices.pick(((INT, INT), (REAL, REAL), (INT, REAL), (CHAR, CHAR)))
        elif way < 7:
            left, right = choices.pick(((CHAR, INT), (INT, CHAR), (REAL, INT)))
        else:
            left = right = BOOL
        sign = choices.pick(_EQUAL if left == BOOL else _ORDERS)
        if left == right == CHAR and self.risks():
            return f'{self._operand(CHAR, depth - 1)} {sign} ""'  # which is no letter
        return f"{self._operand(left, depth - 1)} {sign} {self._operand(right, depth - 1)}"

    def _near(self, type_: Type) -> str:
        """A comparison of numbers that are equal or nearly so."""
        choices = self.choices
        left = self.atom(type_)
        others = (left, left, left, f"{left}+1", f"{left}-1", "0", "1", "2", f"{left}*1.0")
        return f"{left} {choices.pick(_ORDERS)} {choices.pick(others)}"

    def _of_constants(self, depth: int) -> str:
        """A comparison of constants of an enumeration, the controller's own among them."""
        choices = self.choices
        type_ = choices.weighted(_ENUMERATIONS)
        left = self.function_value(type_, depth) or self.read(type_)
        if left is None:
            type_ = VAR_STATE
            left = self.function_value(type_, depth)
        right = self.read(type_) if choices.chance(30) else None
        return f"{left} {choices.pick(_EQUAL)} {right or constant(choices, type_)}"

    def _letter(self, depth: int) -> str:
        found = self.atom(CHAR)
        return f"({found})" if depth > 1 and self.choices.chance(10) else found

    def _pose(self, type_: Structure, depth: int) -> str:
        """Frames composed by the geometric operator; the last one gives the type [ARI-08]."""
        choices = self.choices
        if choices.chance(45):
            return self.atom(type_)
        found = [self._composable(choices.pick(POSES)) for _ in range(choices.between(1, depth))]
        return ":".join([*found, self._composable(type_)])

    def _composable(self, type_: Structure) -> str:
        """A variable, or an aggregate that tells its type, as nothing else would."""
        choices = self.choices
        found = self.read(type_)
        if found is None or choices.chance(15):
            number = constant(choices, REAL)
            return f"{{{type_.name}: X 1.0,Y {number},Z 3.0,A 10.0,B 0.0,C -90.0}}"
        return f"({found})" if choices.chance(10) else found


def _is_atom(text: str) -> bool:
    return all(one.isalnum() or one in "_.$" for one in text)


_ENUMERATIONS: Final[tuple[tuple[int, Type], ...]] = (
    (4, COLOUR),
    (2, MODE),
    (2, VAR_STATE),
    (2, VAR_TYPE),
    (1, predefined("ORI_TYPE")),
    (1, predefined("MODE_OP")),
    (1, CASES),
)
_MAKERS: Final[Mapping[Type, Callable[[Expressions, int], str]]] = {
    INT: Expressions._integer,
    REAL: Expressions._real,
    BOOL: Expressions._truth,
    CHAR: Expressions._letter,
}
