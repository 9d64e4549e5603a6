"""Paths to statements in the syntax tree: the blocks around a line, for a jump to that line."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from grammar.syntax import ast
from grammar.syntax.walk import bodies
from interp.program.load import CheckedProgram, Routine


def routine_at(program: CheckedProgram, file: str, name: str) -> Routine | None:
    """Return the routine of a file by its name, or ``None`` if there is none."""
    return program.routines_by_name.get((file, name.upper()))


def statement_lines(routine: Routine) -> set[int]:
    """Return the lines in which statements of a routine begin, UNTIL conditions included."""
    found: set[int] = set()
    for statement in statements(routine.node.body):
        if not isinstance(statement, ast.Definition | ast.Label):
            found.add(routine.unit.line(statement))
        if isinstance(statement, ast.Repeat):
            found.add(routine.unit.line(statement.condition))
    return found


def statements(body: Sequence[ast.Statement]) -> Iterator[ast.Statement]:
    """Yield all statements of a body, including those in blocks."""
    todo = [*reversed(body)]
    while todo:
        statement = todo.pop()
        yield statement
        for inner in reversed([*_bodies(statement)]):
            todo += reversed(inner)


def way_to(routine: Routine, line: int) -> tuple[ast.Statement, ...]:
    """Return the blocks around the first statement of a line, outermost first, and that statement.

    Return an empty tuple if no statement begins there.
    """
    return next(_paths_to(routine, line, routine.node.body), ())


def _paths_to(
    routine: Routine, line: int, body: Sequence[ast.Statement]
) -> Iterator[tuple[ast.Statement, ...]]:
    for statement in body:
        if isinstance(statement, ast.Definition | ast.Label):
            continue
        if routine.unit.line(statement) == line:
            yield (statement,)
        for inner in _bodies(statement):
            for way in _paths_to(routine, line, inner):
                yield (statement, *way)


def _bodies(statement: ast.Statement) -> Iterator[tuple[ast.Statement, ...]]:
    """Return the statement lists of a block; a spline block has none, its items are one motion."""
    return iter(()) if isinstance(statement, ast.SplineBlock) else bodies(statement)
