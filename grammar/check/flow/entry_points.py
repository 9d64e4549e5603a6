"""Entry points of routines: interrupts, calls, and selection as a program.

BRAKE and RESUME are only allowed in interrupt routines, and the first motion of a program must be
complete. Both can be checked if all callers of a routine are known: for a local routine these are
in its module, for a GLOBAL one in a complete project. A routine that sets up motions with
``BAS(#INITMOV, 0)`` is a program, and not just a routine that is never called.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

from grammar.check.analysis.context import Context, PlacedStatement, RoutineBody
from grammar.check.analysis.control_flow_graph import FlowNode
from grammar.check.flow.advance_stop_reasons import is_known_call
from grammar.diagnostics.codes import Severity
from grammar.diagnostics.diagnostic import Diagnostic
from grammar.notation.model import reached
from grammar.semantics.scopes import REST
from grammar.semantics.symbols import Access
from grammar.syntax import ast
from grammar.syntax.references import calls_in

# Statements that are looked at before the first motion; who needs more sets up a lot.
_FARTHEST_LOOK = 2_000


def check(context: Context) -> Iterator[Diagnostic]:
    """Yield findings about BRAKE, RESUME and first motions."""
    if not context.routines:
        return
    suspects = [routine for routine in context.routines if _interrupting(routine)]
    if suspects:
        entered = _Entered(context)
        for routine in suspects:
            if not entered.maybe_by_interrupt(routine):
                yield from _outside(context, routine)
            elif _is_program(routine) and not entered.maybe_by_interrupt(
                routine, _is_called_at_hand
            ):
                yield from _outside(context, routine, "note", "one in a missing file may")
    yield from _first_motion(context, context.routines[0])


# ---------------------------------------------------------------------------- BRAKE and RESUME


def _interrupting(routine: RoutineBody) -> list[ast.Brake | ast.Resume]:
    return [
        placed.statement
        for placed in routine.statements
        if isinstance(placed.statement, ast.Brake | ast.Resume)
    ]


def _is_called_outside(context: Context, key: str) -> bool:
    """Return whether another module, or a missing one, may call a routine."""
    return not context.project.is_complete or _is_called_at_hand(context, key)


def _is_called_at_hand(context: Context, key: str) -> bool:
    """Return whether another module of the project calls a routine or cannot be read."""
    return any(
        module.table is None or key in module.table.calls or key in (module.words or ())
        for module in context.project.modules
        if module.path != context.module.path
    )


def _is_program(routine: RoutineBody) -> bool:
    """Return whether a routine is a program: inline forms call GLOBAL ones with arguments."""
    return not routine.node.parameters and not routine.node.is_global


class _Entered:
    """The call graph of a module, and the routines that its interrupts call.

    Unreadable lines may be declarations of interrupts.
    """

    def __init__(self, context: Context) -> None:
        self._context = context
        self._callers: dict[str, set[str]] = {}
        self._targets = set(context.module.words or ())
        for routine in context.routines:
            for called in calls_in(routine.node.body):
                self._callers.setdefault(called, set()).add(routine.node.name.key)
            for placed in routine.statements:
                match placed.statement:
                    case ast.InterruptDeclaration(action=ast.CallStatement(call=call)):
                        self._targets.add(call.name.key)
        self._seen_outside = {
            routine.node.name.key
            for routine in context.routines
            if routine.table.routine.access is not Access.MODULE
        } | {context.module.name}
        first = context.routines[0]
        if any(map(_sets_up, first.statements)) and not first.node.parameters:
            self._seen_outside.discard(first.node.name.key)  # somebody selects it

    def maybe_by_interrupt(
        self, routine: RoutineBody, is_called: Callable[[Context, str], bool] = _is_called_outside
    ) -> bool:
        """Return whether an interrupt may lead to a routine.

        ``is_called`` says whether unknown code may call a routine.
        """
        name = routine.node.name.key
        return any(
            not self._targets.isdisjoint((key, REST))
            or (key in self._seen_outside and is_called(self._context, key))
            for key in reached(self._callers, name) | {name}
        )


def _outside(
    context: Context, routine: RoutineBody, severity: Severity | None = None, reason: str = ""
) -> Iterator[Diagnostic]:
    name = routine.node.name.text
    for node in _interrupting(routine):
        word, slug = "RESUME", "resume-outside-interrupt"
        if isinstance(node, ast.Brake):
            word, slug = "BRAKE", "brake-outside-interrupt"
        message = f"{word} in {name}, which no interrupt calls"
        yield context.finding(slug, node, message, severity=severity, reason=reason)


# -------------------------------------------------------------------------------- first motions


def _first_motion(context: Context, routine: RoutineBody) -> Iterator[Diagnostic]:
    """Yield the first motion of a program that is never called, if it is certain."""
    if context.module.suffix != ".src" or routine.node.parameters or routine.node.result:
        return
    key = routine.node.name.key
    if key in context.table.calls or not any(map(_sets_up, routine.statements)):
        return
    if _is_called_outside(context, key):
        return
    for motion in _first_motions(context, routine):
        what = _incomplete(motion)
        if what:
            message = f"the program begins with {what}"
            yield context.finding("first-motion", motion, message)


def _sets_up(placed: PlacedStatement) -> bool:
    """Return whether a statement sets up the motions of a program."""
    match placed.statement:
        case ast.CallStatement(
            call=ast.Call(name=name, arguments=(ast.EnumConstant() as what, *_))
        ):
            return name.key == "BAS" and what.name.key == "INITMOV"
    return False


def _first_motions(context: Context, routine: RoutineBody) -> list[ast.Motion]:
    """Return the possible first motions in order; none if a called routine may move."""
    ways = routine.ways
    found: list[ast.Motion] = []
    seen: set[FlowNode] = {ways.start}
    todo = [ways.start]
    while todo and len(seen) < _FARTHEST_LOOK:
        for step in ways.after[todo.pop()]:
            if step in seen:
                continue
            seen.add(step)
            node = step.statement
            if isinstance(node, ast.Motion):
                found.append(node)
            elif isinstance(node, ast.SplineBlock | ast.EmilyMotion):
                return []
            elif node is None or is_known_call(context, node, step.is_test):
                todo.append(step)
            else:
                return []
    return sorted(found, key=lambda motion: motion.span)


_COMPLETE = frozenset({"PTP", "SPTP", "ASYPTP"})


def _incomplete(motion: ast.Motion) -> str:
    """Return why a motion cannot be the first one; empty if it can."""
    if motion.kind not in _COMPLETE:
        return motion.kind
    if isinstance(motion.target, ast.Aggregate) and motion.kind != "ASYPTP":
        names = {component.name.key for component in motion.target.components}
        if "X" in names and not {"S", "T"} <= names:
            return f"{motion.kind} without Status and Turn"
    return ""
