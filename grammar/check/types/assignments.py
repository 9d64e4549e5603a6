"""Assignments: what may be written, and which values."""

from __future__ import annotations

from grammar.check.analysis.constant_folding import constant
from grammar.check.analysis.context import Bound
from grammar.check.analysis.signal_direction import side_of
from grammar.check.analysis.type_checker import TypeChecker
from grammar.check.limits.motion_limits import check_motion_limit
from grammar.semantics.predefined import SystemVariable
from grammar.semantics.symbols import Kind, SignalSymbol
from grammar.syntax import ast
from grammar.syntax.walk import root_variable


def assign(checker: TypeChecker, node: ast.Assignment) -> None:
    """Check an assignment in a routine."""
    to = checker.infer_target(node.target)
    root = root_variable(node.target)
    variable = None if root is None else _system_variable(checker, root)
    if root is not None:
        _check_writable(checker, node.target, root, variable)
    checker.check(to, node.value)
    if variable is not None and variable.limits is not None:
        _check_limits(checker, variable, variable.limits, node)
    elif variable is not None:
        check_motion_limit(checker, node)


def _system_variable(checker: TypeChecker, root: ast.Variable) -> SystemVariable | None:
    """Return the table entry of a system variable, or ``None`` for other variables."""
    if root.name.text.startswith("$"):
        return checker.context.system.variables.get(root.name.key)
    return None


def _check_writable(
    checker: TypeChecker,
    node: ast.Expression,
    root: ast.Variable,
    variable: SystemVariable | None,
) -> None:
    found = checker.context.found(root.name)
    symbol = found.symbol if found else None
    if symbol is not None and symbol.kind is Kind.CONSTANT:
        checker.report("write-protected", node, f"{symbol.name} is a constant", rules=("TYP-07",))
        return
    if isinstance(symbol, SignalSymbol) and side_of(checker.context, root) == "inputs":
        # No source says so of signals, and one public archive does it.
        message = f"{symbol.name} is an input, which cannot be written"
        checker.report("write-protected", node, message, is_unconfirmed=True)
        return
    if variable is not None and variable.access == "read":
        message = f"{variable.name} cannot be written"
        checker.report("write-protected", node, message, is_unconfirmed=variable.access_unconfirmed)


def _check_limits(
    checker: TypeChecker, variable: SystemVariable, limits: tuple[int, int], node: ast.Assignment
) -> None:
    value = constant(checker.context, node.value)
    low, high = limits
    message = f"{variable.name} must be between {low} and {high}"
    if value is None:
        bound = Bound("invalid-system-value", f"assigns it, and {message}", low, high)
        checker.context.note_bound(node.value, bound)
    elif isinstance(value, int | float) and type(value) is not bool and not low <= value <= high:
        checker.report("invalid-system-value", node.value, message)
