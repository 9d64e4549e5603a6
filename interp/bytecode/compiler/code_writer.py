"""A code object under construction: instructions, labels, variables, temporaries."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import field
from typing import Any

from grammar.semantics.types import Array, Type
from interp.bytecode._generated.opcodes import Op
from interp.bytecode.cell_layout import size
from interp.bytecode.compiler.buffer_sizes import Bound, Sizes
from interp.bytecode.compiler.tables import Tables
from interp.bytecode.instruction_set.table import MAX_CELLS, shape
from interp.bytecode.program import (
    ENDS,
    Code,
    CodeKind,
    Instruction,
    Mode,
    Variable,
    width,
)
from support.lazy_dataclass import dataclass


@dataclass(slots=True, eq=False)
class Label:
    """A jump target; ``place`` is the index of an instruction once it is known."""

    place: int = -1


@dataclass(slots=True, eq=False)
class DeferredOperand:
    """An operand that is known only when the code object is complete."""

    value: int = -1


@dataclass(slots=True, eq=False)
class CopyBuffer:
    """A buffer in the frame for copies of arrays of unknown size.

    ``given`` are the bounds of all arrays that are copied into it; ``offset`` and ``type`` are set
    when the code object is complete.
    """

    element: Type
    dimensions: int
    given: set[Bound] = field(default_factory=set)
    offset: DeferredOperand = field(default_factory=DeferredOperand)
    type: DeferredOperand = field(default_factory=DeferredOperand)


Operand = int | Label | DeferredOperand


@dataclass(slots=True)
class PendingInstruction:
    """An instruction whose jump targets are labels."""

    op: Op
    operands: tuple[Operand, ...]


@dataclass(slots=True, eq=False)
class Writer:
    """One code object. Parameters come before locals; locals are added when they are needed."""

    tables: Tables
    name: str
    kind: CodeKind
    file: str
    line: int
    owner: int | None = None
    result: int | None = None
    parameters: list[Variable] = field(default_factory=list)
    captures: list[int] = field(default_factory=list)
    _locals: list[Variable] = field(default_factory=list)
    _cells: int = 0
    _code: list[PendingInstruction] = field(default_factory=list)
    _labels: list[Label] = field(default_factory=list)
    _free: dict[int, list[int]] = field(default_factory=dict)
    _buffers: list[CopyBuffer] = field(default_factory=list)
    _free_buffers: dict[tuple[int, int], list[CopyBuffer]] = field(default_factory=dict)
    #: Temporaries and buffers in use, each with the free list to which it returns.
    _taken: list[tuple[list[Any], Any]] = field(default_factory=list)

    # ----------------------------------------------------------------------- the frame

    def parameter(self, name: str, mode: Mode, type_: Type, dimensions: int = 0) -> int:
        """Add a parameter and return its offset."""
        assert not self._locals, "parameters come first"
        number = self.tables.number(type_)
        parameter = Variable(name, mode, number, dimensions)
        self.parameters.append(parameter)
        return self._reserved(width(parameter, self.tables.types[number]))

    def local(self, name: str, type_: Type) -> int:
        """Add a variable and return its offset."""
        number = self.tables.number(type_)
        self._locals.append(Variable(name, Mode.IN, number))
        return self._reserved(size(self.tables.types[number]))

    def _reserved(self, cells: int) -> int:
        offset = self._cells
        self._cells += cells
        return offset

    def temporary(self, type_: Type) -> int:
        """Return the offset of an unnamed variable for use until the end of `temporaries`.

        Its contents are undefined.
        """
        number = self.tables.number(type_)
        free = self._free.setdefault(number, [])
        offset = free.pop() if free else self.local(f"%{len(self._locals)}", type_)
        self._taken.append((free, offset))
        return offset

    def copy_buffer(self, element: Type, dimensions: int, most: Bound) -> CopyBuffer:
        """Return a buffer for copies of an array, for use until the end of `temporaries`."""
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
        """Release at the end all temporaries and buffers that are taken inside."""
        count = len(self._taken)
        try:
            yield
        finally:
            for free, taken in reversed(self._taken[count:]):
                free.append(taken)
            del self._taken[count:]

    # ----------------------------------------------------------------------- instructions

    def emit(self, op: Op, *operands: Operand) -> None:
        """Append an instruction."""
        self._code.append(PendingInstruction(op, operands))

    @property
    def here(self) -> int:
        """The number of instructions so far."""
        return len(self._code)

    def insert(self, place: int, op: Op, *operands: Operand) -> None:
        """Insert an instruction into the code of the current expression, which has no labels."""
        self._code.insert(place, PendingInstruction(op, operands))

    def last(self) -> PendingInstruction | None:
        """Return the last instruction, or ``None`` if a label follows it."""
        if not self._code or any(label.place == self.here for label in self._labels[-3:]):
            return None
        return self._code[-1]

    def constant(self) -> int | None:
        """Return the INT that the last instruction pushes, or ``None`` if it pushes none."""
        last = self.last()
        number = last.operands[0] if last is not None and last.op is Op.PUSH_INT else None
        assert number is None or isinstance(number, int), "a constant"
        return number

    def cut(self, place: int) -> None:
        """Remove all instructions from this place on."""
        del self._code[place:]

    def drop_last(self) -> None:
        """Remove the last instruction."""
        self._code.pop()

    def place(self, label: Label) -> None:
        """Place a label before the next instruction."""
        label.place = self.here
        self._labels.append(label)

    def code(self, sizes: Sizes) -> Code:
        """Return the code object without unreachable instructions; its stack size is not set."""
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
        """Turn buffers into locals; an array that does not fit fails when it is copied."""
        for buffer in self._buffers:
            left = (MAX_CELLS - self.tables.cells - self._cells) // size(buffer.element)
            count = max(1, min(sizes.most(buffer.given), left))
            type_ = Array(buffer.element, (count, *[1] * (buffer.dimensions - 1)))
            buffer.offset.value = self.local(f"%{len(self._locals)}", type_)
            buffer.type.value = self.tables.number(type_)

    def _instruction(self, written: PendingInstruction, places: dict[int, int]) -> Instruction:
        operands: list[int] = []
        for operand in written.operands:
            match operand:
                case Label(place):
                    operands.append(places[place])
                case DeferredOperand(value):
                    operands.append(value)
                case _:
                    operands.append(operand)
        return Instruction(written.op, tuple(operands))

    def _reached(self) -> list[int]:
        """Return the indices of all reachable instructions, in order."""
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
