"""Successors of instructions: the control flow graph of a code object."""

from __future__ import annotations

from collections.abc import Iterator

from interp.bytecode._generated.opcodes import Op
from interp.bytecode.instruction_set.table import instructions, shape
from interp.bytecode.program import Instruction

#: What nothing follows.
ENDS = frozenset(Op(one.number) for one in instructions() if "ends" in one.flags)


def targets(instruction: Instruction) -> Iterator[int]:
    """The instructions that an instruction may continue at, besides the next one."""
    kinds = shape(instruction.op.name).operands
    for kind, operand in zip(kinds, instruction.operands, strict=True):
        if kind == "target":
            yield operand


def successors(place: int, instruction: Instruction) -> Iterator[int]:
    """The instructions that may come after the one at this place."""
    yield from targets(instruction)
    if instruction.op not in ENDS:
        yield place + 1
