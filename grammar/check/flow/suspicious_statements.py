"""Statements that are allowed and hardly meant.

A counter that its own loop changes, a variable assigned to itself, REAL values compared for
equality, a WAIT that nothing can end.
"""

from __future__ import annotations

from collections.abc import Iterator

from grammar.check.analysis.accesses import accesses
from grammar.check.analysis.constant_folding import constant
from grammar.check.analysis.context import Context, RoutineBody
from grammar.diagnostics.codes import Severity
from grammar.diagnostics.diagnostic import Diagnostic
from grammar.semantics.symbols import Kind
from grammar.semantics.types import BOOL, REAL
from grammar.syntax import ast
from grammar.syntax.walk import root_variable, walk, without_parentheses


def check(context: Context) -> Iterator[Diagnostic]:
    """Yield findings about suspicious statements in all routines of a file."""
    for routine in context.routines:
        yield from _counters(context, routine)
        before: ast.Node | None = None
        for placed in routine.statements:
            is_tried = isinstance(before, ast.OnErrorProceed)
            if isinstance(placed.statement, ast.Assignment) and not is_tried:
                yield from _to_itself(context, placed.statement)
            elif isinstance(placed.statement, ast.WaitFor):
                yield from _waiting(context, placed.statement)
            before = placed.statement
    if context.routines:
        yield from _real_equality(context)


def _counters(context: Context, routine: RoutineBody) -> Iterator[Diagnostic]:
    """Yield counters that are changed inside their own loop [CTL-05]."""
    for placed in routine.statements:
        statement = placed.statement
        if isinstance(statement, ast.For):
            name, place = statement.counter, statement.counter
        elif isinstance(statement, ast.Assignment) and isinstance(statement.target, ast.Variable):
            name, place = statement.target.name, statement.target.name
        else:
            continue
        for around in placed.around:
            if type(around.statement) is ast.For and around.statement.counter.key == name.key:
                line = context.line(around.statement)
                message = f"{name.text} counts the loop of line {line} and is changed inside it"
                yield context.finding("counter-changed", place, message)
                break


def _to_itself(context: Context, node: ast.Assignment) -> Iterator[Diagnostic]:
    """``A = A``; to assign to a variable of the controller has effects of its own.

    Behind ON_ERROR_PROCEED it is a way to ask whether there is a value.
    """
    root = root_variable(node.target)
    value = without_parentheses(node.value)
    if root is None or root.name.text.startswith("$") or type(value) is not type(node.target):
        return
    found = context.found(root.name)
    is_plain = found is not None and found.symbol.kind is not Kind.SIGNAL
    has_call = any(isinstance(inner, ast.Call) for inner in walk(node.target))
    shown = [
        "".join(context.source.text[slice(*one.span)].upper().split())
        for one in (node.target, value)
    ]
    if is_plain and not has_call and shown[0] == shown[1]:
        written = context.source.text[slice(*node.target.span)]
        yield context.finding("self-assignment", node, f"{written} is assigned to itself")


def _real_equality(context: Context) -> Iterator[Diagnostic]:
    """``==`` and ``<>`` of numbers that are rounded [ARI-10]."""
    for node in context.typed_nodes[ast.Binary]:
        if node.operator in ("==", "<>"):
            types = context.types.get(node.left), context.types.get(node.right)
            if REAL in types:
                message = f"{node.operator} compares REAL values, which are rounded"
                yield context.finding("real-equality", node, message)


def _waiting(context: Context, node: ast.WaitFor) -> Iterator[Diagnostic]:
    """WAIT FOR on what nothing can change while the routine waits: FALSE, its own variables."""
    used = accesses(context, node)
    found = [context.found(access.name) for access in used]
    has_call = any(isinstance(inner, ast.Call) for inner in walk(node))
    is_own = bool(found) and all(
        one is not None and one.scope.routine is not None and one.symbol.kind is Kind.VARIABLE
        for one in found
    )
    if is_own and not has_call and context.types.get(node.condition) == BOOL:
        names = ", ".join(dict.fromkeys(access.name.text for access in used))
        message = f"{names} cannot change while this waits"
        yield context.finding("waits-for-ever", node.condition, message)
    elif constant(context, node.condition) is False:
        is_on_purpose = isinstance(without_parentheses(node.condition), ast.BoolLiteral)
        severity: Severity = "note" if is_on_purpose else "warning"
        message = "this condition is never true"
        yield context.finding("waits-for-ever", node.condition, message, severity=severity)
