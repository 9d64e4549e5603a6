"""The types of declared symbols, as values of `grammar.semantics.types`.

A type name is looked up in the scope of the declaration. If a type or a size is unknown, for
example because a package is missing, it is `UNKNOWN` or ``None`` and fits everywhere.
"""

from __future__ import annotations

from grammar.semantics.scopes import Found, Scope
from grammar.semantics.symbols import Kind, SignalSymbol, Symbol, TypeReference, TypeSymbol
from grammar.semantics.types import BOOL, INT, UNKNOWN, Array, Enumeration, Member, Structure, Type
from grammar.syntax import ast
from grammar.syntax.references import Space
from grammar.syntax.walk import root_variable

#: Structures nest less deeply than this on any controller; hostile files may nest without limit.
_DEEPEST = 40


class DeclaredTypes:
    """The types of the symbols of one project; each is built once."""

    def __init__(self) -> None:
        self._made: dict[tuple[Scope, Symbol], Type] = {}
        self._depth = 0

    def of(self, found: Found) -> Type:
        """Return the type of a variable or member, of a function's result, or of a type itself.

        Returns `UNKNOWN` for symbols without a type: labels, channels, procedures.
        """
        symbol, scope = found.symbol, found.scope
        if symbol.given is not None:
            return symbol.given
        key = scope, symbol
        made = self._made.get(key)
        if made is None:
            self._made[key] = UNKNOWN  # until it is complete: ends the recursion of recursive types
            made = self._made[key] = self._type(symbol, scope)
        return made

    def _type(self, symbol: Symbol, scope: Scope) -> Type:
        if isinstance(symbol, TypeSymbol):
            return self._declared(symbol, scope, is_open=Found(symbol, scope).is_open)
        if isinstance(symbol, SignalSymbol):
            return self._signal(symbol, scope)
        return UNKNOWN if symbol.type is None else self.written(symbol.type, scope)

    def written(self, written: TypeReference, scope: Scope) -> Type:
        """Return the type that a type name, with its sizes, means in a scope."""
        answer = scope.find(Space.TYPE, written.key)
        element = self.of(answer) if isinstance(answer, Found) else UNKNOWN
        if written.indices is None or element == UNKNOWN:
            return element
        return Array(element, tuple(_size(index, scope) for index in written.indices))

    def _declared(self, symbol: TypeSymbol, scope: Scope, *, is_open: bool) -> Type:
        if symbol.kind is Kind.ENUMERATION:
            constants = tuple(one.name for one in symbol.members.values())
            return Enumeration(symbol.name, constants, is_open)
        if self._depth == _DEEPEST:
            return UNKNOWN
        self._depth += 1
        try:
            members = tuple(
                Member(member.name, self.of(Found(member, scope)))
                for member in symbol.members.values()
            )
        finally:
            self._depth -= 1
        return Structure(symbol.name, members, is_open)

    def _signal(self, symbol: SignalSymbol, scope: Scope) -> Type:
        """Return INT for a signal of several bits, otherwise the type of what it stands for."""
        if symbol.last is not None:
            return INT
        root = root_variable(symbol.first)
        if root is None:  # FALSE: connected to nothing
            return BOOL
        answer = scope.find(Space.VALUE, root.name.key)
        if not isinstance(answer, Found) or isinstance(answer.symbol, SignalSymbol):
            return UNKNOWN
        type_ = self.of(answer)
        return type_.element if isinstance(type_, Array) else type_


def _size(index: ast.Expression | None, scope: Scope) -> int | None:
    """Return the size of a dimension if it is a number or a constant with a number as value."""
    if isinstance(index, ast.Variable):
        answer = scope.find(Space.VALUE, index.name.key)
        index = answer.symbol.value if isinstance(answer, Found) else None
    return index.value if isinstance(index, ast.IntegerLiteral | ast.BitLiteral) else None
