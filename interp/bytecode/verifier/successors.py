"""Successors of instructions: the control flow graph of a code object."""

from __future__ import annotations

from collections.abc import Iterator

from interp.bytecode._generated.opcodes import Op
from interp.bytecode.instruction_set.table import instructions, shape
from interp.bytecode.program import Instruction

#: Instructions without a next instruction.
ENDS = frozenset(Op(one.number) for one in instructions() if "ends" in one.flags)


def targets(instruction: Instruction) -> Iterator[int]:
    """Yield the jump targets of an instruction."""
    kinds = shape(instruction.op.name).operands
    for kind, operand in zip(kinds, instruction.operands, strict=True):
        if kind == "target":
            yield operand


def successors(place: int, instruction: Instruction) -> Iterator[int]:
    """Yield the instructions that can come after the one at this place."""
    yield from targets(instruction)
    if instruction.op not in ENDS:
        yield place + 1
