"""The instruction set is one table, and all that depends on it agrees with it."""

from __future__ import annotations

from typing import Any

import pytest

from interp.bytecode._generated.opcodes import Op
from interp.bytecode.assembly.assembler import assemble
from interp.bytecode.instruction_set import OPERAND_KINDS, instructions, outdated
from interp.bytecode.verifier.stack_effects import StackEffects
from interp.bytecode.verifier.verify import verify
from interp.bytecode.vm.executor import Machine
from interp.bytecode.vm.threaded_code import Threads
from interp.values.operators import PRIMITIVES

SMALLEST = """
bytecode 2
code MAIN routine "main.src" 1
begin
  RETURN
end
"""


def test_what_is_made_from_the_table_is_up_to_date() -> None:
    """The opcodes, the C header and the document say what the table says."""
    assert [] == outdated()


def test_numbers_are_places() -> None:
    """Opcodes count from 0 without a gap, so that a table of them has no holes."""
    assert list(range(len(Op))) == [one.number for one in instructions()]
    assert [op.name for op in Op] == [one.name for one in instructions()]


def test_operands_are_of_known_kinds() -> None:
    """Every kind of operand is described, and every described kind is used."""
    used = {kind for one in instructions() for kind in one.operands}
    assert set(OPERAND_KINDS) == used


def test_every_primitive_is_an_instruction_of_its_kinds() -> None:
    """An operator has the operands and the result that `interp.values.operators` gives it."""
    for primitive in PRIMITIVES.values():
        if {"ENUM", "FRAME"} & {*primitive.operands}:
            assert primitive.name.upper() in Op.__members__
            continue
        effect = instructions()[Op[primitive.name.upper()]].effect
        assert effect is not None
        assert (primitive.operands, (primitive.result,)) == (effect.takes, effect.leaves)


def test_sentences_name_the_faults_of_primitives() -> None:
    """What a primitive can fault stands in the sentence of its instruction."""
    for primitive in PRIMITIVES.values():
        if primitive.name == "char_to_int":  # it faults for the empty text, which no cell holds
            continue
        sentence = instructions()[Op[primitive.name.upper()]].sentence
        assert [] == [slug for slug in primitive.faults if f"`{slug}`" not in sentence]


@pytest.mark.parametrize("name", [one.name for one in instructions()])
def test_every_instruction_is_verified_and_done(name: str) -> None:
    """The verifier knows the effect of each instruction, and the machine what it does."""
    program = assemble(SMALLEST)
    effects: Any = StackEffects(program, program.codes[0])
    assert Op[name] in effects._rules or instructions()[Op[name]].effect is not None
    machine: Any = Machine(verify(program), "MAIN")
    threads: Threads = machine._threads
    assert Op[name] in threads._rules or name.startswith("TELL")
