"""The data lists of a program: their variables and the initial values of these.

Data lists live as long as the program, unlike the data of routines [SCO-03].
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from weakref import WeakKeyDictionary

from grammar.semantics.link import Project
from grammar.semantics.scopes import Found
from grammar.semantics.symbols import SignalSymbol, Symbol
from grammar.syntax import ast
from interp.program.load import CheckedProgram, Unit
from interp.program.variables import MOST_CELLS, cells, data_lists, data_variables, first_values
from interp.tree.calls import Calls
from interp.tree.places import LocalPlace, Place, fresh
from interp.tree.program_state import Frame, ProgramState, at_once
from interp.values.faults import Fault, LinkError
from interp.values.values import Value, copied


@dataclass(slots=True)
class DataLists:
    """The variables of all data lists, and the number of scalars in them.

    ``left_out`` are the initial values that cannot be computed, as (path, line, reason).
    """

    places: dict[Symbol, LocalPlace] = field(default_factory=dict)
    cells: int = 0
    left_out: list[tuple[str, int, str]] = field(default_factory=list)


#: The data lists with their initial values, computed once for each project.
_FILLED: WeakKeyDictionary[Project, DataLists] = WeakKeyDictionary()


def fill_data(run: ProgramState) -> None:
    """Create the variables of all data lists with their initial values.

    System variables that a data list declares are created too, but at run time the controller holds
    them. Raises `LinkError` as `initial_data` does.
    """
    filled = initial_data(run.program)
    run.cells = filled.cells
    run.data = {
        symbol: LocalPlace([copied(place.get())], place.type, place.path)
        for symbol, place in filled.places.items()
    }


def system_values(program: CheckedProgram) -> Mapping[str, Value]:
    """Return the initial values that data lists give to system variables, by name in upper case."""
    found = {symbol.key: place.get() for symbol, place in initial_data(program).places.items()}
    return {
        key: copied(value)
        for key, value in found.items()
        if key.startswith("$") and value is not None
    }


def initial_data(program: CheckedProgram) -> DataLists:
    """Return the data lists with their initial values; nothing of it may be changed.

    Raises `LinkError` if they are too large, or if an initial value cannot be computed in a program
    that was loaded with ``strict``.
    """
    data = _FILLED.get(program.project)
    if data is None:
        data = DataLists()
        lists = list(data_lists(program))
        for unit, _ in lists:
            _declare(data, program, unit)
        run = ProgramState(program)
        run.data = data.places
        for unit, content in lists:
            _initialise(data, run, unit, content)
        _FILLED[program.project] = data
    return data


def _declare(data: DataLists, program: CheckedProgram, unit: Unit) -> None:
    for found, type_ in data_variables(program, unit):
        data.cells += cells(type_)
        if data.cells > MOST_CELLS:
            raise LinkError(f"{unit.module.path}: the data lists hold too much")
        data.places[found.symbol] = fresh(type_, found.symbol.key)


def _initialise(data: DataLists, run: ProgramState, unit: Unit, content: ast.DataList) -> None:
    """Assign the initial values of a data list."""
    scope = run.program.project.scope(unit.module)
    frame = Frame(unit, content.name.text, scope, {}, None, 0)
    inside = _DataList(run, frame)
    for line, target, value in first_values(unit, content):
        try:
            inside.give(target, value)
        except (Fault, LinkError) as error:
            if run.program.is_strict:
                raise LinkError(f"{unit.module.path}:{line}: {error}") from None
            data.left_out.append((unit.module.path, line, str(error)))


class _DataList(Calls):
    """The evaluation of expressions in a data list."""

    def declared(self, found: Found, signals: tuple[SignalSymbol, ...] = ()) -> Place:
        """Return the place of a variable; a system variable of a data list is an ordinary one."""
        place = self.run.data.get(found.symbol)
        return place if place is not None else super().declared(found, signals)

    def give(self, target: ast.Expression, value: ast.Expression) -> None:
        """Assign its initial value to a variable or to an element of one."""
        place = at_once(self.place(target))
        if not isinstance(place, LocalPlace):
            raise LinkError("a value is given to what is declared elsewhere")
        place.set(at_once(self.value(value, place.type)))
