"""Faults planted into the instructions of the machine in Python, by table.

A mutant replaces the maker of one instruction's operations by a wrong one
(`interp.bytecode.vm.context`). What can be wrong follows from the row of the instruction set:
instructions with two operands take them the wrong way round, those with a constant take its
neighbour, jumps go the wrong way. What would change nothing (the operands of a sum exchanged) is
left out.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from conformance.differential.fault_patterns import (
    Change,
    Rules,
    before,
    behind,
    change_top,
    computing,
    doing,
    exchange,
    instead,
    quiet,
    taking,
    twice,
    with_operands,
)
from conformance.differential.instruction_faults import OF_ITS_OWN
from interp.bytecode._generated.opcodes import Op
from interp.bytecode.instruction_set.table import Shape, instructions
from interp.bytecode.vm.context import Rule, Site
from interp.bytecode.vm.state import Operation, State

#: A mutant that never comes to an end is stopped.
_ENDLESS: Final = 100_000


@dataclass(frozen=True, slots=True)
class Mutant:
    """A planted fault: the instruction, and in words what it does wrong."""

    op: Op
    fault: str
    change: Change

    @property
    def name(self) -> str:
        """Both in one."""
        return f"{self.op.name}: {self.fault}"

    def rule(self, rules: Rules, state: State) -> Rule:
        """The wrong maker; its operations raise when they are called without end."""
        wrong = self.change(rules, state)
        left = [_ENDLESS]

        def made(here: Site, *operands: int) -> Operation:
            operation = wrong(here, *operands)

            def counted() -> Operation | None:
                left[0] -= 1
                if left[0] < 0:
                    raise AssertionError("this never ends")
                return operation()

            return counted

        return made


def mutants() -> tuple[Mutant, ...]:
    """All of them, in the order of the instruction set."""
    return tuple(
        Mutant(Op[row.name], words, change)
        for row in instructions()
        for words, change in (*_by_shape(row), *OF_ITS_OWN.get(row.name, ()))
    )


# --------------------------------------------------------------------------------- by the row

_SYMMETRIC: Final = frozenset({"ADD", "MUL", "EQ", "NE", "AND", "OR", "EXOR"})
_PARTNERS: Final = {
    "ADD": "SUB", "SUB": "ADD", "MUL": "ADD", "DIV": "MUL", "EQ": "NE", "NE": "EQ", "LT": "LE",
    "LE": "LT", "GT": "GE", "GE": "GT", "AND": "OR", "OR": "EXOR", "EXOR": "OR",
}  # fmt: skip
_CONSTANTS: Final = frozenset({"PUSH_INT", "PUSH_CHAR", "PUSH_BOOL", "ADD_CONSTANT"})
_NEIGHBOURS: Final = frozenset(
    "LOAD_LOCAL LOAD_DATA STORE_LOCAL STORE_DATA REF_LOCAL REF_DATA MEMBER INDEX_LOCAL INDEX_DATA"
    " ELEMENT_LOCAL ELEMENT_DATA FOR_DATA".split()
)
_RESULTS: Final = frozenset(
    "LOAD_LOCAL LOAD_DATA LOAD ELEMENT_LOCAL ELEMENT_DATA PUSH_REAL PUSH_ENUM INT_TO_REAL"
    " REAL_TO_INT CHAR_TO_INT INT_TO_CHAR NEG_INT NEG_REAL NOT_BITS NOT_BOOL".split()
)
_READS: Final = frozenset({"LOAD_LOCAL", "LOAD_DATA", "LOAD", "ELEMENT_LOCAL", "ELEMENT_DATA"})


def _by_shape(row: Shape) -> Iterator[tuple[str, Change]]:
    """What can be wrong with any instruction of this kind."""
    op = Op[row.name]
    family, _, kind = row.name.rpartition("_")
    is_binary = len(row.effect.partition("--")[0].split()) == 2 and family in _PARTNERS
    if is_binary:
        if family not in _SYMMETRIC:
            yield "the operands are exchanged", before(exchange, op)
        yield "the first operand is the result", computing(lambda left, _right: left)
        yield "the result is a little off", behind(change_top, op)
        partner = Op.__members__.get(f"{_PARTNERS[family]}_{kind}")
        if partner is not None:
            yield f"does what {partner.name} does", doing(partner)
    if row.name.startswith("UNLESS_"):
        yield from _unless(row, op)
    if row.name in _CONSTANTS:
        yield (
            "the constant is one more",
            with_operands(lambda n: (n ^ 1 if n in (0, 1) else n + 1,), op),
        )
    if row.name in _NEIGHBOURS:
        yield "means the next cell", with_operands(lambda place, *rest: (place + 1, *rest), op)
    if row.name in _RESULTS:
        yield "the value is a little off", behind(change_top, op)
    if row.name in _READS:
        yield "no value is 0", quiet(op, "uninitialised")
    if row.name.startswith("TELL"):
        yield "reports nothing", instead(lambda _state, here, _operands: here.after)
        yield "reports twice", twice(op)


def _unless(row: Shape, op: Op) -> Iterator[tuple[str, Change]]:
    _, relation, kind = row.name.split("_")
    partner = Op.__members__.get(f"UNLESS_{_PARTNERS[relation]}_{kind}")
    yield "never goes elsewhere", taking(2, goes=False)
    yield "always goes elsewhere", taking(2, goes=True)
    if partner is not None:
        yield f"does what {partner.name} does", doing(partner)
    if relation not in _SYMMETRIC:
        yield "the operands are exchanged", before(exchange, op)
