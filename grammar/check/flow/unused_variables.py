"""Local variables and parameters that nothing reads."""

from __future__ import annotations

from collections.abc import Iterator

from grammar.check.analysis.accesses import Use
from grammar.check.analysis.context import Context, RoutineBody
from grammar.check.flow.data_flow import all_accesses, data_flow
from grammar.diagnostics.diagnostic import Diagnostic
from grammar.diagnostics.did_you_mean import one_of
from grammar.diagnostics.typos import Typos
from grammar.semantics.symbols import Kind
from grammar.syntax.references import Space


def check(context: Context) -> Iterator[Diagnostic]:
    """Findings about unused variables in all routines of a file."""
    for routine in context.routines:
        yield from _unused(context, routine)


def _unused(context: Context, routine: RoutineBody) -> Iterator[Diagnostic]:
    """Variables and parameters that nothing reads; notes.

    What is one slip away from a name of another file that the routine uses is a warning.
    """
    flow = data_flow(context, routine)
    if not flow.variables and not flow.parameters:
        return
    used: set[str] = set()
    written: set[str] = set()
    table = routine.table.table.spaces[Space.VALUE]
    others: dict[str, str] = {}
    for placed in routine.statements:
        for access in all_accesses(context, placed):
            key = access.key
            (written if access.use is Use.WRITTEN else used).add(key)
            if key not in table and context.found(access.name):
                others[key] = access.name.text
    unused = [
        table[key]
        for key in sorted((flow.variables | flow.parameters) - used)
        if table[key].kind is not Kind.PARAMETER or key not in written
    ]
    typos = Typos(others.values() if unused else ())
    for symbol in unused:
        key = symbol.key
        what = "is assigned to and never read" if key in written else "is never used"
        may_slip = symbol.kind is Kind.VARIABLE and key not in written
        near = typos.meant(symbol.name) if may_slip else ()
        is_slip = len(near) == 1
        yield context.finding(
            "unused",
            symbol.span,
            f"{symbol.name} {what}",
            reason=f"{near[0]} is used here and declared elsewhere" if is_slip else "",
            severity="warning" if is_slip else None,
            fix=one_of(near) if is_slip else None,
        )
