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
    """Yield findings about unused variables in all routines of a file."""
    for routine in context.routines:
        yield from _unused(context, routine)


def _unused(context: Context, routine: RoutineBody) -> Iterator[Diagnostic]:
    """Yield variables and parameters that nothing reads; notes.

    What is one slip away from a name of another file that the routine uses is a warning.
    """
    flow = data_flow(context, routine)
    table = routine.table.table.spaces[Space.VALUE]
    ways = {
        key: {one.use for one in flow.uses.get(key, ())}
        for key in sorted(flow.variables | flow.parameters)
    }
    unused = [
        table[key]
        for key, uses in ways.items()
        if not uses or (uses == {Use.WRITTEN} and table[key].kind is not Kind.PARAMETER)
    ]
    others = {
        access.key: access.name.text
        for placed in (routine.statements if unused else ())
        for access in all_accesses(context, placed)
        if access.key not in table and context.found(access.name)
    }
    typos = Typos(others.values())
    for symbol in unused:
        is_written = bool(ways[symbol.key])
        what = "is assigned to and never read" if is_written else "is never used"
        may_slip = symbol.kind is Kind.VARIABLE and not is_written
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
