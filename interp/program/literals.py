"""The values of literals, for all code that evaluates or translates expressions."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Final

from grammar.semantics.numbers import signed
from grammar.semantics.types import INT_MAX, UNKNOWN, Enumeration, Type
from grammar.syntax import ast
from grammar.syntax.walk import without_parentheses
from interp.program.load import Unit
from interp.values.faults import LinkError
from interp.values.operators import apply_unary
from interp.values.values import EnumValue, Value, constant, integer, letters, single

#: The value of a literal by the class of its node. A number that is too large faults ``overflow``
#: [ARI-12].
LITERALS: Final[Mapping[type[Any], Callable[[Any], int | float | bool | str]]] = {
    ast.IntegerLiteral: lambda node: integer(node.value),
    ast.RealLiteral: lambda node: single(node.value),
    ast.BoolLiteral: lambda node: node.value,
    ast.BitLiteral: lambda node: integer(signed(node.value)),
    ast.StringLiteral: lambda node: letters(node.text),
    ast.ChannelName: lambda node: letters(node.name.key),
}


def enumeration_constant(unit: Unit, node: ast.EnumConstant, wanted: Type) -> EnumValue:
    """Return ``#NAME`` as a value of the type that its context wants [TYP-16].

    Raises `LinkError` if the enumeration is unknown.
    """
    kind = unit.checked.enumerations.get(node, wanted)
    return constant(known_enumeration(node, kind), node.name.key)


def known_enumeration(node: ast.EnumConstant, found: object) -> Enumeration:
    """Return ``found`` if it is the enumeration of a constant, else raise `LinkError`."""
    if not isinstance(found, Enumeration):
        raise LinkError(f"nothing says which enumeration #{node.name.text} is of")
    return found


def literal_value(unit: Unit, node: ast.Expression, wanted: Type) -> Value:
    """Return the value of a literal or an enumeration constant, with unary operators around it.

    Raises `LinkError` for any other expression, and `Fault`.
    """
    match node:
        case ast.Parenthesised():
            return literal_value(unit, node.inner, wanted)
        case ast.Unary():
            return apply_unary(node.operator, literal_value(unit, node.operand, UNKNOWN))
        case ast.EnumConstant():
            return enumeration_constant(unit, node, wanted)
    if (rule := LITERALS.get(type(node))) is None:
        raise LinkError("no literal")
    return rule(node)


def integer_literal(node: ast.Expression) -> int | None:
    """Return the value of an INT literal, also in parentheses; ``None`` for all else."""
    node = without_parentheses(node)
    if isinstance(node, ast.IntegerLiteral) and node.value <= INT_MAX:
        return node.value
    return None
