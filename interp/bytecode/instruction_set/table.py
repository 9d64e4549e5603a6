"""The instruction set, read from ``instructions.tsv``.

An instruction is a word for its opcode and one for each operand, 32 bits each. The columns of the
table:

========== =========================================================================================
number     the opcode
name       in capitals
operands   their kinds, see `OPERAND_KINDS`, as ``name:kind`` where the name is another
checks     what must hold of the operands
effect     what it takes from the stack of operands and what it leaves; for this and the checks see
           `interp.bytecode.verifier.stack_effects`
flags      ``ends`` where the next instruction does not follow, ``changes`` what no condition may
           have, ``trace`` what only makes a trace event
sentence   what it does, and the faults it raises
========== =========================================================================================
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import Final

from interp.program.variables import MOST_CELLS
from interp.values.faults import FAULTS
from support.files.tables import read_table
from support.lazy_dataclass import dataclass

#: How an image begins, and the version of the format and the instruction set: a change of either
#: makes it another one.
MAGIC: Final = b"KRLI"
FORMAT: Final = 4
#: The data lists and all frames together have at most so many cells.
MAX_CELLS: Final = MOST_CELLS


@dataclass(frozen=True, slots=True)
class OperandKind:
    """What an operand may be: at least ``least``, below ``limit``.

    A ``limit`` that is a word is how many of something the program or the code object has.
    """

    meaning: str
    least: int | None = None
    limit: int | str | None = None


#: What operands are.
OPERAND_KINDS: Mapping[str, OperandKind] = {
    "int": OperandKind("a signed integer"),
    "real": OperandKind("the bits of a single-precision number"),
    "bool": OperandKind("0 or 1", 0, 2),
    "char": OperandKind("a code, 0 to 255", 0, 256),
    "count": OperandKind("an unsigned integer", 0),
    "line": OperandKind("a line of the source file, from 1 on", 1),
    "target": OperandKind(
        "an instruction of the same code object: its first word, counted from 0", 0, "length"
    ),
    "local": OperandKind("a cell of the frame", 0, "frame"),
    "data": OperandKind("a cell of the data lists", 0, "data_cells"),
    "type": OperandKind("a type of the program", 0, "type_count"),
    "text": OperandKind("a text of the program", 0, "text_count"),
    "code": OperandKind("a code object", 0, "code_count"),
    "ask": OperandKind("an entry of the table of requests", 0, "ask_count"),
    "builtin": OperandKind("an entry of the table of predefined functions", 0, "builtin_count"),
    "fault": OperandKind("a fault of the catalogue, by its code", 0, len(FAULTS)),
}


@dataclass(frozen=True, slots=True)
class Shape:
    """An instruction of the set: ``operands`` are their kinds, in ``operand_text`` with names."""

    number: int
    name: str
    operands: tuple[str, ...]
    operand_text: str
    checks: str
    effect: str
    flags: frozenset[str]
    sentence: str

    @property
    def words(self) -> int:
        """The number of words, the opcode included."""
        return 1 + len(self.operands)


@cache
def instructions() -> tuple[Shape, ...]:
    """All instructions, by number."""
    return tuple(map(_shape, read_table("interp.bytecode", "instructions.tsv")[1:]))


@cache
def shape(name: str) -> Shape:
    """Return the instruction with a name; raise `KeyError` if there is none."""
    return {one.name: one for one in instructions()}[name]


def _shape(row: list[str]) -> Shape:
    number, name, operands, checks, effect, flags, sentence = row
    kinds = tuple(operand.rpartition(":")[2] for operand in operands.split())
    return Shape(
        int(number), name, kinds, operands, checks, effect, frozenset(flags.split()), sentence
    )
