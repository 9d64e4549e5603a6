"""Writes to constants, to inputs, and to variables that only the controller sets."""

from __future__ import annotations

from collections.abc import Iterator

from grammar.check.analysis.accesses import Access, Use, accesses
from grammar.check.analysis.context import Context
from grammar.check.analysis.signal_direction import side_of
from grammar.diagnostics.diagnostic import Diagnostic
from grammar.semantics.symbols import Kind, SignalSymbol
from grammar.syntax import ast


def check(context: Context) -> Iterator[Diagnostic]:
    """Yield findings about what the statements of routines write."""
    for routine in context.routines:
        for placed in routine.statements:
            node: ast.Node | None = placed.statement
            if isinstance(node, ast.Trigger | ast.InterruptDeclaration):
                node = node.action
            for access in accesses(context, node) if node is not None else ():
                if access.use is Use.WRITTEN:
                    yield from _protected(context, access)


def _protected(context: Context, access: Access) -> Iterator[Diagnostic]:
    name, where = access.name, access.place or access.name
    found = context.found(name)
    symbol = found.symbol if found and not found.is_disputed else None
    system = context.system.variables.get(name.key) if name.text.startswith("$") else None
    if symbol is not None and symbol.kind is Kind.CONSTANT:
        message = f"{symbol.name} is a constant"
        yield context.finding("write-protected", where, message, rules=("TYP-07",))
    elif (
        isinstance(symbol, SignalSymbol)
        and access.place
        and (side_of(context, access.place) == "inputs")
    ):
        # No source says so of signals, and one public archive does it.
        message = f"{symbol.name} is an input, which cannot be written"
        yield context.finding("write-protected", where, message, is_unconfirmed=True)
    elif system is not None and system.access == "read":
        message = f"{system.name} cannot be written"
        is_unconfirmed = system.access_unconfirmed
        yield context.finding("write-protected", where, message, is_unconfirmed=is_unconfirmed)
