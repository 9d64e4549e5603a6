"""Stack effects: what each instruction checks, pops and pushes on the abstract stack.

The table of the instruction set states them.

An effect is ``TAKES -- LEAVES``, the top of the stack at the right. ``x`` is an operand:

=================== ================================================================================
``INT`` …           a value of this scalar type
``t``               a value of one cell of any type; where it stands again, of the same
``ENUM``            a constant of an enumeration; where it stands again, of the same
``nothing``         what an argument that was left out is
``x``               a value of the type ``x``, or such as the cell ``x`` holds
``x[]``             an element of the array type ``x``, which is of one cell
``@t``              a reference to a cell
``@x``              a reference to the type ``x``, or the one that the parameter ``x`` is
``@x[]``            a reference to an element of the array type ``x``, or of the parameter ``x``
``[x]``             a view of the array type ``x``, or the one that the parameter ``x`` is
``[x,y]``           a view of elements of the type ``x`` in ``y`` dimensions
``[x/y]``           a view of what is left of ``x`` when ``y`` leading dimensions have an index
``letters``         a view of CHARs in one dimension
``[…]?``            a view that may be missing
``x?``              a value that may be missing, such as the cell ``x`` holds
``INT*x``           indices: all those of the array type or parameter ``x``, or the number ``x``
``rule(x,…)``       what depends on more than types: the arguments of a code object, and the like
=================== ================================================================================

Checks are made before the stack is touched: words with the operands they are about, separated by
semicolons. Then items are popped, from the top downwards, and others pushed. A word of a check and
``rule(x,…)`` stand for the method of `StackEffects` with this name, as ``check_array``; any other
item for an entry of `_ITEMS`.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cache
from itertools import zip_longest

from grammar.semantics.types import BOOL, REAL, SCALARS, Array, Enumeration, Type, is_cartesian
from interp.bytecode._generated.opcodes import Op
from interp.bytecode.cell_layout import Plain, is_word_of, kind_at, path_to, shared_cells
from interp.bytecode.instruction_set.table import Shape, instructions
from interp.bytecode.program import (
    Argument,
    Ask,
    Code,
    CodeKind,
    Handle,
    Instruction,
    Items,
    Mode,
    Program,
    Record,
    Slot,
    Variable,
    inputs_of,
    slot_at,
)
from interp.bytecode.verifier.signatures import may_be_missing
from interp.bytecode.verifier.stack_types import (
    NOTHING,
    Refused,
    Stack,
    StackItem,
    item_of,
    reference_to,
    value_of,
    view_of,
)

_MOST_DIMENSIONS = 3
#: Values of the scalar types, which have the first numbers in every program.
_VALUES = {name: value_of(number) for number, name in enumerate(SCALARS)}
_INT = _VALUES["INT"]

_Step = Callable[["StackEffects", Sequence[int]], None]


class StackEffects:
    """Applies the effects of instructions of one code object of a well-formed program."""

    def __init__(self, program: Program, code: Code) -> None:
        self._program = program
        self._code = code
        self._types = program.types
        self._slots = program.slots(code)
        self._numbers = {type_: number for number, type_ in enumerate(program.types)}
        self.empty = self._stack = Stack()
        #: What ``t``, ``ENUM`` or ``@t`` has found, where it stands again in the effect.
        self._same = NOTHING

    def after(self, instruction: Instruction, before: Stack) -> Stack:
        """Return the stack after an instruction; raises `Refused` if it does not fit."""
        self._stack = before
        for step in _steps(instruction.op):
            step(self, instruction.operands)
        return self._stack

    def at_target(self, op: Op, after: Stack) -> Stack:
        """Return the stack at the jump target of an instruction, given the stack after it."""
        if op is Op.AT or after.below is None:  # a statement is left: its operands are forgotten
            return self.empty
        return after.below if op is Op.CASE else after

    def take(self, wanted: StackItem) -> None:
        """Pop an item, which must be this one."""
        if self._pop() != wanted:
            raise Refused("an operand has the wrong type")

    def _pop(self) -> StackItem:
        stack = self._stack
        if stack.below is None:
            raise Refused("the stack is empty")
        self._stack = stack.below
        return stack.top

    def push(self, item: StackItem) -> None:
        """Push an item."""
        self._stack = self._stack.with_item(item)

    # ----------------------------------------------------------------------- operands

    def passed(self, place: int, mode: Mode) -> StackItem:
        """Return what is passed for a parameter."""
        slot = self._slot(place)
        if slot.offset != place or slot.variable.mode is not mode:
            raise Refused("no parameter begins at this cell that is passed so")
        return item_of(slot.variable)

    def cell(self, place: tuple[Type, int]) -> StackItem:
        """Return the value of a cell of a variable, which `variable` or `data_variable` finds."""
        return value_of(self._numbers[kind_at(*place)])

    def variable(self, place: int) -> tuple[Type, int]:
        """Return the type of the variable of a cell of the frame, and the cell's offset in it."""
        slot = self._slot(place)
        if slot.variable.mode is not Mode.IN:
            raise Refused("the cell holds a reference")
        return self._types[slot.variable.type], place - slot.offset

    def data_variable(self, address: int) -> tuple[Type, int]:
        """Return the type of the variable of a cell of the data lists, and the cell's offset."""
        number = self._program.data_at(address)
        if number is None:
            raise Refused("the data lists have no such cell")
        type_ = self._types[self._program.data[number].type]
        return type_, address - self._program.addresses[number]

    def element(self, array: int) -> int:
        """Return the number of the type of an array's elements."""
        return self._numbers[self._array(array).element]

    def rank(self, array: int) -> int:
        """Return the number of dimensions of an array type."""
        return len(self._array(array).sizes)

    def element_value(self, array: int) -> StackItem:
        """Return the value of an element of an array type."""
        return self._cell_of(reference_to(self.element(array)))

    def _array(self, number: int) -> Array:
        type_ = self._types[number]
        if not isinstance(type_, Array):
            raise Refused(f"an array is required: {type_}")
        return type_

    def _slot(self, place: int) -> Slot:
        """Return the parameter or local variable to which a cell of the frame belongs."""
        slot = slot_at(self._slots, place)
        if slot is None:
            raise Refused("the frame has no such cell")
        return slot

    def _cell_of(self, item: StackItem) -> StackItem:
        """Return the value in the cell that a reference refers to."""
        if item.mode is not Mode.REF or not isinstance(self._types[item.type], Plain):
            raise Refused("a reference to a single cell is required")
        return value_of(item.type)

    def _check_part(self, whole: Type, offset: int, number: int) -> None:
        """Check that a part of this type begins at an offset in a type."""
        if path_to(whole, offset, self._types[number]) is None:
            raise Refused(f"no part of this type begins here: {self._types[number]}")

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

    def take_same(self) -> None:
        """Pop such an item as was popped before."""
        self.take(self._same)

    def push_same(self) -> None:
        """Push such an item as was popped before."""
        self.push(self._same)

    def take_reference_to_cell(self) -> None:
        """Pop a reference to a cell of any type."""
        self._same = self._cell_of(self._pop())

    def take_reference_to_same(self) -> None:
        """Pop a reference to a cell of the type of the value that was popped before."""
        if self._cell_of(self._pop()) != self._same:
            raise Refused("the value and the cell have different types")

    def take_whole(self, offset: int, number: int) -> None:
        """Pop a reference to a variable that has a part of this type at an offset in cells."""
        item = self._pop()
        if item.mode is not Mode.REF:
            raise Refused("a reference is required")
        self._check_part(self._types[item.type], offset, number)

    def take_indices(self, count: int) -> None:
        """Pop this number of INTs."""
        for _ in range(count):
            self.take(_INT)

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

    def _argument(self, parameter: Variable) -> StackItem:
        """Return the item for an argument; a structure is passed by reference."""
        if parameter.mode is Mode.IN and not isinstance(self._types[parameter.type], Plain):
            return reference_to(parameter.type)
        return item_of(parameter)

    def push_result(self, number: int) -> None:
        """Push the result of a routine, if it has one."""
        result = self._program.codes[number].result
        if result is not None:
            self.push(value_of(result))

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

    def _take_entry(self, entry: Ask, missing: Sequence[bool] = ()) -> None:
        if entry.result is not None and not isinstance(self._types[entry.result], Plain):
            self.take(reference_to(entry.result))
        inputs = list(inputs_of(entry.parts))
        for given, is_text in zip_longest(reversed(inputs), reversed(missing)):
            item = self._pop()
            if (replace(item, is_missing=False) if is_text else item) != item_of(given):
                raise Refused("an input has the wrong type")

    def _push_entry(self, entry: Ask) -> None:
        if entry.result is not None and isinstance(self._types[entry.result], Plain):
            self.push(value_of(entry.result))

    def take_own_result(self) -> None:
        """Pop the result of this code object; raises `Refused` if the stack is not empty then."""
        if self._code.result is None:
            raise Refused("the code object has no result")
        self.take(value_of(self._code.result))
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
        self._array(number)

    def check_row(self, array: int, count: int) -> None:
        """Check that this number of indices selects a row of an array type."""
        _check_indices(count, self.rank(array))

    def check_view_row(self, place: int, count: int) -> None:
        """Check that this number of indices selects a row of an array parameter."""
        _check_indices(count, self.passed(place, Mode.VIEW).cells - 1)

    def check_part_of_local(self, cell: int, number: int) -> None:
        """Check that a part of this type begins at a cell of the frame."""
        self._check_part(*self.variable(cell), number)

    def check_part_of_data(self, cell: int, number: int) -> None:
        """Check that a part of this type begins at a cell of the data lists."""
        self._check_part(*self.data_variable(cell), number)

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
        self._check_counter(self.cell(self.variable(counter)), limit, step)

    def check_for_data(self, counter: int, limit: int, step: int) -> None:
        """Check that a FOR loop can count in a cell of the data lists."""
        self._check_counter(self.cell(self.data_variable(counter)), limit, step)

    def _check_counter(self, counter: StackItem, limit: int, step: int) -> None:
        integer = _INT
        if counter != integer or self.cell(self.variable(limit)) != integer or step == 0:
            raise Refused("counter and limit must be INT, and the step must not be 0")

    def check_told(self, place: int, dimensions: int) -> None:
        """Check that the trace can name the :OUT parameter through which something was assigned."""
        self.check_rank(dimensions, 0)
        slot = self._slot(place)
        if slot.offset != place or slot.variable.mode is Mode.IN:
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


