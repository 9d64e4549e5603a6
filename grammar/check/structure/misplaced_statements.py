"""Misplaced statements: in submit programs, in interrupt routines, before declarations.

Calls by interrupts are only known in the module that declares them. A routine of another module may
be called by unknown interrupts and is not checked.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from grammar.check.analysis.context import Context, RoutineBody
from grammar.diagnostics.diagnostic import Diagnostic
from grammar.motion_kinds import SPLINE_MOTIONS
from grammar.syntax import ast
from grammar.syntax.walk import walk

#: The one motion that is not the robot's but of external axes on their own.
_ASYNCHRONOUS = "ASYPTP"
_WORKSPACES = frozenset({"WSPACEGIVE", "WSPACETAKE"})


def check(context: Context) -> Iterator[Diagnostic]:
    """Yield findings about the places of declarations and statements."""
    interrupts = _interrupt_routines(context)
    for routine in context.routines:
        yield from _declarations(context, routine)
        if context.module.suffix == ".sub":
            yield from _in_submit(context, routine)
        declaration = interrupts.get(routine.node.name.key)
        if declaration is not None:
            yield from _in_interrupt(context, routine, declaration)


# ----------------------------------------------------------------------------------- declarations


def _declarations(context: Context, routine: RoutineBody) -> Iterator[Diagnostic]:
    first: ast.Node | None = None
    for placed in routine.statements:
        statement = placed.statement
        if not isinstance(statement, ast.Definition):
            first = first or statement
            continue
        if placed.inside is not None:
            yield context.finding(
                "misplaced-declaration",
                statement,
                "declarations come before instructions, and not inside a block",
            )
        elif first is not None:
            line = context.line(first)
            message = f"declarations come before instructions, and line {line} is an instruction"
            yield context.finding("misplaced-declaration", statement, message)


# ------------------------------------------------------------------------------- submit programs


def _in_submit(context: Context, routine: RoutineBody) -> Iterator[Diagnostic]:
    for placed in routine.statements:
        statement = placed.statement
        if placed.is_in_spline:
            continue  # the block itself is reported
        match statement:
            case ast.Motion(kind=kind) if kind != _ASYNCHRONOUS:
                message = f"{kind} in a submit program"
                yield context.finding("motion-in-submit", statement, message)
            case ast.SplineBlock(keyword=keyword):
                message = f"{keyword} in a submit program"
                yield context.finding("motion-in-submit", context.head(statement), message)
            case ast.EmilyMotion():
                yield context.finding("motion-in-submit", statement, "MOVE_EMI in a submit program")
            case ast.Assignment(target=ast.Subscript(base=ast.Variable(name=name)) as target) if (
                name.key == "$OUT_C"
            ):
                message = "$OUT_C in a submit program, which has no main run to be in step with"
                yield context.finding("out-c-not-allowed", target, message, is_unconfirmed=True)
            case ast.Trigger():
                yield context.finding(
                    "trigger-not-allowed",
                    statement,
                    "TRIGGER in a submit program",
                    rules=("TRG-09", "SUB-06", "MSG-09"),
                )
    for node in walk(routine.node):
        if isinstance(node, ast.Call) and node.name.key in _WORKSPACES:
            message = f"{node.name.text} in a submit program"
            yield context.finding("workspace-in-submit", node, message)


# ------------------------------------------------------------------------------ interrupt routines


def _interrupt_routines(context: Context) -> Mapping[str, ast.InterruptDeclaration]:
    """Return the routines that interrupts of this module call, each with its interrupt.

    If several interrupts call a routine, a GLOBAL one is returned.
    """
    own = {routine.node.name.key for routine in context.routines}
    found: dict[str, ast.InterruptDeclaration] = {}
    for routine in context.routines:
        for placed in routine.statements:
            declaration = placed.statement
            if not isinstance(declaration, ast.InterruptDeclaration):
                continue
            if isinstance(declaration.action, ast.CallStatement):
                key = declaration.action.call.name.key
                if key in own and (key not in found or declaration.is_global):
                    found[key] = declaration
    return found


def _in_interrupt(
    context: Context, routine: RoutineBody, declaration: ast.InterruptDeclaration
) -> Iterator[Diagnostic]:
    line = context.line(declaration)
    reason = f"the interrupt of line {line} calls {routine.node.name.text}"
    for placed in routine.statements:
        statement = placed.statement
        if placed.is_in_spline:
            continue
        slug, message = _forbidden(statement, declaration.is_global)
        if slug:
            rules = ("TRG-09", "MSG-09") if isinstance(statement, ast.Trigger) else None
            yield context.finding(
                slug, context.head(statement), message, reason=reason, rules=rules
            )


def _forbidden(statement: ast.Node, is_global: bool) -> tuple[str, str]:
    """Return slug and message for a statement that an interrupt routine must not contain."""
    match statement:
        case ast.Motion(kind=kind) if kind in SPLINE_MOTIONS:
            return "spline-in-interrupt", f"{kind} in an interrupt routine"
        case ast.SplineBlock(keyword=keyword):
            return "spline-in-interrupt", f"{keyword} in an interrupt routine"
        case ast.Trigger():
            return "trigger-not-allowed", "TRIGGER in an interrupt routine"
        case ast.Assignment(target=ast.Variable(name=name)) if name.key == "$ADVANCE":
            return "advance-in-interrupt", "an interrupt routine changes $ADVANCE"
        case ast.Resume() if is_global:
            return "resume-in-global-interrupt", "RESUME in the routine of a global interrupt"
    return "", ""
