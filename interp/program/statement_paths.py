"""Paths to statements: the blocks around a line, for jumps to it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from grammar.syntax import ast
from grammar.syntax.walk import bodies
from interp.program.load import CheckedProgram, Routine


def routine_at(program: CheckedProgram, file: str, name: str) -> Routine | None:
    """A routine of a file by its name."""
    for unit in program.units.values():
        if unit.module.path == file:
            for routine in program.routines_of(unit):
                if routine.node.name.key == name.upper():
                    return routine
    return None


def statement_lines(routine: Routine) -> set[int]:
    """The lines in which statements of a routine begin; UNTIL is one, as a loop tests there."""
    found: set[int] = set()
    todo = [routine.node.body]
    while todo:
        for statement in todo.pop():
            if not isinstance(statement, ast.Definition | ast.Label):
                found.add(routine.unit.line(statement))
                todo += _bodies(statement)
            if isinstance(statement, ast.Repeat):
                found.add(routine.unit.line(statement.condition))
    return found


def way_to(routine: Routine, line: int) -> tuple[ast.Statement, ...]:
    """The blocks around the first statement of a line, and that statement; empty without one."""
    return next(_ways(routine, line, routine.node.body), ())


def _ways(
    routine: Routine, line: int, body: Sequence[ast.Statement]
) -> Iterator[tuple[ast.Statement, ...]]:
    for statement in body:
        if isinstance(statement, ast.Definition | ast.Label):
            continue
        if routine.unit.line(statement) == line:
            yield (statement,)
        for inner in _bodies(statement):
            for way in _ways(routine, line, inner):
                yield (statement, *way)


def _bodies(statement: ast.Statement) -> Iterator[tuple[ast.Statement, ...]]:
    """The lists of statements in a block; a spline block holds parts of its own motion."""
    return iter(()) if isinstance(statement, ast.SplineBlock) else bodies(statement)
