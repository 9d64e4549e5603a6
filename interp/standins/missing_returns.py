"""Results for functions that reach their end without RETURN [CTL-09].

A controller stops the program then. In an incomplete backup the RETURN may be in a line that is
missing or was skipped. Therefore two statements are added to the end of each function: a RETURN
without a value, which fails, is reported and skipped, and a RETURN with the first value of its
type.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from grammar.semantics.link import File, Project, extended
from grammar.semantics.scopes import Found, Module
from grammar.semantics.types import BOOL, CHAR, INT, REAL, Enumeration, Type
from grammar.syntax import ast


def with_returns(project: Project) -> Project:
    """Return the project with a RETURN at the end of all functions whose results can be written."""
    files = []
    for module in project.modules:
        if module.syntax is None or not isinstance(module.syntax.content, ast.Program):
            continue
        program = module.syntax.content
        routines = tuple(_routines(project, module, program))
        if routines != program.routines:
            syntax = replace(module.syntax, content=replace(program, routines=routines))
            files.append(File(module.path, syntax))
    return extended(project, files) if files else project


def _routines(project: Project, module: Module, program: ast.Program) -> Iterator[ast.Routine]:
    assert module.table is not None, "what can be read has its table"
    for routine, table in zip(program.routines, module.table.routines, strict=True):
        end = routine.span[1] - 1, routine.span[1]
        is_open = routine.result is not None and not any(one.span == end for one in routine.body)
        type_ = project.types.of(Found(table.routine, project.scope(module))) if is_open else None
        value = None if type_ is None else _first_value(type_, end)
        if value is None:
            yield routine
        else:
            returns = ast.Return(end, None), ast.Return(end, value)
            yield replace(routine, body=(*routine.body, *returns))


def _first_value(type_: Type, span: tuple[int, int]) -> ast.Literal | None:
    """0, FALSE, a blank, the first constant; ``None`` for structures and arrays."""
    if isinstance(type_, Enumeration):
        return ast.EnumConstant(span, ast.Name(span, type_.constants[0]))
    values: dict[Type, ast.Literal] = {
        INT: ast.IntegerLiteral(span, 0),
        REAL: ast.RealLiteral(span, "0.0"),
        BOOL: ast.BoolLiteral(span, value=False),
        CHAR: ast.StringLiteral(span, " "),
    }
    return values.get(type_)
