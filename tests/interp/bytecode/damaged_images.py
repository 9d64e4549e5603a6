"""Damaged images on both machines: what they do must be the same, and come to a clear end."""

from __future__ import annotations

import struct
import zlib
from contextlib import suppress
from typing import Any

from grammar.semantics.predefined import System
from interp.bytecode.image.codec import ImageError
from interp.bytecode.image.image import read_image
from interp.bytecode.instruction_set.table import FORMAT, MAGIC
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

_LIMITS = Limits(statements=300, per_slice=40, depth=8)
_POSE = zero(System.load().types["POS"])


def sealed(body: bytes) -> bytes:
    """Return an image with a correct header for what follows its header."""
    return struct.pack("<4sIII", MAGIC, FORMAT, 16 + len(body), zlib.crc32(body)) + body


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


def run_on_machines(data: bytes) -> Program | None:
    """Run each routine of an image on both machines, which must agree; return its program.

    Returns ``None`` if it is refused, which takes one line.
    """
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
