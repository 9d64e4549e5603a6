"""Code for designators: variables, members and elements, and the locations that they denote.

Indices are evaluated from left to right. A location in the frame or in the data lists needs no
instruction until it is used; other locations are references on the stack.
"""

from __future__ import annotations

import math
from typing import Protocol

from grammar.semantics.scopes import Found
from grammar.semantics.symbols import Kind, SignalSymbol
from grammar.semantics.types import BOOL, INT, UNKNOWN, Array, Type
from grammar.syntax import ast
from interp.bytecode._generated.opcodes import Op
from interp.bytecode.cell_layout import array_sizes, elements
from interp.bytecode.compiler.emitter import Emitter
from interp.bytecode.compiler.loads_and_stores import Memory
from interp.bytecode.compiler.locations import (
    DataCells,
    FixedCells,
    IndexCell,
    Location,
    Pushed,
    PushedView,
    Reference,
    ReferenceParameter,
    SystemVariable,
    Value,
    View,
    ViewParameter,
)
from interp.program.literals import integer_literal
from interp.program.variables import signal_ends, untyped
from interp.values.faults import LinkError


class Evaluation(Protocol):
    """Generates the value of an expression on the stack, for a place of type ``wanted``."""

    def __call__(self, node: ast.Expression, wanted: Type = UNKNOWN) -> Value:
        """Return what is left on the stack."""


