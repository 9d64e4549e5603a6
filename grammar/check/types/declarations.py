"""Declarations: array sizes, GLOBAL, signals, imports, parameters, names of modules."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from grammar.check.analysis.constant_folding import constant
from grammar.check.analysis.context import Context, RoutineBody
from grammar.check.analysis.type_checker import TypeChecker
from grammar.check.types.expressions import type_checker
from grammar.check.types.signals import check_signal
from grammar.diagnostics.diagnostic import Diagnostic, Fix
from grammar.diagnostics.did_you_mean import one_of
from grammar.diagnostics.typos import Series, Typos
from grammar.semantics.assignability import declarable
from grammar.semantics.scopes import Found, NotFound
from grammar.semantics.symbols import Kind
from grammar.semantics.types import INT, REAL, UNKNOWN
from grammar.syntax import ast
from grammar.syntax.ast import Span
from grammar.syntax.references import Space


def check(context: Context) -> Iterator[Diagnostic]:
    """Yield the findings on the declarations of a file."""
    checker = type_checker(context)
    _check_name(checker)
    _check_use(checker)
    data = context.data
    if data is not None:
        _check_globals(checker, data)
        for item in data.items:
            if not isinstance(item, ast.Assignment):
                _check_definition(checker, item, open_sizes=frozenset())
    for routine in context.routines:
        _check_parameters(checker, routine)
        _check_body(checker, routine)
    yield from checker.diagnostics


# ------------------------------------------------------------------------------------- names


def _check_name(checker: TypeChecker) -> None:
    """Report a module whose name differs from that of its file [SCO-01]."""
    module, table = checker.context.module, checker.context.table
    if not module.is_misnamed:
        return
    what = "data list" if table.is_data else "first routine"
    message = f"the {what} is called {table.name}, but the file {module.name}"
    fix = Fix("give both the same name")
    checker.report("module-name", table.span, message, fix=fix)


def _check_use(checker: TypeChecker) -> None:
    """Report a data list that is not PUBLIC and has no program of its name [SCO-01, SCO-05]."""
    context = checker.context
    table, module = context.table, context.module
    if not table.is_data or table.is_public or table.is_system:
        return
    lists = map(context.project.data_of, context.project.modules)
    if not any(one is not None and one.path == module.path for one in lists):
        message = f"no program is called {table.name}, so nothing uses this data list"
        fix = Fix("PUBLIC behind its name would open it to others")
        checker.report("orphan-data-list", table.span, message, fix=fix)


# ------------------------------------------------------------------------------- declarations


def _check_globals(checker: TypeChecker, data: ast.DataList) -> None:
    """GLOBAL data in a list that is not PUBLIC, reported once: one word is missing [SCO-04]."""
    is_public = data.is_public or checker.context.module.is_head_unread(data.name.key)
    if is_public or checker.context.table.is_system:
        return
    found = [
        one
        for one in data.items
        if not isinstance(one, ast.Assignment) and getattr(one, "is_global", False)
    ]
    if found:
        more = f", and so do {len(found) - 1} below" if len(found) > 1 else ""
        message = f"GLOBAL needs DEFDAT {data.name.text} PUBLIC{more}"
        checker.report("global-not-public", _name_of(found[0]), message)


def _name_of(node: ast.Definition) -> ast.Node:
    if isinstance(node, ast.VariableDeclaration):
        return node.declarators[0].name
    return node.declarator.name if isinstance(node, ast.Importation) else node.name


def _check_body(checker: TypeChecker, routine: RoutineBody) -> None:
    parameters = frozenset(parameter.name.key for parameter in routine.node.parameters)
    parameters |= checker.context.module.words or frozenset()  # its first line may be unreadable
    for placed in routine.statements:
        if type(placed.statement) in _DEFINITIONS:
            _check_definition(checker, placed.statement, open_sizes=parameters)


def _check_definition(checker: TypeChecker, node: ast.Node, *, open_sizes: frozenset[str]) -> None:
    """Check one declaration; the names in ``open_sizes`` are arrays that need no size."""
    match node:
        case ast.VariableDeclaration():
            for declarator in node.declarators:
                _check_owner(checker, declarator.name, node.type.key)
                _check_sizes(checker, declarator, declarator.name.key in open_sizes)
        case ast.Structure():
            for group in node.groups:
                for declarator in group.declarators:
                    _check_sizes(checker, declarator, is_open=False)
        case ast.Signal():
            _check_owner(checker, node.name)
            check_signal(checker, node)
        case ast.ChannelDefinition():
            checker.infer(node.description)
        case ast.Importation():
            _check_import(checker, node)


_DEFINITIONS: frozenset[type[Any]] = frozenset(
    {ast.VariableDeclaration, ast.Structure, ast.Signal, ast.ChannelDefinition, ast.Importation}
)


def _check_owner(checker: TypeChecker, name: ast.Name, written: str = "") -> None:
    """Report the declaration of a system variable, which only the controller declares.

    One of the right type changes nothing: data lists that are generated have $BWDSTART so.
    """
    found = checker.context.found(name)
    if found is not None and found.module is None and str(found.symbol.given) != written:
        message = f"{name.text} is declared by the controller already"
        checker.report("declared-twice", name, message, severity="warning")


def _check_sizes(checker: TypeChecker, declarator: ast.Declarator, is_open: bool) -> None:
    """Report an array dimension without size; parameters need none [TYP-08]."""
    for size in declarator.indices or ():
        if size is None:
            if not is_open:
                message = f"the array {declarator.name.text} needs a size for each dimension"
                checker.report("size-missing", declarator, message)
                return
            continue
        kind, value = checker.infer(size), constant(checker.context, size)
        if kind not in (INT, REAL, UNKNOWN):
            checker.report(
                "wrong-size", size, f"the size of an array is an INT, and this is {kind}"
            )
        elif isinstance(value, int | float) and (value < 1 or value != int(value)):
            message = f"an array has at least one element and not {value}"
            checker.report("wrong-size", size, message)
        elif value is None and kind != UNKNOWN:
            message = "the size of an array must be a constant"
            checker.report("wrong-size", size, message, is_unconfirmed=True)


def _check_import(checker: TypeChecker, node: ast.Importation) -> None:
    """Report an import from a data list that is not PUBLIC or not there [ADV-05]."""
    context = checker.context
    found = context.found(node.declarator.name)
    if found is None or found.symbol.kind is not Kind.IMPORT:
        return
    answer = context.project.imported(found)
    if isinstance(answer, NotFound):
        module = node.path[-1].text
        reason = "its data list is not PUBLIC" if answer.hidden else ""
        message = f"the data list {module} exports no such name"
        checker.report("unknown-name", node.source, message, reason=reason)


# --------------------------------------------------------------------------------- parameters


def _check_parameters(checker: TypeChecker, routine: RoutineBody) -> None:
    """Parameters are declared in the body; whole arrays are passed :OUT [SCO-06, SCO-07]."""
    symbols = routine.table.routine.parameters
    undeclared: list[ast.Parameter] = []
    for node, parameter in zip(routine.node.parameters, symbols, strict=True):
        context = checker.context
        is_unread = parameter.key in (context.module.words or ()) or context.is_cut(routine)
        if parameter.type is None and not is_unread:
            undeclared.append(node)
        type_ = checker.type_of_symbol(parameter, routine.scope)
        verdict = declarable(type_, is_out=parameter.mode == "OUT")
        if not verdict:
            checker.reject("array-by-value", node, verdict)
    if undeclared:
        names = ", ".join(node.name.text for node in undeclared)
        what = "the parameter" if len(undeclared) == 1 else "the parameters"
        verb = "is" if len(undeclared) == 1 else "are"
        message = f"{what} {names} {verb} not declared in the routine"
        place, fix = _slipped(checker.context, routine, undeclared)
        advice = "declare each with its type, DECL INT NAME for instance, before any instruction"
        checker.report("parameter-undeclared", place, message, fix=fix or Fix(advice))


def _slipped(
    context: Context, routine: RoutineBody, undeclared: Sequence[ast.Parameter]
) -> tuple[Span, Fix | None]:
    """Return where undeclared parameters are told, and the name that is meant instead.

    If there is one, and a variable that is a slip of it and unused, that is its declaration.
    """
    name = undeclared[0].name
    if len(undeclared) > 1:
        return undeclared[0].span, None
    typos = Typos([name.text], series=Series.NONE)
    used = {
        found.symbol
        for name, found in context.resolution.answers.items()
        if isinstance(found, Found) and name.span != found.symbol.span
    }
    is_used = any(symbol.key == name.key for symbol in used)
    near = [
        symbol
        for symbol in routine.table.table.spaces[Space.VALUE].values()
        if symbol.kind is Kind.VARIABLE and typos.meant(symbol.name)
    ]
    slips = [
        symbol.span
        for symbol in near
        if symbol not in used and (is_used or context.spelling.is_likelier(name.text, symbol.name))
    ]
    if len(slips) == 1:
        return slips[0], one_of([name.text])
    return name.span, one_of(symbol.name for symbol in near)
