"""What the controller predefines as a scope: variables, routines, types and channels as symbols."""

from __future__ import annotations

from collections.abc import Iterable

from grammar.semantics.predefined import PredefinedFunction, PredefinedParameter, System
from grammar.semantics.scopes import Answer, Found, NotFound, Scope
from grammar.semantics.symbols import (
    Access,
    Kind,
    ParameterSymbol,
    RoutineSymbol,
    Symbol,
    Table,
    TypeSymbol,
)
from grammar.semantics.types import SCALARS, Enumeration, Structure, Type
from grammar.syntax.references import Space

_NO_SPAN = (0, 0)


class SystemScope(Scope):
    """What the controller predefines; symbols are created on demand.

    The entry for a symbol has the same name in `System.variables`, `System.functions` or
    `System.types`.
    """

    __slots__ = ("system",)

    def __init__(self, system: System) -> None:
        super().__init__(None, None, Table({space: {} for space in Space}, ()), self)
        self.system = system

    def names(self, space: Space) -> Iterable[str]:
        """Return all names that the controller predefines in a space."""
        match space:
            case Space.VALUE:
                return ("TRUE", "FALSE", *self.system.variables)
            case Space.ROUTINE:
                return self.system.functions
            case Space.TYPE:
                return (*SCALARS, *self.system.types)
            case Space.CHANNEL:
                return self.system.channels
        return ()

    def own(self, space: Space, key: str) -> Found | None:
        """Return the symbol with that name if the controller predefines it."""
        answer = self.find(space, key)
        return answer if isinstance(answer, Found) else None

    def _answer(self, space: Space, key: str) -> Answer:
        symbol = self._symbol(space, key)
        return Found(symbol, self) if symbol else NotFound()

    def _symbol(self, space: Space, key: str) -> Symbol | None:
        if space is Space.VALUE and key in self.system.variables:
            variable = self.system.variables[key]
            return _given(Kind.VARIABLE, variable.name, variable.type)
        if space is Space.ROUTINE and key in self.system.functions:
            return _routine(self.system.functions[key])
        if space is Space.CHANNEL and key in self.system.channels:
            return _given(Kind.CHANNEL, self.system.channels[key], None)
        if space is Space.TYPE:
            if key in SCALARS:
                return _type(key, SCALARS[key])
            if key in self.system.types:
                return _type(key, self.system.types[key])
        return None


def _given(kind: Kind, name: str, type_: Type | None) -> Symbol:
    return Symbol(kind, name, _NO_SPAN, Access.GLOBAL, given=type_)


def _routine(function: PredefinedFunction) -> RoutineSymbol:
    def parameter(known: PredefinedParameter) -> ParameterSymbol:
        return ParameterSymbol(
            Kind.PARAMETER, known.name, _NO_SPAN, Access.ROUTINE, given=known.type, mode=known.mode
        )

    return RoutineSymbol(
        Kind.ROUTINE,
        function.name,
        _NO_SPAN,
        Access.GLOBAL,
        given=function.result,
        parameters=tuple(map(parameter, function.parameters)),
        more=parameter(function.more) if function.more is not None else None,
    )


def _type(key: str, type_: Type) -> TypeSymbol:
    kind, members, is_open = Kind.PLAIN_TYPE, dict[str, Symbol](), False
    if isinstance(type_, Structure):
        kind, is_open = Kind.STRUCTURE, type_.is_open
        for member in type_.members:
            members[member.name.upper()] = _given(Kind.MEMBER, member.name, member.type)
    elif isinstance(type_, Enumeration):
        kind, is_open = Kind.ENUMERATION, type_.is_open
        for name in type_.constants:
            members[name.upper()] = _given(Kind.ENUM_CONSTANT, name, type_)
    name = type_.name if isinstance(type_, Structure | Enumeration) else key
    return TypeSymbol(
        kind, name, _NO_SPAN, Access.GLOBAL, given=type_, members=members, is_open=is_open
    )
