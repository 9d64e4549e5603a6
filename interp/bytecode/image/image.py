"""Images as bytes: a header, a table of sections, and the sections.

`interp.bytecode.image.layout` describes the format. Images are not trusted: `read_image` raises
`ImageError` for any bytes that are not of this format. `interp.bytecode.verifier.verify` then
checks the program.
"""

from __future__ import annotations

import struct
import zlib
from typing import Any

from grammar.semantics.types import Type
from interp.bytecode.image.codec import ImageError, WordReader, WordWriter
from interp.bytecode.image.layout import SECTIONS, TABLES
from interp.bytecode.instruction_set.table import FORMAT, MAGIC
from interp.bytecode.program import BASIC_TYPES, Program


def write_image(program: Program) -> bytes:
    """Return the image of a verified program."""
    strings: dict[str, int] = {}
    types = {type_: number for number, type_ in enumerate(program.types)}
    tables = (
        *(program.types[len(BASIC_TYPES) :], program.texts, program.asks, program.builtins),
        *(program.data, program.initial, program.codes, program.imports),
    )
    sections = {}
    for (name, codec), table in zip(TABLES.items(), tables, strict=True):
        writer = WordWriter(strings, types)
        codec.write(writer, table)
        sections[name] = writer.data()
    sections = {"STRS": _strings(list(strings)), **sections}
    names = (name.encode("ascii") + struct.pack("<I", len(data)) for name, data in sections.items())
    body = struct.pack("<I", len(sections)) + b"".join((*names, *sections.values()))
    return struct.pack("<4sIII", MAGIC, FORMAT, 16 + len(body), zlib.crc32(body)) + body


def _strings(strings: list[str]) -> bytes:
    parts = [text.encode("utf-8") for text in strings]
    letters = b"".join(parts)
    lengths = [len(parts), *map(len, parts)]
    return struct.pack(f"<{len(lengths)}I", *lengths) + letters + bytes(-len(letters) % 4)


def read_image(data: bytes) -> Program:
    """Return the program in an image; raises `ImageError`."""
    sections = _read_sections(data)
    strings = _read_strings(sections["STRS"])
    types: list[Type] = list(BASIC_TYPES)
    found: list[Any] = []
    for name, table in TABLES.items():
        reader = WordReader(name, sections[name], strings, types)
        found.append(table.read(reader))
        if reader.left:
            raise reader.error("it is longer than its contents")
    return Program(tuple(types), *found[1:])


def _read_sections(data: bytes) -> dict[str, bytes]:
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
        tag, size = struct.unpack_from("<4sI", data, 20 + 8 * number)
        if tag != name.encode("ascii") or size % 4 or start + size > length:
            raise ImageError(f"the image has no proper section {name}")
        sections[name] = data[start : start + size]
        start += size
    if start != length:
        raise ImageError("the image is longer than its sections")
    return sections


def _read_strings(data: bytes) -> list[str]:
    reader = WordReader("STRS", data, (), [])
    count = reader.word()
    if count > reader.left:
        raise reader.error("it ends early")
    lengths = [reader.word() for _ in range(count)]
    start = 4 + 4 * count
    end = start + sum(lengths)
    if end + -end % 4 != len(data) or any(data[end:]):
        raise reader.error("it is not as long as its strings")
    found = []
    for length in lengths:
        try:
            found.append(data[start : start + length].decode("utf-8"))
        except UnicodeDecodeError:
            raise reader.error("a string is not UTF-8") from None
        start += length
    return found
