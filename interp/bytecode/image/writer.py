"""Writes a program as an image; `interp.bytecode.image.layout` describes the format."""

from __future__ import annotations

import struct
import zlib

from interp.bytecode.image.codec import WordWriter
from interp.bytecode.image.layout import TABLES
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
