"""Code objects made ready to run: instructions as functions that give the next one.

A code object is made ready from its last instruction to its first, so that each knows the one
behind it; where it goes elsewhere it looks its target up. This is faster in Python than one loop
that asks for every opcode, and keeps every instruction a few lines of its own: they stand in
`interp.bytecode.vm.control_flow`, `data_movement`, `arrays` and `arithmetic`.

Nothing of this looks at what `interp.bytecode.verifier.verify` has made sure of.
"""

from __future__ import annotations

from collections.abc import Mapping

from interp.bytecode._generated.opcodes import Op
from interp.bytecode.program import Instruction, Program
from interp.bytecode.vm.arithmetic import ArithmeticRules
from interp.bytecode.vm.arrays import ArrayRules
from interp.bytecode.vm.context import Hooks, Rule, Runtime, Site
from interp.bytecode.vm.control_flow import ControlRules
from interp.bytecode.vm.data_movement import MovementRules
from interp.bytecode.vm.state import Operation, State


class ThreadedCode:
    """The code objects of a program, made ready when they are first called.

    ``entries`` are their first operations, ``frames`` how many cells their frames have.
    """

    def __init__(self, program: Program, state: State, hooks: Hooks) -> None:
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
        """The operations of a code object, by the places of their instructions."""
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
