"""The data lists of a program: their variables with the values they have at first.

They live as long as the program, unlike the data of routines [SCO-03].
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from weakref import WeakKeyDictionary

from grammar.semantics.link import Project
from grammar.semantics.scopes import Found
from grammar.semantics.symbols import Symbol
from grammar.syntax import ast
from interp.program.load import CheckedProgram, Unit
from interp.program.variables import MOST_CELLS, cells, data_lists, data_variables, first_values
from interp.tree.calls import Calls
from interp.tree.places import LocalPlace, Place, fresh
from interp.tree.run import Frame, ProgramState, at_once
from interp.values.faults import Fault, LinkError
from interp.values.values import Value, copied


@dataclass(slots=True)
class _Data:
    """The variables of all data lists, and how many scalars they can hold."""

    places: dict[Symbol, LocalPlace] = field(default_factory=dict)
    cells: int = 0


#: What is in the data lists at first, which is worked out once for each project.
_FILLED: WeakKeyDictionary[Project, _Data] = WeakKeyDictionary()


def fill_data(run: ProgramState) -> None:
    """Make the variables of all data lists.

    Raises `LinkError` where an initial value cannot be had. Those whose names begin
    with a dollar sign are made as well, but it is the world that has them when the program runs.
    """
    filled = _filled(run.program)
    run.cells = filled.cells
    run.data = {
        symbol: LocalPlace([copied(place.get())], place.type, place.path)
        for symbol, place in filled.places.items()
    }


def system_values(program: CheckedProgram) -> Mapping[str, Value]:
    """What the data lists give the controller's own variables at first, by name in upper case."""
    found = {symbol.key: place.get() for symbol, place in _filled(program).places.items()}
    return {
        key: copied(value)
        for key, value in found.items()
        if key.startswith("$") and value is not None
    }


def _filled(program: CheckedProgram) -> _Data:
    data = _FILLED.get(program.project)
    if data is None:
        data = _Data()
        lists = list(data_lists(program))
        for unit, _ in lists:
            _declare(data, program, unit)
        run = ProgramState(program)
        run.data = data.places
        for unit, content in lists:
            _initialise(run, unit, content)
        _FILLED[program.project] = data
    return data


def _declare(data: _Data, program: CheckedProgram, unit: Unit) -> None:
    for found, type_ in data_variables(program, unit):
        data.cells += cells(type_)
        if data.cells > MOST_CELLS:
            raise LinkError(f"{unit.module.path}: the data lists hold too much")
        data.places[found.symbol] = fresh(type_, found.symbol.key)


def _initialise(run: ProgramState, unit: Unit, content: ast.DataList) -> None:
    """Where errors are no obstacle, what cannot be had is left without a value."""
    scope = run.program.project.scope(unit.module)
    frame = Frame(unit, content.name.text, scope, {}, None, 0)
    inside = _DataList(run, frame)
    for line, target, value in first_values(unit, content):
        try:
            inside.give(target, value)
        except (Fault, LinkError) as error:
            if run.program.is_strict:
                raise LinkError(f"{unit.module.path}:{line}: {error}") from None


class _DataList(Calls):
    """The values of a data list."""

    def declared(self, found: Found, signals: int = 0) -> Place:
        """The place of a variable; in data lists the controller's own are variables like others."""
        place = self.run.data.get(found.symbol)
        return place if place is not None else super().declared(found, signals)

    def give(self, target: ast.Expression, value: ast.Expression) -> None:
        """Give a variable or an element of one its first value."""
        place = at_once(self.place(target))
        if not isinstance(place, LocalPlace):
            raise LinkError("a value is given to what is declared elsewhere")
        place.set(at_once(self.value(value, place.type)))
