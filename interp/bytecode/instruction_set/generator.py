"""Generates code and documents from the instruction set.

``python -m interp.bytecode.instruction_set --write`` writes the enumeration of opcodes, the headers
in C and the table in ``docs/bytecode.md``; ``--check`` says whether they are up to date.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from interp.bytecode.instruction_set.table import (
    FORMAT,
    MAGIC,
    MAX_CELLS,
    OPERAND_KINDS,
    Shape,
    instructions,
)
from interp.values.builtins import WEIGHTS
from interp.values.faults import FAULTS

_ROOT = Path(__file__).resolve().parents[3]

_MADE_BY = (
    "Made from interp/bytecode/instructions.tsv"
    " by python -m interp.bytecode.instruction_set --write"
)
#: The names in C of operators with a weight.
_IN_C = {":": "COMPOSE"}
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
    ends = [f"op == KRL_{one.name}" for one in instructions() if "ends" in one.flags]
    lines = [
        f"/* {_MADE_BY}. */",
        "#ifndef KRL_ISA_GEN_H",
        "#define KRL_ISA_GEN_H",
        "",
        f'#define KRL_IMAGE_MAGIC "{MAGIC.decode()}"',
        f"#define KRL_IMAGE_FORMAT {FORMAT}",
        f"#define KRL_MAX_CELLS {MAX_CELLS}",
        "",
        "/* X(name, number of operands, place of a target or -1), in the order of the opcodes. */",
        "#define KRL_OPCODES(X) \\",
        *(f"    {_entry(one)} \\" for one in instructions()),
        "",
        "enum krl_opcode {",
        *(f"    KRL_{one.name} = {one.number}, /* {one.effect} */" for one in instructions()),
        f"    KRL_OPCODE_COUNT = {len(instructions())}",
        "};",
        "",
        "/* Whether execution never continues with the next instruction. */",
        "static inline int krl_ends(uint32_t op)",
        "{",
        f"    return {' || '.join(ends)};",
        "}",
        "",
        "/* The catalogue of faults. */",
        "enum krl_fault {",
        *(f"    KRL_FAULT_{slug.upper()} = {kind.code}," for slug, kind in FAULTS.items()),
        f"    KRL_FAULT_COUNT = {len(FAULTS)}",
        "};",
        "",
        "/* As how many statements functions count. */",
        "enum krl_weight {",
        *(f"    KRL_WEIGHT_{_IN_C.get(name, name)} = {one}," for name, one in WEIGHTS.items()),
        "};",
        "",
        "#endif",
    ]
    return "\n".join(lines) + "\n"


def _entry(one: Shape) -> str:
    target = one.operands.index("target") if "target" in one.operands else -1
    return f"X({one.name}, {len(one.operands)}, {target})"


def _rows() -> str:
    lines = [
        _BEGIN,
        "",
        "| | instruction | operands | checks | stack | |",
        "| --- | --- | --- | --- | --- | --- |",
    ]
    for one in instructions():
        checks = f"`{one.checks}`" if one.checks else ""
        cells = (f"`{one.name}`", one.operand_text, checks, f"`{one.effect}`", one.sentence)
        lines.append(f"| {one.number} | {' | '.join(cells)} |")
    lines += ["", "| operand | |", "| --- | --- |"]
    lines += [f"| {name} | {kind.meaning} |" for name, kind in OPERAND_KINDS.items()]
    lines += ["", _END]
    return "\n".join(lines)


def _document(text: str) -> str:
    """Return the document with up-to-date tables."""
    before, begin, rest = text.partition(_BEGIN)
    _, end, after = rest.partition(_END)
    if not begin or not end:
        raise ValueError("docs/bytecode.md has no place for the instructions")
    return before + _rows() + after


def products() -> Mapping[Path, str]:
    """Return the text of each generated file."""
    native = _ROOT / "interp" / "native"
    document = _ROOT / "docs" / "bytecode.md"
    return {
        _ROOT / "interp" / "bytecode" / "_generated" / "opcodes.py": _opcodes(),
        native / "program" / "isa.gen.h": _header(),
        document: _document(document.read_text(encoding="utf-8")),
    }
