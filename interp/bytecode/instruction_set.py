"""The instruction set: read from ``instructions.tsv``, and what is made from it.

``python -m interp.bytecode.instruction_set --write`` makes the enumeration of opcodes, the C header
and the table in ``docs/bytecode.md``; ``--check`` tells whether they are up to date.

An instruction is a word for its opcode and one for each operand, 32 bits each. The columns of the
table:

========== =========================================================================================
number     the opcode
name       in capitals
operands   their kinds, see `OPERAND_KINDS`
effect     what it takes from the stack of operands and what it leaves, the top at the right. ``t``
           is any value of one cell, ``@T`` a reference to something of type T, ``[E]`` a view: a
           reference to elements and the sizes of the array
asks       ``*`` where the machine may stop there to ask the world
sentence   what it does, and the faults it raises
========== =========================================================================================
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Final

from interp.program.variables import MOST_CELLS
from interp.values.faults import FAULTS

__all__ = [
    "FORMAT",
    "MAGIC",
    "MAX_CELLS",
    "OPERAND_KINDS",
    "Effect",
    "Shape",
    "instructions",
    "main",
    "outdated",
    "shape",
]

#: How an image begins, and the version of the format and the instruction set: a change of either
#: makes it another one.
MAGIC: Final = b"KRLI"
FORMAT: Final = 2
#: The data lists and all frames together have at most so many cells.
MAX_CELLS: Final = MOST_CELLS

#: What operands are.
OPERAND_KINDS: Mapping[str, str] = {
    "int": "a number with sign",
    "real": "the bits of a single",
    "bool": "0 or 1",
    "char": "a code, 0 to 255",
    "count": "a number without sign",
    "line": "a line of the source file, from 1 on",
    "target": "an instruction of the same code object: its first word, counted from 0",
    "local": "a cell of the frame",
    "data": "a cell of the data lists",
    "type": "a type of the program",
    "text": "a text of the program",
    "code": "a code object",
    "ask": "an entry of the table of requests",
    "builtin": "an entry of the table of predefined functions",
    "fault": "a fault of the catalogue, by its code",
}

_SIMPLE = frozenset({"INT", "REAL", "BOOL", "CHAR"})
_HERE = Path(__file__).resolve().parent
_ROOT = _HERE.parents[1]


@dataclass(frozen=True, slots=True)
class Effect:
    """What an instruction with a simple effect takes and leaves, the top at the right."""

    takes: tuple[str, ...]
    leaves: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Shape:
    """An instruction of the set. ``effect`` is ``None`` where it depends on the operands."""

    number: int
    name: str
    operands: tuple[str, ...]
    effect: Effect | None
    effect_text: str
    asks: bool
    sentence: str

    @property
    def words(self) -> int:
        """How many words it has, the opcode included."""
        return 1 + len(self.operands)


@cache
def instructions() -> tuple[Shape, ...]:
    """All instructions, by number."""
    table = resources.files(__package__).joinpath("instructions.tsv").read_text(encoding="utf-8")
    return tuple(_shape(line.split("\t")) for line in table.splitlines()[1:])


@cache
def shape(name: str) -> Shape:
    """The instruction of a name; `KeyError` where there is none."""
    return {one.name: one for one in instructions()}[name]


def _shape(row: list[str]) -> Shape:
    number, name, operands, effect, asks, sentence = row
    takes, _, leaves = (words.split() for words in effect.partition("--"))
    kinds = tuple(operands.split())
    # where a simple effect has operands of other kinds than constants it depends on them
    is_simple = {*takes, *leaves} <= _SIMPLE and name not in ("CALL", "ASK", "BUILTIN")
    return Shape(
        int(number),
        name,
        kinds,
        Effect(tuple(takes), tuple(leaves)) if is_simple else None,
        effect,
        asks == "*",
        sentence,
    )


# ------------------------------------------------------------------------------- what is made

_MADE_BY = (
    "Made from interp/bytecode/instructions.tsv"
    " by python -m interp.bytecode.instruction_set --write"
)
_BEGIN = "<!-- instructions: made by python -m interp.bytecode.instruction_set --write -->"
_END = "<!-- end of instructions -->"


def _opcodes() -> str:
    lines = [
        '"""The opcodes.',
        "",
        f"{_MADE_BY}.",
        '"""',
        "",
        "from enum import IntEnum",
        "",
        '__all__ = ["Op"]',
        "",
        "",
        "class Op(IntEnum):",
        '    """The opcodes by name; what they do stands in the table that this is made from."""',
        "",
    ]
    lines += [f"    {one.name} = {one.number}" for one in instructions()]
    return "\n".join(lines) + "\n"


