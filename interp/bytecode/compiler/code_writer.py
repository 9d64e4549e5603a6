"""A code object in the making: instructions, labels, variables, temporaries."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import field
from typing import Any

from grammar.semantics.types import Array, Type
from interp.bytecode._generated.opcodes import Op
from interp.bytecode.cell_layout import size
from interp.bytecode.compiler.array_bounds import Bound, Sizes
from interp.bytecode.compiler.tables import Tables
from interp.bytecode.instruction_set.table import MAX_CELLS, shape
from interp.bytecode.program import (
    Code,
    CodeKind,
    Instruction,
    Local,
    Mode,
    Parameter,
    stack_cells,
)
from interp.bytecode.verifier.successors import ENDS
from support.lazy_dataclass import dataclass


@dataclass(slots=True, eq=False)
class Label:
    """A place to continue at; ``place`` is that of an instruction when it is known."""

    place: int = -1


@dataclass(slots=True, eq=False)
class Later:
    """An operand that is known at the end."""

    value: int = -1


@dataclass(slots=True, eq=False)
class CopyBuffer:
    """A place of the frame for copies of arrays of unknown size: its offset, and its type.

    ``given`` are the bounds of all that is copied there.
    """

    element: Type
    dimensions: int
    given: set[Bound] = field(default_factory=set)
    offset: Later = field(default_factory=Later)
    type: Later = field(default_factory=Later)


Operand = int | Label | Later


@dataclass(slots=True)
class Written:
    """An instruction; its targets are labels."""

    op: Op
    operands: tuple[Operand, ...]


@dataclass(slots=True, eq=False)
class Writer:
    """One code object. Parameters come before locals, locals as they are needed."""

    tables: Tables
    name: str
    kind: CodeKind
    file: str
    line: int
    owner: int | None = None
    result: int | None = None
    parameters: list[Parameter] = field(default_factory=list)
    captures: list[int] = field(default_factory=list)
    _locals: list[Local] = field(default_factory=list)
    _cells: int = 0
    _code: list[Written] = field(default_factory=list)
    _labels: list[Label] = field(default_factory=list)
    _free: dict[int, list[int]] = field(default_factory=dict)
    _buffers: list[CopyBuffer] = field(default_factory=list)
    _free_buffers: dict[tuple[int, int], list[CopyBuffer]] = field(default_factory=dict)
    #: What is taken for a while, each behind the list that it goes back to.
    _taken: list[tuple[list[Any], Any]] = field(default_factory=list)

    # ----------------------------------------------------------------------- the frame

    def parameter(self, name: str, mode: Mode, type_: Type, dimensions: int = 0) -> int:
        """Add a parameter; gives its offset."""
        assert not self._locals, "parameters come first"
        number = self.tables.number(type_)
        parameter = Parameter(name, mode, number, dimensions)
        self.parameters.append(parameter)
        is_value = mode is Mode.IN
        cells = size(self.tables.types[number]) if is_value else stack_cells(parameter)
        return self._reserved(cells)

    def local(self, name: str, type_: Type) -> int:
        """Add a variable; gives its offset."""
        number = self.tables.number(type_)
        self._locals.append(Local(name, number))
        return self._reserved(size(self.tables.types[number]))

    def _reserved(self, cells: int) -> int:
        offset = self._cells
        self._cells += cells
        return offset

    def temporary(self, type_: Type) -> int:
        """A variable without a name, until the end of `temporaries`; what it holds is not known."""
        number = self.tables.number(type_)
        free = self._free.setdefault(number, [])
        offset = free.pop() if free else self.local(f"%{len(self._locals)}", type_)
        self._taken.append((free, offset))
        return offset

    def copy_buffer(self, element: Type, dimensions: int, most: Bound) -> CopyBuffer:
        """A place for a copy of an array, until the end of `temporaries`."""
        free = self._free_buffers.setdefault((self.tables.number(element), dimensions), [])
        if free:
            buffer = free.pop()
        else:
            buffer = CopyBuffer(element, dimensions)
            self._buffers.append(buffer)
        buffer.given.add(most)
        self._taken.append((free, buffer))
        return buffer

    @contextmanager
    def temporaries(self) -> Iterator[None]:
        """What is taken inside is free again behind it."""
        count = len(self._taken)
        try:
            yield
        finally:
            for free, taken in reversed(self._taken[count:]):
                free.append(taken)
            del self._taken[count:]

    # ----------------------------------------------------------------------- instructions

    def emit(self, op: Op, *operands: Operand) -> None:
        """Add an instruction."""
        self._code.append(Written(op, operands))

    @property
    def here(self) -> int:
        """How many instructions there are."""
        return len(self._code)

    def insert(self, place: int, op: Op, *operands: Operand) -> None:
        """Put an instruction between others of the same expression, which has no labels."""
        self._code.insert(place, Written(op, operands))

    def last(self) -> Written | None:
        """The last instruction, unless a label leads behind it."""
        if not self._code or any(label.place == self.here for label in self._labels[-3:]):
            return None
        return self._code[-1]

    def cut(self, place: int) -> None:
        """Take all instructions back that were added behind a place."""
        del self._code[place:]

    def ops(self, place: int) -> set[Op]:
        """The instructions that were added behind a place."""
        return {written.op for written in self._code[place:]}

    def drop_last(self) -> None:
        """Take the last instruction back."""
        self._code.pop()

    def place(self, label: Label) -> None:
        """What comes next is where the label leads."""
        label.place = self.here
        self._labels.append(label)

    def code(self, sizes: Sizes) -> Code:
        """The code object, without what is never reached; its stack is not known yet."""
        self._allocate_buffers(sizes)
        reached = self._reached()
        places = {place: number for number, place in enumerate(reached)}
        return Code(
            self.name,
            self.kind,
            self.file,
            self.line,
            self.owner,
            tuple(self.parameters),
            tuple(self.captures),
            tuple(self._locals),
            self.result,
            0,
            tuple(self._instruction(self._code[place], places) for place in reached),
        )

    def _allocate_buffers(self, sizes: Sizes) -> None:
        """Buffers become locals; what does not fit into memory faults when it is copied."""
        for buffer in self._buffers:
            left = (MAX_CELLS - self.tables.cells - self._cells) // size(buffer.element)
            count = max(1, min(sizes.most(buffer.given), left))
            type_ = Array(buffer.element, (count, *[1] * (buffer.dimensions - 1)))
            buffer.offset.value = self.local(f"%{len(self._locals)}", type_)
            buffer.type.value = self.tables.number(type_)

    def _instruction(self, written: Written, places: dict[int, int]) -> Instruction:
        operands: list[int] = []
        for operand in written.operands:
            match operand:
                case Label(place):
                    operands.append(places[place])
                case Later(value):
                    operands.append(value)
                case _:
                    operands.append(operand)
        return Instruction(written.op, tuple(operands))

    def _reached(self) -> list[int]:
        """The instructions that some way leads to, in their order."""
        seen, todo = {0}, [0]
        while todo:
            place = todo.pop()
            written = self._code[place]
            after = [one.place for one in written.operands if isinstance(one, Label)]
            if written.op not in ENDS:
                after.append(place + 1)
            for one in after:
                assert 0 <= one < self.here, f"{self.name}: {shape(written.op.name).name} leads on"
                if one not in seen:
                    seen.add(one)
                    todo.append(one)
        return sorted(seen)
