"""Calls of routines that are in no file, with another number of arguments than all other calls.

Without its routine a call cannot be checked. But programs call a routine with the same number of
arguments everywhere, or with the same one as their first argument, as BAS and P00 are called:
KUKA's own leave some arguments empty, and never end a list early.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator

from grammar.check.analysis.context import Context
from grammar.check.types.calls import counted
from grammar.diagnostics.diagnostic import Diagnostic, Region, diagnose
from grammar.semantics.package_scope import PackageScope
from grammar.semantics.scopes import Answer, Found, Undetermined
from grammar.semantics.symbols import Kind, RoutineSymbol
from grammar.syntax import ast
from support.lazy_dataclass import dataclass

# So many calls that agree say how many arguments there are.
_FEWEST = 3


@dataclass(frozen=True, slots=True)
class OpenCall:
    """The calls in a file of a routine that is in no file, with one number of arguments.

    ``command`` is the constant that they begin with, in upper case, or empty. ``region`` is the
    first of ``count`` calls. ``is_unknown`` if not even an option package has the routine.
    """

    name: str
    command: str
    arguments: int
    path: str
    region: Region
    count: int
    is_unknown: bool


def open_calls(context: Context) -> Iterator[OpenCall]:
    """Yield the calls of routines that are in no file, by command and number of arguments."""
    calls: dict[tuple[str, str, int], list[ast.Call]] = {}
    for call in context.typed_nodes[ast.Call]:
        arguments = len(call.arguments)
        if _may_have_more(context.resolution.answers[call.name], arguments):
            key = call.name.key, _command(call), arguments
            calls.setdefault(key, []).append(call)
    for (_, command, arguments), some in calls.items():
        first, path = some[0], context.source.path
        region = Region.of(context.source, first.span)
        answer = context.resolution.answers[first.name]
        is_unknown = not (isinstance(answer, Found) and isinstance(answer.scope, PackageScope))
        yield OpenCall(first.name.text, command, arguments, path, region, len(some), is_unknown)


def _command(call: ast.Call) -> str:
    first = call.arguments[0] if call.arguments else None
    return first.name.key if isinstance(first, ast.EnumConstant) else ""


def _may_have_more(answer: Answer, arguments: int) -> bool:
    """Return whether a routine may have further parameters, or has optional ones left."""
    if not isinstance(answer, Found):
        return isinstance(answer, Undetermined)
    symbol = answer.symbol
    if isinstance(answer.scope, PackageScope) and isinstance(symbol, RoutineSymbol):
        needed = sum(not one.is_optional for one in symbol.parameters)
        return symbol.more is not None or needed <= arguments
    return symbol.kind is Kind.EXTERNAL


def missing_arguments(calls: Iterable[OpenCall]) -> Iterator[Diagnostic]:
    """Yield the single call of a routine, or with one command, that is unlike all others.

    A call with more arguments is only told if nothing is known of the routine, and is a note, since
    the last parameters of a routine are often not used.
    """
    routines: dict[str, list[OpenCall]] = {}
    commands: dict[tuple[str, str], list[OpenCall]] = {}
    for call in calls:
        key = call.name.upper()
        routines.setdefault(key, []).append(call)
        commands.setdefault((key, call.command), []).append(call)
    found: dict[OpenCall, tuple[int, int]] = {}
    for some in (*routines.values(), *commands.values()):
        counts = Counter[int]()
        for call in some:
            counts[call.arguments] += call.count
        if len(counts) != 2:
            continue
        (usual, others), (odd, one) = counts.most_common()
        if one == 1 and others >= _FEWEST:
            call = next(call for call in some if call.arguments == odd)
            is_alike = all(other.command == call.command for other in some)
            if odd < usual or (call.is_unknown and is_alike):
                found.setdefault(call, (usual, others))
    for call, (usual, others) in found.items():
        many = f"{counted(usual)} in its {others} other calls"
        message = f"{call.name} has {many}, and {call.arguments} here"
        if call.arguments < usual:
            yield diagnose("argument-missing", call.path, call.region, message, severity="warning")
        else:
            yield diagnose("too-many-arguments", call.path, call.region, message, severity="note")
