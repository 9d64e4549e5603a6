"""The verifier: whether a program keeps the invariants that executors rely on.

`verify` gives a `Verified` program, or raises `VerificationError`. An executor may rely on this
without looking again:

- every number names something: types, texts, entries, code objects, faults; every type has a size,
  what it is made of has a smaller number, and the data lists and any frame together have at most
  `MAX_CELLS` cells;
- every cell has one kind, which never changes: what is loaded from it or stored in it is of that
  kind; a constant is a value of its kind; a REAL is finite;
- every instruction finds on the stack what it takes, and the stack of a code object never has more
  than ``Code.stack`` cells; a statement begins with an empty one;
- a reference leads to cells that are there, of the type that it is said to have. It lies on the
  stack or in a parameter, never elsewhere, so that it never outlives what it refers to; the sizes
  of a view are those of its array;
- every way through a code object ends with RETURN, RETURN_VALUE or FAIL; targets are instructions;
- every circle of instructions has a LINE or an ASK in it, and no routine is called before the first
  LINE, so that a budget of statements ends every program; a condition has no circle and no LINE;
- a request has the fields of the request it names, and hands over actions and conditions of the
  code object it stands in only.

What remains for running: values that are missing, indices, overflow, the depth of calls, and the
cells of all frames together.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

from interp.bytecode._generated.opcodes import Op
from interp.bytecode.image.writer import write_image
from interp.bytecode.instruction_set.table import instructions
from interp.bytecode.program import Code, CodeKind, Program
from interp.bytecode.verifier.operand_stack import Flow
from interp.bytecode.verifier.stack_types import Stack
from interp.bytecode.verifier.successors import successors, targets
from interp.bytecode.verifier.wellformed import VerificationError, check_form

__all__ = ["VerificationError", "Verified", "measured", "stacks_needed", "verify"]

_LONGEST_STACK = 1 << 16


@dataclass(frozen=True)  # without slots, as it keeps its image
class Verified:
    """A program that keeps the rules.

    ``depths`` is for each code object how many cells lie on the stack before each instruction,
    -1 where no way leads to it.
    """

    program: Program
    depths: tuple[tuple[int, ...], ...]

    @cached_property
    def image(self) -> bytes:
        """The program as bytes, made once for all machines that run it."""
        return write_image(self.program)


def verify(program: Program) -> Verified:
    """Check a program; raises `VerificationError`."""
    check_form(program)
    depths = []
    for code in program.codes:
        stacks = _checked_body(program, code)
        depths.append(tuple(-1 if one is None else one.cells for one in stacks))
    return Verified(program, tuple(depths))


def measured(program: Program) -> Program:
    """The program with the sizes of stacks that it needs, as far as it keeps the other rules."""
    pairs = zip(program.codes, stacks_needed(program), strict=True)
    codes = (replace(code, stack=needed) for code, needed in pairs)
    return replace(program, codes=tuple(codes))


def stacks_needed(program: Program) -> list[int]:
    """The most cells that each code object has on the stack, 0 where it breaks other rules."""
    needed = [0] * len(program.codes)
    try:
        check_form(program)
        for number, code in enumerate(program.codes):
            flow = Flow(program, code)
            needed[number] = flow.largest(flow.stacks())
    except VerificationError:
        pass  # running the program reports it
    return needed


# ------------------------------------------------------------------------------- the body

_SIDE_EFFECTS = frozenset(Op(one.number) for one in instructions() if "changes" in one.flags)


def _checked_body(program: Program, code: Code) -> list[Stack | None]:
    flow = Flow(program, code)
    stacks = flow.stacks()
    needed = flow.largest(stacks)
    if needed > _LONGEST_STACK:
        raise VerificationError(f"{code.name}: the stack is too large")
    if needed != code.stack:
        raise VerificationError(f"{code.name}: the stack has {needed} cells, not {code.stack}")
    if code.kind is CodeKind.CONDITION:
        _check_condition(code)
    else:
        _check_start(code)
        _check_circles(code, stacks)
    return stacks


def _check_condition(code: Code) -> None:
    for place, instruction in enumerate(code.instructions):
        if instruction.op in _SIDE_EFFECTS:
            raise VerificationError(
                f"{code.name}, instruction {place}: a condition has no {instruction.op.name}"
            )
        if any(target <= place for target in targets(instruction)):
            raise VerificationError(f"{code.name}, instruction {place}: a condition goes forwards")


def _check_start(code: Code) -> None:
    """Nothing is called or asked before the first statement begins."""
    todo, seen = [0], {0}
    while todo:
        place = todo.pop()
        instruction = code.instructions[place]
        if instruction.op in (Op.CALL, Op.ASK):
            raise VerificationError(
                f"{code.name}, instruction {place}: a statement has to begin before"
            )
        if instruction.op is not Op.LINE:
            for after in successors(place, instruction):
                if after not in seen:
                    seen.add(after)
                    todo.append(after)


def _check_circles(code: Code, stacks: Sequence[Stack | None]) -> None:
    """Every circle has a LINE or an ASK: without their edges, no instruction leads to itself."""
    done, open_ = 2, 1
    colour = [0] * len(code.instructions)
    for start, stack in enumerate(stacks):
        if stack is None or colour[start]:
            continue
        colour[start] = open_
        todo = [(start, _uncounted(code, start))]
        while todo:
            place, rest = todo[-1]
            after = next(rest, None)
            if after is None:
                colour[place] = done
                todo.pop()
            elif colour[after] == open_:
                raise VerificationError(
                    f"{code.name}, instruction {place}: a circle without a statement"
                )
            elif not colour[after]:
                colour[after] = open_
                todo.append((after, _uncounted(code, after)))


def _uncounted(code: Code, place: int) -> Iterator[int]:
    instruction = code.instructions[place]
    if instruction.op not in (Op.LINE, Op.ASK):
        yield from successors(place, instruction)
