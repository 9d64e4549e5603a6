"""The instructions that compute: numbers, comparisons, poses.

Primitives of `interp.values.operators` are called as functions. The most frequent ones have an
operation of their own with the same result.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

from interp.bytecode._generated.opcodes import Op
from interp.bytecode.cell_layout import cells_of, size, value_at
from interp.bytecode.vm.context import Rule, Rules, Site
from interp.bytecode.vm.state import Operation, computed
from interp.values.builtins import WEIGHTS
from interp.values.faults import fault
from interp.values.geometric_operator import composed
from interp.values.operators import PRIMITIVES, Primitive
from interp.values.values import StructureValue, single


class ArithmeticRules(Rules):
    """Makes the operations of instructions that compute."""

    def rules(self) -> Mapping[Op, Rule]:
        """Return the factory of each opcode."""
        rules: dict[Op, Rule] = {
            Op[name.upper()]: partial(self._primitive, primitive)
            for name, primitive in PRIMITIVES.items()
        }
        for name, primitive in PRIMITIVES.items():
            if unless := Op.__members__.get(f"UNLESS_{name.upper()}"):
                rules[unless] = partial(self._unless, primitive.function)
        for sign, compute in (("ADD", operator.add), ("SUB", operator.sub), ("MUL", operator.mul)):
            rules[Op[f"{sign}_INT"]] = partial(self._whole, compute)
            rules[Op[f"{sign}_REAL"]] = partial(self._single, compute)
        return {
            **rules,
            Op.ADD_INT: self._add_int,
            Op.ADD_CONSTANT: self._add_constant,
            Op.CHAR_TO_INT: lambda site: site.after,  # a cell holds the code
            Op.INT_TO_CHAR: self._int_to_char,
            Op.COMPOSE: self._compose,
        }

    def _primitive(self, primitive: Primitive, site: Site) -> Operation:
        return computed(primitive.function, len(primitive.operands), self._stack, site.after)

    def _unless(self, compare: Callable[[Any, Any], bool], site: Site, target: int) -> Operation:
        pop, after, body = self._stack.pop, site.after, site.body

        def operation() -> Operation:
            right = pop()
            return after if compare(pop(), right) else body[target]

        return operation

    def _whole(self, compute: Callable[[int, int], int], site: Site) -> Operation:
        stack, after = self._stack, site.after

        def operation() -> Operation:
            right = stack.pop()
            result = compute(stack[-1], right)
            if not -0x80000000 <= result <= 0x7FFFFFFF:
                raise fault("overflow")
            stack[-1] = result
            return after

        return operation

    def _single(self, compute: Callable[[float, float], float], site: Site) -> Operation:
        stack, after = self._stack, site.after

        def operation() -> Operation:
            right = stack.pop()
            stack[-1] = single(compute(stack[-1], right))
            return after

        return operation

    def _add_int(self, site: Site) -> Operation:
        stack, after = self._stack, site.after

        def operation() -> Operation:
            right = stack.pop()
            result = stack[-1] + right
            if not -0x80000000 <= result <= 0x7FFFFFFF:
                raise fault("overflow")
            stack[-1] = result
            return after

        return operation

    def _add_constant(self, site: Site, constant: int) -> Operation:
        stack, after = self._stack, site.after

        def operation() -> Operation:
            result = stack[-1] + constant
            if not -0x80000000 <= result <= 0x7FFFFFFF:
                raise fault("overflow")
            stack[-1] = result
            return after

        return operation

    def _int_to_char(self, site: Site) -> Operation:
        stack, after = self._stack, site.after

        def operation() -> Operation:
            if not 0 <= stack[-1] <= 255:
                raise fault("inadmissible")
            return after

        return operation

    def _compose(self, site: Site, left: int, right: int) -> Operation:
        cells, pop, after = self._cells, self._stack.pop, site.after
        left_type, right_type = self._types[left], self._types[right]
        width, charge = size(right_type), self._runtime.hooks.charge

        def operation() -> Operation:
            other = value_at(cells, pop(), right_type)
            one = value_at(cells, pop(), left_type)
            assert isinstance(one, StructureValue), "verified"
            assert isinstance(other, StructureValue), "verified"
            target = pop()
            cells[target : target + width] = cells_of(composed(one, other), right_type)
            charge(WEIGHTS[":"])
            return after

        return operation
