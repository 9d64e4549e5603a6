"""Expressions of a given type, from operators, the visible variables, and calls.

Relations bind most weakly in KRL and are put in parentheses as operands [ARI-05, ARI-06]. Most
numbers stay small, so that most programs run to their end without a fault.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from typing import Final

from grammar.generation import literals
from grammar.generation.choices import Weighted
from grammar.generation.literals import Path
from grammar.generation.routine_writer import Counter, ExpressionRule, RoutineWriter
from grammar.generation.scope import Parameter, Place, Places, Routine, Variable
from grammar.generation.types import COLOUR, MODE, POSES, TEXT, predefined
from grammar.semantics.types import BOOL, CHAR, INT, REAL, Array, Structure, Type

_ORDERS: Final = ("==", "<>", "<", ">", "<=", ">=", "=>", "=<")
_EQUAL: Final = ("==", "<>")
#: A depth of recursion at which the program stack overflows.
_TOO_DEEP: Final = 70
_VAR_STATE: Final = predefined("VAR_STATE")
_ENUMERATIONS: Final = Weighted[Type](
    (4, COLOUR),
    (2, MODE),
    (2, _VAR_STATE),
    (2, predefined("VAR_TYPE")),
    (1, predefined("ORI_TYPE")),
    (1, predefined("MODE_OP")),
    (1, predefined("CASE_SENSE_T")),
)
_ATOM: Final = re.compile(r"[\w.$]+(\[[\w.,$+]*\][\w.]*)?")


# ------------------------------------------------------------------------- places and atoms


def constant(code: RoutineWriter, type_: Type, *, is_signed: bool = True) -> str:
    """Return a constant."""
    return literals.constant(code.choices, type_, is_signed=is_signed)


def _index(code: RoutineWriter, size: int) -> str:
    """Return an index for a dimension of ``size`` elements, nearly always a valid one."""
    choices = code.choices
    if code.risks() and choices.chance(30):
        # The checker finds what lies outside if it is a constant.
        wrong = choices.pick(("-1", "0", str(size + 1), "100"))
        return f"{wrong}+0*{code.passes[0]}"
    way = choices.below(20)
    fitting = [one.name for one in code.counters if one.low >= 1 and one.high <= size]
    if 10 <= way < 16 and fitting:
        return choices.pick(fitting)
    if 16 <= way < 18 and size >= 2:
        return f"({operand(code, INT, 1)} B_AND {3 if size >= 4 else 1})+1"
    if way == 18:
        return f"{choices.between(1, size)}.{choices.pick('04')}"
    return str(choices.between(1, size))


def _written(code: RoutineWriter, variable: Variable, path: Path) -> str:
    """Return a place as text, with random indices."""
    way = (_index(code, one) if isinstance(one, int) else one for one in path)
    return "".join([variable.name, *way])


def target(code: RoutineWriter, type_: Type, *, is_local: bool = True) -> str | None:
    """Return a place that can be assigned, or ``None`` if there is none."""
    return _one_of(code, code.scope.places(type_, is_written=True, is_local=is_local))


def read(code: RoutineWriter, type_: Type) -> str | None:
    """Return a place that has a value, or ``None`` if there is none."""
    is_bare = code.risks()
    has_letters = type_ != CHAR or not code.choices.chance(92)
    return _one_of(code, code.scope.places(type_, is_bare=is_bare, has_letters=has_letters))


def _one_of(code: RoutineWriter, places: Places) -> str | None:
    """Return a random place: any place, or a place of a random variable."""
    choices = code.choices
    if not places.holders:
        return None
    if choices.chance(50):
        place = choices.pick(places.all)
        return _written(code, place.variable, place.path)
    variable, paths = choices.pick(places.holders)
    return _written(code, variable, choices.pick(paths))


def atom(code: RoutineWriter, type_: Type) -> str:
    """Return a variable or a constant."""
    choices = code.choices
    if choices.chance(70):
        if type_ == INT and code.counters and choices.chance(25):
            return choices.pick(code.counters).name
        found = read(code, type_)
        if found is not None:
            return found
    return constant(code, type_, is_signed=False)


def constant_or_place(code: RoutineWriter, type_: Type) -> str:
    """Return an assignable place, or a constant if there is none."""
    return target(code, type_) or constant(code, type_)


def count(code: RoutineWriter, name: str, low: int, high: int) -> None:
    """Record that a variable is a counter within these limits here."""
    code.counters.append(Counter(name, low, high))


# ------------------------------------------------------------------------- calls


def call_text(name: str, arguments: Iterable[str]) -> str:
    """Return a call as a statement or as part of an expression."""
    return f"{name}({', '.join(arguments)})"


def call_of(code: RoutineWriter, routine: Routine) -> str:
    """Return a call; its cost is counted at the current place."""
    if not routine.deepest:
        code.spend(routine.cost)
        return call_text(routine.name, _arguments(code, routine.parameters))
    deepest = max(min(code.left() // routine.cost - 1, routine.deepest), 1)
    bound = code.choices.between(1, min(deepest, 6))
    if deepest > _TOO_DEEP and code.risks():
        bound = _TOO_DEEP
    code.spend(routine.cost * (bound + 1))
    given = _arguments(code, routine.parameters[1:])
    return call_text(routine.name, [str(bound), *given])


def _arguments(code: RoutineWriter, parameters: Sequence[Parameter]) -> list[str]:
    return [argument(code, one.type, is_out=one.is_out) for one in parameters]


def argument(code: RoutineWriter, type_: Type, *, is_out: bool) -> str:
    """Return an argument; for a parameter :OUT nearly always a variable."""
    choices = code.choices
    if choices.chance(1):
        return ""  # left out [SCO-13]
    if isinstance(type_, Array):
        return text(code) if not is_out and type_ == TEXT else array(code, type_)
    if is_out and choices.chance(95):
        place = target(code, type_)
        if place is not None:
            return place
    if is_out or type_ not in (INT, REAL):
        return expression(code, type_, 1)
    return expression(code, choices.pick((type_, type_, type_, type_, INT, REAL)), 1)


def array(code: RoutineWriter, type_: Array) -> str:
    """Return a whole array, or part of one with more dimensions; empty if there is none."""
    rank, choices = len(type_.sizes), code.choices
    found = []
    for given in range(4 - rank):
        arrays = code.scope.arrays(type_.element, rank + given, is_written=True)
        if arrays and (given == 0 or choices.chance(40)):
            found.append(_row(code, choices.pick(arrays), given))
    return choices.pick(found) if found else ""


def _row(code: RoutineWriter, place: Place, given: int) -> str:
    """Return an array with its first ``given`` indices written [TYP-11]."""
    assert isinstance(place.type, Array)
    sizes = [size or 2 for size in place.type.sizes]
    first = ",".join(_index(code, size) for size in sizes[:given])
    commas = "," * (len(sizes) - max(given, 1))
    return f"{_written(code, place.variable, place.path)}[{first}{commas}]"


def text(code: RoutineWriter) -> str:
    """Return a text: a variable, a row of a table, or a literal."""
    found = array(code, TEXT) if code.choices.chance(60) else ""
    return found or constant(code, TEXT)


# ------------------------------------------------------------------------- expressions


def expression(code: RoutineWriter, type_: Type, depth: int) -> str:
    """Return an expression of a type; ``depth`` is how deep it may nest."""
    if depth <= 0:
        return atom(code, type_)
    choices, style = code.choices, code.style
    way = choices.below(100)
    if 75 <= way < 84:
        found = code.scope.callable(type_, code.left() - 1)
        if found:
            return call_of(code, choices.pick(found))
    elif way >= 84 and type_ in style.functions:
        return choices.weighted(style.functions[type_])(code, depth)
    if type_ in style.expressions:
        return choices.weighted(style.expressions[type_])(code, depth)
    return atom(code, type_)


def truth(code: RoutineWriter, depth: int = 2) -> str:
    """Return a condition."""
    return expression(code, BOOL, depth)


def operand(code: RoutineWriter, type_: Type, depth: int) -> str:
    """Return an expression as an operand: in parentheses if it is not an atom."""
    found = expression(code, type_, depth)
    return found if _ATOM.fullmatch(found) else f"({found})"


def factor(code: RoutineWriter, type_: Type) -> str:
    """Return a small number, as the operand of a product."""
    choices = code.choices
    small = ("2", "3", "7", "-1", "0") if type_ == INT else ("0.5", "1.1", "-2.0")
    found = choices.pick((*small, atom(code, type_)))
    return f"({found})" if found.startswith("-") else found


def divisor(code: RoutineWriter, type_: Type) -> str:
    """Return a number that is seldom zero."""
    choices = code.choices
    if code.risks():
        return choices.pick(("0", atom(code, type_)))
    if choices.chance(30):
        return f"(({atom(code, INT)} B_AND 7)+1)"
    return choices.pick(("2", "3", "(-2)", "7") if type_ == INT else ("2.0", "0.3", "4", "1.5"))


def chain(type_: Type) -> ExpressionRule:
    """Return a rule for sums and products without parentheses, to test precedence [ARI-05]."""

    def rule(code: RoutineWriter, depth: int) -> str:
        choices = code.choices
        found = atom(code, type_)
        for _ in range(choices.between(1, depth + 1)):
            sign = choices.pick("+-*/")
            if sign == "/":
                right = divisor(code, type_)
            elif sign == "*":
                right = str(choices.between(0, 4))
            else:
                right = atom(code, type_)
            found = f"{found} {sign} {right}"
        return found

    return rule


def letter(code: RoutineWriter, depth: int) -> str:
    """Return a CHAR, sometimes in parentheses; no operator has a CHAR as its result."""
    found = atom(code, CHAR)
    return f"({found})" if depth > 1 and code.choices.chance(10) else found


def pose(type_: Structure) -> ExpressionRule:
    """Return a rule for frames joined by the operator ``:``; the last gives the type [ARI-08]."""

    def rule(code: RoutineWriter, depth: int) -> str:
        choices = code.choices
        if choices.chance(45):
            return atom(code, type_)
        frames = [_frame(code, choices.pick(POSES)) for _ in range(choices.between(1, depth))]
        return " : ".join([*frames, _frame(code, type_)])

    return rule


def _frame(code: RoutineWriter, type_: Structure) -> str:
    """Return a variable, or an aggregate that names its type, which would be unknown otherwise."""
    choices = code.choices
    found = read(code, type_)
    if found is None or choices.chance(15):
        return f"{{{type_.name}: X 1.0,Y {constant(code, REAL)},Z 3.0,A 10.0,B 0.0,C -90.0}}"
    return f"({found})" if choices.chance(10) else found


# ------------------------------------------------------------------------- relations


def relation(code: RoutineWriter, depth: int) -> str:
    """Return a comparison by one of the rules [ARI-10]."""
    return code.choices.weighted(code.style.relations)(code, depth)


def near_comparison(code: RoutineWriter, _depth: int) -> str:
    """Return a comparison of numbers that are equal or nearly equal."""
    choices = code.choices
    left = atom(code, choices.pick((INT, REAL)))
    others = (left, left, left, f"{left}+1", f"{left}-1", "0", "1", "2", f"{left}*1.0")
    return f"{left} {choices.pick(_ORDERS)} {choices.pick(others)}"


def letter_comparison(code: RoutineWriter, _depth: int) -> str:
    """Return a comparison of CHAR values, sometimes with an empty text."""
    right = '""' if code.risks() else atom(code, CHAR)
    return f"{atom(code, CHAR)} {code.choices.pick(_ORDERS)} {right}"


def constant_comparison(code: RoutineWriter, depth: int) -> str:
    """Return a comparison of enumeration values, also predefined ones."""
    choices, style = code.choices, code.style
    type_ = choices.weighted(_ENUMERATIONS)
    if type_ not in style.functions and not code.scope.places(type_).holders:
        type_ = _VAR_STATE
    functions = style.functions.get(type_)
    left = choices.weighted(functions)(code, depth) if functions else read(code, type_)
    if left is None:
        return f"{atom(code, BOOL)}==TRUE"
    right = read(code, type_) if choices.chance(30) else None
    return f"{left} {choices.pick(_EQUAL)} {right or constant(code, type_)}"
