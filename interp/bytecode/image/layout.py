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

The sections follow one another in the order of the table, which is that of `SECTIONS`. ``STRS``
has all strings, each once: how many, their lengths, and their UTF-8 bytes, filled up with zeros to
a whole word. Elsewhere a string is its number. Lists are their length and what is in them; what may
be missing is 0, or its number and one more. Targets are words of the code object, not instructions.

Here is what both sides have to agree on: `interp.bytecode.image.writer` writes images,
`interp.bytecode.image.reader` reads them.
"""

from __future__ import annotations

from enum import IntEnum

from interp.bytecode.program import CodeKind, Mode

SECTIONS = ("STRS", "TYPE", "TEXT", "ASKS", "BLTN", "DATA", "INIT", "CODE", "IMPT")
#: Modes and kinds of code objects by their numbers.
MODES = tuple(Mode)
KINDS = tuple(CodeKind)


class TypeTag(IntEnum):
    """How a type begins."""

    STRUCTURE = 0
    ENUMERATION = 1
    ARRAY = 2


class PartTag(IntEnum):
    """How a part of a request begins."""

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
