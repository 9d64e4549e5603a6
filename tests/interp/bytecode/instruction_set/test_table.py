"""The instruction set is one table, and all that depends on it agrees with it."""

from __future__ import annotations

import re
from typing import Any

import pytest

from interp.bytecode._generated.opcodes import Op
from interp.bytecode.assembly.assembler import assemble
from interp.bytecode.instruction_set.generator import products
from interp.bytecode.instruction_set.table import OPERAND_KINDS, instructions
from interp.bytecode.verifier.stack_effects import StackEffects
from interp.bytecode.verifier.verify import verify
from interp.bytecode.vm.executor import Machine
from interp.bytecode.vm.threaded_code import ThreadedCode
from interp.values.operators import PRIMITIVES
from support.files.generated_files import stale

SMALLEST = """
bytecode 4
code MAIN routine "main.src" 1
begin
  RETURN
end
"""


def test_what_is_made_from_the_table_is_up_to_date() -> None:
    """The opcodes, the C header and the document say what the table says."""
    assert [] == stale(products())


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
        effect = " ".join((*primitive.operands, "--", primitive.result))
        assert effect == instructions()[Op[primitive.name.upper()]].effect


def test_sentences_name_the_faults_of_primitives() -> None:
    """What a primitive can fault stands in the sentence of its instruction."""
    for primitive in PRIMITIVES.values():
        if primitive.name == "char_to_int":  # it faults for the empty text, which no cell holds
            continue
        sentence = instructions()[Op[primitive.name.upper()]].sentence
        assert [] == [slug for slug in primitive.faults if f"`{slug}`" not in sentence]


def test_every_rule_of_the_verifier_is_used_by_the_table() -> None:
    """A check or an item that is a rule has a method, and no method is left over."""
    written = {"any", "same", "enumeration", "reference_to_cell", "reference_to_same", "indices"}
    for one in instructions():
        written |= {check.split()[0] for check in one.checks.split(";") if check}
        written |= set(re.findall(r"(\w+)\(", one.effect))
    rules = (name for name in vars(StackEffects) if re.match("(check|take|push)_", name))
    assert written == {name.partition("_")[2] for name in rules}


@pytest.mark.parametrize("name", [one.name for one in instructions()])
def test_the_machine_does_every_instruction(name: str) -> None:
    """The machine knows what each instruction does, but for what only the trace is told."""
    machine: Any = Machine(verify(assemble(SMALLEST)), "MAIN")
    code: ThreadedCode = machine._threaded
    assert Op[name] in code._rules or "trace" in instructions()[Op[name]].flags
