"""The verifier: checks that a program keeps the invariants on which executors rely.

`verify` returns a `Verified` program or raises `VerificationError`. Executors do not check again
that

- every number refers to something: types, texts, entries, code objects, faults; every type has a
  size and is composed of types with smaller numbers; the data lists and any one frame together have
  at most `MAX_CELLS` cells;
- every cell has one type, which never changes, and every load and store uses this type; a constant
  is a value of its type; a REAL is finite;
- every instruction finds its operands on the stack; the stack of a code object never has more than
  ``Code.stack`` cells and is empty at the beginning of a statement;
- a reference refers to existing cells of the stated type. References exist only on the stack and in
  parameters, so none outlives its target; the sizes of a view are those of its array;
- every path through a code object ends with RETURN, RETURN_VALUE or FAIL; jump targets are
  instructions;
- every cycle of instructions contains a LINE or an ASK, and no routine is called before the first
  LINE, so a statement budget ends every program; a condition has no cycle and no LINE;
- a request has the fields of the request that it names, and passes only actions and conditions of
  its own code object.

Checked at run time are missing values, indices, overflow, the depth of calls, and the total size of
all frames.
"""

from __future__ import annotations

from array import array
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from graphlib import CycleError, TopologicalSorter

from interp.bytecode._generated.opcodes import Op
from interp.bytecode.image.image import write_image
from interp.bytecode.instruction_set.table import instructions
from interp.bytecode.program import Code, CodeKind, Program, successors, targets
from interp.bytecode.verifier.operand_stack import Flow
from interp.bytecode.verifier.stack_types import Stack
from interp.bytecode.verifier.wellformed import VerificationError, check_form, error_at

__all__ = ["VerificationError", "Verified", "measured", "stacks_needed", "verify"]

_LONGEST_STACK = 1 << 16


@dataclass(frozen=True)  # without slots, as it keeps its image
class Verified:
    """A program that has passed the verifier.

    ``depths`` has the stack size in cells before each instruction of all code objects, or -1 for an
    unreachable one, as 32-bit integers for the machine in C.
    """

    program: Program
    depths: bytes

    @cached_property
    def image(self) -> bytes:
        """The program as an image, encoded once for all machines that run it."""
        return write_image(self.program)


def verify(program: Program) -> Verified:
    """Check a program; raises `VerificationError`."""
    check_form(program)
    depths = array("i")
    for code in program.codes:
        stacks = _checked_body(program, code)
        depths.extend(-1 if one is None else one.cells for one in stacks)
    return Verified(program, depths.tobytes())


def measured(program: Program) -> Program:
    """Return the program with the stack sizes that its code objects need.

    Sizes are wrong if the program breaks other rules; see `stacks_needed`.
    """
    pairs = zip(program.codes, stacks_needed(program), strict=True)
    codes = (replace(code, stack=needed) for code, needed in pairs)
    return replace(program, codes=tuple(codes))


def stacks_needed(program: Program) -> list[int]:
    """Return the maximum stack size of each code object in cells; 0 if it breaks another rule."""
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
        raise VerificationError(f"{code.name}: the stack needs {needed} cells: not {code.stack}")
    if code.kind is CodeKind.CONDITION:
        _check_condition(code)
    else:
        _check_start(code)
        _check_cycles(code, stacks)
    return stacks


def _check_condition(code: Code) -> None:
    """Check that a condition has forward jumps only, and changes nothing of the program."""
    for place, instruction in enumerate(code.instructions):
        if instruction.op in _SIDE_EFFECTS:
            raise error_at(code, place, "a condition cannot change anything")
        if any(target <= place for target in targets(instruction)):
            raise error_at(code, place, "a condition can only jump forwards")


def _check_start(code: Code) -> None:
    """Check that nothing is called or requested before the first statement begins."""
    todo, seen = [0], {0}
    while todo:
        place = todo.pop()
        instruction = code.instructions[place]
        if instruction.op in (Op.CALL, Op.ASK):
            raise error_at(code, place, "a LINE is required before a call or a request")
        if instruction.op is not Op.LINE:
            for after in successors(place, instruction):
                if after not in seen:
                    seen.add(after)
                    todo.append(after)


def _check_cycles(code: Code, stacks: Sequence[Stack | None]) -> None:
    """Check that every cycle contains a LINE or an ASK."""
    reached = (place for place, stack in enumerate(stacks) if stack is not None)
    try:
        TopologicalSorter({place: _uncounted(code, place) for place in reached}).prepare()
    except CycleError as error:
        place = max(error.args[1])
        raise error_at(code, place, "a cycle without a LINE or an ASK") from None


def _uncounted(code: Code, place: int) -> Iterator[int]:
    instruction = code.instructions[place]
    if instruction.op not in (Op.LINE, Op.ASK):
        yield from successors(place, instruction)
