"""Values that programs assign: small numbers, conversions, and sometimes an overflow."""

from __future__ import annotations

from typing import Final

from grammar.generation.expressions import atom, expression, operand, read
from grammar.generation.routine_writer import RoutineWriter
from grammar.semantics.types import CHAR, INT, REAL, Type

#: Expressions at and beyond the limits of INT and REAL.
_TOO_LARGE: Final = (
    *("2147483647+?", "?-2147483647-2", "99999*99999+?", "-2147483647-1-?", "1.0E30*1.0E30+?"),
    *("46341*46341+?", "3.0E38+3.0E38+?", "-(-2147483647-1)", "2147483647.0+?", "0.5E-30*1.0E-30"),
)


def assigned_value(code: RoutineWriter, type_: Type) -> str:
    """Return a value for a variable of a type, sometimes one that has to be converted."""
    choices = code.choices
    depth = choices.between(1, code.size.depth)
    if type_ in (INT, REAL) and code.risks():
        return choices.pick(_TOO_LARGE).replace("?", atom(code, INT))
    if type_ == INT:
        return _integer(code, depth)
    if type_ == REAL and choices.chance(25):
        if choices.chance(20):  # more than a REAL can hold
            return f"{operand(code, INT, 1)} B_OR 16777217"
        return expression(code, INT, depth)
    if type_ == CHAR and code.risks():
        return '""'  # the checker accepts it for a letter
    if type_ == CHAR and choices.chance(25):
        if code.risks():
            return expression(code, INT, 1)
        return f"{operand(code, INT, 1)} B_AND 127"
    return expression(code, type_, depth)


def _integer(code: RoutineWriter, depth: int) -> str:
    choices = code.choices
    match choices.below(12):
        case 0 | 1 | 2 | 3:
            return f"({expression(code, INT, depth)}) B_AND {choices.pick(('255', '4095'))}"
        case 4 | 5:
            return f"({expression(code, INT, depth)})/{choices.pick(('10', '7', '100'))}"
        case 6:
            return expression(code, REAL, depth)
        case 7:
            return f"{operand(code, INT, 1)}/{choices.pick(('2.0', '-2.0', '4.0'))}"
        case 8:
            return read(code, CHAR) or expression(code, INT, 1)
    return expression(code, INT, depth)
