"""Expressions: the values of literals, operators and aggregates.

Every evaluation is a generator, because any variable may be a system variable and any call may move
the arm (see `interp.tree.program_state`). Operands are evaluated from left to right.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Mapping
from typing import Any

from grammar.semantics.types import (
    BOOL,
    INT,
    REAL,
    UNKNOWN,
    Type,
)
from grammar.syntax import ast
from grammar.syntax.walk import left_chain
from interp.program.literals import LITERALS, enumeration_constant
from interp.program.reads import UNKNOWN_STRUCTURE, structure_of
from interp.tree.designators import Designators
from interp.tree.places import LocalPlace, member
from interp.tree.program_state import Steps
from interp.values.faults import LinkError, fault
from interp.values.operators import apply, apply_unary
from interp.values.values import (
    EnumValue,
    Value,
    converted,
    empty,
    known,
)


class Expressions(Designators):
    """The evaluation of expressions in one frame."""

    def value(self, node: ast.Expression, wanted: Type = UNKNOWN) -> Steps[Value]:
        """Return the value of an expression in a context of type ``wanted``; it is never ``None``.

        A structure or array is the one that the variable holds: to keep it, copy it. Faults
        ``uninitialised`` if there is no value.
        """
        rule = _VALUES.get(type(node))
        if rule is not None:
            return (yield from rule(self, node, wanted))
        return known((yield from self.read((yield from self.place(node)))))

    def truth(self, node: ast.Expression) -> Steps[bool]:
        """Return the value of a condition; fault ``operand`` if it is not a BOOL."""
        found = yield from self.value(node, BOOL)
        if not isinstance(found, bool):
            raise fault("operand")
        return found

    def integer(self, node: ast.Expression) -> Steps[int]:
        """Return the value of an expression converted to INT."""
        found = converted((yield from self.value(node, INT)), INT)
        assert isinstance(found, int), "converted"
        return found

    def real(self, node: ast.Expression) -> Steps[float]:
        """Return the value of an expression converted to REAL."""
        found = converted((yield from self.value(node, REAL)), REAL)
        assert isinstance(found, float), "converted"
        return found

    def _literal(self, node: Any, _wanted: Type) -> Steps[Value]:
        return LITERALS[type(node)](node)
        yield  # makes this a generator like the other rules

    def _constant(self, node: ast.EnumConstant, wanted: Type) -> Steps[Value]:
        return enumeration_constant(self.frame.unit, node, wanted)
        yield

    def _parenthesised(self, node: ast.Parenthesised, wanted: Type) -> Steps[Value]:
        return (yield from self.value(node.inner, wanted))

    def _unary(self, node: ast.Unary, _wanted: Type) -> Steps[Value]:
        return apply_unary(node.operator, (yield from self.value(node.operand)))

    def _binary(self, node: ast.Binary, _wanted: Type) -> Steps[Value]:
        chain = left_chain(node)
        left = yield from self.value(chain[0].left)
        for each in chain:
            wanted = left.type if isinstance(left, EnumValue) else UNKNOWN
            left = apply(each.operator, left, (yield from self.value(each.right, wanted)))
            if each.operator == ":":
                self.run.charge(":")
        return left

    def _aggregate(self, node: ast.Aggregate, wanted: Type) -> Steps[Value]:
        type_ = structure_of(self.frame.unit, node, wanted)
        if type_ is None:
            raise LinkError(UNKNOWN_STRUCTURE)
        made = empty(type_)
        whole = LocalPlace([made], type_, ())
        for component in node.components:
            place = member(whole, component.name.text)
            if component.indices:
                place = yield from self.element(place, component.indices)
            assert isinstance(place, LocalPlace), "a part of what was made here"
            place.set((yield from self.value(component.value, place.type)))
        return known(made)

    @abstractmethod
    def called(self, node: ast.Call) -> Steps[Value]:
        """Call a function and return its value."""


_Rule = Callable[[Expressions, Any, Type], Steps[Value]]
_VALUES: Mapping[type[Any], _Rule] = {
    **dict.fromkeys(LITERALS, Expressions._literal),
    ast.EnumConstant: Expressions._constant,
    ast.Parenthesised: Expressions._parenthesised,
    ast.Unary: Expressions._unary,
    ast.Binary: Expressions._binary,
    ast.Aggregate: Expressions._aggregate,
    ast.Call: lambda self, node, _wanted: self.called(node),
}
