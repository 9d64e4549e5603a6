"""Undeclared variables that one place takes for another kind of value than all others do.

Nothing says what type such a variable has, but a truth value cannot be compared with a number.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from grammar.check.analysis.context import Context
from grammar.diagnostics.diagnostic import Diagnostic
from grammar.syntax import ast
from grammar.syntax.walk import root_variable, without_parentheses

#: The least number of places that agree against a single one that differs.
_USUAL = 2

#: What a variable of one type can be compared with.
_KINDS: Mapping[type[ast.Node], str] = {
    ast.BoolLiteral: "a truth value",
    ast.IntegerLiteral: "a number",
    ast.RealLiteral: "a number",
    ast.BitLiteral: "a number",
    ast.StringLiteral: "a text",
}

#: A variable, and the value that it receives or is compared with.
_Pair = tuple[ast.Expression, ast.Expression]


def check(context: Context) -> Iterator[Diagnostic]:
    """Yield the places where a variable of a file is another kind of value than elsewhere in it."""
    uses: dict[str, dict[str, list[tuple[str, ast.Expression]]]] = {}
    for variable, value in _pairs(context):
        kind = _kind(value)
        root = root_variable(variable) if kind and type(variable) is not ast.Subscript else None
        if root is not None and root.name.text[0] != "$" and context.found(root.name) is None:
            shown = _shown(root, variable)
            uses.setdefault(shown.upper(), {}).setdefault(kind, []).append((shown, value))
    for kinds in uses.values():
        if len(kinds) != 2:
            continue
        (rare, few), (usual, many) = sorted(kinds.items(), key=lambda item: len(item[1]))
        if len(few) == 1 and len(many) >= _USUAL:
            shown, value = few[0]
            message = f"{shown} is {usual} elsewhere, and this is {rare}"
            reason = f"so it is in {len(many)} places"
            yield context.finding("wrong-value", value, message, reason=reason, severity="warning")


def _pairs(context: Context) -> Iterator[_Pair]:
    """Yield what is assigned in the routines of a file, and what is compared for equality."""
    for routine in context.routines:
        for placed in routine.statements:
            for assignment in _assignments(placed.statement):
                yield assignment.target, assignment.value
    for node in context.typed_nodes[ast.Binary] if context.routines else ():
        if node.operator in ("==", "<>"):
            yield node.left, node.right


def _assignments(statement: ast.Node) -> Sequence[ast.Assignment]:
    match statement:
        case ast.Assignment():
            return (statement,)
        case ast.Motion(values=values) | ast.SplineBlock(values=values):
            return values
        case ast.SignalOn(assignment=assignment):
            return (assignment,)
        case ast.Trigger(action=action) | ast.InterruptDeclaration(action=action):
            return (action,) if isinstance(action, ast.Assignment) else ()
    return ()


def _kind(value: ast.Expression) -> str:
    """Return what sort of literal a value is; ``""`` if it is none."""
    value = without_parentheses(value)
    if type(value) is ast.Unary and value.operator in "+-":
        value = value.operand
    return _KINDS.get(type(value), "")


def _shown(root: ast.Variable, node: ast.Expression) -> str:
    """Return ``a.c`` for ``a.b[1].c`` with its components, without indices."""
    parts: list[str] = []
    while isinstance(node, ast.Member | ast.Subscript):
        if isinstance(node, ast.Member):
            parts.insert(0, node.name.text)
        node = node.base
    return ".".join((root.name.text, *parts))
