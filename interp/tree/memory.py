"""The data lists of a program: their variables with the values they have at first.

They live as long as the program, unlike the data of routines.
"""

from __future__ import annotations

from collections.abc import Mapping

from grammar import ast
from grammar.scopes import Found
from grammar.symbols import Kind, SignalSymbol, Space
from interp.faults import LinkError
from interp.program import CheckedProgram, Unit
from interp.tree.expressions import Expressions
from interp.tree.places import MOST_CELLS, Local, Place, cells, fresh
from interp.tree.run import Frame, Run, at_once
from interp.values import Value, copied

__all__ = ["fill_data", "system_values"]


def fill_data(run: Run) -> None:
    """Make the variables of all data lists.

    Raises `LinkError` and `Fault` where an initial value cannot be had. Those whose names begin
    with a dollar sign are made as well, but it is the world that has them when the program runs.
    """
    lists = [(unit, content) for unit in run.program.units.values() if (content := _data(unit))]
    for unit, _ in lists:
        _declare(run, unit)
    for unit, content in lists:
        _initialise(run, unit, content)


def system_values(program: CheckedProgram) -> Mapping[str, Value]:
    """What the data lists give the controller's own variables at first, by name in upper case."""
    run = Run(program)
    fill_data(run)
    found = {symbol.key: place.get() for symbol, place in run.data.items()}
    return {
        key: copied(value)
        for key, value in found.items()
        if key.startswith("$") and value is not None
    }


def _data(unit: Unit) -> ast.DataList | None:
    syntax = unit.module.syntax
    return syntax.content if syntax and isinstance(syntax.content, ast.DataList) else None


def _declare(run: Run, unit: Unit) -> None:
    scope = run.program.project.scope(unit.module)
    assert unit.module.table is not None, "it was checked"
    for space, symbol in unit.module.table.table.symbols():
        is_variable = symbol.kind in (Kind.VARIABLE, Kind.CONSTANT)
        if space is Space.VALUE and is_variable and not isinstance(symbol, SignalSymbol):
            found = scope.own(space, symbol.key)
            assert found is not None, "a scope has what its table has"
            type_ = run.program.type_of(found)
            run.cells += cells(type_)
            if run.cells > MOST_CELLS:
                raise LinkError(f"{unit.module.path}: the data lists hold too much")
            run.data[symbol] = fresh(type_, symbol.key)


def _initialise(run: Run, unit: Unit, content: ast.DataList) -> None:
    scope = run.program.project.scope(unit.module)
    frame = Frame(unit, content.name.text, scope, {}, None, 0)
    inside = _DataList(run, frame)
    for item in content.items:
        frame.line = unit.line(item)
        try:
            match item:
                case ast.VariableDeclaration():
                    for declarator in item.declarators:
                        if declarator.value is not None:
                            variable = ast.Variable(declarator.span, declarator.name)
                            inside.give(variable, declarator.value)
                case ast.Assignment():
                    inside.give(item.target, item.value)
        except LinkError as error:
            raise LinkError(f"{unit.module.path}:{frame.line}: {error}") from None


class _DataList(Expressions):
    """The values of a data list."""

    def declared(self, found: Found, signals: int = 0) -> Place:
        """The place of a variable; in data lists the controller's own are variables like others."""
        place = self.run.data.get(found.symbol)
        return place if place is not None else super().declared(found, signals)

    def give(self, target: ast.Expression, value: ast.Expression) -> None:
        """Give a variable or an element of one its first value."""
        place = at_once(self.place(target))
        if not isinstance(place, Local):
            raise LinkError("a value is given to what is declared elsewhere")
        place.set(at_once(self.value(value, place.type)))
