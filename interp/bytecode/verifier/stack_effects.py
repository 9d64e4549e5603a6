"""What each instruction takes from the stack of operands, and what it leaves there.

The instruction set tells it of most instructions. Here are rules for those of which it depends on
operands: on the types, cells, parameters and entries that they name.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import zip_longest

from grammar.semantics.types import BOOL, REAL, Array, Enumeration, is_cartesian
from interp.bytecode._generated.opcodes import Op
from interp.bytecode.cell_layout import Plain, is_word_of, shared_cells
from interp.bytecode.instruction_set import shape
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
    SCALAR,
    Held,
    Refused,
    Stack,
    handed_over,
    reference,
    view_of,
)

__all__ = ["StackEffects", "at_target"]

_INT, _BOOL, _CHAR = SCALAR["INT"], SCALAR["BOOL"], SCALAR["CHAR"]
_MOST_DIMENSIONS = 3


class StackEffects:
    """The effects of the instructions of one code object of a well-formed program."""

    def __init__(self, program: Program, code: Code) -> None:
        self._program = program
        self._code = code
        self._types = program.types
        self._cells = CellTypes(program, code)
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
            Op.LOAD_LOCAL: lambda place: self._stack.append(self._cells.local(place)),
            Op.LOAD_DATA: lambda place: self._stack.append(self._cells.data(place)),
            Op.STORE_LOCAL: lambda place: self._take(self._cells.local(place)),
            Op.STORE_DATA: lambda place: self._take(self._cells.data(place)),
            Op.REF_LOCAL: self._ref_local,
            Op.REF_DATA: self._ref_data,
            Op.LOAD_REF: lambda place: self._stack.append(self._cells.parameter(place, Mode.REF)),
            Op.LOAD_VIEW: lambda place: self._stack.append(self._cells.parameter(place, Mode.VIEW)),
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
            Op.COPY: lambda type_: self._take(reference(type_), reference(type_)),
            Op.CLEAR: lambda type_: self._take(reference(type_)),
            Op.FILL_POSE: self._fill_pose,
            Op.FILL_ARRAY: self._fill_array,
            Op.COPY_VIEW: self._copy_view,
            Op.SET_TEXT: lambda _text: self._take(view_of(_CHAR.type, 1)),
            Op.EQ_ENUM: self._equal,
            Op.NE_ENUM: self._equal,
            Op.COMPOSE: self._compose,
            Op.FOR_LOCAL: self._for_local,
            Op.FOR_DATA: self._for_data,
            Op.TELL_LOCAL: self._cells.check_local,
            Op.TELL_DATA: self._cells.check_data,
            Op.TELL_REF: self._tell_ref,
            Op.TELL: lambda _type, dimensions: self._rank(dimensions, 0),
        }

    def after(self, instruction: Instruction, before: Stack) -> Stack:
        """The stack behind an instruction; raises `Refused`."""
        self._stack = list(before)
        self._apply(instruction)
        return tuple(self._stack)

    def _apply(self, instruction: Instruction) -> None:
        rule = self._rules.get(instruction.op)
        if rule is not None:
            rule(*self._given(instruction))
            return
        effect = shape(instruction.op.name).effect
        assert effect is not None, f"{instruction.op.name} has a rule"
        self._take(*(SCALAR[kind] for kind in effect.takes))
        self._stack += [SCALAR[kind] for kind in effect.leaves]

    def _given(self, instruction: Instruction) -> Iterator[int]:
        """The operands but targets and lines, which say nothing about the stack."""
        kinds = shape(instruction.op.name).operands
        for kind, operand in zip(kinds, instruction.operands, strict=True):
            if kind not in ("target", "line"):
                yield operand

    # ----------------------------------------------------------------------- the stack

    def _take(self, *kinds: Held) -> None:
        """Take values of these kinds, the last one from the top."""
        count = len(kinds)
        if count and tuple(self._stack[-count:]) != kinds:
            raise Refused("the stack does not hold what it takes")
        del self._stack[len(self._stack) - count :]

    def _pop(self) -> Held:
        if not self._stack:
            raise Refused("the stack is empty")
        return self._stack.pop()

    def _take_value(self) -> Held:
        held = self._pop()
        if held.mode is not Mode.IN or held == NOTHING:
            raise Refused("a value is needed")
        return held

    def _drop(self) -> None:
        self._take_value()

    def _take_numbers(self, count: int) -> None:
        self._take(*[_INT] * count)

    def _rank(self, dimensions: int, least: int = 1) -> None:
        if not least <= dimensions <= _MOST_DIMENSIONS:
            raise Refused(f"arrays have no {dimensions} dimensions")

    # ----------------------------------------------------------------------- control

    def _line(self) -> None:
        if self._stack:
            raise Refused("a statement begins with an empty stack")

    def _case(self, constant: int) -> None:
        held = self._take_value()
        type_ = self._types[held.type]
        if type_ in (REAL, BOOL) or not isinstance(type_, Plain) or not is_word_of(constant, type_):
            raise Refused(f"{constant} is no constant for {type_}")
        self._stack.append(held)

    def _call(self, number: int) -> None:
        callee = self._program.codes[number]
        if callee.kind is not CodeKind.ROUTINE:
            raise Refused(f"{callee.name} is no routine")
        for parameter in reversed(callee.parameters):
            held = self._pop()
            wanted = self._argument(parameter)
            is_left_out = held == NOTHING and wanted.mode is Mode.IN
            if replace(held, is_missing=False) != wanted and not is_left_out:
                raise Refused(f"the argument for {parameter.name} is of another kind")
        if callee.result is not None:
            self._stack.append(Held(Mode.IN, callee.result))

    def _argument(self, parameter: Parameter) -> Held:
        """What the stack holds for a parameter: a structure lies there by reference."""
        if parameter.mode is Mode.IN and not isinstance(self._types[parameter.type], Plain):
            return reference(parameter.type)
        return handed_over(parameter)

    def _return(self) -> None:
        if self._code.result is not None or self._code.kind is CodeKind.CONDITION:
            raise Refused("a result is needed")
        self._line()

    def _return_value(self) -> None:
        if self._code.result is None:
            raise Refused("there is no result")
        self._take(Held(Mode.IN, self._code.result))
        if self._stack:
            raise Refused("more than the result is on the stack")

    def _ask(self, number: int) -> None:
        ask = self._program.asks[number]
        for handle in _handles_of(ask.parts):
            owner = self._program.codes[handle.code].owner
            if owner is None or self._program.codes[owner] is not self._code:
                raise Refused("the action or condition belongs to another code object")
        self._cross(ask)

    def _builtin(self, number: int) -> None:
        builtin = self._program.builtins[number]
        self._cross(builtin, list(may_be_missing(builtin)))

    def _cross(self, entry: Ask | Builtin, missing: Sequence[bool] = ()) -> None:
        is_large = entry.result is not None and not isinstance(self._types[entry.result], Plain)
        if entry.result is not None and is_large:
            self._take(reference(entry.result))
        inputs = list(inputs_of(entry.parts))
        for given, is_text in zip_longest(reversed(inputs), reversed(missing)):
            held = self._pop()
            if (replace(held, is_missing=False) if is_text else held) != handed_over(given):
                raise Refused("an input is of another kind")
        if entry.result is not None and not is_large:
            self._stack.append(Held(Mode.IN, entry.result))

    # ----------------------------------------------------------------------- values

    def _push_enum(self, number: int, place: int) -> None:
        type_ = self._types[number]
        if not isinstance(type_, Enumeration) or not place < len(type_.constants):
            raise Refused("there is no such constant")
        self._stack.append(Held(Mode.IN, number))

    def _push_no_view(self, number: int, dimensions: int) -> None:
        self._rank(dimensions)
        if isinstance(self._types[number], Array):
            raise Refused("elements are no arrays")
        self._stack.append(Held(Mode.VIEW, number, 1 + dimensions, is_missing=True))

    def _equal(self) -> None:
        held = self._take_value()
        if not isinstance(self._types[held.type], Enumeration):
            raise Refused("constants of enumerations are needed")
        self._take(held)
        self._stack.append(_BOOL)

    def _ref_local(self, place: int, number: int) -> None:
        self._cells.check_local(place, number)
        self._stack.append(reference(number))

    def _ref_data(self, address: int, number: int) -> None:
        self._cells.check_data(address, number)
        self._stack.append(reference(number))

    def _load(self) -> None:
        self._stack.append(self._referred())

    def _store(self) -> None:
        value = self._take_value()
        if self._referred() != value:
            raise Refused("the value is of another kind")

    def _referred(self) -> Held:
        """Take a reference to a cell; gives what the cell holds."""
        held = self._pop()
        if held.mode is not Mode.REF or not isinstance(self._types[held.type], Plain):
            raise Refused("a reference to a cell is needed")
        return Held(Mode.IN, held.type)

    def _member(self, offset: int, number: int) -> None:
        held = self._pop()
        if held.mode is not Mode.REF:
            raise Refused("a reference is needed")
        self._cells.check_part(self._types[held.type], offset, number)
        self._stack.append(reference(number))

    # ----------------------------------------------------------------------- arrays

    def _indices(self, number: int) -> int:
        """Take all indices of an array; gives the number of the type of its elements."""
        array = self._cells.array(number)
        self._take_numbers(len(array.sizes))
        return self._cells.element(array)

    def _index(self, number: int) -> None:
        element = self._indices(number)
        self._take(reference(number))
        self._stack.append(reference(element))

    def _index_local(self, place: int, number: int) -> None:
        self._cells.check_local(place, number)
        self._stack.append(reference(self._indices(number)))

    def _index_data(self, address: int, number: int) -> None:
        self._cells.check_data(address, number)
        self._stack.append(reference(self._indices(number)))

    def _index_view(self, place: int) -> None:
        view = self._cells.parameter(place, Mode.VIEW)
        self._take_numbers(view.cells - 1)
        self._stack.append(reference(view.type))

    def _element_local(self, place: int, number: int) -> None:
        self._index_local(place, number)
        self._load()

    def _element_data(self, address: int, number: int) -> None:
        self._index_data(address, number)
        self._load()

    def _view(self, number: int) -> None:
        array = self._cells.array(number)
        self._take(reference(number))
        self._stack.append(view_of(self._cells.element(array), len(array.sizes)))

    def _pass_view(self, place: int) -> None:
        self._stack.append(replace(self._cells.parameter(place, Mode.VIEW), is_missing=True))

    def _row(self, number: int, count: int) -> None:
        array = self._cells.array(number)
        self._take_numbers(self._given_indices(count, len(array.sizes)))
        self._take(reference(number))
        self._stack.append(view_of(self._cells.element(array), len(array.sizes) - count))

    def _row_view(self, place: int, count: int) -> None:
        view = self._cells.parameter(place, Mode.VIEW)
        self._take_numbers(self._given_indices(count, view.cells - 1))
        self._stack.append(view_of(view.type, view.cells - 1 - count))

    def _given_indices(self, count: int, dimensions: int) -> int:
        if not 1 <= count < dimensions:
            raise Refused("a row has one index at least and not all of them")
        return count

    def _fill_pose(self, to: int, of: int) -> None:
        if shared_cells(self._types[to], self._types[of]) is None:
            raise Refused("positions of one family are needed")
        self._take(reference(to), reference(of))

    def _fill_array(self, number: int, dimensions: int) -> None:
        self._rank(dimensions)
        self._take(view_of(number, dimensions), view_of(number, dimensions))

    def _copy_view(self, place: int, number: int) -> None:
        self._cells.check_local(place, number)
        array = self._cells.array(number)
        view = view_of(self._cells.element(array), len(array.sizes))
        self._take(view)
        self._stack.append(view)

    def _compose(self, left: int, right: int) -> None:
        if not (is_cartesian(self._types[left]) and is_cartesian(self._types[right])):
            raise Refused("poses are needed")
        if shared_cells(self._types[left], self._types[right]) is None:
            raise Refused("poses are needed")
        self._take(reference(right), reference(left), reference(right))

    # ----------------------------------------------------------------------- loops, the trace

    def _for_local(self, counter: int, limit: int, step: int) -> None:
        self._for(self._cells.local(counter), limit, step)

    def _for_data(self, counter: int, limit: int, step: int) -> None:
        self._for(self._cells.data(counter), limit, step)

    def _for(self, counter: Held, limit: int, step: int) -> None:
        if counter != _INT or self._cells.local(limit) != _INT or step == 0:
            raise Refused("a counter and a limit that are INT and a step that is not 0 are needed")

    def _tell_ref(self, place: int, _type: int, dimensions: int) -> None:
        self._rank(dimensions, 0)
        slot = self._cells.slot(place)
        if (
            slot.offset != place
            or not isinstance(slot.variable, Parameter)
            or slot.variable.mode is Mode.IN
        ):
            raise Refused("no parameter :OUT begins there")


def at_target(op: Op, after: Stack) -> Stack:
    """The stack where an instruction goes on elsewhere, by that behind it."""
    if op is Op.AT:  # where a statement is left its operands are forgotten
        return ()
    return after[:-1] if op is Op.CASE else after


def _handles_of(parts: Sequence[Argument]) -> Iterator[Handle]:
    """The actions and conditions that a request hands over."""
    for part in parts:
        if isinstance(part, Handle):
            yield part
        elif isinstance(part, Items | Record):
            yield from _handles_of(part.parts)
