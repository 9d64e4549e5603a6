"""The declarations of option packages as a scope: names that no file has to declare.

A package is available if it is named in a setting, or if a project calls one of its routines. A
file's own declaration always has priority. The signatures come from `grammar.semantics.packages`.
The scope also has the routines that inline forms call on every controller, such as BAS, because
repositories rarely contain the files that define them.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import cache
from typing import Final

from grammar.semantics.packages import PackageParameter, PackageRoutine, load_packages
from grammar.semantics.scopes import Found, Outer, Scope
from grammar.semantics.symbol_table import table_of
from grammar.semantics.symbols import (
    Access,
    Kind,
    ParameterSymbol,
    RoutineSymbol,
    Symbol,
    Table,
    TypeReference,
)
from grammar.semantics.types import UNKNOWN
from grammar.syntax.build import read_module
from grammar.syntax.references import Space

_NO_SPAN = (0, 0)
#: Routines of inline forms with unknown parameters, with whether each returns a value.
_OF_INLINE_FORMS = {
    **dict.fromkeys("SVEL_CP SVEL_JOINT SACC_CP SACC_JOINT SJERK SGEAR_JERK".split(), True),
    **dict.fromkeys("STOOL STOOL2 SBASE SLOAD SIPO_MODE SORI_TYP SAPO SAPO_PTP".split(), True),
    "USE_CM_PRO_VALUES": True,
}


def called_packages(calls: Iterable[str]) -> frozenset[str]:
    """Return the packages to which any of the called routines belong."""
    routines = load_packages().routines
    return frozenset(routines[name].package for name in calls if name in routines)


class PackageScope(Scope):
    """The global declarations of some packages; their types are looked up in the outer scope."""

    __slots__ = ()

    def __init__(self, packages: frozenset[str], outer: Outer) -> None:
        super().__init__(None, None, _table(packages), outer)

    def all(self) -> Iterator[tuple[Space, Found]]:
        """Yield each declaration with its name space."""
        for space, symbol in self._table.symbols():
            found = self.own(space, symbol.key)
            assert found is not None, "a scope has what its table has"
            yield space, found


@cache
def _table(packages: frozenset[str]) -> Table:
    known = load_packages()
    data = [one.declaration for one in known.types.values() if one.package in packages]
    data += [
        f"DECL GLOBAL {one.type} {one.name}"
        for one in known.variables.values()
        if one.package in packages
    ]
    module = read_module("\n".join(["DEFDAT PACKAGES PUBLIC", *data, "ENDDAT", ""]), "")
    assert not isinstance(module, list), "the table has declarations that can be read"
    spaces: dict[Space, dict[str, Symbol]] = {space: {} for space in Space}
    for space, symbol in table_of(module).table.symbols():
        spaces[space][symbol.key] = symbol
    for routine in known.routines.values():
        if routine.package in packages:
            spaces[Space.ROUTINE][routine.name] = _routine(routine)
    for symbol in _of_every_controller():
        spaces[Space.ROUTINE].setdefault(symbol.key, symbol)
    return Table(spaces, ())


def _of_every_controller() -> Iterator[RoutineSymbol]:
    """Yield the routines of every controller.

    BAS takes a command and a number, IR_STOPM no argument [MOT-03, INT-16].
    """
    command = PackageParameter("COMMAND", "?", False, False, False)
    number = PackageParameter("VALUE", "REAL", False, False, True)
    yield _symbol("BAS", False, (command, number), has_more=False)
    yield _symbol("IR_STOPM", False, (), has_more=False)
    for name, has_value in _OF_INLINE_FORMS.items():
        yield _symbol(name, has_value, (), has_more=True)


#: Stands for arguments of which nothing is known.
_ANYTHING: Final = ParameterSymbol(
    Kind.PARAMETER, "VALUE", _NO_SPAN, Access.ROUTINE, given=UNKNOWN, mode=""
)


def _routine(routine: PackageRoutine) -> RoutineSymbol:
    has_more = routine.has_more or routine.is_unconfirmed
    return _symbol(routine.name, bool(routine.result), routine.parameters, has_more=has_more)


def _symbol(
    name: str, has_value: bool, parameters: tuple[PackageParameter, ...], *, has_more: bool
) -> RoutineSymbol:
    return RoutineSymbol(
        Kind.ROUTINE,
        name,
        _NO_SPAN,
        Access.GLOBAL,
        # working programs receive a value in variables of several types
        given=UNKNOWN if has_value else None,
        parameters=tuple(map(_parameter, parameters)),
        more=_ANYTHING if has_more else None,
    )


def _parameter(parameter: PackageParameter) -> ParameterSymbol:
    indices = (None,) if parameter.is_array else None
    is_known = parameter.type != "?"
    return ParameterSymbol(
        Kind.PARAMETER,
        parameter.name,
        _NO_SPAN,
        Access.ROUTINE,
        TypeReference(parameter.type, indices) if is_known else None,
        mode="OUT" if parameter.is_out else "IN",
        is_optional=parameter.is_optional,
    )
