"""Writes a program as an image; `interp.bytecode.image.layout` describes the format."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Callable, Sequence
from typing import TypeVar

from grammar.semantics.types import Array, Enumeration, Member, Structure, Type
from interp.bytecode.cell_layout import bits_of
from interp.bytecode.image.layout import KINDS, MODES, SECTIONS, PartTag, TypeTag
from interp.bytecode.instruction_set.table import FORMAT, MAGIC, instructions
from interp.bytecode.program import (
    BASIC_TYPES,
    Argument,
    Ask,
    Builtin,
    Changed,
    Choice,
    Code,
    Constant,
    Data,
    Handle,
    Import,
    Input,
    Items,
    Local,
    Parameter,
    Program,
    Record,
)

_T = TypeVar("_T")


def write_image(program: Program) -> bytes:
    """Return the image of a verified program."""
    return _Writer(program).image()


class _Writer:
    def __init__(self, program: Program) -> None:
        self._program = program
        self._strings: dict[str, int] = {}
        self._words: list[int] = []
        self._numbers = {type_: number for number, type_ in enumerate(program.types)}

    def image(self) -> bytes:
        program = self._program
        sections = {
            "TYPE": self._section(self._type, program.types[len(BASIC_TYPES) :]),
            "TEXT": self._section(self._string, program.texts),
            "ASKS": self._section(self._ask, program.asks),
            "BLTN": self._section(self._builtin, program.builtins),
            "DATA": self._section(self._data, program.data),
            "INIT": self._section(lambda pair: self._put(*pair), program.initial),
            "CODE": self._section(self._code, program.codes),
            "IMPT": self._section(self._import, program.imports),
        }
        sections["STRS"] = self._string_section()
        table = b"".join(
            name.encode("ascii") + struct.pack("<I", len(sections[name])) for name in SECTIONS
        )
        body = struct.pack("<I", len(SECTIONS)) + table
        body += b"".join(sections[name] for name in SECTIONS)
        head = struct.pack("<4sIII", MAGIC, FORMAT, 16 + len(body), zlib.crc32(body))
        return head + body

    def _section(self, write: Callable[[_T], None], entries: Sequence[_T]) -> bytes:
        self._words = []
        self._list(write, entries)
        return struct.pack(f"<{len(self._words)}I", *(word & 0xFFFFFFFF for word in self._words))

    def _string_section(self) -> bytes:
        parts = [text.encode("utf-8") for text in self._strings]
        blob = b"".join(parts)
        lengths = [len(parts), *map(len, parts)]
        return struct.pack(f"<{len(lengths)}I", *lengths) + blob + bytes(-len(blob) % 4)

    def _put(self, *words: int) -> None:
        self._words += words

    def _list(self, write: Callable[[_T], None], entries: Sequence[_T]) -> None:
        self._put(len(entries))
        for entry in entries:
            write(entry)

    def _string(self, text: str) -> None:
        self._put(self._strings.setdefault(text, len(self._strings)))

    def _optional(self, number: int | None) -> None:
        self._put(0 if number is None else number + 1)

    def _type(self, type_: Type) -> None:
        match type_:
            case Structure():
                self._put(TypeTag.STRUCTURE)
                self._string(type_.name)
                self._list(self._member, type_.members)
            case Enumeration():
                self._put(TypeTag.ENUMERATION)
                self._string(type_.name)
                self._list(self._string, type_.constants)
            case Array():
                self._put(TypeTag.ARRAY, self._numbers[type_.element])
                self._list(self._put, [one or 0 for one in type_.sizes])

    def _member(self, member: Member) -> None:
        self._string(member.name)
        self._put(self._numbers[member.type])

    def _ask(self, ask: Ask) -> None:
        self._entry(ask.request, ask.parts, ask.result)

    def _builtin(self, builtin: Builtin) -> None:
        self._entry(builtin.name, builtin.parts, builtin.result)

    def _entry(self, name: str, parts: Sequence[Argument], result: int | None) -> None:
        self._string(name)
        self._optional(result)
        self._list(self._part, parts)

    def _part(self, part: Argument) -> None:
        match part:
            case Constant(value):
                self._constant(value)
            case Choice(type_, place):
                self._put(PartTag.CHOICE, type_, place)
            case Input():
                self._put(PartTag.INPUT)
                self._handed_over(part)
            case Changed(given, through, path):
                self._put(PartTag.CHANGED)
                self._handed_over(given)
                self._optional(through)
                self._list(self._part, [path] if path else [])
            case Handle(code):
                self._put(PartTag.HANDLE, code)
            case Items(parts):
                self._put(PartTag.ITEMS)
                self._list(self._part, parts)
            case Record(name, line, parts):
                self._put(PartTag.RECORD, line)
                self._string(name)
                self._list(self._part, parts)

    def _constant(self, value: str | float | bool | None) -> None:
        if value is None:
            self._put(PartTag.NIL)
        elif isinstance(value, bool):
            self._put(PartTag.TRUE if value else PartTag.FALSE)
        elif isinstance(value, int):
            self._put(PartTag.INT, value)
        elif isinstance(value, float):
            self._put(PartTag.REAL, bits_of(value))
        else:
            self._put(PartTag.STRING)
            self._string(value)

    def _handed_over(self, given: Input | Parameter) -> None:
        self._put(MODES.index(given.mode), given.type, given.dimensions)

    def _data(self, variable: Data) -> None:
        self._string(variable.module)
        self._string(variable.name)
        self._put(variable.type, int(variable.is_global))

    def _import(self, given: Import) -> None:
        self._string(given.module)
        self._string(given.routine)
        self._string(given.name)
        self._put(given.number)

    def _code(self, code: Code) -> None:
        self._string(code.name)
        self._string(code.file)
        self._put(KINDS.index(code.kind), code.line)
        self._optional(code.owner)
        self._list(self._parameter, code.parameters)
        self._list(self._put, code.captures)
        self._list(self._local, code.locals)
        self._optional(code.result)
        self._put(code.stack)
        self._list(self._put, _words(code))

    def _parameter(self, parameter: Parameter) -> None:
        self._string(parameter.name)
        self._handed_over(parameter)

    def _local(self, local: Local) -> None:
        self._string(local.name)
        self._put(local.type)


def _words(code: Code) -> list[int]:
    """Return the words of the instructions of a code object."""
    shapes = instructions()
    starts, count = [], 0
    for instruction in code.instructions:
        starts.append(count)
        count += shapes[instruction.op].words
    words: list[int] = []
    for instruction in code.instructions:
        words.append(instruction.op)
        for kind, operand in zip(
            shapes[instruction.op].operands, instruction.operands, strict=True
        ):
            words.append(starts[operand] if kind == "target" else operand)
    return words
