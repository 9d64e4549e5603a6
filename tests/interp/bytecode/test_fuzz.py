"""A damaged image is refused, or runs to a clear end, in the same way on both machines."""

from __future__ import annotations

import struct

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from interp.bytecode.assembly.assembler import assemble
from interp.bytecode.assembly.disassembler import disassemble
from interp.bytecode.image.image import write_image
from interp.bytecode.instruction_set.table import instructions
from tests.interp.bytecode.damaged_images import run_on_machines, sealed

_WORD = struct.Struct("<I")


def _mutations(places: range) -> st.SearchStrategy[list[tuple[int, int]]]:
    """Places of words, and what they become."""
    word = st.integers(-2, 40) | st.integers(0, len(instructions())) | st.integers(0, 2**32 - 1)
    return st.lists(st.tuples(st.sampled_from(places), word), min_size=1, max_size=4)


def test_programs_run_to_an_end(everything: str) -> None:
    """What the mutations begin with runs itself."""
    assert run_on_machines(write_image(assemble(everything))) is not None


@pytest.mark.parametrize("part", [0, -420], ids=["all of it", "instructions"])
@settings(max_examples=3 * settings().max_examples)
@given(data=st.data())
def test_mutated_images_do_no_harm(everything: str, part: int, data: st.DataObject) -> None:
    """A few words changed and the checksum made right: refused, or run to an end."""
    words = [one[0] for one in _WORD.iter_unpack(write_image(assemble(everything)))]
    places = range(len(words))[part:] if part else range(5, len(words))
    for place, word in data.draw(_mutations(places)):
        words[place] = word
    program = run_on_machines(sealed(b"".join(_WORD.pack(word & 0xFFFFFFFF) for word in words[4:])))
    if program is not None:
        assert program == assemble(disassemble(program))
