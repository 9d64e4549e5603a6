"""Code for expressions, which leaves their values on the stack.

Operands and arguments are evaluated from left to right. If something must be known at compile time
and is not, above all the type of a system variable that is in no table, the expression is refused:
the program ends when it is reached, and the place is reported as a `Refusal`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

from grammar.semantics.types import (
    BOOL,
    CHAR,
    INT,
    INT_MIN,
    REAL,
    UNKNOWN,
    Enumeration,
    Type,
)
from grammar.syntax import ast
from grammar.syntax.walk import left_chain
from interp.bytecode._generated.opcodes import Op
from interp.bytecode.cell_layout import bits_of
from interp.bytecode.compiler.code_writer import Label
from interp.bytecode.compiler.designators import Designators
from interp.bytecode.compiler.emitter import Emitter
from interp.bytecode.compiler.loads_and_stores import Memory
from interp.bytecode.compiler.locations import (
    FrameCells,
    Location,
    PushedView,
    Reference,
    Scalar,
    Text,
    Value,
    ViewParameter,
)
from interp.program.literals import LITERALS, enumeration_constant, integer_literal
from interp.program.reads import UNKNOWN_STRUCTURE, structure_of
from interp.values.faults import Fault, LinkError
from interp.values.operators import Primitive, Selection, kind_of, select

#: Generates a call of a function and returns its value.
Call = Callable[[ast.Call], Value]


class Expressions:
    """Generates code for expressions."""

    def __init__(self, emitter: Emitter, call: Call) -> None:
        self.emitter = emitter
        self.memory = Memory(emitter)
        self.designators = Designators(emitter, self.memory, self.value)
        self._call = call
        self._emitter = emitter
        self._context = emitter.context
        self._writer = emitter.writer
        self._emit = emitter.emit
        self._memory = self.memory
        self._designators = self.designators

    # ----------------------------------------------------------------------- values

    def value(self, node: ast.Expression, wanted: Type = UNKNOWN) -> Value:
        """Generate the value of an expression for a place of type ``wanted``."""
        rule = _VALUES.get(type(node))
        if rule is not None:
            return rule(self, node, wanted)
        return self.place_or_value(node)

    def place_or_value(self, node: ast.Expression) -> Value:
        """Generate the value of a variable, or of a part of the value of an expression."""
        return self._memory.load(self._designators.place(node))

    def truth(self, node: ast.Expression) -> None:
        """Generate a condition."""
        if self.value(node, BOOL) != Scalar(BOOL):
            raise self._emitter.fail("operand")

    def unless(self, node: ast.Expression, label: Label) -> None:
        """Generate a jump to the label if a condition is FALSE."""
        self.truth(node)
        last = self._writer.last()
        if last is not None and f"UNLESS_{last.op.name}" in Op.__members__:
            self._writer.drop_last()
            self._emit(Op[f"UNLESS_{last.op.name}"], label)
        elif last is not None and last.op is Op.NOT_BOOL:
            self._writer.drop_last()
            self._emit(Op.JUMP_IF, label)
        else:
            self._emit(Op.JUMP_UNLESS, label)

    def number(self, node: ast.Expression, type_: Type) -> None:
        """Generate a number as INT or REAL."""
        self._memory.convert(self.value(node, type_), type_)

    def integer(self, node: ast.Expression) -> None:
        """Generate a number as INT."""
        self.number(node, INT)

    def real(self, node: ast.Expression) -> None:
        """Generate a number as REAL."""
        self.number(node, REAL)

    def _literal(self, node: Any, _wanted: Type) -> Value:
        try:
            value = LITERALS[type(node)](node)
        except Fault as error:
            raise self._emitter.fail(error.slug) from None
        match value:
            case str():
                return Text(value)
            case bool():
                self._emit(Op.PUSH_BOOL, int(value))
                return Scalar(BOOL)
            case int():
                self._emit(Op.PUSH_INT, value)
                return Scalar(INT)
        self._emit(Op.PUSH_REAL, bits_of(value))
        return Scalar(REAL)

    def literal_integer(self, node: ast.Expression) -> int | None:
        """Return the value of an INT literal with its sign, or ``None``."""
        match node:
            case ast.Parenthesised():
                return self.literal_integer(node.inner)
            case ast.Unary(operator="-" | "+" as sign):
                number = self.literal_integer(node.operand)
                return -number if number is not None and sign == "-" else number
        return integer_literal(node)

    def _constant(self, node: ast.EnumConstant, wanted: Type) -> Value:
        try:
            value = enumeration_constant(self._context.unit, node, wanted)
        except LinkError as error:
            raise self._emitter.unlinked(str(error)) from None
        self._emit(Op.PUSH_ENUM, self._emitter.number(value.type), value.index)
        return Scalar(self._emitter.closed(value.type))

    def _parenthesised(self, node: ast.Parenthesised, wanted: Type) -> Value:
        return self.value(node.inner, wanted)

    # ----------------------------------------------------------------------- operators

    def _unary(self, node: ast.Unary, _wanted: Type) -> Value:
        value = self.operand(node.operand, UNKNOWN)
        kind = kind_of(value.type)
        selection = None if kind is None else select(node.operator, kind)
        if selection is None:
            raise self._emitter.fail("operand")
        if selection.primitive is None:
            return value
        number = self._writer.constant()
        if node.operator == "-" and number not in (None, INT_MIN):
            self._writer.drop_last()
            self._emit(Op.PUSH_INT, -number)
            return value
        for step in selection.conversions[0]:
            self._emit(Op[step.name.upper()])
        self._apply(selection.primitive)
        return self._result(selection, value)

    def operand(self, node: ast.Expression, wanted: Type) -> Scalar | Reference:
        """Generate an operand of an operator."""
        return self._as_operand(self.value(node, wanted))

    def _as_operand(self, value: Value) -> Scalar | Reference:
        match value:
            case Text(text) if len(text) == 1:
                self._emit(Op.PUSH_CHAR, ord(text))
                return Scalar(CHAR)
            case Scalar() | Reference():
                return value
        raise self._emitter.fail("operand")

    def _binary(self, node: ast.Binary, _wanted: Type) -> Value:
        chain = left_chain(node)
        first = self._writer.here
        value: Value = self.operand(chain[0].left, UNKNOWN)
        for each in chain:
            value = self.joined(each.operator, value, partial(self.operand, each.right), first)
        return value

    def joined(
        self,
        operator: str,
        value: Value,
        push_right: Callable[[Type], Scalar | Reference],
        first: int = 0,
    ) -> Value:
        """Generate an operation whose left operand is on the stack, from ``first`` on.

        ``push_right`` pushes the right one, for a place of a type.
        """
        left, between = self._as_operand(value), self._writer.here
        right = push_right(left.type if isinstance(left.type, Enumeration) else UNKNOWN)
        selection = self._selected(operator, left.type, right.type)
        primitive = selection.primitive
        assert primitive is not None, "an operator of two operands does something"
        if primitive.name == "compose":
            return self._composed(left, right, first)
        if primitive.operands[0] == "ENUM" and left.type != right.type:
            return self._unlike(primitive)
        for step in reversed(selection.conversions[0]):
            self._writer.insert(between, Op[step.name.upper()])
        for step in selection.conversions[1]:
            self._emit(Op[step.name.upper()])
        self._apply(primitive)
        return self._result(selection, left)

    def _selected(self, operator: str, left: Type, right: Type) -> Selection:
        """Return the variant of an operator for these operand types."""
        kinds = kind_of(left), kind_of(right)
        selection = None
        if kinds[0] is not None and kinds[1] is not None:
            selection = select(operator, kinds[0], kinds[1])
        if selection is None:
            raise self._emitter.fail("operand")
        return selection

    def _unlike(self, primitive: Primitive) -> Value:
        """Generate the comparison of constants of two enumerations, which are never equal."""
        self._emit(Op.DROP)
        self._emit(Op.DROP)
        self._emit(Op.PUSH_BOOL, int(primitive.name != "eq_enum"))
        return Scalar(BOOL)

    def _apply(self, primitive: Primitive) -> None:
        """Emit a primitive; the addition of a constant has its own instruction."""
        number = self._writer.constant()
        if primitive.name in _SIGNS and number not in (None, INT_MIN):
            self._writer.drop_last()
            self._emit(Op.ADD_CONSTANT, _SIGNS[primitive.name] * number)
            return
        self._emit(Op[primitive.name.upper()])

    def _result(self, selection: Selection, operand: Scalar | Reference) -> Value:
        found = {"INT": INT, "REAL": REAL, "BOOL": BOOL, "CHAR": CHAR}.get(selection.result)
        return operand if found is None else Scalar(found)

    def _composed(self, left: Scalar | Reference, right: Scalar | Reference, first: int) -> Value:
        """Generate the geometric operator; a reference to its result lies below its operands."""
        kept = FrameCells(self._writer.temporary(right.type), right.type)
        self._memory.refer_below(kept, first)
        self._emit(Op.COMPOSE, self._emitter.number(left.type), self._emitter.number(right.type))
        self._memory.refer(kept)
        return Reference(right.type)

    # ----------------------------------------------------------------------- aggregates

    def _aggregate(self, node: ast.Aggregate, wanted: Type) -> Value:
        structure = structure_of(self._context.unit, node, wanted)
        if structure is None:
            raise self._emitter.unlinked(UNKNOWN_STRUCTURE)
        type_ = self._emitter.closed(structure)
        whole = FrameCells(self._writer.temporary(type_), type_)
        self._memory.refer(whole)
        self._emit(Op.CLEAR, self._emitter.number(type_))
        for component in node.components:
            place = self._memory.member(whole, component.name.text)
            if component.indices:
                place = self._designators.element(place, component.indices)
            self.assign(place, component.value)
        self._memory.refer(whole)
        return Reference(type_)

    def assign(self, place: Location, node: ast.Expression) -> Location:
        """Generate an assignment; return the location to trace."""
        ready = self._memory.ready(place)
        behind = self._writer.here
        wanted = UNKNOWN if isinstance(ready, ViewParameter | PushedView) else ready.type
        self._memory.store(ready, self.value(node, wanted), behind)
        return ready


_SIGNS = {"add_int": 1, "sub_int": -1}


_Rule = Callable[[Expressions, Any, Type], Value]


class CodeMaker:
    """The parts that all generators above expressions use."""

    def __init__(self, expressions: Expressions) -> None:
        self._expressions = expressions
        self._emitter = expressions.emitter
        self._context = expressions.emitter.context
        self._writer = expressions.emitter.writer
        self._emit = expressions.emitter.emit
        self._memory = expressions.memory
        self._designators = expressions.designators


_VALUES: Mapping[type[Any], _Rule] = {
    **dict.fromkeys(LITERALS, Expressions._literal),
    ast.EnumConstant: Expressions._constant,
    ast.Parenthesised: Expressions._parenthesised,
    ast.Unary: Expressions._unary,
    ast.Binary: Expressions._binary,
    ast.Aggregate: Expressions._aggregate,
    ast.Call: lambda self, node, _wanted: self._call(node),
}
