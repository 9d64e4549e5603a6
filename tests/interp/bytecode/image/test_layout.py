"""An image is the program, byte for byte; anything else is refused."""

from __future__ import annotations

import struct
import zlib
from contextlib import suppress
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from interp.bytecode.assembly.assembler import assemble
from interp.bytecode.image.codec import ImageError
from interp.bytecode.image.image import read_image, write_image
from interp.bytecode.instruction_set.table import FORMAT
from interp.bytecode.verifier.verify import VerificationError, verify

SMALL = 'bytecode 4\nstruct S A:INT\ndata M.X S = 1\ncode M routine "m" 1\nbegin\n  RETURN\nend\n'


def sealed(data: bytes) -> bytes:
    """The image with the length and the checksum that it should have."""
    body = data[16:]
    return data[:8] + struct.pack("<II", len(data), zlib.crc32(body)) + body


def test_program_survives_its_image(everything: str) -> None:
    """Written and read, a program is what it was; written again, the image too."""
    program = assemble(everything)
    image = write_image(program)
    assert program == read_image(image)
    assert image == write_image(read_image(image))


def test_image_begins_with_its_name_and_version() -> None:
    """Four letters, the version, and the length stand first."""
    image = write_image(assemble(SMALL))
    assert (b"KRLI", FORMAT, len(image)) == struct.unpack_from("<4sII", image)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda image: image[:0], "not an image"),
        (lambda image: b"ELF" + image[3:], "not an image"),
        (lambda image: image[:12], "too short"),
        (lambda image: image[:4] + b"\1" + image[5:], "has format 1"),
        (lambda image: image[:-1], "not .* as it says"),
        (lambda image: image + b"\0", "not .* as it says"),
        (lambda image: image[:-1] + b"\1", "checksum"),
        (lambda image: sealed(image[:16] + b"\7" + image[17:]), "the sections of the image"),
        (lambda image: sealed(image[:20] + b"X" + image[21:]), "no proper section STRS"),
        (lambda image: sealed(image[:24] + b"\xff\xff\xff\xff" + image[28:]), "no proper section"),
        (lambda image: sealed(image + b"\0\0\0\0"), "longer than its sections"),
    ],
)
def test_damaged_frame_is_refused(change, message: str) -> None:  # type: ignore[no-untyped-def]
    """Every field of the header and the table of sections is checked."""
    with pytest.raises(ImageError, match=message):
        read_image(change(write_image(assemble(SMALL))))


def _words(image: bytes) -> list[int]:
    return list(struct.unpack(f"<{len(image) // 4}I", image))


def test_every_word_may_be_wrong(everything: str) -> None:
    """Whatever a word becomes, reading gives a program or says what is damaged."""
    words = _words(write_image(assemble(everything)))
    chance = Random(1)
    for place in range(5, len(words)):
        changed = [*words[:place], chance.choice((0, 2, 0xFFFFFFFF)), *words[place + 1 :]]
        with suppress(ImageError):
            read_image(sealed(struct.pack(f"<{len(words)}I", *changed)))


@given(st.binary(max_size=300))
def test_bytes_are_refused_quietly(data: bytes) -> None:
    """Bytes that only begin like an image are refused like all others."""
    with pytest.raises(ImageError):
        read_image(sealed(b"KRLI" + struct.pack("<III", 1, 0, 0) + data))


def test_targets_lead_to_instructions() -> None:
    """A target between two words of an instruction is no target."""
    text = 'bytecode 4\ncode M routine "m" 1\nbegin\n  JUMP L\n  PUSH_INT 5\nL:\n  RETURN\nend\n'
    words = _words(write_image(assemble(text)))
    place = words.index(4, len(words) - 9)  # the word of RETURN
    words[place] = 3
    with pytest.raises(ImageError, match="a jump target is not an instruction"):
        read_image(sealed(struct.pack(f"<{len(words)}I", *words)))


def test_names_of_types_differ() -> None:
    """Two structures of one name would have to be compared by all that they are made of."""
    image = write_image(assemble(SMALL.replace("data", "struct T A:INT\ndata")))
    start = image.index(b"SAT")  # the names, in the order in which they come
    with pytest.raises(VerificationError, match="S is defined twice"):
        verify(read_image(sealed(image[:start] + b"SAS" + image[start + 3 :])))
