"""The types of what files declare, as values of `grammar.semantics.types`.

The name of a type is looked up in the scope of its declaration. What is unknown, such as a type of
a missing package or a size known only at run time, is `UNKNOWN` or ``None`` and fits everywhere.
"""

from __future__ import annotations

from grammar.semantics.scopes import Found, Scope
from grammar.semantics.symbols import Kind, SignalSymbol, Symbol, TypeReference, TypeSymbol
from grammar.semantics.types import BOOL, INT, UNKNOWN, Array, Enumeration, Member, Structure, Type
from grammar.syntax import ast
from grammar.syntax.references import Space
from grammar.syntax.walk import root_variable

#: Structures of structures go no deeper on any controller; hostile files may go as deep as they are
#: long.
_DEEPEST = 40


class DeclaredTypes:
    """The types of the symbols of one project; each is made once."""

    def __init__(self) -> None:
        self._made: dict[tuple[Scope, Symbol], Type] = {}
        self._depth = 0

    def of(self, found: Found) -> Type:
        """The type of a variable or member, of what a function gives, or what a type itself is.

        `UNKNOWN` for what has none: labels, channels, routines without a result.
        """
        symbol, scope = found.symbol, found.scope
        if symbol.given is not None:
            return symbol.given
        key = scope, symbol
        made = self._made.get(key)
        if made is None:
            self._made[key] = UNKNOWN  # as long as it is in the making: what holds itself ends here
            made = self._made[key] = self._type(symbol, scope)
        return made

    def _type(self, symbol: Symbol, scope: Scope) -> Type:
        if isinstance(symbol, TypeSymbol):
            return self._declared(symbol, scope, is_open=Found(symbol, scope).is_open)
        if isinstance(symbol, SignalSymbol):
            return self._signal(symbol, scope)
        return UNKNOWN if symbol.type is None else self.written(symbol.type, scope)

    def written(self, written: TypeReference, scope: Scope) -> Type:
        """The type that is named so in a scope."""
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
        """A signal of several bits is a number; another one has the type of what it stands for."""
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
    """The size of a dimension, where it is a number or a constant that stands for one."""
    if isinstance(index, ast.Variable):
        answer = scope.find(Space.VALUE, index.name.key)
        index = answer.symbol.value if isinstance(answer, Found) else None
    return index.value if isinstance(index, ast.IntegerLiteral | ast.BitLiteral) else None
