"""Names that are declared twice: in one scope, by two modules for all, or hidden by another.

Folders of collected programs are full of copies. Two modules that declare the same name for all are
therefore only reported if the files are laid out like the drive of a controller.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache

from grammar.check.analysis.context import Context
from grammar.diagnostics.diagnostic import Diagnostic
from grammar.semantics.link import Project
from grammar.semantics.scopes import Found, Module
from grammar.semantics.symbols import Duplicate, Kind, Table
from grammar.syntax.references import Space
from support.lazy_dataclass import dataclass

#: Labels are the affair of `grammar.check.flow.control_flow`; a routine may be announced again and
#: again.
_HARMLESS = frozenset({Kind.LABEL, Kind.EXTERNAL})


def check(context: Context) -> Iterator[Diagnostic]:
    """Tell the names of a file that stand twice or hide others."""
    yield from _in_table(context, context.table.table)
    for routine in context.routines:
        yield from _in_table(context, routine.table.table)
        for inner, outer in routine.scope.shadowed():
            if outer.module is not None and inner.symbol.kind is not Kind.ROUTINE:
                yield _hides(context, inner, outer)
    for one in repeated(context.project).get(context.module.path, ()):
        verb = "are" if one.more else "is"
        message = f"{one.names} {verb} declared for everybody in another module already"
        reason = f"in {one.earlier.module.path}" if one.earlier.module else ""
        yield context.finding(
            "declared-twice", one.first.symbol.span, message, reason=reason, severity="warning"
        )


def _in_table(context: Context, table: Table) -> Iterator[Diagnostic]:
    for duplicate in table.duplicates:
        if _HARMLESS.isdisjoint((duplicate.first.kind, duplicate.second.kind)):
            yield _twice(context, duplicate)


def _twice(context: Context, duplicate: Duplicate) -> Diagnostic:
    first, second = duplicate.first, duplicate.second
    line, _ = context.source.place(first.span[0])
    message = f"{second.name} is already declared in line {line}"
    reason = "" if first.kind is second.kind else f"there it is a {first.kind.value}"
    return context.finding("declared-twice", second.span, message, reason=reason)


def _hides(context: Context, inner: Found, outer: Found) -> Diagnostic:
    symbol = inner.symbol
    where = outer.module.path if outer.module else "the controller"
    message = f"{symbol.name} hides the {outer.symbol.kind.value} {outer.symbol.name}"
    return context.finding("shadowed", symbol.span, message, reason=f"declared in {where}")


@dataclass(frozen=True, slots=True)
class Repeated:
    """Declarations for all modules that repeat those of one earlier module.

    The ``first`` of them repeats the ``earlier`` one, and so do ``more`` others.
    """

    first: Found
    earlier: Found
    more: int

    @property
    def names(self) -> str:
        """The declared names, as text."""
        name = self.first.symbol.name
        return f"{name} and {self.more} more" if self.more else name


@lru_cache(maxsize=1)
def repeated(project: Project) -> Mapping[str, Sequence[Repeated]]:
    """Return by path which modules repeat declarations of earlier ones."""
    found: dict[str, dict[Module | None, list[tuple[Found, Found]]]] = {}
    for clash in project.clashes if project.is_controller else ():
        if clash.space is not Space.LABEL:
            first, *others = clash.declarations
            for other in others:
                if other.module is not None:
                    of_module = found.setdefault(other.module.path, {})
                    of_module.setdefault(first.module, []).append((other, first))
    return {
        path: [
            Repeated(*min(some, key=lambda pair: pair[0].symbol.span), len(some) - 1)
            for some in of_module.values()
        ]
        for path, of_module in found.items()
    }
