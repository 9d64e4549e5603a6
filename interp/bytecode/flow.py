"""What lies on the stack of operands at each instruction, worked out without running it.

Each instruction takes values of certain kinds from the stack and leaves others. Where ways meet the
stack must hold the same. From that follow the largest stack, and that nothing is ever taken from an
empty one or taken for what it is not.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import zip_longest
from typing import NoReturn

from grammar.types import BOOL, REAL, Array, Enumeration, Type, is_cartesian
from interp.bytecode._generated.opcodes import Op
from interp.bytecode.cells import (
    Plain,
    is_word_of,
    kind_at,
    path_to,
    shared_cells,
)
from interp.bytecode.crossing import may_be_missing
from interp.bytecode.isa import shape
from interp.bytecode.program import (
    Argument,
    Ask,
    Builtin,
    Code,
    CodeKind,
    Handle,
    Input,
    Instruction,
    Items,
    Mode,
    Parameter,
    Program,
    Record,
    Slot,
    inputs_of,
)
from interp.bytecode.syntax import printable

__all__ = ["ENDS", "Flow", "Stack", "VerificationError", "handles_of", "targets"]


class VerificationError(Exception):
    """A program does not keep the rules; the message says where and why, on one line."""

    def __init__(self, message: str) -> None:
        super().__init__(printable(message))


@dataclass(frozen=True, slots=True)
class Held:
    """What lies on the stack.

    ``mode`` is ``IN`` for a value of one cell. ``type`` is a number of the program; -1 stands for
    a value that was left out, ``is_missing`` for such a view. ``cells`` is how many cells it takes.
    """

    mode: Mode
    type: int
    cells: int = 1
    is_missing: bool = False


Stack = tuple[Held, ...]

NOTHING = Held(Mode.IN, -1)
_INT, _REAL, _BOOL, _CHAR = (Held(Mode.IN, number) for number in range(4))
_KINDS = {"INT": _INT, "REAL": _REAL, "BOOL": _BOOL, "CHAR": _CHAR}
_MOST_DIMENSIONS = 3


class Flow:
    """The stacks of one code object. ``Flow(…).stacks()`` goes through it.

    The tables of the program, its types, data, entries and the heads of its code objects, have been
    verified.
    """

    def __init__(self, program: Program, code: Code) -> None:
        self._program = program
        self._code = code
        self._slots = program.slots(code)
        self._starts = [slot.offset for slot in self._slots]
        self._numbers = {type_: number for number, type_ in enumerate(program.types)}
        self._place = 0
        self._stack: list[Held] = []
        self._rules: Mapping[Op, Callable[..., None]] = {
            Op.LINE: self._line,
            Op.CASE: self._case,
            Op.CALL: self._call,
            Op.RETURN: self._return,
            Op.RETURN_VALUE: self._return_value,
            Op.ASK: self._ask,
            Op.BUILTIN: self._builtin,
            Op.PUSH_ENUM: self._push_enum,
            Op.PUSH_NOTHING: lambda: self._stack.append(NOTHING),
            Op.PUSH_NO_VIEW: self._push_no_view,
            Op.DROP: self._drop,
            Op.LOAD_LOCAL: lambda place: self._stack.append(self._cell(place)),
            Op.LOAD_DATA: lambda place: self._stack.append(self._data_cell(place)),
            Op.STORE_LOCAL: lambda place: self._take(self._cell(place)),
            Op.STORE_DATA: lambda place: self._take(self._data_cell(place)),
            Op.REF_LOCAL: self._ref_local,
            Op.REF_DATA: self._ref_data,
            Op.LOAD_REF: lambda place: self._stack.append(self._handed(place, Mode.REF)),
            Op.LOAD_VIEW: lambda place: self._stack.append(self._handed(place, Mode.VIEW)),
            Op.PASS_VIEW: self._pass_view,
            Op.LOAD: self._load,
            Op.STORE: self._store,
            Op.MEMBER: self._member,
            Op.INDEX: self._index,
            Op.INDEX_LOCAL: self._index_local,
            Op.INDEX_DATA: self._index_data,
            Op.INDEX_VIEW: self._index_view,
            Op.ELEMENT_LOCAL: self._element_local,
            Op.ELEMENT_DATA: self._element_data,
            Op.VIEW: self._view,
            Op.ROW: self._row,
            Op.ROW_VIEW: self._row_view,
            Op.COPY: lambda type_: self._take(_ref(type_), _ref(type_)),
            Op.CLEAR: lambda type_: self._take(_ref(type_)),
            Op.FILL_POSE: self._fill_pose,
            Op.FILL_ARRAY: self._fill_array,
            Op.COPY_VIEW: self._copy_view,
            Op.SET_TEXT: lambda _text: self._take(_view(_CHAR.type, 1)),
            Op.EQ_ENUM: self._equal,
            Op.NE_ENUM: self._equal,
            Op.COMPOSE: self._compose,
            Op.FOR_LOCAL: self._for_local,
            Op.FOR_DATA: self._for_data,
            Op.TELL_LOCAL: self._part,
            Op.TELL_DATA: self._data_part,
            Op.TELL_REF: self._tell_ref,
            Op.TELL: lambda _type, dimensions: self._rank(dimensions, 0),
        }

    def stacks(self) -> list[Stack | None]:
        """The stack before each instruction, ``None`` where none leads to it.

        Raises `VerificationError`.
        """
        instructions = self._code.instructions
        found: list[Stack | None] = [None] * len(instructions)
        found[0] = ()
        todo = [0]
        while todo:
            place = todo.pop()
            before = found[place]
            assert before is not None, "only what is reached is looked at"
            for after, stack in self._after(place, before):
                if after >= len(instructions):
                    self._refuse("the code object ends without RETURN")
                if found[after] is None:
                    found[after] = stack
                    todo.append(after)
                elif found[after] != stack:
                    self._refuse(f"the stack differs from that of another way to {after}")
        return found

    def largest(self, stacks: Sequence[Stack | None]) -> int:
        """The most cells that the stack ever has."""
        return max((_cells(stack) for stack in stacks if stack is not None), default=0)

    def _after(self, place: int, before: Stack) -> Iterator[tuple[int, Stack]]:
        """Where an instruction can go on, and the stack there."""
        self._place, self._stack = place, list(before)
        instruction = self._code.instructions[place]
        self._apply(instruction)
        stack = tuple(self._stack)
        for target in targets(instruction):
            yield target, self._stack_at_target(instruction.op, stack)
        if instruction.op not in ENDS:
            yield place + 1, stack

    def _stack_at_target(self, op: Op, stack: Stack) -> Stack:
        if op is Op.AT:  # where a statement is left its operands are forgotten
            return ()
        return stack[:-1] if op is Op.CASE else stack

    def _apply(self, instruction: Instruction) -> None:
        rule = self._rules.get(instruction.op)
        if rule is not None:
            rule(*self._given(instruction))
            return
        effect = shape(instruction.op.name).effect
        assert effect is not None, f"{instruction.op.name} has a rule"
        self._take(*(_KINDS[kind] for kind in effect.takes))
        self._stack += [_KINDS[kind] for kind in effect.leaves]

    def _given(self, instruction: Instruction) -> Iterator[int]:
        """The operands but targets and lines, which say nothing about the stack."""
        kinds = shape(instruction.op.name).operands
        for kind, operand in zip(kinds, instruction.operands, strict=True):
            if kind not in ("target", "line"):
                yield operand

    # ----------------------------------------------------------------------- the stack

    def _refuse(self, reason: str) -> NoReturn:
        instruction = self._code.instructions[self._place]
        raise VerificationError(
            f"{self._code.name}, instruction {self._place} ({instruction.op.name}): {reason}"
        )

    def _take(self, *kinds: Held) -> None:
        """Take values of these kinds, the last one from the top."""
        count = len(kinds)
        if count and tuple(self._stack[-count:]) != kinds:
            self._refuse("the stack does not hold what it takes")
        del self._stack[len(self._stack) - count :]

    def _pop(self) -> Held:
        if not self._stack:
            self._refuse("the stack is empty")
        return self._stack.pop()

    def _take_value(self) -> Held:
        held = self._pop()
        if held.mode is not Mode.IN or held == NOTHING:
            self._refuse("a value is needed")
        return held

    def _drop(self) -> None:
        self._take_value()

    def _take_numbers(self, count: int) -> None:
        self._take(*[_INT] * count)

    # ----------------------------------------------------------------------- places and types

    def _type(self, number: int) -> Type:
        return self._program.types[number]

    def _value(self, type_: Type) -> Held:
        return Held(Mode.IN, self._numbers[type_])

    def _slot(self, place: int) -> Slot:
        number = bisect_right(self._starts, place) - 1
        if number < 0 or place >= self._slots[number].offset + self._slots[number].cells:
            self._refuse("there is no such cell in the frame")
        return self._slots[number]

    def _variable(self, place: int) -> tuple[Type, int]:
        """The type of the parameter or local that a cell belongs to, and the offset within it."""
        slot = self._slot(place)
        if isinstance(slot.variable, Parameter) and slot.variable.mode is not Mode.IN:
            self._refuse("the cell holds a reference")
        return self._type(slot.variable.type), place - slot.offset

    def _data_variable(self, address: int) -> tuple[Type, int]:
        number = self._program.data_at(address)
        if number is None:
            self._refuse("there is no such cell in the data lists")
        type_ = self._type(self._program.data[number].type)
        return type_, address - self._program.addresses[number]

    def _cell(self, place: int) -> Held:
        return self._value(kind_at(*self._variable(place)))

    def _data_cell(self, address: int) -> Held:
        return self._value(kind_at(*self._data_variable(address)))

    def _part(self, place: int, number: int) -> None:
        self._check_part(*self._variable(place), number)

    def _data_part(self, address: int, number: int) -> None:
        self._check_part(*self._data_variable(address), number)

    def _check_part(self, whole: Type, offset: int, number: int) -> None:
        if path_to(whole, offset, self._type(number)) is None:
            self._refuse(f"no {self._type(number)} is there")

    def _handed(self, place: int, mode: Mode) -> Held:
        """The reference or view that a parameter is."""
        slot = self._slot(place)
        parameter = slot.variable
        if slot.offset != place or not isinstance(parameter, Parameter):
            self._refuse("no parameter begins there")
        if parameter.mode is not mode:
            self._refuse(f"the parameter is no {mode.value}")
        return _handed_over(parameter)

    def _array(self, number: int) -> Array:
        type_ = self._type(number)
        if not isinstance(type_, Array):
            self._refuse(f"{type_} is no array")
        return type_

    def _rank(self, dimensions: int, least: int = 1) -> None:
        if not least <= dimensions <= _MOST_DIMENSIONS:
            self._refuse(f"arrays have no {dimensions} dimensions")

    def _element(self, array: Array) -> int:
        return self._numbers[array.element]

    # ----------------------------------------------------------------------- control

    def _line(self) -> None:
        if self._stack:
            self._refuse("a statement begins with an empty stack")

    def _case(self, constant: int) -> None:
        held = self._take_value()
        type_ = self._type(held.type)
        if type_ in (REAL, BOOL) or not isinstance(type_, Plain) or not is_word_of(constant, type_):
            self._refuse(f"{constant} is no constant for {type_}")
        self._stack.append(held)

    def _call(self, number: int) -> None:
        callee = self._program.codes[number]
        if callee.kind is not CodeKind.ROUTINE:
            self._refuse(f"{callee.name} is no routine")
        for parameter in reversed(callee.parameters):
            held = self._pop()
            wanted = self._argument(parameter)
            is_left_out = held == NOTHING and wanted.mode is Mode.IN
            if replace(held, is_missing=False) != wanted and not is_left_out:
                self._refuse(f"the argument for {parameter.name} is of another kind")
        if callee.result is not None:
            self._stack.append(Held(Mode.IN, callee.result))

    def _argument(self, parameter: Parameter) -> Held:
        """What the stack holds for a parameter: a structure lies there by reference."""
        if parameter.mode is Mode.IN and not isinstance(self._type(parameter.type), Plain):
            return _ref(parameter.type)
        return _handed_over(parameter)

    def _return(self) -> None:
        if self._code.result is not None or self._code.kind is CodeKind.CONDITION:
            self._refuse("a result is needed")
        self._line()

    def _return_value(self) -> None:
        if self._code.result is None:
            self._refuse("there is no result")
        self._take(Held(Mode.IN, self._code.result))
        if self._stack:
            self._refuse("more than the result is on the stack")

    def _ask(self, number: int) -> None:
        ask = self._program.asks[number]
        for handle in handles_of(ask.parts):
            owner = self._program.codes[handle.code].owner
            if owner is None or self._program.codes[owner] is not self._code:
                self._refuse("the action or condition belongs to another code object")
        self._cross(ask)

    def _builtin(self, number: int) -> None:
        builtin = self._program.builtins[number]
        self._cross(builtin, list(may_be_missing(builtin)))

    def _cross(self, entry: Ask | Builtin, missing: Sequence[bool] = ()) -> None:
        is_large = entry.result is not None and not isinstance(self._type(entry.result), Plain)
        if entry.result is not None and is_large:
            self._take(_ref(entry.result))
        inputs = list(inputs_of(entry.parts))
        for given, is_text in zip_longest(reversed(inputs), reversed(missing)):
            held = self._pop()
            if (replace(held, is_missing=False) if is_text else held) != _handed_over(given):
                self._refuse("an input is of another kind")
        if entry.result is not None and not is_large:
            self._stack.append(Held(Mode.IN, entry.result))

    # ----------------------------------------------------------------------- values

    def _push_enum(self, number: int, place: int) -> None:
        type_ = self._type(number)
        if not isinstance(type_, Enumeration) or not place < len(type_.constants):
            self._refuse("there is no such constant")
        self._stack.append(Held(Mode.IN, number))

    def _push_no_view(self, number: int, dimensions: int) -> None:
        self._rank(dimensions)
        if isinstance(self._type(number), Array):
            self._refuse("elements are no arrays")
        self._stack.append(Held(Mode.VIEW, number, 1 + dimensions, is_missing=True))

    def _equal(self) -> None:
        held = self._take_value()
        if not isinstance(self._type(held.type), Enumeration):
            self._refuse("constants of enumerations are needed")
        self._take(held)
        self._stack.append(_BOOL)

    def _ref_local(self, place: int, number: int) -> None:
        self._part(place, number)
        self._stack.append(_ref(number))

    def _ref_data(self, address: int, number: int) -> None:
        self._data_part(address, number)
        self._stack.append(_ref(number))

    def _load(self) -> None:
        self._stack.append(self._referred())

    def _store(self) -> None:
        value = self._take_value()
        if self._referred() != value:
            self._refuse("the value is of another kind")

    def _referred(self) -> Held:
        """Take a reference to a cell; gives what the cell holds."""
        held = self._pop()
        if held.mode is not Mode.REF or not isinstance(self._type(held.type), Plain):
            self._refuse("a reference to a cell is needed")
        return Held(Mode.IN, held.type)

    def _member(self, offset: int, number: int) -> None:
        held = self._pop()
        if held.mode is not Mode.REF:
            self._refuse("a reference is needed")
        self._check_part(self._type(held.type), offset, number)
        self._stack.append(_ref(number))

    # ----------------------------------------------------------------------- arrays

    def _indices(self, number: int) -> int:
        """Take all indices of an array; gives the number of the type of its elements."""
        array = self._array(number)
        self._take_numbers(len(array.sizes))
        return self._element(array)

    def _index(self, number: int) -> None:
        element = self._indices(number)
        self._take(_ref(number))
        self._stack.append(_ref(element))

    def _index_local(self, place: int, number: int) -> None:
        self._part(place, number)
        self._stack.append(_ref(self._indices(number)))

    def _index_data(self, address: int, number: int) -> None:
        self._data_part(address, number)
        self._stack.append(_ref(self._indices(number)))

    def _index_view(self, place: int) -> None:
        view = self._handed(place, Mode.VIEW)
        self._take_numbers(view.cells - 1)
        self._stack.append(_ref(view.type))

    def _element_local(self, place: int, number: int) -> None:
        self._index_local(place, number)
        self._load()

    def _element_data(self, address: int, number: int) -> None:
        self._index_data(address, number)
        self._load()

    def _view(self, number: int) -> None:
        array = self._array(number)
        self._take(_ref(number))
        self._stack.append(_view(self._element(array), len(array.sizes)))

    def _pass_view(self, place: int) -> None:
        self._stack.append(replace(self._handed(place, Mode.VIEW), is_missing=True))

    def _row(self, number: int, count: int) -> None:
        array = self._array(number)
        self._take_numbers(self._given_indices(count, len(array.sizes)))
        self._take(_ref(number))
        self._stack.append(_view(self._element(array), len(array.sizes) - count))

    def _row_view(self, place: int, count: int) -> None:
        view = self._handed(place, Mode.VIEW)
        self._take_numbers(self._given_indices(count, view.cells - 1))
        self._stack.append(_view(view.type, view.cells - 1 - count))

    def _given_indices(self, count: int, dimensions: int) -> int:
        if not 1 <= count < dimensions:
            self._refuse("a row has one index at least and not all of them")
        return count

    def _fill_pose(self, to: int, of: int) -> None:
        if shared_cells(self._type(to), self._type(of)) is None:
            self._refuse("positions of one family are needed")
        self._take(_ref(to), _ref(of))

    def _fill_array(self, number: int, dimensions: int) -> None:
        self._rank(dimensions)
        self._take(_view(number, dimensions), _view(number, dimensions))

    def _copy_view(self, place: int, number: int) -> None:
        self._part(place, number)
        array = self._array(number)
        view = _view(self._element(array), len(array.sizes))
        self._take(view)
        self._stack.append(view)

    def _compose(self, left: int, right: int) -> None:
        if not (is_cartesian(self._type(left)) and is_cartesian(self._type(right))):
            self._refuse("poses are needed")
        if shared_cells(self._type(left), self._type(right)) is None:
            self._refuse("poses are needed")
        self._take(_ref(right), _ref(left), _ref(right))

    # ----------------------------------------------------------------------- loops, the trace

    def _for_local(self, counter: int, limit: int, step: int) -> None:
        self._for(self._cell(counter), limit, step)

    def _for_data(self, counter: int, limit: int, step: int) -> None:
        self._for(self._data_cell(counter), limit, step)

    def _for(self, counter: Held, limit: int, step: int) -> None:
        if counter != _INT or self._cell(limit) != _INT or step == 0:
            self._refuse("a counter and a limit that are INT and a step that is not 0 are needed")

    def _tell_ref(self, place: int, _type: int, dimensions: int) -> None:
        self._rank(dimensions, 0)
        slot = self._slot(place)
        if (
            slot.offset != place
            or not isinstance(slot.variable, Parameter)
            or slot.variable.mode is Mode.IN
        ):
            self._refuse("no parameter :OUT begins there")


#: What nothing follows.
ENDS = frozenset({Op.JUMP, Op.RETURN, Op.RETURN_VALUE, Op.FAIL, Op.UNLINKED})


def targets(instruction: Instruction) -> Iterator[int]:
    """The instructions that an instruction may go on at, besides the next one."""
    kinds = shape(instruction.op.name).operands
    for kind, operand in zip(kinds, instruction.operands, strict=True):
        if kind == "target":
            yield operand


def handles_of(parts: Sequence[Argument]) -> Iterator[Handle]:
    """The actions and conditions that a request hands over."""
    for part in parts:
        if isinstance(part, Handle):
            yield part
        elif isinstance(part, Items | Record):
            yield from handles_of(part.parts)


def _ref(type_: int) -> Held:
    return Held(Mode.REF, type_)


def _view(type_: int, dimensions: int) -> Held:
    return Held(Mode.VIEW, type_, 1 + dimensions)


def _handed_over(given: Parameter | Input) -> Held:
    return Held(given.mode, given.type, 1 + given.dimensions)


def _cells(stack: Stack) -> int:
    return sum(held.cells for held in stack)