def _header() -> str:
    kinds = list(OPERAND_KINDS)
    lines = [
        f"/* {_MADE_BY}. */",
        "#ifndef KRL_ISA_GEN_H",
        "#define KRL_ISA_GEN_H",
        "",
        f'#define KRL_IMAGE_MAGIC "{MAGIC.decode()}"',
        f"#define KRL_IMAGE_FORMAT {FORMAT}",
        f"#define KRL_MAX_CELLS {MAX_CELLS}",
        "",
        "/* Kinds of operands, as bits of a byte each: the first operand lowest. */",
        "enum krl_operand {",
        *(
            f"    KRL_OPERAND_{kind.upper()} = {number}, /* {OPERAND_KINDS[kind]} */"
            for number, kind in enumerate(kinds, start=1)
        ),
        "};",
        "",
        "/* X(name, number of operands, kinds of operands), in the order of the opcodes. */",
        "#define KRL_OPCODES(X) \\",
        *(f"    {_entry(one, kinds)} \\" for one in instructions()),
        "",
        "enum krl_opcode {",
        *(f"    KRL_{one.name} = {one.number}, /* {one.effect_text} */" for one in instructions()),
        f"    KRL_OPCODE_COUNT = {len(instructions())}",
        "};",
        "",
        "/* The catalogue of faults. */",
        "enum krl_fault {",
        *(f"    KRL_FAULT_{slug.upper()} = {kind.code}," for slug, kind in FAULTS.items()),
        f"    KRL_FAULT_COUNT = {len(FAULTS)}",
        "};",
        "",
        "#endif",
    ]
    return "\n".join(lines) + "\n"


def _entry(one: Shape, kinds: list[str]) -> str:
    packed = sum((kinds.index(kind) + 1) << 8 * place for place, kind in enumerate(one.operands))
    return f"X({one.name}, {len(one.operands)}, 0x{packed:08x})"


def _rows() -> str:
    lines = [
        _BEGIN,
        "",
        "| | instruction | operands | stack | |",
        "| --- | --- | --- | --- | --- |",
    ]
    for one in instructions():
        operands = " ".join(one.operands)
        effect = one.effect_text.replace("|", "\\|")
        lines.append(f"| {one.number} | `{one.name}` | {operands} | `{effect}` | {one.sentence} |")
    lines += ["", "| operand | |", "| --- | --- |"]
    lines += [f"| {kind} | {meaning} |" for kind, meaning in OPERAND_KINDS.items()]
    lines += ["", _END]
    return "\n".join(lines)


def _document(text: str) -> str:
    """The document with its tables as they have to be."""
    before, begin, rest = text.partition(_BEGIN)
    _, end, after = rest.partition(_END)
    if not begin or not end:
        raise ValueError("docs/bytecode.md has no place for the instructions")
    return before + _rows() + after


def _products() -> Mapping[Path, str]:
    document = _ROOT / "docs" / "bytecode.md"
    return {
        _HERE / "_generated" / "opcodes.py": _opcodes(),
        _ROOT / "interp" / "native" / "isa.gen.h": _header(),
        document: _document(document.read_text(encoding="utf-8")),
    }


def outdated() -> list[str]:
    """The files that are not what the table says, by their paths in the repository."""
    return [
        path.relative_to(_ROOT).as_posix()
        for path, text in _products().items()
        if not path.exists() or path.read_text(encoding="utf-8") != text
    ]


def main() -> int:
    """Entry point; exit status 0 fine, 1 out of date."""
    parser = argparse.ArgumentParser(
        prog="python -m interp.bytecode.instruction_set", description=__doc__
    )
    choice = parser.add_mutually_exclusive_group(required=True)
    choice.add_argument("--write", action="store_true", help="make what follows from the table")
    choice.add_argument("--check", action="store_true", help="tell what is out of date")
    if parser.parse_args().write:
        for path, text in _products().items():
            path.write_text(text, encoding="utf-8", newline="\n")
        return 0
    for name in (names := outdated()):
        sys.stdout.write(
            f"{name} is out of date: run python -m interp.bytecode.instruction_set --write\n"
        )
    return 1 if names else 0


if __name__ == "__main__":
    sys.exit(main())
