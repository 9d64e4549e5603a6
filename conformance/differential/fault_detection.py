"""How many planted faults the fuzzer finds: mutants of the machine run on generated programs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, Final

from conformance.differential.campaign import world_seed
from conformance.differential.divergence import prepared
from conformance.differential.fault_catalogue import Mutant, mutants
from conformance.differential.runs import EXECUTORS, Factory, Prepared, trace_of
from conformance.differential.traces import Fact
from grammar.generation.closed.programs import seeded
from interp.bytecode._generated.opcodes import Op
from interp.bytecode.program import Instruction
from interp.bytecode.vm.executor import Machine
from interp.port.events import Sink
from interp.program.load import Limits
from support.parallel.ordered_map import ordered_map

REFERENCE: Final = "tree"


@dataclass(frozen=True, slots=True)
class Verdict:
    """A mutant, and the number of the program that caught it; ``None`` where none did."""

    op: str
    fault: str
    caught_by: int | None
    runs: int


def mutated(mutant: Mutant) -> Factory:
    """The machine in Python with this fault planted."""

    def made(program: Prepared, limits: Limits, sink: Sink) -> Machine:
        machine = Machine(program.verified, program.start, limits, sink)
        threads, state, services = machine._threaded, machine._state, machine._services

        def telling(op: Op) -> Callable[..., Any]:
            return lambda here, *operands: services.tell(Instruction(op, operands), here.after)

        rules = {op: telling(op) for op in Op if op.name.startswith("TELL")}
        rules.update(threads._rules)
        threads._rules = {**rules, mutant.op: mutant.rule(rules, state)}
        return machine

    return made


@dataclass(slots=True)
class ReferenceRuns:
    """Programs of which the traces are known; made one after the other, as they are needed."""

    seed: int
    most: int
    _programs: list[tuple[int, Prepared, list[Fact], frozenset[Op]]] = field(default_factory=list)
    _next: int = 0

    def examine(self, mutant: Mutant) -> Verdict:
        """Run a mutant on programs that have its instruction, until one detects it."""
        factory, runs, place = mutated(mutant), 0, 0
        while place < len(self._programs) or self._grow():
            number, program, expected, ops = self._programs[place]
            place += 1
            if mutant.op not in ops:
                continue
            runs += 1
            if trace_of(program, factory, world_seed(self.seed, number)) != expected:
                return Verdict(mutant.op.name, mutant.fault, number, runs)
        return Verdict(mutant.op.name, mutant.fault, None, runs)

    def _grow(self) -> bool:
        """Make another program; one on which the machine itself is wrong is left out."""
        while self._next < self.most:
            number = self._next
            self._next += 1
            program = prepared(seeded(self.seed, number).files)
            world = world_seed(self.seed, number)
            expected = trace_of(program, EXECUTORS[REFERENCE], world)
            if trace_of(program, EXECUTORS["vm"], world) == expected:
                codes = program.verified.program.codes
                ops = frozenset(one.op for code in codes for one in code.instructions)
                self._programs.append((number, program, expected, ops))
                return True
        return False


def examine_mutants(
    programs: int, seed: int, jobs: int = 1, on_done: Callable[[int], None] = lambda _count: None
) -> list[Verdict]:
    """Run all mutants, each on so many programs at most; the result does not depend on ``jobs``.

    ``on_done`` is called with how many mutants were examined since the last call.
    """
    count = len(mutants())
    if jobs <= 1:
        runs = ReferenceRuns(seed, programs)
        alone: list[Verdict] = []
        for mutant in mutants():
            alone.append(runs.examine(mutant))
            on_done(1)
        return alone
    shares = [tuple(range(first, count, jobs)) for first in range(jobs)]
    found: dict[int, Verdict] = {}
    tasks = ((share, seed, programs) for share in shares)
    for share, verdicts in zip(shares, ordered_map(_examined, tasks, jobs=jobs), strict=True):
        found.update(zip(share, verdicts, strict=True))
        on_done(len(share))
    return [found[number] for number in range(count)]


def _examined(numbers: Sequence[int], seed: int, programs: int) -> list[Verdict]:
    runs, known = ReferenceRuns(seed, programs), mutants()
    return [runs.examine(known[number]) for number in numbers]


def record_of(verdicts: Sequence[Verdict], programs: int, seed: int) -> dict[str, Any]:
    """What is written as JSON."""
    caught = [one for one in verdicts if one.caught_by is not None]
    runs = sorted(one.runs for one in caught)
    return {
        "bench": "fuzz",
        "programs": programs,
        "seed": seed,
        "mutants": len(verdicts),
        "caught": len(caught),
        "share": round(len(caught) / len(verdicts), 4),
        "median_runs": runs[len(runs) // 2] if runs else None,
        "missed": [f"{one.op}: {one.fault}" for one in verdicts if one.caught_by is None],
        "verdicts": [
            {"instruction": one.op, "fault": one.fault, "program": one.caught_by, "runs": one.runs}
            for one in verdicts
        ],
    }
