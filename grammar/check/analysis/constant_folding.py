"""Constant folding: the values of expressions that are known before a program runs.

Array sizes, steps of FOR, labels of CASE and numbers of inputs and outputs need them. What folds
has the value that executors compute. No constant is what overflows, a quotient of integers with a
remainder, as the rounding of negative ones is not certain [ARI-02], and a comparison of rounded
numbers with == [ARI-10].
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping

from grammar.check.analysis.context import Context
from grammar.semantics.numbers import nearest_integer, nearest_single, signed
from grammar.semantics.symbols import Kind
from grammar.semantics.types import INT, INT_MAX, INT_MIN, REAL
from grammar.syntax import ast
from grammar.syntax.walk import left_chain

#: A number, a truth value, a text, or a constant of an enumeration as ``#NAME`` in upper case.
Value = int | float | bool | str

_ORDERS: Mapping[str, Callable[[float, float], bool]] = {
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
}
_EQUALITY: Mapping[str, Callable[[Value, Value], bool]] = {"==": operator.eq, "<>": operator.ne}
_LOGIC: Mapping[str, Callable[[bool, bool], bool]] = {
    "AND": operator.and_,
    "OR": operator.or_,
    "EXOR": operator.xor,
}
_ARITHMETIC: Mapping[str, Callable[[float, float], float]] = {
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
}
#: By operator the value of one side that settles it whatever the other side is.
_SETTLED = {"AND": False, "OR": True}


def constant(context: Context, node: ast.Expression) -> Value | None:
    """Return the value of an expression and store it in the context; ``None`` if not constant.

    The name of a CONST stands for its value. A text is returned in quotation marks to distinguish
    it from an enumeration constant.
    """
    if node in context.values:
        known: Value = context.values[node]
        return known
    value = _value(context, node)
    if value is not None:
        context.values[node] = value
    return value


def integer_of(context: Context, node: ast.Expression | None) -> int | None:
    """Return the value of an expression if it is a constant integer."""
    value = None if node is None else constant(context, node)
    return value if type(value) is int else None


def _value(context: Context, node: ast.Expression) -> Value | None:
    match node:
        case ast.IntegerLiteral() | ast.RealLiteral():
            return _in_range(node.value)
        case ast.BitLiteral():
            return _in_range(signed(node.value))
        case ast.BoolLiteral():
            return node.value
        case ast.StringLiteral():
            return f'"{node.text}"'
        case ast.EnumConstant():
            return f"#{node.name.key}"
        case ast.Parenthesised():
            return constant(context, node.inner)
        case ast.Variable():
            return _of_constant(context, node)
        case ast.Unary():
            return _unary(context, node)
        case ast.Binary():
            return _binary(context, node)
    return None


def _of_constant(context: Context, node: ast.Variable) -> Value | None:
    """Return the value of a CONST, converted to the type that it is declared with."""
    found = context.found(node.name)
    symbol = None if found is None else found.symbol
    if symbol is None or symbol.kind is not Kind.CONSTANT or symbol.value is None:
        return None
    value = _value(context, symbol.value)
    declared = symbol.type.key if symbol.type else ""
    if isinstance(value, float) and declared == INT.name:
        return _in_range(nearest_integer(value))
    if type(value) is int and declared == REAL.name:
        return _in_range(float(value))
    return value


def _in_range(value: float) -> float | None:
    """Return a number as an INT or a REAL; ``None`` if it does not fit into 32 bits."""
    if isinstance(value, float):
        return nearest_single(value)
    return value if INT_MIN <= value <= INT_MAX else None


def _unary(context: Context, node: ast.Unary) -> Value | None:
    value = constant(context, node.operand)
    if value is None or isinstance(value, str):
        return None
    if isinstance(value, bool):
        return not value if node.operator == "NOT" else None
    if node.operator == "-":
        return _in_range(-value)
    return value if node.operator == "+" else None


def _binary(context: Context, node: ast.Binary) -> Value | None:
    first, *others = left_chain(node)
    value = _folded(first.operator, constant(context, first.left), constant(context, first.right))
    for each in others:
        value = _folded(each.operator, value, constant(context, each.right))
    return value


def _folded(sign: str, left: Value | None, right: Value | None) -> Value | None:
    settled = _SETTLED.get(sign)
    if settled is not None and (left is settled or right is settled):
        return settled
    if left is None or right is None:
        return None
    if type(left) is type(right) is not float and sign in _EQUALITY:
        return _EQUALITY[sign](left, right)
    if isinstance(left, bool) and isinstance(right, bool):
        return _LOGIC[sign](left, right) if sign in _LOGIC else None
    if isinstance(left, str | bool) or isinstance(right, str | bool):
        return None
    if isinstance(left, float) or isinstance(right, float):
        left, right = nearest_single(left), nearest_single(right)  # [ARI-01]
    if left is None or right is None:
        return None
    if sign in _ORDERS:
        return _ORDERS[sign](left, right)
    if sign in _ARITHMETIC:
        return _in_range(_ARITHMETIC[sign](left, right))
    if sign != "/" or not right:
        return None
    if isinstance(left, int) and isinstance(right, int):
        return None if left % right else _in_range(left // right)
    return _in_range(left / right)
