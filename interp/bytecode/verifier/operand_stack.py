"""Computes the contents of the operand stack at each instruction, by abstract interpretation.

Each instruction pops items of certain types and pushes others. Where two paths meet, their stacks
must be equal. This gives the maximum stack size, and proves that no instruction pops from an empty
stack or misinterprets an item.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from interp.bytecode.program import ENDS, Code, Program, targets
from interp.bytecode.verifier.stack_effects import StackEffects
from interp.bytecode.verifier.stack_types import Refused, Stack
from interp.bytecode.verifier.wellformed import error_at


class Flow:
    """The stacks of one code object of a well-formed program."""

    def __init__(self, program: Program, code: Code) -> None:
        self._code = code
        self._effects = StackEffects(program, code)

    def stacks(self) -> list[Stack | None]:
        """Return the stack before each instruction, or ``None`` for an unreachable one.

        Raises `VerificationError`.
        """
        instructions = self._code.instructions
        found: list[Stack | None] = [None] * len(instructions)
        found[0] = self._effects.empty
        todo = [0]
        while todo:
            place = todo.pop()
            before = found[place]
            assert before is not None, "only what is reached is looked at"
            for after, stack in self._after(place, before):
                if after >= len(instructions):
                    raise error_at(self._code, place, "the code object ends without RETURN")
                if found[after] is None:
                    found[after] = stack
                    todo.append(after)
                elif found[after] is not stack:
                    raise error_at(
                        self._code, place, f"paths meet with different stacks: at {after}"
                    )
        return found

    def largest(self, stacks: Sequence[Stack | None]) -> int:
        """Return the maximum size of the stack in cells."""
        return max((stack.cells for stack in stacks if stack is not None), default=0)

    def _after(self, place: int, before: Stack) -> Iterator[tuple[int, Stack]]:
        """Yield the instructions that can come next, each with the stack before it."""
        instruction = self._code.instructions[place]
        try:
            stack = self._effects.after(instruction, before)
        except Refused as refused:
            raise error_at(self._code, place, str(refused)) from None
        for target in targets(instruction):
            yield target, self._effects.at_target(instruction.op, stack)
        if instruction.op not in ENDS:
            yield place + 1, stack
