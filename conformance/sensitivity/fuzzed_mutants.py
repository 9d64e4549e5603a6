"""The share of mutants of the Python machine that the fuzzer detects.

A mutant is found by the first generated program on which the mutated machine behaves differently
from the tree interpreter.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, Final

from conformance.differential.campaign import world_seed
from conformance.differential.divergence import prepared
from conformance.differential.runs import EXECUTORS, trace_of
from conformance.differential.traces import Fact
from conformance.evaluation.time_limit import TimeOver, time_limited
from conformance.sensitivity.code_exchange import InvalidMutant, load
from conformance.sensitivity.mutants import Mutant, drawn
from grammar.generation.programs import seeded
from interp.executors import Prepared
from support.parallel.ordered_map import ordered_map

#: What mutants are drawn from, in `conformance.sensitivity.mutated_code.PACKAGES`.
MACHINE: Final = "machine"
#: So many seconds of computing, and of waiting, a program may take with a mutant; usually it takes
#: a hundredth of the first.
_COMPUTING, _LASTING = 1.0, 120.0


@dataclass(frozen=True, slots=True)
class Verdict:
    """A mutant, and the number of the program that found it, or ``None``.

    ``runs`` is how many programs were run; 0 if the mutant is invalid.
    """

    mutant: Mutant
    found_by: int | None
    runs: int


@dataclass(slots=True)
class ReferenceRuns:
    """Programs with known traces, generated one after another when they are needed."""

    seed: int
    most: int
    _programs: list[tuple[int, Prepared, list[Fact]]] = field(default_factory=list)
    _next: int = 0

    def examine(self, mutant: Mutant) -> Verdict:
        """Run programs with a mutant until one finds it."""
        runs = 0
        try:
            while runs < len(self._programs) or self._grow():
                with mutant.plant():
                    for number, program, expected in self._programs[runs:]:
                        runs += 1
                        if self._trace(number, program, "vm") != expected:
                            return Verdict(mutant, number, runs)
        except InvalidMutant:
            runs = 0
        return Verdict(mutant, None, runs)

    def _trace(self, number: int, program: Prepared, executor: str) -> list[Fact]:
        """Return the facts of a run, or none if it never ends."""
        try:
            with time_limited(_COMPUTING, _LASTING):
                return trace_of(program, EXECUTORS[executor], world_seed(self.seed, number))
        except TimeOver:
            return []

    def _grow(self) -> bool:
        """Make as many programs again; those on which the machine itself is wrong are left out."""
        before = len(self._programs)
        numbers = range(self._next, min(max(4, 2 * self._next), self.most))
        for number in numbers:
            program = prepared(seeded(self.seed, number).files)
            expected = self._trace(number, program, "tree")
            if self._trace(number, program, "vm") == expected:
                self._programs.append((number, program, expected))
        self._next = numbers.stop
        return len(self._programs) > before


def examine_mutants(
    count: int,
    programs: int,
    seed: int,
    jobs: int = 1,
    on_done: Callable[[int], None] = lambda _count: None,
) -> list[Verdict]:
    """Return verdicts on ``count`` mutants, each on at most this number of programs.

    The result does not depend on ``jobs``. ``on_done`` is called with the number of mutants
    examined since the last call.
    """
    every = drawn(seed, count, [MACHINE])
    shares = [every[first::jobs] for first in range(jobs)]
    found: dict[Mutant, Verdict] = {}
    tasks = ((share, seed, programs) for share in shares)
    for share, verdicts in zip(shares, ordered_map(_examined, tasks, jobs=jobs), strict=True):
        found.update(zip(share, verdicts, strict=True))
        on_done(len(share))
    return [found[one] for one in every]


def _examined(mutants: Sequence[Mutant], seed: int, programs: int) -> list[Verdict]:
    load()
    runs = ReferenceRuns(seed, programs)
    return [runs.examine(one) for one in mutants]


def record_of(verdicts: Sequence[Verdict], programs: int, seed: int) -> dict[str, Any]:
    """Return the verdicts as data for JSON; the share is that of valid mutants."""
    valid = [one for one in verdicts if one.runs]
    runs = sorted(one.runs for one in valid if one.found_by is not None)
    fields = ("file", "line", "function", "source", "was", "now")
    return {
        "bench": "fuzz",
        "programs": programs,
        "seed": seed,
        "mutants": len(valid),
        "found": len(runs),
        "share": round(len(runs) / len(valid), 4) if valid else 0.0,
        "median_runs": runs[len(runs) // 2] if runs else None,
        "verdicts": [
            {
                **{name: getattr(one.mutant, name) for name in fields},
                "program": one.found_by,
                "runs": one.runs,
            }
            for one in valid
        ],
    }
