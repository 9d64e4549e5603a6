"""The variables that are visible where a program has stopped, and its signals."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from grammar.semantics.scopes import Found, Module
from grammar.semantics.symbols import Access, Kind, SignalSymbol, Table
from grammar.syntax import ast
from grammar.syntax.references import Space
from interp.port.inspection import StackFrame
from interp.program.load import CheckedProgram
from interp.program.statement_paths import routine_at
from interp.standins.uses import FOLDER
from interp.values.faults import LinkError

_DATA: Final = frozenset({Kind.VARIABLE, Kind.CONSTANT, Kind.PARAMETER, Kind.IMPORT})


@dataclass(frozen=True, slots=True)
class Names:
    """The names of variables as written, each group in the order of declaration.

    ``local`` are those of the routine, with its parameters; ``data`` those of the module's data
    list; ``config`` those of $CONFIG; ``others`` are GLOBAL in other data lists. ``signals`` are
    the names of signals.
    """

    local: tuple[str, ...]
    data: tuple[str, ...]
    config: tuple[str, ...]
    others: tuple[str, ...]
    signals: tuple[str, ...]


def names_in(program: CheckedProgram, frame: StackFrame) -> Names:
    """Return the names that are visible in a frame."""
    routine = routine_at(program, frame.at.file, frame.name)
    if routine is None:
        return Names((), (), (), (), ())
    own = program.project.data_of(routine.unit.module)
    config: list[str] = []
    others: list[str] = []
    signals: list[str] = []
    for unit in program.units.values():
        module = unit.module
        if module.table is None or module.folder == FOLDER:
            continue
        is_own = module is own or module is routine.unit.module
        signals += _names(
            module.table.table, frozenset({Kind.SIGNAL}), is_all=is_own or _is_system(module)
        )
        if not is_own and module.table.is_data:
            found = _names(module.table.table, _DATA, is_all=_is_system(module))
            target = config if _is_config(module) else others
            target += (name for name in found if not name.startswith("$"))
    data = () if own is None or own.table is None else _names(own.table.table, _DATA)
    return Names(
        _names(routine.table.table, _DATA), data, tuple(config), tuple(others), tuple(signals)
    )


def signal_in(
    program: CheckedProgram, frame: StackFrame, name: str
) -> tuple[ast.Expression, ast.Expression | None] | None:
    """Return the first and the last variable that a signal denotes; ``None`` if it is no signal.

    The last variable is ``None`` for a signal of one variable.
    """
    routine = routine_at(program, frame.at.file, frame.name)
    answer = None if routine is None else routine.scope.find(Space.VALUE, name.upper())
    if not isinstance(answer, Found):
        return None
    try:
        symbol = program.declaration(answer).symbol
    except LinkError:
        return None
    return (symbol.first, symbol.last) if isinstance(symbol, SignalSymbol) else None


def signals_of(program: CheckedProgram) -> frozenset[str]:
    """Return the names of all signals of a program, in upper case."""
    units = program.units.values()
    tables = [unit.module.table.table for unit in units if unit.module.table is not None]
    tables += [one.table.table for unit in units for one in program.routines_of(unit)]
    symbols = (symbol for table in tables for _, symbol in table.symbols())
    return frozenset(one.name.upper() for one in symbols if one.kind is Kind.SIGNAL)


def _names(table: Table, kinds: frozenset[Kind], *, is_all: bool = True) -> tuple[str, ...]:
    return tuple(
        symbol.name
        for space, symbol in table.symbols()
        if space is Space.VALUE
        and symbol.kind in kinds
        and (is_all or symbol.access is Access.GLOBAL)
    )


def _is_system(module: Module) -> bool:
    return module.table is not None and module.table.is_system


def _is_config(module: Module) -> bool:
    return module.name.removeprefix("$") == "CONFIG"
