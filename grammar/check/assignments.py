"""Assignments: what may be written, and with which values."""

from __future__ import annotations

from grammar.check.constant_folding import constant
from grammar.check.expressions import Typer, root_of
from grammar.check.signal_direction import side_of
from grammar.semantics.predefined import Variable
from grammar.semantics.symbols import Kind, SignalSymbol
from grammar.syntax import ast

__all__ = ["assign"]


def assign(typer: Typer, node: ast.Assignment) -> None:
    """Check an assignment in a routine."""
    to = typer.target(node.target)
    _check_writable(typer, node.target)
    typer.fit(to, node.value)
    variable = _system_variable(typer, node.target)
    if variable is not None and variable.limits is not None:
        _check_limits(typer, variable, variable.limits, node)


def _system_variable(typer: Typer, node: ast.Expression) -> Variable | None:
    """What is known of the variable of the controller that an expression is part of."""
    root = root_of(node)
    if isinstance(root, ast.Variable) and root.name.text.startswith("$"):
        return typer.context.system.variables.get(root.name.key)
    return None


def _check_writable(typer: Typer, node: ast.Expression) -> None:
    root = root_of(node)
    symbol = typer.root(node)
    if symbol is not None and symbol.kind is Kind.CONSTANT:
        typer.tell("write-protected", node, f"{symbol.name} is a constant", rules=("TYP-07",))
        return
    if isinstance(symbol, SignalSymbol) and side_of(typer.context, root) == "inputs":
        # No source says so of signals, and one public archive does it.
        message = f"{symbol.name} is an input, which cannot be written"
        typer.tell("write-protected", node, message, is_unconfirmed=True)
        return
    variable = _system_variable(typer, node)
    if variable is not None and variable.access == "read":
        message = f"{variable.name} cannot be written"
        typer.tell("write-protected", node, message, is_unconfirmed=variable.access_unconfirmed)


def _check_limits(
    typer: Typer, variable: Variable, limits: tuple[int, int], node: ast.Assignment
) -> None:
    value = constant(typer.context, node.value)
    if type(value) not in (int, float) or isinstance(value, str) or value is None:
        return
    low, high = limits
    if not low <= value <= high:
        message = f"{variable.name} reaches from {low} to {high}"
        typer.tell("invalid-system-value", node.value, message)
