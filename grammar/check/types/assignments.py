"""Assignments: which values a variable may receive."""

from __future__ import annotations

from grammar.check.analysis.constant_folding import constant
from grammar.check.analysis.type_checker import TypeChecker
from grammar.check.limits.motion_limits import check_motion_limit
from grammar.semantics.predefined import SystemVariable
from grammar.syntax import ast
from grammar.syntax.walk import root_variable


def assign(checker: TypeChecker, node: ast.Assignment) -> None:
    """Check an assignment in a routine."""
    checker.check_assignment(node)
    root = root_variable(node.target)
    variable = None if root is None else _system_variable(checker, root)
    if variable is not None and variable.limits is not None:
        _check_limits(checker, variable, variable.limits, node)
    elif variable is not None:
        check_motion_limit(checker, node)


def _system_variable(checker: TypeChecker, root: ast.Variable) -> SystemVariable | None:
    """Return the table entry of a system variable, or ``None`` for other variables."""
    if root.name.text.startswith("$"):
        return checker.context.system.variables.get(root.name.key)
    return None


def _check_limits(
    checker: TypeChecker, variable: SystemVariable, limits: tuple[int, int], node: ast.Assignment
) -> None:
    value = constant(checker.context, node.value)
    low, high = limits
    message = f"{variable.name} must be between {low} and {high}"
    if value is None:
        use = f"assigns it, and {message}"
        checker.context.note_bound(node.value, "invalid-system-value", use, low, high)
    elif isinstance(value, int | float) and type(value) is not bool and not low <= value <= high:
        checker.report("invalid-system-value", node.value, message)
