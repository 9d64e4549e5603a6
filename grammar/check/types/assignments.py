"""Assignments: which values a variable may receive."""

from __future__ import annotations

from grammar.check.analysis.type_checker import TypeChecker
from grammar.check.limits.motion_limits import check_motion_limit, check_range
from grammar.syntax import ast
from grammar.syntax.walk import root_variable


def assign(checker: TypeChecker, node: ast.Assignment) -> None:
    """Check an assignment in a routine."""
    checker.check_assignment(node)
    root = root_variable(node.target)
    if root is None or not root.name.text.startswith("$"):
        return
    variable = checker.context.system.variables.get(root.name.key)
    if variable is not None and variable.limits is not None:
        low, high = variable.limits
        message = f"{variable.name} must be between {low} and {high}"
        check_range(checker, node.value, message, low, high)
    elif variable is not None:
        check_motion_limit(checker, node)