class Designators:
    """Generates code for designators."""

    def __init__(self, emitter: Emitter, memory: Memory, value: Evaluation) -> None:
        self._emitter = emitter
        self._context = emitter.context
        self._writer = emitter.writer
        self._emit = emitter.emit
        self._memory = memory
        self._value = value

    def place(self, node: ast.Expression) -> Location:
        """Return the location of the value of an expression."""
        match node:
            case ast.Variable():
                found = self._context.unit.found(node.name)
                if found is not None and found.symbol.kind is Kind.IMPORT:
                    self._emitter.ask("StopAdvance")
                return self.variable(node.name)
            case ast.Parenthesised():
                return self.place(node.inner)
            case ast.Member():
                return self._memory.member(self.place(node.base), node.name.text)
            case ast.Subscript():
                return self.element(self.place(node.base), node.indices)
        match self._value(node):
            case Reference(type_):
                return Pushed(type_, None)
            case View(element, dimensions, most):
                return PushedView(element, dimensions, None, most)
        raise self._emitter.unlinked("a part of what has none")

    def variable(self, name: ast.Name) -> Location:
        """Return the location of a variable."""
        found = self._context.unit.found(name)
        if found is not None:
            return self.declared(found)
        if name.key.startswith("$"):  # another release may have it
            return SystemVariable((name.key,), UNKNOWN)
        raise self._emitter.unlinked(self._context.unit.undeclared(name))

    def declared(self, found: Found, signals: tuple[SignalSymbol, ...] = ()) -> Location:
        """Return the location of a declared name: frame, data list, or system variable."""
        try:
            found = self._context.program.declaration(found)
        except LinkError as error:
            raise self._emitter.unlinked(str(error)) from None
        symbol = found.symbol
        if found.scope.routine is not None and not isinstance(symbol, SignalSymbol):
            if symbol in self._context.variables:
                return self._context.variables[symbol]
            raise self._emitter.refuse(str(untyped(symbol.name)))
        if found.module is None or symbol.key.startswith("$"):  # the controller owns it
            return SystemVariable((symbol.key,), self._context.program.type_of(found))
        if isinstance(symbol, SignalSymbol):
            if symbol in signals:
                raise self._emitter.unlinked(f"the signal {symbol.name} leads nowhere")
            return self._signal(symbol, found, (*signals, symbol))
        if symbol in self._context.tables.places:
            return DataCells(*self._context.tables.places[symbol])
        if symbol.kind in (Kind.VARIABLE, Kind.CONSTANT):
            raise self._emitter.refuse(str(untyped(symbol.name)))
        raise self._emitter.unlinked(f"{symbol.name} is no variable")

    def _signal(
        self, symbol: SignalSymbol, found: Found, signals: tuple[SignalSymbol, ...]
    ) -> SystemVariable:
        """Return the inputs or outputs of a signal; a group is ``("$IN", 1, "TO", 8)`` [IOT-03]."""
        assert found.module is not None, "the controller's signals are variables"
        unit = self._context.program.units[found.module]
        ends: list[SystemVariable] = []
        for name, numbers in signal_ends(symbol):
            means = unit.found(name)
            place = self.declared(means, signals) if means else SystemVariable((name.key,), UNKNOWN)
            if isinstance(place, SystemVariable):
                ends.append(_remote_element(place, tuple(numbers)) if numbers else place)
        if not ends:
            return SystemVariable((symbol.key,), BOOL)  # connected to nothing
        if symbol.last is None:
            return ends[0]
        return SystemVariable((*ends[0].path, "TO", ends[-1].path[-1]), INT)

    # ----------------------------------------------------------------------- elements

    def element(self, base: Location, nodes: tuple[ast.Expression | None, ...]) -> Location:
        """Return the location of an element, or of a row if indices at the end are omitted."""
        given: list[ast.Expression] = []
        for node in nodes:
            if node is None:
                break
            given.append(node)
        if not given:
            return base
        if isinstance(base, SystemVariable):
            return self._remote_element(base, given)
        if isinstance(base, ViewParameter | PushedView):
            return self._view_element(base, given)
        if not isinstance(base.type, Array):
            raise self._emitter.unlinked("an index of what is no array")
        sizes = base.type.sizes
        fixed = [number for node in given if (number := integer_literal(node)) is not None]
        if isinstance(base, FixedCells) and len(fixed) == len(given) <= len(sizes):
            found = self._memory.fixed_element(base, tuple(fixed))
            if found is not None:
                return found
        through = base.offset if isinstance(base, ReferenceParameter) else None
        through = base.through if isinstance(base, Pushed) else through
        if len(given) == len(sizes):
            return self._indexed(base, base.type, given, through)
        self._memory.refer(base)
        self._indices(given)
        if len(given) > len(sizes):
            raise self._emitter.unlinked("an array has too many indices")
        self._emit(Op.ROW, self._emitter.number(base.type), len(given))
        rest = elements(base.type) // math.prod(array_sizes(base.type)[: len(given)])
        return PushedView(base.type.element, len(sizes) - len(given), through, rest)

    def _indexed(
        self,
        base: FixedCells | ReferenceParameter | Pushed,
        type_: Array,
        nodes: list[ast.Expression],
        through: int | None,
    ) -> Pushed:
        number = self._emitter.number(type_)
        if isinstance(base, FixedCells):
            self._indices(nodes)
            self._emit(base.index, base.offset, number)
        else:
            self._memory.refer(base)
            self._indices(nodes)
            self._emit(Op.INDEX, number)
        return Pushed(type_.element, through)

    def _view_element(
        self, base: ViewParameter | PushedView, nodes: list[ast.Expression]
    ) -> Pushed | PushedView:
        if isinstance(base, PushedView):
            raise self._emitter.refuse("an index of a part of an array")
        self._indices(nodes)
        if len(nodes) > base.dimensions:
            raise self._emitter.unlinked("an array has too many indices")
        if len(nodes) == base.dimensions:
            self._emit(Op.INDEX_VIEW, base.offset)
            return Pushed(base.element, base.offset)
        self._emit(Op.ROW_VIEW, base.offset, len(nodes))
        return PushedView(base.element, base.dimensions - len(nodes), base.offset, base.most)

    def _remote_element(self, base: SystemVariable, nodes: list[ast.Expression]) -> SystemVariable:
        steps: list[int | IndexCell] = []
        for node in nodes:
            number = integer_literal(node)
            if number is None:
                self._memory.convert(self._value(node), INT)
                hole = IndexCell(self._writer.temporary(INT))
                self._emit(Op.STORE_LOCAL, hole.offset)
                steps.append(hole)
            else:
                steps.append(number)
        return _remote_element(base, tuple(steps))

    def _indices(self, nodes: list[ast.Expression]) -> None:
        for node in nodes:
            self._memory.convert(self._value(node), INT)


def _remote_element(base: SystemVariable, steps: tuple[int | IndexCell, ...]) -> SystemVariable:
    is_whole = isinstance(base.type, Array) and len(base.type.sizes) == len(steps)
    element = base.type.element if isinstance(base.type, Array) and is_whole else UNKNOWN
    return SystemVariable((*base.path, *steps), element)
