"""Constant folding: the values of expressions that are known before a program runs.

Array sizes, steps of FOR, labels of CASE and numbers of inputs and outputs need them. A quotient of
integers with a remainder is not folded, because the rounding of negative ones is not certain
[ARI-02]. Comparisons of rounded numbers with == are not folded either [ARI-10].
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping

from grammar.check.analysis.context import Context
from grammar.semantics.symbols import Kind
from grammar.semantics.types import INT_MAX, INT_MIN
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
        case ast.IntegerLiteral() | ast.BitLiteral():
            return _in_range(node.value)
        case ast.RealLiteral() | ast.BoolLiteral():
            return node.value
        case ast.StringLiteral():
            return f'"{node.text}"'
        case ast.EnumConstant():
            return f"#{node.name.key}"
        case ast.Parenthesised():
            return constant(context, node.inner)
        case ast.Variable():
            found = context.found(node.name)
            if found is None or found.symbol.kind is not Kind.CONSTANT:
                return None
            return None if found.symbol.value is None else _value(context, found.symbol.value)
        case ast.Unary():
            return _unary(context, node)
        case ast.Binary():
            return _binary(context, node)
    return None


def _in_range(value: int) -> int | None:
    """Return a number if it fits into 32 bits, where a bit literal may be unsigned."""
    return value if INT_MIN <= value <= 2 * INT_MAX + 1 else None


def _unary(context: Context, node: ast.Unary) -> Value | None:
    value = constant(context, node.operand)
    if value is None or isinstance(value, str):
        return None
    if isinstance(value, bool):
        return not value if node.operator == "NOT" else None
    if node.operator == "-":
        return -value
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
        return {"AND": left and right, "OR": left or right, "EXOR": left != right}.get(sign)
    if isinstance(left, str | bool) or isinstance(right, str | bool):
        return None
    if sign in _ORDERS:
        return _ORDERS[sign](left, right)
    return _calculated(sign, left, right)


def _calculated(sign: str, left: float, right: float) -> float | None:
    value: int | float | None = None
    match sign:
        case "+":
            value = left + right
        case "-":
            value = left - right
        case "*":
            value = left * right
        case "/" if right != 0:
            if isinstance(left, float) or isinstance(right, float):
                value = left / right
            elif left % right == 0:
                value = left // right
    return _in_range(value) if type(value) is int else value
