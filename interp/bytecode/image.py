"""The byte form of a program: a header, a table of sections, and the sections.

All numbers are words of 32 bits, the lowest byte first; all but the strings is words, so that a
reader in C needs no more than an array. The header:

===== ==============================================================================================
bytes
===== ==============================================================================================
0     ``KRLI``
4     version of the format and the instruction set
8     length of the image
12    CRC-32 of all that follows
16    number of sections; then for each its name, four letters, and its length
===== ==============================================================================================

The sections follow one another in the order of the table, which is that of `_SECTIONS`. ``STRS``
has all strings, each once: how many, their lengths, and their UTF-8 bytes, filled up with zeros to
a whole word. Elsewhere a string is its number. Lists are their length and what is in them; what may
be missing is 0, or its number and one more. Targets are words of the code object, not instructions.

What is read is not trusted: `read_image` raises `ImageError` for whatever is not as written above.
Whether the program keeps the rules is the affair of `interp.bytecode.verify`.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Callable, Sequence
from typing import TypeVar

from grammar.types import Array, Enumeration, Member, Structure, Type
from interp.bytecode._generated.opcodes import Op
from interp.bytecode.cells import bits_of, real_of, size
from interp.bytecode.isa import FORMAT, MAGIC, Shape, instructions
from interp.bytecode.program import (
    BASIC_TYPES,
    Argument,
    Ask,
    Builtin,
    Changed,
    Choice,
    Code,
    CodeKind,
    Constant,
    Data,
    Handle,
    Input,
    Instruction,
    Items,
    Local,
    Mode,
    Parameter,
    Program,
    Record,
)
from interp.bytecode.syntax import printable
from interp.faults import LinkError

__all__ = ["ImageError", "read_image", "write_image"]

_T = TypeVar("_T")

_SECTIONS = ("STRS", "TYPE", "TEXT", "ASKS", "BLTN", "DATA", "INIT", "CODE")
_MODES = tuple(Mode)
_KINDS = tuple(CodeKind)
_DEEPEST = 64
#: How the parts of requests begin.
_NIL, _FALSE, _TRUE, _INT, _REAL, _STRING = range(6)
_CHOICE, _INPUT, _CHANGED, _HANDLE, _ITEMS, _RECORD = range(6, 12)
_STRUCTURE, _ENUMERATION, _ARRAY = range(3)


class ImageError(Exception):
    """Bytes are no image of this version, or a damaged one; the message is one clear line."""

    def __init__(self, message: str) -> None:
        super().__init__(printable(message))


# ------------------------------------------------------------------------------------ writing


def write_image(program: Program) -> bytes:
    """The image of a program that was verified."""
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
        }
        sections["STRS"] = self._string_section()
        table = b"".join(
            name.encode("ascii") + struct.pack("<I", len(sections[name])) for name in _SECTIONS
        )
        body = struct.pack("<I", len(_SECTIONS)) + table
        body += b"".join(sections[name] for name in _SECTIONS)
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
                self._put(_STRUCTURE)
                self._string(type_.name)
                self._list(self._member, type_.members)
            case Enumeration():
                self._put(_ENUMERATION)
                self._string(type_.name)
                self._list(self._string, type_.constants)
            case Array():
                self._put(_ARRAY, self._numbers[type_.element])
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
                self._put(_CHOICE, type_, place)
            case Input():
                self._put(_INPUT)
                self._handed_over(part)
            case Changed(given, through, path):
                self._put(_CHANGED)
                self._handed_over(given)
                self._optional(through)
                self._list(self._part, [path] if path else [])
            case Handle(code):
                self._put(_HANDLE, code)
            case Items(parts):
                self._put(_ITEMS)
                self._list(self._part, parts)
            case Record(name, line, parts):
                self._put(_RECORD, line)
                self._string(name)
                self._list(self._part, parts)

    def _constant(self, value: str | float | bool | None) -> None:
        if value is None:
            self._put(_NIL)
        elif isinstance(value, bool):
            self._put(_TRUE if value else _FALSE)
        elif isinstance(value, int):
            self._put(_INT, value)
        elif isinstance(value, float):
            self._put(_REAL, bits_of(value))
        else:
            self._put(_STRING)
            self._string(value)

    def _handed_over(self, given: Input | Parameter) -> None:
        self._put(_MODES.index(given.mode), given.type, given.dimensions)

    def _data(self, variable: Data) -> None:
        self._string(variable.module)
        self._string(variable.name)
        self._put(variable.type, int(variable.is_global))

    def _code(self, code: Code) -> None:
        self._string(code.name)
        self._string(code.file)
        self._put(_KINDS.index(code.kind), code.line)
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
    """The instructions as words."""
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


# ------------------------------------------------------------------------------------ reading


def read_image(data: bytes) -> Program:
    """The program of an image; raises `ImageError`."""
    if data[:4] != MAGIC:
        raise ImageError("not an image: it does not begin with KRLI")
    if len(data) < 20:
        raise ImageError("the image is too short")
    _, version, length, checksum, count = struct.unpack_from("<4sIIII", data)
    if version != FORMAT:
        raise ImageError(f"the image has format {version}, and only {FORMAT} is known")
    if length != len(data):
        raise ImageError(f"the image has {len(data):,} bytes, not {length:,} as it says")
    if checksum != zlib.crc32(data[16:]):
        raise ImageError("the image is damaged: its checksum is wrong")
    start = 20 + 8 * count
    if count != len(_SECTIONS) or start > length:
        raise ImageError("the image has other sections than it should")
    sections: dict[str, bytes] = {}
    for number, name in enumerate(_SECTIONS):
        tag, size_ = struct.unpack_from("<4sI", data, 20 + 8 * number)
        if tag != name.encode("ascii") or size_ % 4 or start + size_ > length:
            raise ImageError(f"the image has no proper section {name}")
        sections[name] = data[start : start + size_]
        start += size_
    if start != length:
        raise ImageError("the image is longer than its sections")
    return _Reader(sections).program()


class _Reader:
    """Reads the sections, one after the other."""

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
        return Program(tuple(self._types), texts, asks, builtins, data, initial, codes)

    def _error(self, reason: str) -> ImageError:
        return ImageError(f"the image is damaged: section {self._name}, {reason}")

    def _section(self, name: str, read: Callable[[], _T]) -> tuple[_T, ...]:
        data = self._sections[name]
        self._name, self._next = name, 0
        self._words = struct.unpack(f"<{len(data) // 4}I", data)
        found = self._list(read)
        if self._next != len(self._words):
            raise self._error("it is longer than what it holds")
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
            raise self._error("a number stands for nothing")
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
        """Reads a type. Names differ, so that types are never compared by what they are made of."""
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
            case tag if tag == _STRUCTURE:
                return Structure(self._string(), self._list(self._member))
            case tag if tag == _ENUMERATION:
                return Enumeration(self._string(), self._list(self._string))
            case tag if tag == _ARRAY:
                return Array(self._choice(self._types), self._list(self._word))
        raise self._error("a number stands for no type")

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
            raise self._error("parts lie too deep")
        tag = self._word()
        if tag in _CONSTANTS:
            return _CONSTANTS[tag]
        match tag:
            case _ if tag in (_INT, _REAL):
                word = self._signed()
                return Constant(word if tag == _INT else real_of(word))
            case _ if tag == _STRING:
                return Constant(self._string())
            case _ if tag == _CHOICE:
                return Choice(self._word(), self._word())
            case _ if tag == _INPUT:
                return Input(*self._handed_over())
            case _ if tag == _CHANGED:
                return self._changed(depth)
            case _ if tag == _HANDLE:
                return Handle(self._word())
            case _ if tag == _ITEMS:
                return Items(self._list(lambda: self._part(depth + 1)))
            case _ if tag == _RECORD:
                line, name = self._word(), self._string()
                return Record(name, line, self._list(lambda: self._part(depth + 1)))
        raise self._error("a number stands for no part")

    def _changed(self, depth: int) -> Changed:
        given, through = Input(*self._handed_over()), self._optional()
        path = [one for one in self._list(lambda: self._part(depth + 1)) if isinstance(one, Items)]
        return Changed(given, through, path[0] if path else None)

    def _handed_over(self) -> tuple[Mode, int, int]:
        return self._choice(_MODES), self._word(), self._word()

    # ------------------------------------------------------------------------ data and code

    def _data(self) -> Data:
        module, name, type_ = self._string(), self._string(), self._word()
        return Data(module, name, type_, self._choice((False, True)))

    def _code(self) -> Code:
        name, file = self._string(), self._string()
        kind, line, owner = self._choice(_KINDS), self._word(), self._optional()
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
                raise self._error(f"{words[place]} is no opcode")
            shape = shapes[words[place]]
            numbers[place] = len(found)
            found.append((shape, tuple(words[place + 1 : place + shape.words])))
            place += shape.words
        if place != len(words):
            raise self._error("the last instruction is not complete")
        return tuple(
            Instruction(Op(shape.number), self._targets(shape, operands, numbers))
            for shape, operands in found
        )

    def _targets(
        self, shape: Shape, operands: tuple[int, ...], numbers: dict[int, int]
    ) -> tuple[int, ...]:
        """The operands with instructions as targets."""
        if "target" not in shape.operands:
            return operands
        found = []
        for kind, operand in zip(shape.operands, operands, strict=True):
            if kind == "target" and operand not in numbers:
                raise self._error("a target is no instruction")
            found.append(numbers[operand] if kind == "target" else operand)
        return tuple(found)


_CONSTANTS = {_NIL: Constant(None), _FALSE: Constant(False), _TRUE: Constant(True)}