# ------------------------------------------------------------------------------ the notation

_RULE = re.compile(r"(?P<rule>\w+)\((?P<given>[\w,]*)\)")
#: Items that have no operand.
_FIXED: Mapping[str, StackItem] = {
    **_VALUES,
    "nothing": NOTHING,
    "letters": view_of(_VALUES["CHAR"].type, 1),
}
#: Items by how they are written, and by the kind of the operand ``x``.
_ITEMS: Mapping[tuple[str, str], Callable[..., StackItem]] = {
    ("x", "type"): lambda _, x: value_of(x),
    ("x", "local"): lambda at, x: at.cell(at.variable(x)),
    ("x", "data"): lambda at, x: at.cell(at.data_variable(x)),
    ("x[]", "type"): lambda at, x: at.element_value(x),
    ("@x", "type"): lambda _, x: reference_to(x),
    ("@x", "local"): lambda at, x: at.passed(x, Mode.REF),
    ("@x[]", "type"): lambda at, x: reference_to(at.element(x)),
    ("@x[]", "local"): lambda at, x: reference_to(at.passed(x, Mode.VIEW).type),
    ("[x]", "type"): lambda at, x: view_of(at.element(x), at.rank(x)),
    ("[x]", "local"): lambda at, x: at.passed(x, Mode.VIEW),
    ("[x,y]", "type"): lambda _, x, y: view_of(x, y),
    ("[x/y]", "type"): lambda at, x, y: view_of(at.element(x), at.rank(x) - y),
    ("[x/y]", "local"): lambda at, x, y: _row_of(at.passed(x, Mode.VIEW), y),
}
#: How many indices ``INT*x`` are, by the kind of ``x``.
_INDICES: Mapping[str, Callable[[StackEffects, int], int]] = {
    "type": lambda at, x: at.rank(x),
    "local": lambda at, x: at.passed(x, Mode.VIEW).cells - 1,
    "count": lambda _, x: x,
}
#: What is popped as any of a kind, and where it stands again.
_BINDING: Mapping[str, tuple[str, str]] = {
    "t": ("any()", "same()"),
    "ENUM": ("enumeration()", "same()"),
    "@t": ("reference_to_cell()", "reference_to_same()"),
}


