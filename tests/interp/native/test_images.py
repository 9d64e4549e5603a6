"""C takes the images that Python takes, and none that could do harm."""

from __future__ import annotations

import struct
import zlib
from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from interp.bytecode.assembly.assembler import assemble
from interp.bytecode.image.reader import ImageError, read_image
from interp.bytecode.image.writer import write_image
from interp.bytecode.instruction_set.table import FORMAT, MAGIC, instructions
from interp.bytecode.verifier.verify import VerificationError, verify

if TYPE_CHECKING:
    from interp.native._core import Core

_SMALL = """\
bytecode 4
struct POINT X:REAL Y:INT
builtin LENGTH STRLEN view:CHAR[] -> INT
ask SHOW Write ("$SHOWN") in:INT
ask HERE Read ("$HERE") -> POINT
ask LATER DeclareInterrupt 3 FALSE &WHEN &DO
data M.I INT = 3
data M.PS POINT[3] = 1.5 2
data M.T CHAR[4] = "ab"
code MAIN routine "m.src" 1
  local I INT
  local L INT[2,2]
  local P POINT
begin
  LINE 2 A
  LOAD_DATA M.I
  LOAD_DATA M.I
  INDEX_DATA M.PS POINT[3]
  MEMBER 1 INT
  LOAD
  ADD_INT
  STORE_LOCAL I
A:
  LINE 3 B
  REF_LOCAL P POINT
  ASK HERE
  REF_DATA M.PS[2] POINT
  REF_LOCAL P POINT
  COPY POINT
  REF_LOCAL P POINT
  REF_LOCAL L INT[2,2]
  PUSH_INT 1
  ROW INT[2,2] 1
  CALL SUB
  ASK SHOW
B:
  LINE 4 C
  REF_DATA M.T CHAR[4]
  VIEW CHAR[4]
  BUILTIN LENGTH
  CASE 2 C
  DROP
  ASK LATER
C:
  LINE 5 C
  LOAD_LOCAL I
  PUSH_INT 10
  UNLESS_LT_INT D
  JUMP B
D:
  RETURN
end
code SUB routine "m.src" 9
  in P POINT
  view V INT[]
  result INT
begin
  LINE 10 E
  PUSH_INT 1
  INDEX_VIEW V
  LOAD_LOCAL P.Y
  STORE
  LOAD_LOCAL P.Y
  RETURN_VALUE
E:
  FAIL no_result
end
code DO action of MAIN "m.src" 4
  ref I INT from 0
begin
  LINE 4 E
  LOAD_REF I
  PUSH_INT 1
  STORE
E:
  RETURN
end
code WHEN condition of MAIN "m.src" 4
  ref I INT from 0
  result BOOL
begin
  LOAD_REF I
  LOAD
  PUSH_INT 3
  GT_INT
  RETURN_VALUE
end
"""
_WORD = struct.Struct("<I")


def _sealed(words: list[int]) -> bytes:
    body = b"".join(_WORD.pack(word & 0xFFFFFFFF) for word in words[4:])
    return struct.pack("<4sIII", MAGIC, FORMAT, 16 + len(body), zlib.crc32(body)) + body


def _is_taken(image: bytes) -> bool:
    try:
        verify(read_image(image))
    except (ImageError, VerificationError):
        return False
    return True


def _changes(size: int) -> st.SearchStrategy[list[tuple[int, int]]]:
    word = st.integers(-3, 30) | st.integers(0, len(instructions())) | st.integers(0, 2**32 - 1)
    place = st.integers(5, size - 1) | st.integers(size // 2, size - 1)
    return st.lists(st.tuples(place, word), min_size=1, max_size=2)


@settings(max_examples=60)
@given(data=st.data())
def test_damaged_images(core: type[Core], data: st.DataObject) -> None:
    """What Python takes, C takes; what C takes runs on without harm, whatever Python says of it."""
    words = [one[0] for one in _WORD.iter_unpack(write_image(assemble(_SMALL)))]
    for place, word in data.draw(_changes(len(words))):
        words[place] = word
    image = _sealed(words)
    try:
        machine = core(image, False, 5, None)
    except ValueError:
        machine = None
    if machine is None:
        assert not _is_taken(image)
        return
    machine.begin(0)
    machine.left = 50
    with suppress(IndexError):
        machine.run(machine.step(0, 0), 0)


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (lambda _image: b"", "too short"),
        (lambda image: image[:-4], "the length or the sections"),
        (lambda image: image[:4] + _WORD.pack(99) + image[8:], "compile it again"),
        (lambda image: image[:40] + bytes([image[40] ^ 1]) + image[41:], "checksum"),
        (lambda image: b"ELF\x7f" + image[4:], "not an image"),
    ],
)
def test_refusals_say_why(core: type[Core], change: object, reason: str) -> None:
    """An image that is none is refused with one clear line."""
    assert callable(change)
    with pytest.raises(ValueError, match=reason):
        core(change(write_image(assemble(_SMALL))), False, 5, None)


def test_a_stack_that_is_too_small_is_refused(core: type[Core]) -> None:
    """The machine allots what a code object says: C refuses one that needs more."""
    program = assemble(_SMALL)
    tight = replace(program, codes=(replace(program.codes[0], stack=1), *program.codes[1:]))
    with pytest.raises(ValueError, match="more cells than the code object states"):
        core(write_image(tight), False, 5, None)
