"""Faults of the machine in Python: those that `krl bench fuzz` plants, run by cases.

A case finds one where the machine no longer does what the tree interpreter does.
"""

from __future__ import annotations

from typing import Any, Final

from conformance.differential.fault_catalogue import Mutant, mutants
from conformance.differential.fault_detection import mutated
from conformance.sensitivity.planted_fault import EVERY_SUITE, Fault, on
from interp.executors import Prepared
from interp.port.events import Sink
from interp.port.executor import Executor
from interp.program.load import Limits

__all__ = ["faults", "instructions"]

_GROUP: Final = "the machine"


def faults() -> tuple[Fault, ...]:
    """All of them, in the order of the instruction set."""
    return tuple(
        Fault(_GROUP, one.name, EVERY_SUITE, _planted(one), executor="vm", op=one.op.name)
        for one in mutants()
    )


def instructions(prepared: Prepared) -> frozenset[str]:
    """The names of the instructions that a program has."""
    codes = prepared.verified.program.codes
    return frozenset(one.op.name for code in codes for one in code.instructions)


def _planted(mutant: Mutant) -> Any:
    factory = mutated(mutant)

    def make(right: Any) -> Any:
        def executor(
            self: Prepared, name: str, limits: Limits, sink: Sink | None = None
        ) -> Executor:
            if name != "vm":
                return right(self, name, limits, sink)  # type: ignore[no-any-return]
            assert sink is not None, "the controller has one"
            return factory(self, limits, sink)

        return executor

    return on(Prepared, "executor", make)