def _row_of(view: StackItem, count: int) -> StackItem:
    """Return the view of what is left of a view when so many indices are given."""
    return view_of(view.type, view.cells - 1 - count)


@cache
def _steps(op: Op) -> tuple[_Step, ...]:
    """Return what an instruction does to the stack, step by step."""
    return tuple(steps_of(instructions()[op]))


def steps_of(one: Shape) -> Iterator[_Step]:
    """Yield the steps of an instruction; raise `ValueError` for what the notation does not know."""
    pops, mark, pushes = one.effect.partition("--")
    if not mark:
        raise ValueError(f"{one.effect!r} has no --")
    for check in filter(None, one.checks.split(";")):
        rule, *names = check.split()
        yield _rule("check", rule, _places(one, names))
    is_bound = False
    for item in reversed(pops.split()):
        if item in _BINDING:
            yield _step(one, "take", _BINDING[item][is_bound])
            is_bound = True
        else:
            yield _step(one, "take", item)
    for item in pushes.split():
        yield _step(one, "push", "same()" if item == "t" else item)


def _step(one: Shape, verb: str, item: str) -> _Step:
    if call := _RULE.fullmatch(item):
        return _rule(verb, call["rule"], _places(one, re.findall(r"\w+", call["given"])))
    if fixed := _FIXED.get(item):
        return lambda at, _: getattr(at, verb)(fixed)
    names = list(dict.fromkeys(re.findall(r"\w+", item.removeprefix("INT*"))))
    places = _places(one, names)
    kind = one.operands[places[0]] if places else ""
    if item.startswith("INT*"):
        count = _INDICES[kind]
        return lambda at, operands: at.take_indices(count(at, operands[places[0]]))
    form = re.sub(r"\w+", lambda name: "xyz"[names.index(name[0])], item.removesuffix("?"))
    make = _ITEMS.get((form, kind))
    if make is None:
        raise ValueError(f"{item} means nothing")
    is_missing = item.endswith("?")

    def step(at: StackEffects, operands: Sequence[int]) -> None:
        made = make(at, *(operands[place] for place in places))
        getattr(at, verb)(replace(made, is_missing=True) if is_missing else made)

    return step


def _rule(verb: str, name: str, places: Sequence[int]) -> _Step:
    rule = getattr(StackEffects, f"{verb}_{name}", None)
    if rule is None:
        raise ValueError(f"there is no rule {verb}_{name}")
    return lambda at, operands: rule(at, *(operands[place] for place in places))


def _places(one: Shape, names: Sequence[str]) -> list[int]:
    """Return the places of operands by their names."""
    known = [operand.partition(":")[0] for operand in one.operand_text.split()]
    if unknown := [name for name in names if name not in known]:
        raise ValueError(f"there is no operand {unknown[0]}")
    return [known.index(name) for name in names]
