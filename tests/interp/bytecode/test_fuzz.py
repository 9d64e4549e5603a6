"""A damaged image is refused, or runs to a clear end, in the same way on both machines."""

from __future__ import annotations

import struct
import zlib
from contextlib import suppress
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from grammar.semantics.predefined import System
from interp.bytecode.assembly.assembler import assemble
from interp.bytecode.assembly.disassembler import disassemble
from interp.bytecode.image.reader import ImageError, read_image
from interp.bytecode.image.writer import write_image
from interp.bytecode.instruction_set.table import FORMAT, MAGIC, instructions
from interp.bytecode.program import CodeKind, Program
from interp.bytecode.verifier.verify import VerificationError, verify
from interp.bytecode.vm.executor import Machine
from interp.native import AVAILABLE
from interp.port.requests import (
    Crash,
    DeclareInterrupt,
    End,
    Fail,
    Invoke,
    Path,
    Read,
    SetTrigger,
)
from interp.program.load import Limits
from interp.values.faults import Fault, LinkError, RuntimeFailure, fault
from interp.values.values import Value, zero

_WORD = struct.Struct("<I")
_LIMITS = Limits(statements=300, per_slice=40, depth=8)
_POSE = zero(System.load().types["POS"])


def _sealed(words: list[int]) -> bytes:
    body = b"".join(_WORD.pack(word & 0xFFFFFFFF) for word in words[4:])
    return struct.pack("<4sIII", MAGIC, FORMAT, 16 + len(body), zlib.crc32(body)) + body


def _mutations(places: range) -> st.SearchStrategy[list[tuple[int, int]]]:
    """Places of words, and what they become."""
    word = st.integers(-2, 40) | st.integers(0, len(instructions())) | st.integers(0, 2**32 - 1)
    return st.lists(st.tuples(st.sampled_from(places), word), min_size=1, max_size=4)


def _run(machine: Machine, replies: Any) -> list[str]:
    """Run to the end; whatever is handed over is entered and evaluated on the way.

    Returns what is requested, and the data lists at the end, as text.
    """

    def read(_path: Path) -> Value:
        reply = next(replies)
        if isinstance(reply, Fault):
            raise reply
        return reply  # type: ignore[no-any-return]

    request = machine.advance()
    found = []
    for _ in range(600):
        found.append(repr(request))
        assert not isinstance(request, Crash), request
        if machine._final is not None:
            break
        reply = None
        if isinstance(request, Read):
            reply = next(replies)
        elif isinstance(request, Invoke):
            reply = (next(replies), dict(enumerate(request.arguments)))
        elif isinstance(request, DeclareInterrupt):
            with suppress(RuntimeFailure):
                found.append(repr(machine.evaluate(request.condition, read)))
            machine.enter(request.action)
        elif isinstance(request, SetTrigger):
            machine.enter(request.action)
        elif not isinstance(request, End | Fail) and machine.depth > 3:
            machine.unwind(1)
        request = machine.advance(reply)
    return [*found, repr(machine.data())]


def _replies() -> Any:
    """Values of all kinds, over and over."""
    while True:
        yield from (True, 1, 2.5, _POSE, "a", None, 7, False, 3, fault("invalid"), _POSE)


def _checked(data: bytes) -> Program | None:
    try:
        program = read_image(data)
        verified = verify(program)
    except (ImageError, VerificationError) as error:
        told = str(error)
    else:
        told = ""
    if told:
        assert told.isprintable()
        return None
    for code in program.codes:
        if code.kind is CodeKind.ROUTINE:
            with suppress(LinkError):
                runs = [
                    _run(kind(verified, code.name, _LIMITS), _replies()) for kind in _machines()
                ]
                assert all(one == runs[0] for one in runs)
    return program


def _machines() -> list[type[Machine]]:
    if not AVAILABLE:
        return [Machine]
    from interp.native.machine import Machine as NativeMachine

    return [Machine, NativeMachine]


def test_programs_run_to_an_end(everything: str) -> None:
    """What the mutations begin with runs itself."""
    assert _checked(write_image(assemble(everything))) is not None


@pytest.mark.parametrize("part", [0, -420], ids=["all of it", "instructions"])
@settings(max_examples=3 * settings().max_examples)
@given(data=st.data())
def test_mutated_images_do_no_harm(everything: str, part: int, data: st.DataObject) -> None:
    """A few words changed and the checksum made right: refused, or run to an end."""
    words = [one[0] for one in _WORD.iter_unpack(write_image(assemble(everything)))]
    places = range(len(words))[part:] if part else range(5, len(words))
    for place, word in data.draw(_mutations(places)):
        words[place] = word
    program = _checked(_sealed(words))
    if program is not None:
        assert program == assemble(disassemble(program))
