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

The sections have the order of the table, which is that of `SECTIONS`. ``STRS`` has all strings,
each once: their number, their lengths, and their UTF-8 bytes, padded with zeros to a whole word.
Elsewhere a string is its index. A list is its length followed by its items. An optional number is 0
if it is missing, otherwise the number plus one. Jump targets are word offsets in the code object.

The writer and the reader of images, `interp.bytecode.image.writer` and
`interp.bytecode.image.reader`, share these definitions.
"""

from __future__ import annotations

from enum import IntEnum

from interp.bytecode.program import CodeKind, Mode

SECTIONS = ("STRS", "TYPE", "TEXT", "ASKS", "BLTN", "DATA", "INIT", "CODE", "IMPT")
#: Modes and kinds of code objects by their numbers.
MODES = tuple(Mode)
KINDS = tuple(CodeKind)


class TypeTag(IntEnum):
    """The first word of a type."""

    STRUCTURE = 0
    ENUMERATION = 1
    ARRAY = 2


class PartTag(IntEnum):
    """The first word of a part of a request."""

    NIL = 0
    FALSE = 1
    TRUE = 2
    INT = 3
    REAL = 4
    STRING = 5
    CHOICE = 6
    INPUT = 7
    CHANGED = 8
    HANDLE = 9
    ITEMS = 10
    RECORD = 11
