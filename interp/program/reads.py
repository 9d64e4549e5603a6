"""Properties of syntax that executors need before a program runs."""

from __future__ import annotations

from collections.abc import Iterator

from grammar.semantics.symbols import Kind, ParameterSymbol, SignalSymbol
from grammar.semantics.types import UNKNOWN, Aggregate, Structure, Type
from grammar.syntax import ast
from grammar.syntax.walk import root_variable, walk
from interp.program.load import Unit
from interp.values.faults import LinkError
from interp.values.values import position_type

_CONSTANT = (
    ast.IntegerLiteral,
    ast.RealLiteral,
    ast.BoolLiteral,
    ast.BitLiteral,
    ast.StringLiteral,
    ast.EnumConstant,
    ast.Unary,
    ast.Parenthesised,
    ast.Name,
)


def is_constant_output(action: ast.Assignment) -> bool:
    """Return whether an action assigns a literal to a target with literal indices.

    The controller can then make the assignment without running program code.
    """
    parts = [action.value, *_indices(action.target)]
    return all(isinstance(one, _CONSTANT) for part in parts for one in walk(part))


def _indices(node: ast.Expression) -> Iterator[ast.Expression]:
    """Yield all indices in the target of an assignment."""
    while isinstance(node, ast.Subscript | ast.Member):
        if isinstance(node, ast.Subscript):
            yield from (one for one in node.indices if one is not None)
        node = node.base


def is_variable(unit: Unit, node: ast.Expression) -> bool:
    """Return whether an expression denotes a changeable variable, as needed for :OUT [SCO-06]."""
    root = root_variable(node)
    if root is None:
        return False
    found = unit.found(root.name)
    return found is None or found.symbol.kind is not Kind.CONSTANT


def is_input(unit: Unit, node: ast.Expression) -> bool:
    """Return whether an expression is a parameter :IN, which the caller may have left out."""
    found = unit.found(node.name) if isinstance(node, ast.Variable) else None
    return (
        found is not None
        and isinstance(found.symbol, ParameterSymbol)
        and found.symbol.mode == "IN"
    )


#: The message if `structure_of` returns ``None``.
UNKNOWN_STRUCTURE = "nothing says which structure an aggregate is"


def structure_of(unit: Unit, node: ast.Aggregate, wanted: Type) -> Structure | None:
    """Return the structure type of an aggregate in a context of type ``wanted`` [TYP-19].

    Return ``None`` if it is unknown.
    """
    type_: Type | None = unit.checked.types.get(node, UNKNOWN)
    if isinstance(type_, Aggregate):
        type_ = type_.structure
    if isinstance(type_, Structure):
        return type_
    if isinstance(wanted, Structure):
        return wanted
    return position_type(frozenset(component.name.key for component in node.components))


def signal_name(unit: Unit, node: ast.SignalOn | ast.SignalOff) -> str:
    """Return the name of the signal that a statement switches, in upper case, as in this file.

    It is the first signal in an expression, else its first system variable. Raises `LinkError` if
    there is neither.
    """
    match node:
        case ast.SignalOff(variable=where):
            pass
        case ast.SignalOn(keyword="ANOUT", assignment=ast.Assignment(target=where)):
            pass
        case ast.SignalOn(assignment=ast.Assignment(value=where)):
            pass
    names = [one.name for one in walk(where) if isinstance(one, ast.Variable)]
    for name in names:
        found = unit.found(name)
        if found is not None and isinstance(found.symbol, SignalSymbol):
            return name.key
    for name in names:
        if name.key.startswith("$"):
            return name.key
    raise LinkError("nothing says which signal is meant")
