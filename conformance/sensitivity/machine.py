"""Faults of the machine in Python: those that `krl bench fuzz` plants, run by cases.

A case finds one where the machine no longer does what the tree interpreter does.
"""

from __future__ import annotations

from functools import cached_property
from typing import Any, Final

from conformance.differential.hunt import mutated
from conformance.differential.mutants import Mutant, mutants
from conformance.differential.runs import Prepared as Theirs
from conformance.sensitivity.planting import EVERY_SUITE, Fault, on
from interp.bytecode.verify import Verified
from interp.events import Sink
from interp.executor import Executor
from interp.executors import Prepared
from interp.program import Limits

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


class _Shared(Theirs):
    """The same program, compiled once, as the fuzzer takes it."""

    def __init__(self, prepared: Prepared) -> None:
        super().__init__(prepared.program)
        self._prepared = prepared

    @property
    def start(self) -> str:
        """The routine to begin with."""
        return self.program.start(self._prepared.routine).name

    @cached_property
    def verified(self) -> Verified:
        """As bytecode that was verified."""
        return self._prepared.verified


def _planted(mutant: Mutant) -> Any:
    factory = mutated(mutant)

    def make(_right: Any) -> Any:
        def executor(
            self: Prepared, _name: str, limits: Limits, sink: Sink | None = None
        ) -> Executor:
            assert sink is not None, "the controller has one"
            return factory(_Shared(self), limits, sink)

        return executor

    return on(Prepared, "executor", make)
