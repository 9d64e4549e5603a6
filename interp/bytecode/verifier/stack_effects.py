"""The steps of stack effects: what is checked, popped and pushed.

Which instruction has which steps stands in the table of the instruction set, see
`interp.bytecode.instruction_set.effects`; a method here has the name of its step: ``check_array``,
``take_any``, or only ``array_view`` for an item that is taken or pushed.
``interp/native/verifier/stack_effects.c`` has the same steps.
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
from interp.bytecode.verifier.cell_types import CellTypes
from interp.bytecode.verifier.signatures import may_be_missing
from interp.bytecode.verifier.stack_types import (
    NOTHING,
    Refused,
    Stack,
    StackItem,
    item_of,
    view_of,
)
from interp.bytecode.verifier.stack_types import reference as reference_to

_MOST_DIMENSIONS = 3
_INT = SCALARS.index("INT")


class StackEffects:
    """The effects of the instructions of one code object of a well-formed program."""

    def __init__(self, program: Program, code: Code) -> None:
        self._program = program
        self._code = code
        self._types = program.types
        self._cells = CellTypes(program, code)
        self.empty = self._stack = Stack()
        #: What ``t`` and ``ENUM`` stand for in the effect at hand.
        self._same = NOTHING

    def after(self, instruction: Instruction, before: Stack) -> Stack:
        """The stack behind an instruction; raises `Refused`."""
        self._stack = before
        for step in instructions()[instruction.op].steps:
            self._carry_out(step, instruction.operands)
        return self._stack

    def at_target(self, op: Op, after: Stack) -> Stack:
        """The stack where an instruction goes on elsewhere, by that behind it."""
        if op is Op.AT or after.below is None:  # a statement is left: its operands are forgotten
            return self.empty
        return after.below if op is Op.CASE else after

    def _carry_out(self, step: EffectStep, operands: Sequence[int]) -> None:
        given = [SCALARS.index(a) if isinstance(a, str) else operands[a] for a in step.arguments]
        if not step.is_item:
            getattr(self, f"{step.verb}_{step.name}")(*given)
        elif step.verb == "take":
            self._take(getattr(self, step.name)(*given))
        else:
            self._push(getattr(self, step.name)(*given))

    def _take(self, wanted: StackItem) -> None:
        if self._stack.below is None or self._pop() != wanted:
            raise Refused("the stack does not hold what it takes")

    def _pop(self) -> StackItem:
        stack = self._stack
        if stack.below is None:
            raise Refused("the stack is empty")
        self._stack = stack.below
        return stack.top

    def _push(self, item: StackItem) -> None:
        self._stack = self._stack.with_item(item)

    # ----------------------------------------------------------------------- items

    def value(self, type_: int) -> StackItem:
        """A value of this type."""
        return StackItem(Mode.IN, type_)

    def nothing(self) -> StackItem:
        """What an argument that was left out is."""
        return NOTHING

    def same(self) -> StackItem:
        """What was taken as any value."""
        return self._same

    def local(self, cell: int) -> StackItem:
        """A value such as a cell of the frame holds."""
        return self._cells.local(cell)

    def data(self, cell: int) -> StackItem:
        """A value such as a cell of the data lists holds."""
        return self._cells.data(cell)

    def reference(self, type_: int) -> StackItem:
        """A reference to this type."""
        return reference_to(type_)

    def parameter(self, place: int) -> StackItem:
        """The reference that a parameter is."""
        return self._cells.parameter(place, Mode.REF)

    def element(self, array: int) -> StackItem:
        """A reference to an element of an array type."""
        return reference_to(self._element(array))

    def element_value(self, array: int) -> StackItem:
        """The value of an element of an array type."""
        return self._cell_of(self.element(array))

    def view(self, element: int, dimensions: int) -> StackItem:
        """A view of elements of this type."""
        return view_of(element, dimensions)

    def missing_view(self, element: int, dimensions: int) -> StackItem:
        """The same where it may be missing."""
        return replace(view_of(element, dimensions), is_missing=True)

    def letters(self) -> StackItem:
        """A view of CHARs in one dimension."""
        return view_of(SCALARS.index("CHAR"), 1)

    def array_view(self, array: int) -> StackItem:
        """A view of an array type."""
        return view_of(self._element(array), self._rank(array))

    def row(self, array: int, count: int) -> StackItem:
        """A view of what is left of an array type behind so many indices."""
        return view_of(self._element(array), self._rank(array) - count)

    def view_parameter(self, place: int) -> StackItem:
        """The view that a parameter is."""
        return self._cells.parameter(place, Mode.VIEW)

    def missing_view_parameter(self, place: int) -> StackItem:
        """The same where it may be missing."""
        return replace(self.view_parameter(place), is_missing=True)

    def view_element(self, place: int) -> StackItem:
        """A reference to an element of the view that a parameter is."""
        return reference_to(self.view_parameter(place).type)

    def view_row(self, place: int, count: int) -> StackItem:
        """A view of what is left of that view behind so many indices."""
        whole = self.view_parameter(place)
        return view_of(whole.type, whole.cells - 1 - count)

    def _element(self, array: int) -> int:
        return self._cells.element(self._cells.array(array))

    def _rank(self, array: int) -> int:
        return len(self._cells.array(array).sizes)

    def _cell_of(self, item: StackItem) -> StackItem:
        """What the cell holds that a reference leads to."""
        if item.mode is not Mode.REF or not isinstance(self._types[item.type], Plain):
            raise Refused("a reference to a cell is needed")
        return StackItem(Mode.IN, item.type)

    # ----------------------------------------------------------------------- taken by rules

    def take_any(self) -> None:
        """A value of any type."""
        self._same = self._pop()
        if self._same.mode is not Mode.IN or self._same == NOTHING:
            raise Refused("a value is needed")

    def take_enumeration(self) -> None:
        """A constant of any enumeration."""
        self.take_any()
        if not isinstance(self._types[self._same.type], Enumeration):
            raise Refused("constants of enumerations are needed")

    def take_like(self, constant: int) -> None:
        """A value that can be this constant."""
        self.take_any()
        type_ = self._types[self._same.type]
        if type_ in (REAL, BOOL) or not isinstance(type_, Plain) or not is_word_of(constant, type_):
            raise Refused(f"{constant} is no constant for {type_}")

    def take_reference_to_cell(self) -> None:
        """A reference to a cell of any type."""
        self._same = self._cell_of(self._pop())

    def take_reference_to_same(self) -> None:
        """A reference to a cell for the value that was taken."""
        if self._cell_of(self._pop()) != self._same:
            raise Refused("the value is of another kind")

    def take_whole(self, offset: int, number: int) -> None:
        """A reference to something with a part of this type so many cells behind its start."""
        item = self._pop()
        if item.mode is not Mode.REF:
            raise Refused("a reference is needed")
        self._cells.check_part(self._types[item.type], offset, number)

    def take_integers(self, count: int) -> None:
        """So many INTs."""
        for _ in range(count):
            self._take(self.value(_INT))

    def take_indices(self, array: int) -> None:
        """All indices of an array type."""
        self.take_integers(self._rank(array))

    def take_view_indices(self, place: int) -> None:
        """All indices of the view that a parameter is."""
        self.take_integers(self.view_parameter(place).cells - 1)

    # ----------------------------------------------------------------------- calls and requests

    def take_arguments(self, number: int) -> None:
        """The arguments of a routine."""
        callee = self._program.codes[number]
        if callee.kind is not CodeKind.ROUTINE:
            raise Refused(f"{callee.name} is no routine")
        for parameter in reversed(callee.parameters):
            item = self._pop()
            wanted = self._argument(parameter)
            is_left_out = item == NOTHING and wanted.mode is Mode.IN
            if replace(item, is_missing=False) != wanted and not is_left_out:
                raise Refused(f"the argument for {parameter.name} is of another kind")

    def _argument(self, parameter: Parameter) -> StackItem:
        """What the stack holds for a parameter: a structure lies there by reference."""
        if parameter.mode is Mode.IN and not isinstance(self._types[parameter.type], Plain):
            return reference_to(parameter.type)
        return item_of(parameter)

    def push_result(self, number: int) -> None:
        """The result of a routine, if it has one."""
        result = self._program.codes[number].result
        if result is not None:
            self._push(self.value(result))

    def take_request(self, number: int) -> None:
        """The inputs of a request."""
        ask = self._program.asks[number]
        for handle in _handles_of(ask.parts):
            owner = self._program.codes[handle.code].owner
            if owner is None or self._program.codes[owner] is not self._code:
                raise Refused("the action or condition belongs to another code object")
        self._take_entry(ask)

    def push_reply(self, number: int) -> None:
        """What the reply becomes, if that has one cell."""
        self._push_entry(self._program.asks[number])

    def take_inputs(self, number: int) -> None:
        """The inputs of a predefined function."""
        builtin = self._program.builtins[number]
        self._take_entry(builtin, list(may_be_missing(builtin)))

    def push_output(self, number: int) -> None:
        """The result of a predefined function, if it has one of one cell."""
        self._push_entry(self._program.builtins[number])

    def _take_entry(self, entry: Ask | Builtin, missing: Sequence[bool] = ()) -> None:
        if entry.result is not None and not isinstance(self._types[entry.result], Plain):
            self._take(reference_to(entry.result))
        inputs = list(inputs_of(entry.parts))
        for given, is_text in zip_longest(reversed(inputs), reversed(missing)):
            item = self._pop()
            if (replace(item, is_missing=False) if is_text else item) != item_of(given):
                raise Refused("an input is of another kind")

    def _push_entry(self, entry: Ask | Builtin) -> None:
        if entry.result is not None and isinstance(self._types[entry.result], Plain):
            self._push(self.value(entry.result))

    def take_own_result(self) -> None:
        """What this code object gives, and nothing is left."""
        if self._code.result is None:
            raise Refused("there is no result")
        self._take(self.value(self._code.result))
        if self._stack is not self.empty:
            raise Refused("more than the result is on the stack")

    # ----------------------------------------------------------------------- checks

    def check_empty(self) -> None:
        """Nothing is on the stack."""
        if self._stack is not self.empty:
            raise Refused("a statement begins with an empty stack")

    def check_no_result(self) -> None:
        """Nothing is to be given, and nothing is left."""
        if self._code.result is not None or self._code.kind is CodeKind.CONDITION:
            raise Refused("a result is needed")
        self.check_empty()

    def check_constant(self, number: int, place: int) -> None:
        """An enumeration has a constant at this place."""
        type_ = self._types[number]
        if not isinstance(type_, Enumeration) or not place < len(type_.constants):
            raise Refused("there is no such constant")

    def check_rank(self, dimensions: int, least: int = 1) -> None:
        """Arrays can have so many dimensions."""
        if not least <= dimensions <= _MOST_DIMENSIONS:
            raise Refused(f"arrays have no {dimensions} dimensions")

    def check_element(self, number: int) -> None:
        """A type can be that of elements."""
        if isinstance(self._types[number], Array):
            raise Refused("elements are no arrays")

    def check_array(self, number: int) -> None:
        """A type is an array."""
        self._cells.array(number)

    def check_row(self, array: int, count: int) -> None:
        """So many indices leave a row of an array type."""
        _check_indices(count, self._rank(array))

    def check_view_row(self, place: int, count: int) -> None:
        """So many indices leave a row of the view that a parameter is."""
        _check_indices(count, self.view_parameter(place).cells - 1)

    def check_part_of_local(self, cell: int, number: int) -> None:
        """A part of this type begins at a cell of the frame."""
        self._cells.check_local(cell, number)

    def check_part_of_data(self, cell: int, number: int) -> None:
        """A part of this type begins at a cell of the data lists."""
        self._cells.check_data(cell, number)

    def check_positions(self, to: int, of: int) -> None:
        """Both types are positions of one family."""
        if shared_cells(self._types[to], self._types[of]) is None:
            raise Refused("positions of one family are needed")

    def check_poses(self, left: int, right: int) -> None:
        """Both types are cartesian positions."""
        types = self._types[left], self._types[right]
        if not all(map(is_cartesian, types)) or shared_cells(*types) is None:
            raise Refused("poses are needed")

    def check_for_local(self, counter: int, limit: int, step: int) -> None:
        """A loop can be counted in a cell of the frame."""
        self._check_counter(self.local(counter), limit, step)

    def check_for_data(self, counter: int, limit: int, step: int) -> None:
        """A loop can be counted in a cell of the data lists."""
        self._check_counter(self.data(counter), limit, step)

    def _check_counter(self, counter: StackItem, limit: int, step: int) -> None:
        integer = self.value(_INT)
        if counter != integer or self.local(limit) != integer or step == 0:
            raise Refused("a counter and a limit that are INT and a step that is not 0 are needed")

    def check_told(self, place: int, dimensions: int) -> None:
        """The trace can name the parameter that something was assigned through."""
        self.check_rank(dimensions, 0)
        slot = self._cells.slot(place)
        if (
            slot.offset != place
            or not isinstance(slot.variable, Parameter)
            or slot.variable.mode is Mode.IN
        ):
            raise Refused("no parameter :OUT begins there")

    def check_told_rank(self, dimensions: int) -> None:
        """One thing was assigned, or an array of so many dimensions."""
        self.check_rank(dimensions, 0)


def _check_indices(count: int, dimensions: int) -> None:
    if not 1 <= count < dimensions:
        raise Refused("a row has one index at least and not all of them")


def _handles_of(parts: Sequence[Argument]) -> Iterator[Handle]:
    """The actions and conditions that a request hands over."""
    for part in parts:
        if isinstance(part, Handle):
            yield part
        elif isinstance(part, Items | Record):
            yield from _handles_of(part.parts)
