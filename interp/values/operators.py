"""Operators on values: one table of typed primitives, and the choice of a primitive.

A `Primitive` works on operands of fixed kinds; the machines have one instruction for each. `select`
chooses the primitive of an operator from the kinds of its operands that the checker knows, and the
conversions that the operands need first. `apply` does the same at run time from the values. Both
use one table, so an operator has one meaning.

Operands are evaluated from left to right, and always both: AND and OR, whose operands are BOOL
[ARI-13], do not stop after the first, as no rule says that they would (unconfirmed). An INT
combined with a REAL is first converted to REAL, and so rounded to single [ARI-01]. A CHAR in a
relation or bit operation is its code [ARI-10].
A missing value is detected when the variable is read, so primitives never see ``None``.
"""

from __future__ import annotations

import operator as python
from collections.abc import Callable, Mapping
from functools import cache
from types import MappingProxyType
from typing import Any, Literal, cast

from grammar.semantics import operations
from grammar.semantics.types import (
    BOOL,
    CHAR,
    INT,
    REAL,
    Aggregate,
    Constant,
    Enumeration,
    Text,
    Type,
    is_cartesian,
)
from interp.values.faults import fault
from interp.values.geometric_operator import composed
from interp.values.values import EnumValue, StructureValue, Value, integer, rounded, single
from support.lazy_dataclass import dataclass

#: The kinds of operands that primitives distinguish. FRAME is any pose: FRAME, POS, E3POS, E6POS.
Kind = Literal["INT", "REAL", "BOOL", "CHAR", "ENUM", "FRAME"]


@dataclass(frozen=True, slots=True)
class Primitive:
    """An operation on operands of fixed kinds.

    ``faults`` are the slugs of the faults that it can raise.
    """

    name: str
    operands: tuple[Kind, ...]
    result: Kind
    function: Callable[..., Any]
    faults: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Selection:
    """How an operator is executed: the conversions of each operand, then the primitive.

    ``primitive`` is ``None`` if the operator does nothing, as the sign ``+``.
    """

    conversions: tuple[tuple[Primitive, ...], ...]
    primitive: Primitive | None
    result: Kind


# ------------------------------------------------------------------------------- functions


def _divided(left: int, right: int) -> int:
    if right == 0:
        raise fault("division_by_zero")
    return integer(int(left / right))  # a double rounds no quotient of two INT up to a whole number


def _quotient(left: float, right: float) -> float:
    if right == 0:
        raise fault("division_by_zero")
    return single(left / right)


def _code(letter: str) -> int:
    if len(letter) != 1:  # the empty text, which the checker accepts as a CHAR
        raise fault("operand")
    return ord(letter)


def _letter(code: int) -> str:
    if not 0 <= code <= 255:
        raise fault("inadmissible")
    return chr(code)


# ------------------------------------------------------------------------------- the table

_Row = tuple[str, str, Callable[..., Any], str]
#: The relations of each kind of operands, by their names in Python.
_RELATIONS: Mapping[Kind, str] = {
    "INT": "eq ne lt gt le ge",
    "REAL": "eq ne lt gt le ge",
    "BOOL": "eq ne",
    "ENUM": "eq ne",
}

# Name, kinds of the operands and of the result, function, faults. For + - * / and the square root
# of singles, computing in double and rounding once equals single-precision arithmetic.
_ROWS: tuple[_Row, ...] = (
    ("add_int", "INT INT INT", lambda a, b: integer(a + b), "overflow"),
    ("sub_int", "INT INT INT", lambda a, b: integer(a - b), "overflow"),
    ("mul_int", "INT INT INT", lambda a, b: integer(a * b), "overflow"),
    ("div_int", "INT INT INT", _divided, "division_by_zero overflow"),
    ("neg_int", "INT INT", lambda a: integer(-a), "overflow"),
    ("add_real", "REAL REAL REAL", lambda a, b: single(a + b), "overflow"),
    ("sub_real", "REAL REAL REAL", lambda a, b: single(a - b), "overflow"),
    ("mul_real", "REAL REAL REAL", lambda a, b: single(a * b), "overflow"),
    ("div_real", "REAL REAL REAL", _quotient, "division_by_zero overflow"),
    ("neg_real", "REAL REAL", python.neg, ""),
    *(
        (f"{name}_{kind.lower()}", f"{kind} {kind} BOOL", getattr(python, name), "")
        for kind, names in _RELATIONS.items()
        for name in names.split()
    ),
    ("not_bool", "BOOL BOOL", python.not_, ""),
    ("and_bool", "BOOL BOOL BOOL", python.and_, ""),
    ("or_bool", "BOOL BOOL BOOL", python.or_, ""),
    ("exor_bool", "BOOL BOOL BOOL", python.xor, ""),
    ("not_bits", "INT INT", python.invert, ""),
    ("and_bits", "INT INT INT", python.and_, ""),
    ("or_bits", "INT INT INT", python.or_, ""),
    ("exor_bits", "INT INT INT", python.xor, ""),
    ("compose", "FRAME FRAME FRAME", composed, "uninitialised overflow"),
    ("int_to_real", "INT REAL", single, ""),
    ("real_to_int", "REAL INT", rounded, "overflow"),
    ("char_to_int", "CHAR INT", _code, "operand"),
    ("int_to_char", "INT CHAR", _letter, "inadmissible"),
)


