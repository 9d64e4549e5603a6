"""Reads an image into a program; `interp.bytecode.image.layout` describes the format.

Images are not trusted: `read_image` raises `ImageError` for any bytes that are not of this format.
`interp.bytecode.verifier.verify` then checks the program.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Callable, Sequence
from typing import TypeVar

from grammar.semantics.types import Array, Enumeration, Member, Structure, Type
from interp.bytecode._generated.opcodes import Op
from interp.bytecode.cell_layout import real_of, size
from interp.bytecode.image.layout import KINDS, MODES, SECTIONS, PartTag, TypeTag
from interp.bytecode.instruction_set.table import FORMAT, MAGIC, Shape, instructions
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
    Instruction,
    Items,
    Local,
    Mode,
    Parameter,
    Program,
    Record,
    printable,
)
from interp.values.faults import LinkError

_T = TypeVar("_T")

_DEEPEST = 64


class ImageError(Exception):
    """The bytes are not an image of this version, or are damaged; the message is one clear line."""

    def __init__(self, message: str) -> None:
        super().__init__(printable(message))


def read_image(data: bytes) -> Program:
    """Return the program in an image; raises `ImageError`."""
    if data[:4] != MAGIC:
        raise ImageError("not an image: it does not begin with KRLI")
    if len(data) < 20:
        raise ImageError("the image is too short")
    _, version, length, checksum, count = struct.unpack_from("<4sIIII", data)
    if version != FORMAT:
        raise ImageError(
            f"the image has format {version}, and only {FORMAT} is known: compile it again"
        )
    if length != len(data):
        raise ImageError(f"the image has {len(data):,} bytes, not {length:,} as it says")
    if checksum != zlib.crc32(data[16:]):
        raise ImageError("the image is damaged: its checksum is wrong")
    start = 20 + 8 * count
    if count != len(SECTIONS) or start > length:
        raise ImageError("the sections of the image are not those of its format")
    sections: dict[str, bytes] = {}
    for number, name in enumerate(SECTIONS):
        tag, size_ = struct.unpack_from("<4sI", data, 20 + 8 * number)
        if tag != name.encode("ascii") or size_ % 4 or start + size_ > length:
            raise ImageError(f"the image has no proper section {name}")
        sections[name] = data[start : start + size_]
        start += size_
    if start != length:
        raise ImageError("the image is longer than its sections")
    return _Reader(sections).program()


class _Reader:
    """Reads the sections one after another."""

    def __init__(self, sections: dict[str, bytes]) -> None:
        self._sections = sections
        self._name = ""
        self._words: Sequence[int] = ()
        self._next = 0
        self._strings: list[str] = []
        self._types: list[Type] = list(BASIC_TYPES)
        self._names: set[str] = set()

    def program(self) -> Program:
        self._strings = self._read_strings()
        self._section("TYPE", self._add_type)
        texts = self._section("TEXT", self._string)
        asks = self._section("ASKS", self._ask)
        builtins = self._section("BLTN", self._builtin)
        data = self._section("DATA", self._data)
        initial = self._section("INIT", lambda: (self._word(), self._signed()))
        codes = self._section("CODE", self._code)
        imports = self._section(
            "IMPT", lambda: Import(self._string(), self._string(), self._string(), self._word())
        )
        return Program(tuple(self._types), texts, asks, builtins, data, initial, codes, imports)

    def _error(self, reason: str) -> ImageError:
        return ImageError(f"the image is damaged: section {self._name}, {reason}")

    def _section(self, name: str, read: Callable[[], _T]) -> tuple[_T, ...]:
        data = self._sections[name]
        self._name, self._next = name, 0
        self._words = struct.unpack(f"<{len(data) // 4}I", data)
        found = self._list(read)
        if self._next != len(self._words):
            raise self._error("it is longer than its contents")
        return found

    def _word(self) -> int:
        if self._next == len(self._words):
            raise self._error("it ends early")
        self._next += 1
        return self._words[self._next - 1]

    def _signed(self) -> int:
        word = self._word()
        return word - 2**32 if word >= 2**31 else word

    def _list(self, read: Callable[[], _T]) -> tuple[_T, ...]:
        count = self._word()
        if count > len(self._words) - self._next:  # whatever is read has a word at least
            raise self._error("a list is longer than the section")
        return tuple(read() for _ in range(count))

    def _choice(self, choices: Sequence[_T]) -> _T:
        number = self._word()
        if number >= len(choices):
            raise self._error("a number is out of range")
        return choices[number]

    def _optional(self) -> int | None:
        number = self._word()
        return number - 1 if number else None

    def _string(self) -> str:
        return self._choice(self._strings)

    def _read_strings(self) -> list[str]:
        data = self._sections["STRS"]
        self._name = "STRS"
        count = struct.unpack_from("<I", data)[0] if data else 0
        start = 4 + 4 * count
        if start > len(data):
            raise self._error("it ends early")
        lengths = struct.unpack_from(f"<{count}I", data, 4)
        end = start + sum(lengths)
        if end + -end % 4 != len(data) or any(data[end:]):
            raise self._error("it is not as long as its strings")
        found = []
        for length in lengths:
            try:
                found.append(data[start : start + length].decode("utf-8"))
            except UnicodeDecodeError:
                raise self._error("a string is not UTF-8") from None
            start += length
        return found

    # ------------------------------------------------------------------------------ types

    def _add_type(self) -> None:
        """Read a type and add it; names are unique, so that types can be compared by name."""
        type_ = self._type()
        if isinstance(type_, Structure | Enumeration):
            if type_.name.upper() in self._names:
                raise self._error(f"there are two types {type_.name}")
            self._names.add(type_.name.upper())
        try:
            size(type_)
        except LinkError as error:
            raise self._error(str(error)) from None
        self._types.append(type_)

    def _type(self) -> Type:
        match self._word():
            case TypeTag.STRUCTURE:
                return Structure(self._string(), self._list(self._member))
            case TypeTag.ENUMERATION:
                return Enumeration(self._string(), self._list(self._string))
            case TypeTag.ARRAY:
                return Array(self._choice(self._types), self._list(self._word))
        raise self._error("there is no such kind of type")

    def _member(self) -> Member:
        return Member(self._string(), self._choice(self._types))

    # --------------------------------------------------------------------------- requests

    def _ask(self) -> Ask:
        name, result = self._string(), self._optional()
        return Ask(name, self._list(self._part), result)

    def _builtin(self) -> Builtin:
        name, result = self._string(), self._optional()
        return Builtin(name, self._list(self._part), result)

    def _part(self, depth: int = 0) -> Argument:
        if depth > _DEEPEST:
            raise self._error("parts are nested too deeply")
        tag = self._word()
        match tag:
            case PartTag.NIL:
                return Constant(None)
            case PartTag.FALSE | PartTag.TRUE:
                return Constant(tag == PartTag.TRUE)
            case PartTag.INT | PartTag.REAL:
                word = self._signed()
                return Constant(word if tag == PartTag.INT else real_of(word))
            case PartTag.STRING:
                return Constant(self._string())
            case PartTag.CHOICE:
                return Choice(self._word(), self._word())
            case PartTag.INPUT:
                return Input(*self._handed_over())
            case PartTag.CHANGED:
                return self._changed(depth)
            case PartTag.HANDLE:
                return Handle(self._word())
            case PartTag.ITEMS:
                return Items(self._list(lambda: self._part(depth + 1)))
            case PartTag.RECORD:
                line, name = self._word(), self._string()
                return Record(name, line, self._list(lambda: self._part(depth + 1)))
        raise self._error("there is no such kind of part")

    def _changed(self, depth: int) -> Changed:
        given, through = Input(*self._handed_over()), self._optional()
        path = [one for one in self._list(lambda: self._part(depth + 1)) if isinstance(one, Items)]
        return Changed(given, through, path[0] if path else None)

    def _handed_over(self) -> tuple[Mode, int, int]:
        return self._choice(MODES), self._word(), self._word()

    # ------------------------------------------------------------------------ data and code

    def _data(self) -> Data:
        module, name, type_ = self._string(), self._string(), self._word()
        return Data(module, name, type_, self._choice((False, True)))

    def _code(self) -> Code:
        name, file = self._string(), self._string()
        kind, line, owner = self._choice(KINDS), self._word(), self._optional()
        parameters = self._list(lambda: Parameter(self._string(), *self._handed_over()))
        captures = self._list(self._word)
        locals_ = self._list(lambda: Local(self._string(), self._word()))
        result, stack = self._optional(), self._word()
        body = self._instructions(self._list(self._signed))
        return Code(
            name, kind, file, line, owner, parameters, captures, locals_, result, stack, body
        )

    def _instructions(self, words: Sequence[int]) -> tuple[Instruction, ...]:
        shapes = instructions()
        found: list[tuple[Shape, tuple[int, ...]]] = []
        numbers: dict[int, int] = {}
        place = 0
        while place < len(words):
            if not 0 <= words[place] < len(shapes):
                raise self._error(f"{words[place]} is not an opcode")
            shape = shapes[words[place]]
            numbers[place] = len(found)
            found.append((shape, tuple(words[place + 1 : place + shape.words])))
            place += shape.words
        if place != len(words):
            raise self._error("the last instruction is incomplete")
        return tuple(
            Instruction(Op(shape.number), self._targets(shape, operands, numbers))
            for shape, operands in found
        )

    def _targets(
        self, shape: Shape, operands: tuple[int, ...], numbers: dict[int, int]
    ) -> tuple[int, ...]:
        """Return the operands with word offsets of jump targets replaced by instruction indices."""
        if "target" not in shape.operands:
            return operands
        found = []
        for kind, operand in zip(shape.operands, operands, strict=True):
            if kind == "target" and operand not in numbers:
                raise self._error("a jump target is not an instruction")
            found.append(numbers[operand] if kind == "target" else operand)
        return tuple(found)
