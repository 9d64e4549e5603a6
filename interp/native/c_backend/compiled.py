"""Compiles programs to native code: register code becomes C, which the installed compiler compiles.

A step of the machine becomes a macro call in C that names the step (``compiled.h``). So the effect
of each step is defined once, and a compiled program stops where the machine stops and makes the
same requests.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import count
from pathlib import Path
from typing import Final

from grammar.semantics.types import BOOL, REAL, Type
from interp.bytecode.cell_layout import kind_at
from interp.bytecode.program import CodeKind, Mode, Program, stack_cells
from interp.bytecode.verifier.verify import Verified
from interp.native._core import Core
from interp.native.c_backend.register_code import CALLS, Step, roles_of
from interp.native.c_backend.register_flow import INTERPRETED, RegisterFlow
from interp.native.c_backend.shared_objects import library_of
from interp.native.machine import Machine

#: The maximum number of steps of a routine that is inlined, if it calls no other.
_SMALL: Final = 30
#: The maximum number of steps of a routine that is compiled twice, for calls and the interpreter.
_MOST_TWICE: Final = 150
#: Longer routines are interpreted, because the time of the C compiler grows with the square.
_MOST_STEPS: Final = 5_000
#: The kinds of cells; cells of all other types hold an INT.
_KINDS: Final[Mapping[Type, str]] = {REAL: "REAL", BOOL: "BOOL"}
#: The C types of the kinds.
_IN_C: Final = {"INT": "int32_t", "BOOL": "int32_t", "REAL": "float"}


def source_of(program: Program, core: Core) -> str:
    """Return the register code of a program as C."""
    return "\n".join(_lines(program, core)) + "\n"


def keep(verified: Verified) -> Path:
    """Return the shared object of a program for runs without a trace; compile it if necessary.

    Raises `OSError` as `library_of` does.
    """
    core = Core(verified.image, verified.depths, 0, 0, None)
    return library_of(source_of(verified.program, core))


class CompiledMachine(Machine):
    """Runs a program as native code, otherwise like `interp.native.machine.Machine`.

    Raises `OSError` if the program cannot be compiled.
    """

    def _begin(self, number: int) -> None:
        core = self._core
        core.load(str(library_of(source_of(self._program, core))))
        super()._begin(number)


def _lines(program: Program, core: Core) -> Iterator[str]:
    """Yield the tables, a function for each routine, and the symbols that the module looks up."""
    steps, arrays = [Step(*one) for one in core.steps()], core.arrays()
    firsts = [core.step(number, 0) for number in range(len(program.codes))]
    bodies = map(range, firsts, [*firsts[1:], len(steps)])
    compiled = {
        number: body
        for number, (code, body) in enumerate(zip(program.codes, bodies, strict=True))
        if code.kind is CodeKind.ROUTINE and len(body) <= _MOST_STEPS
    }
    routines = dict[int, _Routine]()
    for number, body in compiled.items():
        routines[number] = _Routine(program, number, steps, body, arrays, routines)
    _find_valued(routines)
    deferred = set[int]().union(*(routine.deferred for routine in routines.values()))
    yield f"#define KRL_TRACED {core.traced}"
    yield '#include "c_backend/compiled.h"'
    yield "static const struct krl_array arrays[] = {"
    for base, width, dimensions, *sizes, third in arrays or [(0, 0, 0, 1, 1, 1, 0)]:
        yield f"{{{base}, {width}, {dimensions}, {{{', '.join(map(str, sizes))}}}, {third}}},"
    yield "};"
    yield "static const struct krl_step steps[] = {"
    for place, (name, a, b, c, d, tag, line, _) in enumerate(steps):
        words = ", ".join(map(_int, (a, b, c, d, line)))
        yield f"{{0, {words}, KRL_STEP_{name}, {int(place in deferred) or tag}}},"
    yield "};"
    for routine in routines.values():
        yield from routine.declarations()
    for routine in routines.values():
        yield from routine.lines()
    entries = sorted(entry for routine in routines.values() for entry in routine.entries)
    yield f"const int32_t krl_entries[] = {{{', '.join(map(str, [*entries, -1]))}}};"
    names = (f"enter_{number}" if number in routines else "NULL" for number in range(len(firsts)))
    largest = max((program.frames[number] for number in routines), default=0)
    yield f"PROGRAM({largest}, {', '.join(names)})"


def _find_valued(routines: Mapping[int, _Routine]) -> None:
    """Remove from ``valued`` of each routine the cells that a call may pass without a value."""
    todo = set(routines)
    while todo:
        for number, missing in routines[todo.pop()].given_without_value():
            if not missing.isdisjoint(routines[number].valued):
                routines[number].valued -= missing
                todo.add(number)


class _Routine:
    """Generates the function of a routine, whose steps are those in ``body``.

    ``compiled`` are all routines that have a function. Steps work on copies of cells, which the C
    compiler keeps in processor registers. Cells themselves are used where other code reads them: at
    stops and calls, and for variables whose address is taken.
    """

    def __init__(
        self,
        program: Program,
        number: int,
        steps: Sequence[Step],
        body: range,
        arrays: Sequence[Sequence[int]],
        compiled: Mapping[int, _Routine],
    ) -> None:
        self._program = program
        self._compiled = compiled
        self._number = number
        self._steps = steps
        self._body = body
        self._flow = RegisterFlow(steps, body)
        self._slots = program.slots(program.codes[number])
        self._kinds = dict(self._kinds_of_variables())
        result = program.codes[number].result
        #: The kind of its result; ``None`` if it has none.
        self._result = None if result is None else _KINDS.get(program.types[result], "INT")
        self._used = {one for place in body for one in steps[place].registers()}
        #: Registers that have no copy, and those that have one.
        self._in_frame = self._addressed(arrays)
        self._copies = self._used - self._in_frame
        self._variables = [one for one in self._copies if one < program.frames[number]]
        stack = self._copies.difference(self._variables)
        self._live = self._flow.live(stack)
        self._restarts = self._flow.restarts(self._live, stack)
        self._counted, self._later = self._flow.blocks()
        #: The number of cells of its parameters, and whether calls store them in the frame instead
        #: of passing them.
        count = len(program.codes[number].parameters)
        self._received = sum(one.cells for one in self._slots[:count])
        self._is_copied = any(one.name == "CALL_COPY" and one.b == number for one in steps)
        #: The cells that calls pass, and those that have a value in every call.
        self._given = range(0 if self._is_copied else self._received)
        self.valued = frozenset(self._given)
        #: Steps that do not check whether their result is finite.
        self.deferred = self._flow.deferred(self._restarts, self._live)

    @property
    def _kind(self) -> str:
        return "INLINED" if len(self._body) <= _MOST_TWICE else "static"

    @property
    def entries(self) -> set[int]:
        """The steps at which the interpreter may enter: the first one and loop heads."""
        return {self._body[0], *self._flow.loops}

    @property
    def _parameters(self) -> str:
        """The parameters of the C function, for the cells that calls pass."""
        return "".join(
            f", {_IN_C[self._kinds[one]] if one in self.valued else 'krl_cell'} p{one}"
            for one in self._given
        )

    def _assigned(self) -> Mapping[int, frozenset[int]]:
        giving = {number for number, one in self._compiled.items() if one._result is not None}
        return self._flow.assigned(self.valued, self._in_frame, giving)

    def given_without_value(self) -> Iterator[tuple[int, frozenset[int]]]:
        """Yield each called routine with the cells that may have no value in that call."""
        assigned = self._assigned()
        for place, valued in assigned.items():
            step = self._steps[place]
            if step.name in CALLS and step.b in self._compiled:
                end = step.a + self._arguments(step)
                without = set(range(step.a, end)).difference(valued)
                yield step.b, frozenset(one - step.a for one in without)

    def _arguments(self, step: Step) -> int:
        """Return the number of cells that a call passes."""
        return sum(map(stack_cells, self._program.codes[step.b].parameters))

    def declarations(self) -> Iterator[str]:
        """Yield the declarations for calls and for the interpreter; small functions are inlined."""
        number, parameters = self._number, self._parameters
        is_small = len(self._body) <= _SMALL and not any(
            self._steps[place].name in CALLS for place in self._body
        )
        yield f"BODY({self._kind}, {number}{parameters});"
        kind = "INLINED" if is_small else "static"
        yield f"{kind} krl_ended call_{number}(PARAMETERS{parameters}) {{"
        handed = "".join(f", p{one}" for one in self._given)
        yield f"return body_{number}(machine, fp, left, open, CALLED, CALLED{handed});"
        yield "}"
        handed = "".join(
            f", VALUE_{self._kinds[one]}(krl_register_at(&fp[{one}]))"
            if one in self.valued
            else f", fp[{one}]"
            for one in self._given
        )
        yield f"static void enter_{number}(PARAMETERS, int32_t at) {{"
        yield self._each("NEED_VALUE", self.valued)
        yield f"body_{number}(machine, fp, left, open, at, at{handed});"
        yield "}"

    def lines(self) -> Iterator[str]:
        """Yield the definition of the function."""
        number, frame, received = self._number, self._program.frames[self._number], self._received
        is_owner = any(code.owner == number for code in self._program.codes if code.captures)
        yield f"BODY({self._kind}, {number}{self._parameters}) {{"
        yield f"ENTER({number}, {max(self._used, default=0) + 1}, {int(is_owner)}) {{"
        assigned = self._assigned()
        yield from self._loop_entries(assigned)
        yield "}"
        yield "start:"
        copied = [one for one in self._copies if one < received]
        if self._is_copied:
            yield self._each("GET", copied)
        else:
            for word, cells in (("", set(self._given) - self.valued), ("_VALUE", self.valued)):
                yield self._each(f"TAKE{word}", cells.intersection(copied))
                yield self._each(f"TAKE{word}_CELL", cells.difference(copied))
        yield self._each("BLANK", [one for one in self._copies if one >= received])
        yield from _blank_cells(set(range(received, frame)) - self._copies)
        for place in self._body:
            yield f"do_{place}:;"
            if place in self._flow.targets:
                known = assigned.get(place, frozenset()).intersection(self._copies)
                yield self._each("KNOWN", known.intersection(self._kinds))
            if place in self._counted:
                yield f"BEGIN({place}, {self._counted[place]})"
            if self._steps[place].line >= 0:
                yield f"STATEMENT({place})"
            yield from self._step(place)
        for place, begun in self._counted.items():
            yield f"WAIT({place}, {begun}, {self._each('PUT', self._live[place])})"
        for place in sorted(set(self._restarts)):
            save = self._each("PUT", self._live[place])
            yield f"OUT({place}, {self._later.get(place, 0)}, {save})"
        yield "leave:"
        yield self._each("PUT", self._variables)
        yield "LEAVE();"
        yield "}"

    def _loop_entries(self, assigned: Mapping[int, frozenset[int]]) -> Iterator[str]:
        for place in self._flow.loops:
            valued = assigned.get(place, frozenset())
            yield f"case {place}:"
            yield self._each("GET_VALUE", valued.intersection(self._copies))
            yield self._each("GET", set(self._variables) - valued)
            yield self._each("BLANK", self._copies.difference(self._variables, valued))
            yield f"goto do_{place};"

    def _kinds_of_variables(self) -> Iterator[tuple[int, str]]:
        """Yield the cells of variables with the kind of value that they hold."""
        for slot in self._slots:
            variable, type_ = slot.variable, self._program.types[slot.variable.type]
            for place in range(slot.cells):
                is_value = variable.mode is Mode.IN
                kind = _KINDS.get(kind_at(type_, place), "INT") if is_value else "INT"
                yield slot.offset + place, kind

    def _each(self, word: str, registers: Iterable[int]) -> str:
        """Return a macro call for each register, with its kind."""
        return "".join(f"{word}({one}, {self._kinds.get(one, 'ANY')})" for one in sorted(registers))

    def _addressed(self, arrays: Sequence[Sequence[int]]) -> frozenset[int]:
        """Return the cells of variables whose address is taken."""
        reached = set()
        for place in self._body:
            name, _, b, c, *_ = self._steps[place]
            if name in ("REFER", "COPY_VIEW"):
                reached.add(b)
            elif name in ("INDEX_LOCAL", "GET_LOCAL", "PUT_LOCAL", "PUT_LOCAL_K"):
                reached.add(c)
            elif re.search("_(WIDE|TWO|THREE)_LOCAL", name):
                reached.add(arrays[c][0])
        variables = [range(slot.offset, slot.offset + slot.cells) for slot in self._slots]
        whole = (cells for cells in variables if not reached.isdisjoint(cells))
        return frozenset(reached.union(*whole))

    def _step(self, place: int) -> Iterator[str]:
        step, out = self._steps[place], self._restarts[place - self._body.start]
        name, roles = step.name, roles_of(step.name)
        if name in CALLS and step.b in self._compiled:
            yield self._call(place, out)
        elif name in CALLS or name in INTERPRETED:
            yield f"goto out_{out};"
        elif name == "CASE":
            yield from self._switch(place, out)
        elif name == "SWITCH":
            pass  # the C compiler makes tables itself
        elif name == "STOP":
            yield f"STOP({out})"
        elif name == "AT":
            yield f"statement = {step.b};"
        elif name == "RETURN":
            yield f"RETURN({out})"
        elif roles is None:  # works on cells from `a` on, and on a view
            cells = [one for one in self._copies if one >= step.a]
            view = range(step.c, step.c + step.tag + 1) if "VIEW" in name else ()
            yield self._each("PUT", {*cells, *self._copies.intersection(view)})
            jump = f"JUMP_TO(do_{step.d})" if step.is_jump else ""
            yield f"DO({name}, {place}, {out}, {self._each('GET', cells)}, {jump})"
        else:
            yield self._each("GET", self._in_frame.intersection(step.named(roles[0])))
            written = self._each("PUT", self._in_frame.intersection(step.named(roles[1])))
            jump = f"JUMP_TO(do_{step.d})" if step.is_jump else ""
            if name == "RETURN_VALUE":
                yield f"RETURN_VALUE({place}, {out}, {self._result})"
            else:
                yield f"DO({name}, {place}, {out}, {written}, {jump})"

    def _switch(self, place: int, out: int) -> Iterator[str]:
        """All CASE steps that follow one another, at the first of them."""
        step = self._steps[place]
        if place > self._body.start and self._flow.is_next_case(place):
            return
        yield self._each("GET", self._in_frame.intersection({step.b}))
        yield f"SWITCH({place}, {out}) {{"
        targets = {step.c: step.d}
        while self._flow.is_next_case(place + 1):
            place += 1
            targets.setdefault(self._steps[place].c, self._steps[place].d)
        for constant, target in targets.items():
            yield f"case {_int(constant)}: goto do_{target};"
        yield "}"

    def _call(self, place: int, out: int) -> str:
        """Return a call; cells are restored if the interpreter continues inside it."""
        step = self._steps[place]
        cells = range(step.a, step.a + self._arguments(step))
        frame, prepare = step.a, ""
        if step.name == "CALL_COPY":
            frame, handed = step.d, ""
            prepare = f"{self._each('PUT', self._copies.intersection(cells))}RECEIVE({place})"
        else:
            handed = "".join(f", {self._handed(step, one)}" for one in cells)
        below = {one for one in (*self._variables, *self._live[place]) if one < step.a}
        result = ""
        if (kind := self._compiled[step.b]._result) is not None:
            result = f"RESULT({step.a}, {kind})"
            result += self._each("PUT", self._in_frame.intersection({step.a}))
        return (
            f"CALL({place}, {out}, call_{step.b}, fp + {frame}, {prepare}, "
            f"{self._each('PUT', below)}, {result}{handed})"
        )

    def _handed(self, step: Step, register: int) -> str:
        """Return the C argument for a register that a call passes."""
        callee, is_copy = self._compiled[step.b], register in self._copies
        if register - step.a in callee.valued:
            where = f"registers[{register}]" if is_copy else f"krl_register_at(&fp[{register}])"
            return f"VALUE_{callee._kinds[register - step.a]}({where})"
        if is_copy:
            return f"krl_cell_of_{self._kinds.get(register, 'ANY')}(registers[{register}])"
        return f"fp[{register}]"


def _blank_cells(cells: set[int]) -> Iterator[str]:
    """Yield one macro call for each run of adjacent cells."""
    for first in sorted(cell for cell in cells if cell - 1 not in cells):
        end = next(end for end in count(first) if end not in cells)
        yield f"BLANK_CELLS({first}, {end})"


def _int(number: int) -> str:
    """Return a number as C text; the smallest one has no literal."""
    return str(number) if number > -(2**31) else "INT32_MIN"