def _primitive(name: str, kinds: str, function: Callable[..., Any], faults: str) -> Primitive:
    *operands, result = cast("list[Kind]", kinds.split())
    return Primitive(name, tuple(operands), result, function, tuple(faults.split()))


#: All primitives by name, in a fixed order.
PRIMITIVES: Mapping[str, Primitive] = MappingProxyType({row[0]: _primitive(*row) for row in _ROWS})

#: The primitives of an operator, from narrow to wide: the first to which its operands convert.
BINARY: Mapping[str, tuple[str, ...]] = {
    "+": ("add_int", "add_real"),
    "-": ("sub_int", "sub_real"),
    "*": ("mul_int", "mul_real"),
    "/": ("div_int", "div_real"),
    "==": ("eq_int", "eq_real", "eq_bool", "eq_enum"),
    "<>": ("ne_int", "ne_real", "ne_bool", "ne_enum"),
    "<": ("lt_int", "lt_real"),
    ">": ("gt_int", "gt_real"),
    "<=": ("le_int", "le_real"),
    ">=": ("ge_int", "ge_real"),
    "AND": ("and_bool",),
    "OR": ("or_bool",),
    "EXOR": ("exor_bool",),
    "B_AND": ("and_bits",),
    "B_OR": ("or_bits",),
    "B_EXOR": ("exor_bits",),
    ":": ("compose",),
}
UNARY: Mapping[str, tuple[str, ...]] = {
    "-": ("neg_int", "neg_real"),
    "NOT": ("not_bool",),
    "B_NOT": ("not_bits",),
}

#: Operators that accept a CHAR and use its code.
_ACCEPTS_CHAR = operations.EQUALITY | operations.ORDER | operations.BITWISE | {"B_NOT"}
#: The primitives that convert one kind to another.
_CONVERSIONS: Mapping[tuple[Kind, Kind], tuple[str, ...]] = {
    ("INT", "REAL"): ("int_to_real",),
    ("CHAR", "INT"): ("char_to_int",),
    ("CHAR", "REAL"): ("char_to_int", "int_to_real"),
}


@cache
def select(operator: str, *kinds: Kind) -> Selection | None:
    """Return how an operator works on one or two operands of these kinds.

    Return ``None`` if it does not accept such operands. Raises `ValueError` if there is no such
    operator with that number of operands.
    """
    table = BINARY if len(kinds) == 2 else UNARY
    if operator == "+" and len(kinds) == 1:
        (kind,) = kinds
        return Selection(((),), None, kind) if kind in ("INT", "REAL") else None
    if operator not in table:
        raise ValueError(f"{operator!r} is no operator of so many operands: {len(kinds)}")
    for name in table[operator]:
        primitive = PRIMITIVES[name]
        per_operand = [
            _conversion(kind, to, operator)
            for kind, to in zip(kinds, primitive.operands, strict=True)
        ]
        if all(conversion is not None for conversion in per_operand):
            conversions = tuple(
                tuple(PRIMITIVES[step] for step in conversion or ()) for conversion in per_operand
            )
            return Selection(conversions, primitive, primitive.result)
    return None


def _conversion(kind: Kind, to: Kind, operator: str) -> tuple[str, ...] | None:
    if kind == to:
        return ()
    if kind == "CHAR" and operator not in _ACCEPTS_CHAR:
        return None
    return _CONVERSIONS.get((kind, to))


# ------------------------------------------------------------------------------- kinds

_SCALARS: Mapping[Type, Kind] = {INT: "INT", REAL: "REAL", BOOL: "BOOL", CHAR: "CHAR"}
_PYTHON: Mapping[type, Kind] = {
    int: "INT",
    float: "REAL",
    bool: "BOOL",
    str: "CHAR",
    EnumValue: "ENUM",
    StructureValue: "FRAME",
}


def kind_of(type_: Type) -> Kind | None:
    """Return the kind of a type; ``None`` for arrays and other types that no operator accepts."""
    match type_:
        case Enumeration() | Constant():
            return "ENUM"
        case Text():
            return "CHAR" if type_.length <= 1 else None
        case Aggregate():
            return "FRAME" if type_.structure is None or is_cartesian(type_.structure) else None
    if is_cartesian(type_):
        return "FRAME"
    return _SCALARS.get(type_)


def kind_of_value(value: Value) -> Kind:
    """Return the kind of a value; faults ``operand`` if no operator accepts the value."""
    kind = _PYTHON.get(type(value))
    if kind is None or (isinstance(value, StructureValue) and not is_cartesian(value.type)):
        raise fault("operand")
    return kind


# ------------------------------------------------------------------------------- application


def apply(operator: str, left: Value, right: Value) -> Value:
    """Return ``left operator right``; faults ``operand`` if it does not accept such operands."""
    return _applied(select(operator, kind_of_value(left), kind_of_value(right)), (left, right))


def apply_unary(operator: str, operand: Value) -> Value:
    """Return ``operator operand``; faults ``operand`` if it does not accept such an operand."""
    return _applied(select(operator, kind_of_value(operand)), (operand,))


def _applied(selection: Selection | None, operands: tuple[Value, ...]) -> Value:
    if selection is None:
        raise fault("operand")
    values: list[Any] = list(operands)
    for place, steps in enumerate(selection.conversions):
        for step in steps:
            values[place] = step.function(values[place])
    if selection.primitive is None:
        (same,) = operands
        return same
    result: Value = selection.primitive.function(*values)
    return result
