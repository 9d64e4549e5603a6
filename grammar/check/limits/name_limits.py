"""Limits of names and numbers of a module: 24 characters, 255 local routines."""

from __future__ import annotations

from collections.abc import Iterator

from grammar.check.analysis.context import Context
from grammar.diagnostics.diagnostic import Diagnostic
from grammar.semantics.symbols import RoutineSymbol, TypeSymbol
from grammar.syntax import ast
from grammar.syntax.ast import Span

LONGEST_NAME = 24
MOST_LOCAL_ROUTINES = 255


def check(context: Context) -> Iterator[Diagnostic]:
    """Names that a file declares and that are too long, its own included; too many routines."""
    declared = dict(_declared(context))
    own = context.module.name
    content = context.syntax.content
    if len(own) > LONGEST_NAME:
        node = content.name if isinstance(content, ast.DataList) else content.routines[0].name
        message = f"the module name {own} has {len(own)} characters; {LONGEST_NAME} are allowed"
        yield context.finding("module-name-too-long", node, message)
        # the routine or data list that carries the name of the file is not distinguished from it
        declared = {span: name for span, name in declared.items() if name.upper() != own}
    for span, name in declared.items():
        if len(name) > LONGEST_NAME:
            message = f"{name} has {len(name)} characters; {LONGEST_NAME} are allowed"
            yield context.finding("name-too-long", span, message)
    if isinstance(content, ast.Program) and len(content.routines) > MOST_LOCAL_ROUTINES + 1:
        first = content.routines[MOST_LOCAL_ROUTINES + 1]
        count = len(content.routines) - 1
        message = f"{count} local routines; {MOST_LOCAL_ROUTINES} are allowed"
        yield context.finding("too-many-routines", first.name, message)


def _declared(context: Context) -> Iterator[tuple[Span, str]]:
    """Yield the places and names of what a file declares, not of what it announces of others."""
    if context.data is not None:
        yield context.table.span, context.table.name
    own = {routine.table.routine for routine in context.routines}
    for table in context.tables:
        every = (one for _, one in table.symbols())
        for symbol in (*every, *(one.second for one in table.duplicates)):
            if not isinstance(symbol, RoutineSymbol) or symbol in own:
                yield symbol.span, symbol.name
            if isinstance(symbol, TypeSymbol):
                yield from ((one.span, one.name) for one in symbol.members.values())
