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
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cache
from itertools import count
from pathlib import Path
from typing import Final

from grammar.semantics.types import BOOL, REAL, Type
from interp.bytecode.cell_layout import kind_at
from interp.bytecode.program import CodeKind, Mode, Parameter, Program, Slot, stack_cells
from interp.bytecode.verifier.verify import Verified
from interp.native._core import Core
from interp.native.machine import Machine
from interp.native.register_code import CALLS, ENDS, Step, roles_of
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
#: What a cell of a type holds; of all others a number.
_KINDS: Final[Mapping[Type, str]] = {REAL: "REAL", BOOL: "BOOL"}
#: Steps that are left to the interpreter.
_INTERPRETED: Final = ("PYTHON", "END_ACTION", "CHECK_CALL", "FAIL")


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
    """Writes the steps of all routines.

    Steps work on copies of cells, which the compiler keeps in registers of the processor. The cells
    themselves are what else looks at them: where the machine stops or calls, and in variables that
    are reached by an address.
    """

    def __init__(self, program: Program, core: Core) -> None:
        self._program = program
        self._steps = [Step(*one) for one in core.steps()]
        self._arrays = core.arrays()
        self._kinds: dict[int, str] = {}
        firsts = [core.step(number, 0) for number in range(len(program.codes))]
        ends = [*firsts[1:], len(self._steps)]
        bodies = zip(program.codes, map(range, firsts, ends), strict=True)
        self._bodies = {
            number: body
            for number, (code, body) in enumerate(bodies)
            if code.kind is CodeKind.ROUTINE
        }
        jumps = [(place, step.d) for place, step in enumerate(self._steps) if step.is_jump]
        self._targets = {target for _, target in jumps}
        self._loops = {target for place, target in jumps if target <= place}
        self._owners = {code.owner for code in program.codes if code.captures}

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
        yield from (f"CODE({number});" for number in self._bodies)
        for number, body in self._bodies.items():
            yield from self._code(number, body)
        loops = (self._loops.intersection(body) for body in self._bodies.values())
        entries = sorted({body[0] for body in self._bodies.values()}.union(*loops))
        yield f"const int32_t krl_entries[] = {{{', '.join(map(str, [*entries, -1]))}}};"
        codes = range(len(self._program.codes))
        names = (f"code_{number}" if number in self._bodies else "NULL" for number in codes)
        yield f"PROGRAM({', '.join(names)})"

    def _code(self, number: int, body: range) -> Iterator[str]:
        """The function of a routine."""
        code = self._program.codes[number]
        first, slots = body[0], self._program.slots(code)
        in_frame = self._in_frame(slots, body)
        used = {one for place in body for one in self._steps[place].registers()}
        kept = sorted(used - in_frame)
        self._kinds = dict(self._kinds_of(slots))
        received = sum(slot.cells for slot in slots if isinstance(slot.variable, Parameter))
        yield f"CODE({number}) {{"
        yield f"ENTER({number}, {max(used, default=0) + 1}, {int(number in self._owners)}) {{"
        known = self._valued(body)
        in_use = [one for one in kept if one < self._program.frames[number]]
        live = self._live(body, set(kept).difference(in_use))
        for place in sorted(self._loops.intersection(body)):
            valued = known.get(place, frozenset())
            yield f"case {place}:"
            yield self._each("GET_VALUE", valued.intersection(kept))
            yield self._each("GET", set(in_use) - valued)
            yield self._each("BLANK", set(kept).difference(in_use, valued))
            yield f"goto do_{place};"
        yield "}"
        yield "start:"
        yield self._each("GET", [one for one in kept if one < received])
        yield self._each("BLANK", [one for one in kept if one >= received])
        yield from _blank_cells(set(range(received, self._program.frames[number])) - set(kept))
        yield f"goto do_{first};"
        counted, later = self._blocks(body)
        for place in body:
            step = self._steps[place]
            yield f"do_{place}:;"
            if place in counted:
                yield f"BEGIN({place}, {counted[place]}, {self._each('PUT', live[place])})"
            if step.line >= 0:
                yield f"STATEMENT({place})"
            yield from self._step(place, later.get(place, 0), in_frame, kept, live[place])
        yield "leave:"
        yield self._each("PUT", in_use)
        yield "LEAVE();"
        yield "}"

    def _live(self, body: range, stack: set[int]) -> dict[int, frozenset[int]]:
        """Liveness: the places of the stack of operands that are read before they are written.

        By the step from which on that is so.
        """
        found: dict[int, frozenset[int]] = dict.fromkeys(body, frozenset())
        before: dict[int, list[int]] = {place: [] for place in body}
        for place in body:
            for other in self._following(place):
                before[other].append(place)
        todo = list(body)
        while todo:
            place = todo.pop()
            step = self._steps[place]
            roles = roles_of(step.name)
            if step.name == "PYTHON":
                live = frozenset(one for one in stack if one < step.a)
            elif roles is None and step.name not in (*ENDS, "AT"):
                live = frozenset(stack)
            else:
                read, written = map(step.named, roles or ("", ""))
                after = frozenset[int]().union(*(found[one] for one in self._following(place)))
                live = (after - written) | stack.intersection(read)
            if live != found[place]:
                found[place] = live
                todo += before[place]
        return found

    def _following(self, place: int) -> list[int]:
        """The steps that may come after a step, within its routine."""
        step = self._steps[place]
        jump = [step.d] if step.is_jump else []
        return jump if step.name in ENDS else [*jump, place + 1]

    def _kinds_of(self, slots: Iterable[Slot]) -> Iterator[tuple[int, str]]:
        """What cells of variables hold, if they hold anything."""
        for slot in slots:
            variable, type_ = slot.variable, self._program.types[slot.variable.type]
            for place in range(slot.cells):
                is_value = not isinstance(variable, Parameter) or variable.mode is Mode.IN
                kind = _KINDS.get(kind_at(type_, place), "INT") if is_value else "INT"
                yield slot.offset + place, kind

    def _each(self, word: str, registers: Iterable[int]) -> str:
        """A macro for each register, with what it holds."""
        return "".join(f"{word}({one}, {self._kinds.get(one, 'ANY')})" for one in sorted(registers))

    def _blocks(self, body: range) -> tuple[dict[int, int], dict[int, int]]:
        """Basic blocks: statements that count together, as nothing but a fault can come between.

        How many a block has, by the first step of its first statement; and how many of its block
        have not begun yet, by step.
        """
        counted: dict[int, int] = {}
        begun: dict[int, tuple[int, int]] = {}
        leader = -1
        for place in body:
            step = self._steps[place]
            if place in self._targets:
                leader = -1
            if step.line >= 0:
                leader = place if leader < 0 else leader
                counted[leader] = counted.get(leader, 0) + 1
            if leader >= 0:
                begun[place] = leader, counted[leader]
            if step.is_jump or step.name in (*CALLS, *ENDS, *_INTERPRETED):
                leader = -1
        return counted, {place: counted[first] - count for place, (first, count) in begun.items()}

    def _valued(self, steps: range) -> dict[int, frozenset[int]]:
        """Definite assignment: the registers with a value before each step, on every way there."""
        found: dict[int, frozenset[int]] = {steps[0]: frozenset()}
        todo = [steps[0]]
        while todo:
            number = todo.pop()
            step, after = self._steps[number], found[number]
            if step.name in CALLS:
                after = frozenset(one for one in after if one < step.a)
            else:
                read, written = map(step.named, roles_of(step.name) or ("", ""))
                can_be_none = step.name == "PASS" or (step.name == "SET_K" and step.tag == 0)
                after = after | read
                after = after - written if can_be_none else after | written
            for other in self._following(number):
                met = after & found.get(other, after)
                if met != found.get(other):
                    found[other] = met
                    todo.append(other)
        return found

    def _in_frame(self, slots: Iterable[Slot], steps: Iterable[int]) -> frozenset[int]:
        """The cells of variables whose address is taken."""
        reached = set()
        for number in steps:
            name, _, b, c, *_ = self._steps[number]
            if name in ("REFER", "COPY_VIEW"):
                reached.add(b)
            elif name in ("INDEX_LOCAL", "GET_LOCAL", "PUT_LOCAL", "PUT_LOCAL_K"):
                reached.add(c)
            elif re.search("_(WIDE|TWO|THREE)_LOCAL", name):
                reached.add(self._arrays[c][0])
        variables = [range(slot.offset, slot.offset + slot.cells) for slot in slots]
        whole = (cells for cells in variables if not reached.isdisjoint(cells))
        return frozenset(reached.union(*whole))

    def _step(
        self,
        place: int,
        later: int,
        in_frame: frozenset[int],
        kept: Sequence[int],
        live: frozenset[int],
    ) -> Iterator[str]:
        step = self._steps[place]
        name, roles, save = step.name, roles_of(step.name), self._each("PUT", live)
        if name in CALLS:
            callee = self._program.codes[step.b]
            end = step.a + sum(map(stack_cells, callee.parameters))
            yield self._each("PUT", [one for one in kept if step.a <= one < end])
            below = self._each("PUT", [one for one in kept if one < step.a])
            size, frame, prepare = self._program.frames[step.b], step.a, ""
            if name == "CALL_COPY":
                frame, prepare = step.d, f"RECEIVE({place})"
            yield f"CALL({place}, {step.b}, {size}, fp + {frame}, {prepare}, {below})"
            if callee.result is not None:
                if frame != step.a:
                    yield f"fp[{step.a}] = fp[{frame}];"
                yield self._each("GET", {step.a} - in_frame)
        elif name in _INTERPRETED:
            yield f"INTERPRET({place}, {later}, {save})"
        elif name == "AT":
            yield f"statement = {step.b};"
        elif name == "RETURN":
            yield f"RETURN({place}, {save})"
        elif roles is None:
            yield self._each("PUT", kept)
            yield f"DO_IN_FRAME({name}, {place}, {later}, {save}){self._each('GET', kept)}"
        else:
            yield self._each("GET", in_frame.intersection(step.named(roles[0])))
            written = self._each("PUT", in_frame.intersection(step.named(roles[1])))
            jump = f"JUMP_TO(do_{step.d})" if step.is_jump else ""
            if name == "RETURN_VALUE":
                yield f"RETURN_VALUE({place}, {save})"
            else:
                yield f"DO({name}, {place}, {later}, {save}, {written}, {jump})"


def _blank_cells(cells: set[int]) -> Iterator[str]:
    """Cells that lie one behind the other, together."""
    for first in sorted(cell for cell in cells if cell - 1 not in cells):
        end = next(end for end in count(first) if end not in cells)
        yield f"BLANK_CELLS({first}, {end})"


def _int(number: int) -> str:
    """A number as C has it: the smallest one is no literal."""
    return str(number) if number > -(2**31) else "INT32_MIN"
