"""Programs as native code: register code as C, made by the compiler at hand and kept.

A step of the machine becomes a line of C that names it (``compiled.h``), so there is one
description of what steps do, and a program that was compiled stops where the machine stops and asks
what it asks. What is kept is found by the text that was compiled, with all that it includes.
"""

from __future__ import annotations

import hashlib
import os
import re
import shutil
import subprocess
import tempfile
from collections.abc import Iterable, Iterator, Sequence
from functools import cache
from pathlib import Path
from typing import Final

from interp.bytecode.program import Parameter, Program, Slot, stack_cells
from interp.bytecode.verifier.verify import Verified
from interp.native._core import Core
from interp.native.machine import Machine
from interp.native.register_code import CALLS, Step, roles_of
from support.files.user_cache import user_cache

__all__ = ["CompiledMachine", "compiler", "keep", "library_of", "source_of"]

_HERE: Final = Path(__file__).parent
_HEADERS: Final = (
    *("compiled.h", "steps.h", "array_operations.h", "machine.h", "register_code.h"),
    *("program.h", "cells.h", "isa.gen.h"),
)
#: Every product and sum is rounded by itself, as by the machine (docs/adr/0013-numbers.md).
_FLAGS: Final = ("-std=c11", "-O2", "-fPIC", "-shared", "-ffp-contract=off", "-w")
_PATIENCE: Final = 600  # seconds that the compiler may take
_MOST_KEPT: Final = 500


def compiler() -> str | None:
    """The C compiler of this machine: that of ``CC``, else one by its usual name."""
    names = (os.environ.get("CC", ""), "cc", "gcc", "clang")
    return next((found for name in names if name and (found := shutil.which(name))), None)


def source_of(program: Program, core: Core) -> str:
    """The register code of a program as C."""
    return "\n".join(_Source(program, core).lines()) + "\n"


def keep(verified: Verified) -> Path:
    """The shared object of a program for runs without a trace, made where it is not kept yet.

    Raises `OSError` as `library_of` does.
    """
    return library_of(source_of(verified.program, Core(verified.image, 0, 0, None)))


def library_of(source: str) -> Path:
    """The shared object of a source, which is kept for the user.

    Raises `OSError` where there is no compiler, it fails, or there is no place to keep it.
    """
    folder = user_cache()
    if folder is None:
        raise OSError("there is no folder to keep it in")
    folder /= "native"
    command = compiler()
    if command is None:
        raise OSError("there is no C compiler")
    key = hashlib.sha256(f"{command} {_FLAGS}\0{source}\0{_headers()}".encode()).hexdigest()
    target = folder / f"{key}.so"
    if target.is_file():
        return target
    folder.mkdir(parents=True, exist_ok=True, mode=0o700)
    with tempfile.TemporaryDirectory(dir=folder) as work:
        text, made = Path(work, "program.c"), Path(work, "program.so")
        text.write_text(source, encoding="utf-8")
        called = [command, *_FLAGS, f"-I{_HERE}", str(text), "-o", str(made)]
        try:
            done = subprocess.run(called, capture_output=True, check=False, timeout=_PATIENCE)
        except subprocess.TimeoutExpired as error:
            raise OSError(f"{command} takes more than {_PATIENCE} s") from error
        if done.returncode:
            told = done.stderr.decode(errors="replace").strip().splitlines()
            raise OSError(f"{command}: {told[0] if told else 'failed'}")
        made.replace(target)
    for old in sorted(folder.glob("*.so"), key=lambda one: one.stat().st_mtime)[:-_MOST_KEPT]:
        old.unlink(missing_ok=True)
    return target


@cache
def _headers() -> str:
    return "".join((_HERE / name).read_text(encoding="utf-8") for name in _HEADERS)


class CompiledMachine(Machine):
    """Runs what was compiled of a verified program; else like `interp.native.machine.Machine`.

    Raises `OSError` where it cannot be compiled.
    """

    def _begin(self, number: int) -> None:
        core = self._core
        core.load(str(library_of(source_of(self._program, core))))
        super()._begin(number)


