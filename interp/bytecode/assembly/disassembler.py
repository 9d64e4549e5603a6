"""The disassembler: writes a verified program as text.

The text contains everything in the program, and in one form only: the assembler returns the same
program, and disassembling that returns the same text. Comments only repeat what follows from the
rest.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import groupby
from typing import Any

from grammar.semantics.types import Array, Enumeration, Structure
from interp.bytecode._generated.opcodes import Op
from interp.bytecode.assembly.forms import ENTRIES, LINES, operands
from interp.bytecode.assembly.names import Names
from interp.bytecode.assembly.syntax import Label, labels, string_text
from interp.bytecode.instruction_set.table import FORMAT
from interp.bytecode.program import (
    BASIC_TYPES,
    Code,
    Instruction,
    Program,
    targets,
    variables,
)

_TYPES = {Structure: "struct", Enumeration: "enum", Array: "array"}


def disassemble(program: Program) -> str:
    """Return the text form of a program."""
    return "".join(f"{line}\n" for line in _Writer(program).lines())


class _Writer:
    """Writes one program."""

    def __init__(self, program: Program) -> None:
        self._program = program
        self._names = Names.of(program)

    def lines(self) -> Iterator[str]:
        program, tables = self._program, self._names.tables
        yield self._line("bytecode", FORMAT)
        entries = {"text": program.texts, "builtin": program.builtins, "ask": program.asks}
        sections: list[Iterable[str]] = [
            (self._line(_TYPES[type(one)], one) for one in program.types[len(BASIC_TYPES) :])
        ]
        for kind, section in entries.items():
            pairs = zip(tables[kind].labels.values(), section, strict=True)
            sections.append([self._line(kind, pair) for pair in pairs])
        sections.append(self._data())
        codes = zip(tables["code"].labels.values(), program.codes, strict=True)
        sections += (self._code(label, code) for label, code in codes)
        for lines in filter(None, map(list, sections)):
            yield from ("", *lines)

    def _line(self, word: str, values: Any) -> str:
        return f"{word} {LINES[word].text(self._names, values)}".rstrip()

    def _data(self) -> Iterator[str]:
        program, found = self._program, self._names.data.labels
        groups = groupby(program.initial, lambda pair: program.data_at(pair[0]))
        initial = {
            number: [(address - program.addresses[number or 0], word) for address, word in pairs]
            for number, pairs in groups
        }
        for number, one in enumerate(program.data):
            word = "global" if one.is_global else "data"
            yield self._line(word, (found[number], one.type, initial.get(number)))
        for each in program.imports:
            routine = (each.routine,) if each.routine else ()
            yield self._line("import", ((each.module, *routine, each.name), each.number))

    def _code(self, label: Label, code: Code) -> Iterator[str]:
        names = self._names
        yield self._line("code", (label, code.kind, code.owner, code.file, code.line))
        names.open_code()
        captures = dict(enumerate(code.captures))
        found = zip(labels((one.name,) for one in variables(code)), variables(code), strict=True)
        for place, (own, one) in enumerate(found):
            names.place(names.frame, own, one)
            passed = own, one.type, one.dimensions, captures.get(place)
            word = one.mode.value if place < len(code.parameters) else "local"
            yield f"  {self._line(word, passed)}"
        if code.result is not None:
            yield f"  {self._line('result', code.result)}"
        yield f"  {self._line('stack', code.stack)}"
        yield "begin"
        jumped_to = {target for one in code.instructions for target in targets(one)}
        for place in sorted(jumped_to):
            names.tables["target"].add(Label((f"L{place}",)), place)
        for place, instruction in enumerate(code.instructions):
            if place in jumped_to:
                yield f"L{place}:"
            name = instruction.op.name
            line = f"  {name}{operands(name).text(names, instruction.operands)}"
            comment = self._comment(instruction)
            yield f"{line:<40} ; {comment}" if comment else line
        yield "end"

    def _comment(self, instruction: Instruction) -> str:
        program, numbers = self._program, instruction.operands
        match instruction.op:
            case Op.ASK:
                return ENTRIES["ask"].text(self._names, program.asks[numbers[0]])
            case Op.BUILTIN:
                return ENTRIES["builtin"].text(self._names, program.builtins[numbers[0]])
            case Op.SET_TEXT:
                return string_text(program.texts[numbers[0]])
        return ""
