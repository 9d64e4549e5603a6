"""Expressions: what leaves their values on the stack, and the places that they name.

Operands, indices and arguments are evaluated from left to right. What cannot be known before the
program runs, above all the type of a system variable that no table has, is refused: it ends the
program when it is reached, and is told to whoever compiles.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

from grammar import ast
from grammar.scopes import Found
from grammar.symbols import Kind, SignalSymbol
from grammar.types import (
    BOOL,
    CHAR,
    INT,
    INT_MAX,
    INT_MIN,
    REAL,
    UNKNOWN,
    Aggregate,
    Array,
    Enumeration,
    Structure,
    Type,
)
from interp.bytecode._generated.opcodes import Op
from interp.bytecode.cells import array_sizes, bits_of, elements
from interp.bytecode.compiler.memory import Memory
from interp.bytecode.compiler.places import (
    Block,
    Cells,
    DataCells,
    Formal,
    FormalView,
    Hole,
    Place,
    Pushed,
    PushedView,
    Remote,
    Scalar,
    Text,
    Value,
    View,
)
from interp.bytecode.compiler.writer import Label
from interp.faults import Fault, LinkError
from interp.operators import Primitive, Selection, kind_of, select
from interp.values import constant, letters, position_type, single
from interp.variables import untyped

__all__ = ["Expressions"]

_MOST_SIGNALS = 8


class Expressions(Memory):
    """Makes the code of expressions."""

    # ----------------------------------------------------------------------- values

    def value(self, node: ast.Expression, wanted: Type = UNKNOWN) -> Value:
        """The value of an expression, for a place of type ``wanted``."""
        rule = _VALUES.get(type(node))
        if rule is not None:
            return rule(self, node, wanted)
        return self.place_or_value(node)

    def place_or_value(self, node: ast.Expression) -> Value:
        """The value of a variable, or of a part of what an expression gives."""
        return self.load(self.place(node))

    def truth(self, node: ast.Expression) -> None:
        """A condition."""
        if self.value(node, BOOL) != Scalar(BOOL):
            raise self.fail("operand")

    def unless(self, node: ast.Expression, label: Label) -> None:
        """Go on at the label where a condition is FALSE."""
        self.truth(node)
        last = self.writer.last()
        if last is not None and f"UNLESS_{last.op.name}" in Op.__members__:
            self.writer.drop_last()
            self.emit(Op[f"UNLESS_{last.op.name}"], label)
        elif last is not None and last.op is Op.NOT_BOOL:
            self.writer.drop_last()
            self.emit(Op.JUMP_IF, label)
        else:
            self.emit(Op.JUMP_UNLESS, label)

    def integer(self, node: ast.Expression) -> None:
        """A number as INT."""
        self.convert(self.value(node, INT), INT)

    def real(self, node: ast.Expression) -> None:
        """A number as REAL."""
        self.convert(self.value(node, REAL), REAL)

    def _integer(self, node: ast.IntegerLiteral | ast.BitLiteral, _wanted: Type) -> Value:
        number = node.value
        if isinstance(node, ast.BitLiteral) and number > INT_MAX:  # 32 bits as written [TYP-04]
            number -= 2**32
        if not INT_MIN <= number <= INT_MAX:
            raise self.fail("overflow")
        self.emit(Op.PUSH_INT, number)
        return Scalar(INT)

    def literal_integer(self, node: ast.Expression) -> int | None:
        """The value of a literal INT, with its sign."""
        match node:
            case ast.Parenthesised():
                return self.literal_integer(node.inner)
            case ast.Unary(operator="-" | "+" as sign):
                number = self.literal_integer(node.operand)
                return -number if number is not None and sign == "-" else number
        return _literal(node)

    def _real(self, node: ast.RealLiteral, _wanted: Type) -> Value:
        try:
            number = single(node.value)
        except Fault as error:
            raise self.fail(error.slug) from None
        self.emit(Op.PUSH_REAL, bits_of(number))
        return Scalar(REAL)

    def _bool(self, node: ast.BoolLiteral, _wanted: Type) -> Value:
        self.emit(Op.PUSH_BOOL, int(node.value))
        return Scalar(BOOL)

    def _text(self, node: ast.StringLiteral, _wanted: Type) -> Value:
        return Text(letters(node.text))

    def _channel(self, node: ast.ChannelName, _wanted: Type) -> Value:
        return Text(letters(node.name.key))

    def _constant(self, node: ast.EnumConstant, wanted: Type) -> Value:
        type_ = self.context.unit.checked.enumerations.get(node, wanted)
        if not isinstance(type_, Enumeration):
            raise self.unlinked(f"nothing tells which enumeration #{node.name.text} is of")
        try:
            place = constant(type_, node.name.key).index
        except LinkError as error:
            raise self.unlinked(str(error)) from None
        self.emit(Op.PUSH_ENUM, self.number(type_), place)
        return Scalar(self.closed(type_))

    def _parenthesised(self, node: ast.Parenthesised, wanted: Type) -> Value:
        return self.value(node.inner, wanted)

    # ----------------------------------------------------------------------- operators

    def _unary(self, node: ast.Unary, _wanted: Type) -> Value:
        value = self.operand(node.operand, UNKNOWN)
        kind = kind_of(value.type)
        selection = None if kind is None else select(node.operator, kind)
        if selection is None:
            raise self.fail("operand")
        if selection.primitive is None:
            return value
        last = self.writer.last()
        if node.operator == "-" and last is not None and last.op is Op.PUSH_INT:
            number = last.operands[0]
            assert isinstance(number, int), "a constant"
            if number != INT_MIN:
                last.operands = (-number,)
                return value
        for step in selection.conversions[0]:
            self.emit(Op[step.name.upper()])
        self._apply(selection.primitive)
        return self._result(selection, value)

    def operand(self, node: ast.Expression, wanted: Type) -> Scalar | Block:
        """A value that an operator works on."""
        value = self.value(node, wanted)
        match value:
            case Text(text) if len(text) == 1:
                self.emit(Op.PUSH_CHAR, ord(text))
                return Scalar(CHAR)
            case Scalar() | Block():
                return value
        raise self.fail("operand")

    def _binary(self, node: ast.Binary, _wanted: Type) -> Value:
        first = self.writer.here
        left = self.operand(node.left, UNKNOWN)
        between = self.writer.here
        wanted = left.type if isinstance(left.type, Enumeration) else UNKNOWN
        right = self.operand(node.right, wanted)
        selection = self.selected(node.operator, left.type, right.type)
        primitive = selection.primitive
        assert primitive is not None, "an operator of two operands does something"
        if primitive.name == "compose":
            return self._composed(left, right, first)
        if primitive.operands[0] == "ENUM" and left.type != right.type:
            return self.unlike(primitive)
        for step in reversed(selection.conversions[0]):
            self.writer.insert(between, Op[step.name.upper()])
        for step in selection.conversions[1]:
            self.emit(Op[step.name.upper()])
        self._apply(primitive)
        return self._result(selection, left)

    def selected(self, operator: str, left: Type, right: Type) -> Selection:
        """How an operator works on values of these types."""
        kinds = kind_of(left), kind_of(right)
        selection = None
        if kinds[0] is not None and kinds[1] is not None:
            selection = select(operator, kinds[0], kinds[1])
        if selection is None:
            raise self.fail("operand")
        return selection

    def unlike(self, primitive: Primitive) -> Value:
        """Constants of two enumerations: they are never the same."""
        self.emit(Op.DROP)
        self.emit(Op.DROP)
        self.emit(Op.PUSH_BOOL, int(primitive.name != "eq_enum"))
        return Scalar(BOOL)

    def _apply(self, primitive: Primitive) -> None:
        """Carry a primitive out; adding a constant is an instruction of its own."""
        last = self.writer.last()
        if last is not None and last.op is Op.PUSH_INT and primitive.name in _SIGNS:
            number = last.operands[0]
            assert isinstance(number, int), "a constant"
            if number != INT_MIN:
                last.op, last.operands = Op.ADD_CONSTANT, (_SIGNS[primitive.name] * number,)
                return
        self.emit(Op[primitive.name.upper()])

    def _result(self, selection: Selection, operand: Scalar | Block) -> Value:
        found = {"INT": INT, "REAL": REAL, "BOOL": BOOL, "CHAR": CHAR}.get(selection.result)
        return operand if found is None else Scalar(found)

    def _composed(self, left: Scalar | Block, right: Scalar | Block, first: int) -> Value:
        """The geometric operator: its result has a place below its operands."""
        kept = Cells(self.writer.temporary(right.type), right.type)
        self.writer.insert(first, Op.REF_LOCAL, kept.offset, self.number(right.type))
        self.emit(Op.COMPOSE, self.number(left.type), self.number(right.type))
        self.refer(kept)
        return Block(right.type)

    # ----------------------------------------------------------------------- aggregates

    def _aggregate(self, node: ast.Aggregate, wanted: Type) -> Value:
        type_ = self.closed(self._structure(node, wanted))
        whole = Cells(self.writer.temporary(type_), type_)
        self.refer(whole)
        self.emit(Op.CLEAR, self.number(type_))
        for component in node.components:
            place = self.member(whole, component.name.text)
            if component.indices:
                place = self.element(place, component.indices)
            self.assign(place, component.value)
        self.refer(whole)
        return Block(type_)

    def _structure(self, node: ast.Aggregate, wanted: Type) -> Structure:
        type_: Type | None = self.context.unit.checked.types.get(node, UNKNOWN)
        if isinstance(type_, Aggregate):
            type_ = type_.structure
        if not isinstance(type_, Structure):
            names = frozenset(component.name.key for component in node.components)
            type_ = wanted if isinstance(wanted, Structure) else position_type(names)
        if type_ is None:
            raise self.unlinked("nothing tells which structure an aggregate is")
        return type_

    def assign(self, place: Place, node: ast.Expression) -> Place:
        """Store the value of an expression; gives the place to tell of."""
        ready = self.ready(place)
        behind = self.writer.here
        wanted = UNKNOWN if isinstance(ready, FormalView | PushedView) else ready.type
        self.store(ready, self.value(node, wanted), behind)
        return ready

    # ----------------------------------------------------------------------- places

    def place(self, node: ast.Expression) -> Place:
        """Where an expression has its value."""
        match node:
            case ast.Variable():
                found = self.context.unit.found(node.name)
                if found is not None and found.symbol.kind is Kind.IMPORT:
                    self.ask("StopAdvance")
                return self.variable(node.name)
            case ast.Parenthesised():
                return self.place(node.inner)
            case ast.Member():
                return self.member(self.place(node.base), node.name.text)
            case ast.Subscript():
                return self.element(self.place(node.base), node.indices)
        match self.value(node):
            case Block(type_):
                return Pushed(type_, None)
            case View(element, dimensions, most):
                return PushedView(element, dimensions, None, most)
        raise self.unlinked("a part of what has none")

    def variable(self, name: ast.Name) -> Place:
        """The place of a variable."""
        found = self.context.unit.found(name)
        if found is not None:
            return self.declared(found)
        if name.key.startswith("$"):  # another release may have it
            return Remote((name.key,), UNKNOWN)
        raise self.unlinked(f"{name.text} is declared nowhere")

    def declared(self, found: Found, signals: int = 0) -> Place:
        """The place of what a name means: of a frame, of a data list, or of the world."""
        try:
            found = self.context.program.declaration(found)
        except LinkError as error:
            raise self.unlinked(str(error)) from None
        symbol = found.symbol
        if found.scope.routine is not None and not isinstance(symbol, SignalSymbol):
            if symbol in self.context.variables:
                return self.context.variables[symbol]
            raise self.refuse(str(untyped(symbol.name)))
        if self._is_remote(found):
            return Remote((symbol.key,), self.context.program.type_of(found))
        if isinstance(symbol, SignalSymbol):
            if signals == _MOST_SIGNALS:
                raise self.unlinked(f"the signal {symbol.name} leads nowhere")
            return self._signal(symbol, found, signals)
        if symbol in self.context.places:
            return DataCells(*self.context.places[symbol])
        if symbol.kind in (Kind.VARIABLE, Kind.CONSTANT):
            raise self.refuse(str(untyped(symbol.name)))
        raise self.unlinked(f"{symbol.name} is no variable")

    def _is_remote(self, found: Found) -> bool:
        """Whether it is the world that has a variable."""
        return found.module is None or found.symbol.key.startswith("$")

    def _signal(self, symbol: SignalSymbol, found: Found, signals: int) -> Remote:
        """What a signal stands for; several bits are ``("$IN", 1, "TO", 8)`` [IOT-03]."""
        assert found.module is not None, "the controller's signals are variables"
        unit = self.context.program.units[found.module]
        ends: list[Remote] = []
        for node in (symbol.first, symbol.last):
            match node:
                case ast.Variable():
                    root, numbers = node, list[int]()
                case ast.Subscript(
                    base=ast.Variable() as root, indices=(ast.IntegerLiteral() as number,)
                ):
                    numbers = [number.value]
                case _:
                    continue
            means = unit.found(root.name)
            place = (
                self.declared(means, signals + 1) if means else Remote((root.name.key,), UNKNOWN)
            )
            if isinstance(place, Remote):
                ends.append(_remote_element(place, tuple(numbers)) if numbers else place)
        if not ends:
            return Remote((symbol.key,), BOOL)  # connected to nothing
        if symbol.last is None:
            return ends[0]
        return Remote((*ends[0].path, "TO", ends[-1].path[-1]), INT)

    # ----------------------------------------------------------------------- elements

    def element(self, base: Place, nodes: tuple[ast.Expression | None, ...]) -> Place:
        """An element; an index left out, and all behind it, mean the rest of the array."""
        given: list[ast.Expression] = []
        for node in nodes:
            if node is None:
                break
            given.append(node)
        if not given:
            return base
        if isinstance(base, Remote):
            return self._remote_element(base, given)
        if isinstance(base, FormalView | PushedView):
            return self._view_element(base, given)
        if not isinstance(base.type, Array):
            raise self.unlinked("an index of what is no array")
        sizes = base.type.sizes
        fixed = [number for node in given if (number := _literal(node)) is not None]
        if isinstance(base, Cells | DataCells) and len(fixed) == len(given) <= len(sizes):
            found = self.fixed_element(base, tuple(fixed))
            if found is not None:
                return found
        through = base.offset if isinstance(base, Formal) else None
        through = base.through if isinstance(base, Pushed) else through
        if len(given) == len(sizes):
            return self._indexed(base, base.type, given, through)
        self.refer(base)
        self._indices(given)
        if len(given) > len(sizes):
            raise self.unlinked("an array has too many indices")
        self.emit(Op.ROW, self.number(base.type), len(given))
        rest = elements(base.type) // math.prod(array_sizes(base.type)[: len(given)])
        return PushedView(base.type.element, len(sizes) - len(given), through, rest)

    def _indexed(
        self,
        base: Cells | DataCells | Formal | Pushed,
        type_: Array,
        nodes: list[ast.Expression],
        through: int | None,
    ) -> Pushed:
        number = self.number(type_)
        match base:
            case Cells(offset):
                self._indices(nodes)
                self.emit(Op.INDEX_LOCAL, offset, number)
            case DataCells(address):
                self._indices(nodes)
                self.emit(Op.INDEX_DATA, address, number)
            case _:
                self.refer(base)
                self._indices(nodes)
                self.emit(Op.INDEX, number)
        return Pushed(type_.element, through)

    def _view_element(
        self, base: FormalView | PushedView, nodes: list[ast.Expression]
    ) -> Pushed | PushedView:
        if isinstance(base, PushedView):
            raise self.refuse("an index of a part of an array")
        self._indices(nodes)
        if len(nodes) > base.dimensions:
            raise self.unlinked("an array has too many indices")
        if len(nodes) == base.dimensions:
            self.emit(Op.INDEX_VIEW, base.offset)
            return Pushed(base.element, base.offset)
        self.emit(Op.ROW_VIEW, base.offset, len(nodes))
        return PushedView(base.element, base.dimensions - len(nodes), base.offset, base.most)

    def _remote_element(self, base: Remote, nodes: list[ast.Expression]) -> Remote:
        steps: list[int | Hole] = []
        for node in nodes:
            number = _literal(node)
            if number is None:
                self.convert(self.value(node), INT)
                hole = Hole(self.writer.temporary(INT))
                self.emit(Op.STORE_LOCAL, hole.offset)
                steps.append(hole)
            else:
                steps.append(number)
        return _remote_element(base, tuple(steps))

    def _indices(self, nodes: list[ast.Expression]) -> None:
        for node in nodes:
            self.convert(self.value(node), INT)

    # ----------------------------------------------------------------------- calls

    def call(self, node: ast.Call, _wanted: Type) -> Value:
        """The value of a function."""
        raise NotImplementedError  # see `interp.bytecode.compiler.calls`


_SIGNS = {"add_int": 1, "sub_int": -1}


def _literal(node: ast.Expression) -> int | None:
    """The value of a literal that is an INT."""
    while isinstance(node, ast.Parenthesised):
        node = node.inner
    if isinstance(node, ast.IntegerLiteral) and node.value <= INT_MAX:
        return node.value
    return None


def _remote_element(base: Remote, steps: tuple[int | Hole, ...]) -> Remote:
    is_whole = isinstance(base.type, Array) and len(base.type.sizes) == len(steps)
    element = base.type.element if isinstance(base.type, Array) and is_whole else UNKNOWN
    return Remote((*base.path, *steps), element)


_Rule = Callable[[Expressions, Any, Type], Value]
_VALUES: Mapping[type[Any], _Rule] = {
    ast.IntegerLiteral: Expressions._integer,
    ast.BitLiteral: Expressions._integer,
    ast.RealLiteral: Expressions._real,
    ast.BoolLiteral: Expressions._bool,
    ast.StringLiteral: Expressions._text,
    ast.ChannelName: Expressions._channel,
    ast.EnumConstant: Expressions._constant,
    ast.Parenthesised: Expressions._parenthesised,
    ast.Unary: Expressions._unary,
    ast.Binary: Expressions._binary,
    ast.Aggregate: Expressions._aggregate,
    ast.Call: lambda self, node, wanted: self.call(node, wanted),
}
