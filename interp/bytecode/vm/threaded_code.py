"""Threaded code: every instruction becomes a function that returns the next function.

A code object is translated from its last instruction to its first, so each operation knows its
successor; jumps look up their target when they are executed. In Python this is faster than a loop
with a dispatch by opcode, and each instruction stays a few lines. The instructions are in
`interp.bytecode.vm.control_flow`, `data_movement`, `arrays` and `arithmetic`.

Nothing that `interp.bytecode.verifier.verify` guarantees is checked again.
"""

from __future__ import annotations

from collections.abc import Mapping

from interp.bytecode._generated.opcodes import Op
from interp.bytecode.program import Instruction, Program
from interp.bytecode.vm.arithmetic import ArithmeticRules
from interp.bytecode.vm.arrays import ArrayRules
from interp.bytecode.vm.context import Rule, Runtime, Site
from interp.bytecode.vm.control_flow import ControlRules
from interp.bytecode.vm.data_movement import MovementRules
from interp.bytecode.vm.services import Services
from interp.bytecode.vm.state import Operation, State


class ThreadedCode:
    """The translated code objects of a program; each is translated at its first call.

    ``entries`` are their first operations, ``frames`` their frame sizes in cells.
    """

    def __init__(self, program: Program, state: State, hooks: Services) -> None:
        self._program = program
        self._hooks = hooks
        self._bodies: dict[int, list[Operation]] = {}
        self.frames = program.frames
        self.entries: list[Operation] = [self._stub(n) for n in range(len(program.codes))]
        owners = frozenset(code.owner for code in program.codes if code.captures)
        runtime = Runtime(program, state, hooks, self.entries, self.frames, owners)
        self._rules: Mapping[Op, Rule] = {
            **ControlRules(runtime).rules(),
            **MovementRules(runtime).rules(),
            **ArrayRules(runtime).rules(),
            **ArithmeticRules(runtime).rules(),
        }

    def body(self, number: int) -> list[Operation]:
        """Return the operations of a code object, by index of the instruction."""
        body = self._bodies.get(number)
        if body is None:
            body = self._bodies[number] = self._made_ready(number)
            self.entries[number] = body[0]
        return body

    def _stub(self, number: int) -> Operation:
        return lambda: self.body(number)[0]

    def _made_ready(self, number: int) -> list[Operation]:
        instructions = self._program.codes[number].instructions
        body: list[Operation] = [_fallen_off] * (len(instructions) + 1)
        for place in range(len(instructions) - 1, -1, -1):
            site = Site(number, place, body, body[place + 1])
            body[place] = self._operation(site, instructions[place])
        return body

    def _operation(self, site: Site, instruction: Instruction) -> Operation:
        rule = self._rules.get(instruction.op)
        if rule is not None:
            return rule(site, *instruction.operands)
        return self._hooks.tell(instruction, site.after)  # what is left is a trace event


def _fallen_off() -> Operation | None:
    raise AssertionError("nothing falls off the end of what was verified")