class _Source:
    """Writes the steps of all code objects.

    Steps work on copies of cells, which the compiler keeps in registers of the processor. The cells
    themselves are what else looks at them: where the machine stops or calls, and in variables that
    are reached by an address.
    """

    def __init__(self, program: Program, core: Core) -> None:
        self._program = program
        self._steps = [Step(*one) for one in core.steps()]
        self._arrays = core.arrays()
        self._firsts = [core.step(number, 0) for number in range(len(program.codes))]
        self._targets = {step.d for step in self._steps if step.is_jump}

    def lines(self) -> Iterator[str]:
        """All lines of the file."""
        yield '#include "compiled.h"'
        yield "static const struct krl_array arrays[] = {"
        for base, width, dimensions, *sizes in self._arrays or [(0, 0, 0, 1, 1, 1)]:
            yield f"{{{base}, {width}, {dimensions}, {{{', '.join(map(str, sizes))}}}}},"
        yield "};"
        yield "static const struct krl_step steps[] = {"
        for name, a, b, c, d, tag, line in self._steps:
            words = ", ".join(map(_int, (a, b, c, d, line)))
            yield f"{{0, {words}, KRL_STEP_{name}, {tag}}},"
        yield "};"
        numbers = range(len(self._firsts))
        yield from (f"CODE({number});" for number in numbers)
        ends = [*self._firsts[1:], len(self._steps)]
        for number, first, end in zip(numbers, self._firsts, ends, strict=True):
            yield from self._code(number, range(first, end))
        yield f"PROGRAM({', '.join(f'code_{number}' for number in numbers)})"

    def _code(self, code: int, steps: Sequence[int]) -> Iterator[str]:
        first, slots = steps[0], self._program.slots(self._program.codes[code])
        in_frame = self._in_frame(slots, steps)
        used = {one for number in steps for one in self._steps[number].registers()}
        kept = sorted(used - in_frame)
        received = sum(slot.cells for slot in slots if isinstance(slot.variable, Parameter))
        yield f"CODE({code}) {{"
        yield f"ENTER({first}, {max(used, default=0) + 1})"
        yield _each("GET", kept)
        yield "ENTRIES() {"
        for number in steps:
            if self._is_way_in(number, first):
                yield f"WAY_IN({number}, {self._label(number)})"
        yield "default: return NOWHERE;"
        yield "}"
        yield "start:"
        yield _each("GET", [one for one in kept if one < received])
        yield _each("BLANK", [one for one in kept if one >= received])
        yield f"goto {self._label(first)};"
        for number in steps:
            step = self._steps[number]
            if step.line >= 0:
                yield f"BEGIN({number})"
            yield f"LABEL({number})"
            yield from self._step(number, step, in_frame, kept)
        yield "LEAVE()"
        yield _each("PUT", kept)
        yield "STOP();"
        yield "}"

    def _in_frame(self, slots: Iterable[Slot], steps: Iterable[int]) -> frozenset[int]:
        """The cells of variables that are reached by an address."""
        reached = set()
        for number in steps:
            name, _, b, c, _, tag, _ = self._steps[number]
            if name in ("REFER", "COPY_VIEW"):
                reached.add(b)
            elif name in ("INDEX_LOCAL", "GET_LOCAL", "PUT_LOCAL", "PUT_LOCAL_K"):
                reached.add(c)
            elif re.search("_(WIDE|TWO)_LOCAL", name) or (name == "INDEX_ANY" and tag == 1):
                reached.add(self._arrays[c][0])
        variables = [range(slot.offset, slot.offset + slot.cells) for slot in slots]
        whole = (cells for cells in variables if not reached.isdisjoint(cells))
        return frozenset(reached.union(*whole))

    def _is_way_in(self, number: int, first: int) -> bool:
        """Whether the machine may go on here: where a statement begins, behind what stops it."""
        is_behind = number > first and self._steps[number - 1].name in ("PYTHON", *CALLS)
        return self._steps[number].line >= 0 or is_behind or number in self._targets

    def _label(self, number: int) -> str:
        return f"{'begin' if self._steps[number].line >= 0 else 'do'}_{number}"

    def _step(
        self, number: int, step: Step, in_frame: frozenset[int], kept: Sequence[int]
    ) -> Iterator[str]:
        name, roles = step.name, roles_of(step.name)
        if name in CALLS:
            end = step.a + sum(map(stack_cells, self._program.codes[step.b].parameters))
            yield _each("PUT", [one for one in kept if step.a <= one < end])
            save = _each("PUT", [one for one in kept if one < step.a])
            yield f"CALL({number}, {step.b}, {self._firsts[step.b]}, {save})"
            yield _each("GET", {step.a} - in_frame)
        elif name in ("RETURN", "END_ACTION", "AT", "PYTHON"):
            yield f"{name}({number})"
        elif roles is None:
            yield f"{_each('PUT', kept)}DO_IN_FRAME({name}, {number}){_each('GET', kept)}"
        else:
            yield _each("GET", in_frame.intersection(step.named(roles[0])))
            written = _each("PUT", in_frame.intersection(step.named(roles[1])))
            if name == "RETURN_VALUE":
                yield f"{name}({number})"
            elif step.is_jump:
                yield f"BRANCH({name}, {number}, {written}, {self._label(step.d)})"
            else:
                yield f"DO({name}, {number}, {written})"


def _each(word: str, registers: Iterable[int]) -> str:
    return "".join(f"{word}({one})" for one in sorted(registers))


def _int(number: int) -> str:
    """A number as C has it: the smallest one is no literal."""
    return str(number) if number > -(2**31) else "INT32_MIN"
