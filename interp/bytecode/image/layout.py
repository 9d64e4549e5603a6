"""The image format of a program: a header, a table of sections, and the sections.

All numbers are 32-bit words in little-endian order. Everything except strings consists of words, so
a reader in C can use the image as an array. The header:

===== ==============================================================================================
bytes
===== ==============================================================================================
0     ``KRLI``
4     version of the format and the instruction set
8     length of the image
12    CRC-32 of everything that follows
16    number of sections; then for each its name of four letters and its length
===== ==============================================================================================

The sections have the order of the table. The first, ``STRS``, has all strings, each once: their
number, their lengths, and their UTF-8 bytes, padded with zeros to a whole word. Elsewhere a string
is its index. The others are `TABLES`, each a list. A list is its length followed by its items. An
optional number is 0 if it is missing, otherwise the number plus one. Types, parts of requests,
modes and kinds of code objects are told apart by numbers, which count from 0 in the order of the
tables here. Jump targets are word offsets in the code object.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial

from grammar.semantics.types import Array, Enumeration, Member, Structure, Type
from interp.bytecode._generated.opcodes import Op
from interp.bytecode.image.codec import (
    OPTIONAL,
    REAL,
    SIGNED,
    STRING,
    TYPE,
    WORD,
    Codec,
    WordReader,
    WordWriter,
    list_of,
    one_of,
    record,
)
from interp.bytecode.instruction_set.table import Shape, instructions
from interp.bytecode.program import (
    DEEPEST,
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
    Import,
    Input,
    Instruction,
    Items,
    Mode,
    Record,
    Variable,
    part_kind,
)

# ------------------------------------------------------------------------------------ types

_TYPES: Mapping[type, Codec] = {
    Structure: record(
        Structure, name=STRING, members=list_of(record(Member, name=STRING, type=TYPE))
    ),
    Enumeration: record(Enumeration, name=STRING, constants=list_of(STRING)),
    Array: record(Array, element=TYPE, sizes=list_of(WORD)),
}


def _read_type(reader: WordReader) -> Type:
    """Read a type and add it."""
    number = reader.word()
    if number >= len(_TYPES):
        raise reader.error("there is no such kind of type")
    found: Type = [*_TYPES.values()][number].read(reader)
    reader.types.append(found)
    return found


def _write_type(to: WordWriter, type_: Type) -> None:
    to.put([*_TYPES].index(type(type_)))
    _TYPES[type(type_)].write(to, type_)


# --------------------------------------------------------------------------------- requests


def _read_part(reader: WordReader) -> Argument:
    if reader.depth > DEEPEST:
        raise reader.error("parts are nested too deeply")
    number = reader.word()
    if number >= len(_PARTS):
        raise reader.error("there is no such kind of part")
    reader.depth += 1
    found: Argument = [*_PARTS.values()][number].read(reader)
    reader.depth -= 1
    return found


def _write_part(to: WordWriter, part: Argument) -> None:
    kind = part_kind(part)
    to.put([*_PARTS].index(kind))
    _PARTS[kind].write(to, part)


def _read_path(reader: WordReader) -> Items | None:
    return next((one for one in _LIST.read(reader) if isinstance(one, Items)), None)


_PART = Codec(_read_part, _write_part)
_LIST = list_of(_PART)
_PATH = Codec(_read_path, lambda to, path: _LIST.write(to, [path] if path else []))
_PASSED = {"mode": one_of(tuple(Mode)), "type": WORD, "dimensions": WORD}
_INPUT = record(Input, **_PASSED)
#: Constants by their value or its type, other parts by their class.
_PARTS: Mapping[object, Codec] = {
    None: record(lambda: Constant(None)),
    False: record(lambda: Constant(False)),
    True: record(lambda: Constant(True)),
    int: record(Constant, value=SIGNED),
    float: record(Constant, value=REAL),
    str: record(Constant, value=STRING),
    Choice: record(Choice, type=WORD, place=WORD),
    Input: _INPUT,
    Changed: record(Changed, given=_INPUT, through=OPTIONAL, path=_PATH),
    Handle: record(Handle, code=WORD),
    Items: record(Items, parts=_LIST),
    Record: record(Record, line=WORD, name=STRING, parts=_LIST),
}

# ------------------------------------------------------------------------------------- code

_WORDS = list_of(SIGNED)


def _read_body(reader: WordReader) -> tuple[Instruction, ...]:
    words, shapes = _WORDS.read(reader), instructions()
    found: list[tuple[Shape, tuple[int, ...]]] = []
    numbers: dict[int, int] = {}
    place = 0
    while place < len(words):
        if not 0 <= words[place] < len(shapes):
            raise reader.error(f"{words[place]} is not an opcode")
        shape = shapes[words[place]]
        numbers[place] = len(found)
        found.append((shape, words[place + 1 : place + shape.words]))
        place += shape.words
    if place != len(words):
        raise reader.error("the last instruction is incomplete")
    for shape, operands in found:
        pairs = zip(shape.operands, operands, strict=True)
        if any(kind == "target" and operand not in numbers for kind, operand in pairs):
            raise reader.error("a jump target is not an instruction")
    return tuple(_with_targets(Op(shape.number), operands, numbers) for shape, operands in found)


def _write_body(to: WordWriter, body: tuple[Instruction, ...]) -> None:
    shapes = instructions()
    starts, words = {0: 0}, list[int]()
    for number, one in enumerate(body, 1):
        starts[number] = starts[number - 1] + shapes[one.op].words
    for one in body:
        words += one.op, *_with_targets(one.op, one.operands, starts).operands
    _WORDS.write(to, words)


def _with_targets(op: Op, operands: tuple[int, ...], places: Mapping[int, int]) -> Instruction:
    """Return an instruction whose targets are those places of its operands."""
    kinds = instructions()[op].operands
    if "target" in kinds:
        pairs = zip(kinds, operands, strict=True)
        operands = tuple(places[one] if kind == "target" else one for kind, one in pairs)
    return Instruction(op, operands)


def _write_initial(to: WordWriter, pair: tuple[int, int]) -> None:
    to.put(*pair)


_CODE = record(
    Code,
    name=STRING,
    file=STRING,
    kind=one_of(tuple(CodeKind)),
    line=WORD,
    owner=OPTIONAL,
    parameters=list_of(record(Variable, name=STRING, **_PASSED)),
    captures=list_of(WORD),
    locals=list_of(record(partial(Variable, mode=Mode.IN), name=STRING, type=WORD)),
    result=OPTIONAL,
    stack=WORD,
    instructions=Codec(_read_body, _write_body),
)

#: The tables of a program by the names of their sections, in the order of `Program`.
TABLES: Mapping[str, Codec] = {
    name: list_of(item)
    for name, item in {
        "TYPE": Codec(_read_type, _write_type),
        "TEXT": STRING,
        "ASKS": record(Ask, name=STRING, result=OPTIONAL, parts=_LIST),
        "BLTN": record(Builtin, name=STRING, result=OPTIONAL, parts=_LIST),
        "DATA": record(
            Data, module=STRING, name=STRING, type=WORD, is_global=one_of((False, True))
        ),
        "INIT": Codec(lambda reader: (reader.word(), SIGNED.read(reader)), _write_initial),
        "CODE": _CODE,
        "IMPT": record(Import, module=STRING, routine=STRING, name=STRING, number=WORD),
    }.items()
}
SECTIONS = ("STRS", *TABLES)
