"""The steps of stack effects: each one checks, pops or pushes something on the abstract stack.

The table of the instruction set lists the steps of every instruction, see
`interp.bytecode.instruction_set.effects`. Each step is a method with the same name here, such as
``check_array`` and ``take_any``. What is popped or pushed otherwise is an item, ``array_view`` for
instance, of `interp.bytecode.verifier.stack_items`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import zip_longest

from grammar.semantics.types import BOOL, REAL, Array, Enumeration, is_cartesian
from interp.bytecode._generated.opcodes import Op
from interp.bytecode.cell_layout import Plain, is_word_of, shared_cells
from interp.bytecode.instruction_set.effects import SCALARS, EffectStep
from interp.bytecode.instruction_set.table import instructions
from interp.bytecode.program import (
    Argument,
    Ask,
    Builtin,
    Code,
    CodeKind,
    Handle,
    Instruction,
    Items,
    Mode,
    Parameter,
    Program,
    Record,
    inputs_of,
)
from interp.bytecode.verifier.signatures import may_be_missing
from interp.bytecode.verifier.stack_items import StackItems
from interp.bytecode.verifier.stack_types import (
    NOTHING,
    Refused,
    Stack,
    StackItem,
    item_of,
    reference_to,
)

_MOST_DIMENSIONS = 3
_INT = SCALARS.index("INT")


class StackEffects:
    """Applies the effects of instructions of one code object of a well-formed program."""

    def __init__(self, program: Program, code: Code) -> None:
        self._program = program
        self._code = code
        self._types = program.types
        self._items = StackItems(program, code)
        self.empty = self._stack = Stack()
        #: What ``t``, ``ENUM`` or ``@t`` has found, where it stands again in the effect.
        self._same = NOTHING

    def after(self, instruction: Instruction, before: Stack) -> Stack:
        """Return the stack after an instruction; raises `Refused` if it does not fit."""
        self._stack = before
        for step in instructions()[instruction.op].steps:
            self._carry_out(step, instruction.operands)
        return self._stack

    def at_target(self, op: Op, after: Stack) -> Stack:
        """Return the stack at the jump target of an instruction, given the stack after it."""
        if op is Op.AT or after.below is None:  # a statement is left: its operands are forgotten
            return self.empty
        return after.below if op is Op.CASE else after

    def _carry_out(self, step: EffectStep, operands: Sequence[int]) -> None:
        given = [SCALARS.index(a) if isinstance(a, str) else operands[a] for a in step.arguments]
        if not step.is_item:
            getattr(self, f"{step.verb}_{step.name}")(*given)
            return
        item = self._same if step.name == "same" else getattr(self._items, step.name)(*given)
        if step.verb == "take":
            self._take(item)
        else:
            self._push(item)

    def _take(self, wanted: StackItem) -> None:
        if self._pop() != wanted:
            raise Refused("an operand has the wrong type")

    def _pop(self) -> StackItem:
        stack = self._stack
        if stack.below is None:
            raise Refused("the stack is empty")
        self._stack = stack.below
        return stack.top

    def _push(self, item: StackItem) -> None:
        self._stack = self._stack.with_item(item)

    # ----------------------------------------------------------------------- taken by rules

    def take_any(self) -> None:
        """Pop a value of any type."""
        self._same = self._pop()
        if self._same.mode is not Mode.IN or self._same == NOTHING:
            raise Refused("a value is required")

    def take_enumeration(self) -> None:
        """Pop a constant of any enumeration."""
        self.take_any()
        if not isinstance(self._types[self._same.type], Enumeration):
            raise Refused("a constant of an enumeration is required")

    def take_like(self, constant: int) -> None:
        """Pop a value whose type includes this constant."""
        self.take_any()
        type_ = self._types[self._same.type]
        if type_ in (REAL, BOOL) or not isinstance(type_, Plain):
            raise Refused("an INT, a CHAR or a constant of an enumeration is required")
        if not is_word_of(constant, type_):
            raise Refused(f"{constant} is not a value of {type_}")

    def take_reference_to_cell(self) -> None:
        """Pop a reference to a cell of any type."""
        self._same = self._items.cell_of(self._pop())

    def take_reference_to_same(self) -> None:
        """Pop a reference to a cell of the type of the value that was popped before."""
        if self._items.cell_of(self._pop()) != self._same:
            raise Refused("the value and the cell have different types")

    def take_whole(self, offset: int, number: int) -> None:
        """Pop a reference to a variable that has a part of this type at an offset in cells."""
        item = self._pop()
        if item.mode is not Mode.REF:
            raise Refused("a reference is required")
        self._items.check_part(self._types[item.type], offset, number)

    def take_integers(self, count: int) -> None:
        """Pop this number of INTs."""
        for _ in range(count):
            self._take(self._items.value(_INT))

    def take_indices(self, array: int) -> None:
        """Pop one index for each dimension of an array type."""
        self.take_integers(self._items.rank(array))

    def take_view_indices(self, place: int) -> None:
        """Pop one index for each dimension of an array parameter."""
        self.take_integers(self._items.view_parameter(place).cells - 1)

    # ----------------------------------------------------------------------- calls and requests

    def take_arguments(self, number: int) -> None:
        """Pop the arguments of a routine."""
        callee = self._program.codes[number]
        if callee.kind is not CodeKind.ROUTINE:
            raise Refused(f"only a routine can be called: {callee.name}")
        for parameter in reversed(callee.parameters):
            item = self._pop()
            wanted = self._argument(parameter)
            is_left_out = item == NOTHING and wanted.mode is Mode.IN
            if replace(item, is_missing=False) != wanted and not is_left_out:
                raise Refused(f"an argument has the wrong type: {parameter.name}")

    def _argument(self, parameter: Parameter) -> StackItem:
        """Return the item for an argument; a structure is passed by reference."""
        if parameter.mode is Mode.IN and not isinstance(self._types[parameter.type], Plain):
            return reference_to(parameter.type)
        return item_of(parameter)

    def push_result(self, number: int) -> None:
        """Push the result of a routine, if it has one."""
        result = self._program.codes[number].result
        if result is not None:
            self._push(self._items.value(result))

    def take_request(self, number: int) -> None:
        """Pop the inputs of a request."""
        ask = self._program.asks[number]
        for handle in _handles_of(ask.parts):
            owner = self._program.codes[handle.code].owner
            if owner is None or self._program.codes[owner] is not self._code:
                raise Refused("the action or condition belongs to another code object")
        self._take_entry(ask)

    def push_reply(self, number: int) -> None:
        """Push the answer to a request, if it fits into one cell."""
        self._push_entry(self._program.asks[number])

    def take_inputs(self, number: int) -> None:
        """Pop the inputs of a predefined function."""
        builtin = self._program.builtins[number]
        self._take_entry(builtin, list(may_be_missing(builtin)))

    def push_output(self, number: int) -> None:
        """Push the result of a predefined function, if it fits into one cell."""
        self._push_entry(self._program.builtins[number])

    def _take_entry(self, entry: Ask | Builtin, missing: Sequence[bool] = ()) -> None:
        if entry.result is not None and not isinstance(self._types[entry.result], Plain):
            self._take(reference_to(entry.result))
        inputs = list(inputs_of(entry.parts))
        for given, is_text in zip_longest(reversed(inputs), reversed(missing)):
            item = self._pop()
            if (replace(item, is_missing=False) if is_text else item) != item_of(given):
                raise Refused("an input has the wrong type")

    def _push_entry(self, entry: Ask | Builtin) -> None:
        if entry.result is not None and isinstance(self._types[entry.result], Plain):
            self._push(self._items.value(entry.result))

    def take_own_result(self) -> None:
        """Pop the result of this code object; raises `Refused` if the stack is not empty then."""
        if self._code.result is None:
            raise Refused("the code object has no result")
        self._take(self._items.value(self._code.result))
        self.check_empty()

    # ----------------------------------------------------------------------- checks

    def check_empty(self) -> None:
        """Check that the stack is empty."""
        if self._stack is not self.empty:
            raise Refused("the stack must be empty here")

    def check_no_result(self) -> None:
        """Check that this code object has no result and that the stack is empty."""
        if self._code.result is not None or self._code.kind is CodeKind.CONDITION:
            raise Refused("the code object must return a result")
        self.check_empty()

    def check_constant(self, number: int, place: int) -> None:
        """Check that an enumeration has a constant with this number."""
        type_ = self._types[number]
        if not isinstance(type_, Enumeration) or not place < len(type_.constants):
            raise Refused("the enumeration has no such constant")

    def check_rank(self, dimensions: int, least: int = 1) -> None:
        """Check that arrays can have this number of dimensions."""
        if not least <= dimensions <= _MOST_DIMENSIONS:
            raise Refused(f"an array has 1 to {_MOST_DIMENSIONS} dimensions")

    def check_element(self, number: int) -> None:
        """Check that an array can have elements of this type."""
        if isinstance(self._types[number], Array):
            raise Refused("the elements of an array cannot be arrays")

    def check_array(self, number: int) -> None:
        """Check that a type is an array."""
        self._items.array(number)

    def check_row(self, array: int, count: int) -> None:
        """Check that this number of indices selects a row of an array type."""
        _check_indices(count, self._items.rank(array))

    def check_view_row(self, place: int, count: int) -> None:
        """Check that this number of indices selects a row of an array parameter."""
        _check_indices(count, self._items.view_parameter(place).cells - 1)

    def check_part_of_local(self, cell: int, number: int) -> None:
        """Check that a part of this type begins at a cell of the frame."""
        self._items.check_part(*self._items.variable(cell), number)

    def check_part_of_data(self, cell: int, number: int) -> None:
        """Check that a part of this type begins at a cell of the data lists."""
        self._items.check_part(*self._items.data_variable(cell), number)

    def check_positions(self, to: int, of: int) -> None:
        """Check that values of both types can be assigned to each other as positions."""
        if shared_cells(self._types[to], self._types[of]) is None:
            raise Refused("positions of the same family are required")

    def check_poses(self, left: int, right: int) -> None:
        """Check that both types are cartesian positions."""
        types = self._types[left], self._types[right]
        if not all(map(is_cartesian, types)) or shared_cells(*types) is None:
            raise Refused("Cartesian positions are required")

    def check_for_local(self, counter: int, limit: int, step: int) -> None:
        """Check that a FOR loop can count in a cell of the frame."""
        self._check_counter(self._items.local(counter), limit, step)

    def check_for_data(self, counter: int, limit: int, step: int) -> None:
        """Check that a FOR loop can count in a cell of the data lists."""
        self._check_counter(self._items.data(counter), limit, step)

    def _check_counter(self, counter: StackItem, limit: int, step: int) -> None:
        integer = self._items.value(_INT)
        if counter != integer or self._items.local(limit) != integer or step == 0:
            raise Refused("counter and limit must be INT, and the step must not be 0")

    def check_told(self, place: int, dimensions: int) -> None:
        """Check that the trace can name the :OUT parameter through which something was assigned."""
        self.check_rank(dimensions, 0)
        slot = self._items.slot(place)
        if (
            slot.offset != place
            or not isinstance(slot.variable, Parameter)
            or slot.variable.mode is Mode.IN
        ):
            raise Refused("no parameter :OUT begins at this cell")

    def check_told_rank(self, dimensions: int) -> None:
        """Check the number of dimensions of an assigned array; 0 stands for a single value."""
        self.check_rank(dimensions, 0)


def _check_indices(count: int, dimensions: int) -> None:
    if not 1 <= count < dimensions:
        raise Refused("a row needs at least one index, but not all of them")


def _handles_of(parts: Sequence[Argument]) -> Iterator[Handle]:
    """Yield the actions and conditions that a request passes to the controller."""
    for part in parts:
        if isinstance(part, Handle):
            yield part
        elif isinstance(part, Items | Record):
            yield from _handles_of(part.parts)
