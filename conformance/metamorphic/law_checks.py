"""Laws checked on cases and on generated programs, with the results."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from random import Random
from typing import Any, Final

from conformance.metamorphic import control_flow_changes, motion_changes, source_text_changes
from conformance.metamorphic.law import Attempt, Law, run_law
from conformance.metamorphic.motion_programs import moving_program
from conformance.metamorphic.subject import Program
from conformance.suite.case import Case
from grammar.generation.programs import seeded
from support.parallel.ordered_map import ordered_map

#: All laws.
LAWS: Final = (*source_text_changes.LAWS, *control_flow_changes.LAWS, *motion_changes.LAWS)
#: How many generated programs are examined for each one to which a law must apply.
_LOOKED_AT: Final = 6


@dataclass(frozen=True, slots=True)
class LawResult:
    """The result of a law: on how many programs it was tried, and on which it was broken.

    ``inapplicable`` is the number of programs that were examined and to which it does not apply.
    """

    law: Law
    applied: int
    inapplicable: int
    broken: tuple[Attempt, ...]

    @property
    def held(self) -> int:
        """The number of programs on which the law held."""
        return self.applied - len(self.broken)


def try_laws(
    cases: Sequence[Case],
    programs: int,
    seed: int = 1,
    jobs: int = 1,
    on_done: Callable[[int], None] = lambda _count: None,
    scheduler: str | None = None,
) -> list[LawResult]:
    """Try each law on up to ``programs`` cases, generated programs, and moving programs each.

    The seed determines which these are. ``jobs`` processes try the laws, or the Dask cluster at
    ``scheduler`` (`support.parallel.ordered_map`). ``on_done`` is called with 1 after each law.
    """
    running = [case for case in cases if case.phase == "run"]
    tasks = ((number, running, programs, seed) for number in range(len(LAWS)))
    counts = ordered_map(_tried, tasks, jobs=max(1, jobs), scheduler=scheduler)
    found = []
    for law, counted in zip(LAWS, counts, strict=True):
        found.append(LawResult(law, *counted))
        on_done(1)
    return found


def _tried(
    number: int, cases: Sequence[Case], programs: int, seed: int
) -> tuple[int, int, tuple[Attempt, ...]]:
    """Return for the law with this number what `LawResult` has besides the law."""
    law = LAWS[number]
    drawn = list(cases)
    Random(f"{seed}/{law.name}").shuffle(drawn)
    applied, inapplicable = 0, 0
    broken: list[Attempt] = []
    most = programs * _LOOKED_AT
    samples = (
        map(Program, drawn),
        (_program(seed, number) for number in range(most)),
        (_moving_program(seed, number) for number in range(most)),
    )
    for source in samples:
        wanted = programs
        for program in source:
            if not wanted:
                break
            attempt = run_law(law, program, seed)
            if attempt is None:
                inapplicable += 1
                continue
            wanted -= 1
            applied += 1
            if attempt.difference:
                broken.append(attempt)
    return applied, inapplicable, tuple(broken)


@lru_cache(maxsize=256)
def _moving_program(seed: int, number: int) -> Program:
    return Program.of_sample(moving_program(seed, number), f"moving/{seed}/{number}", seconds=60.0)


@lru_cache(maxsize=256)
def _program(seed: int, number: int) -> Program:
    return Program.of_sample(seeded(seed, number), f"generated/{seed}/{number}")


def record_of(results: Sequence[LawResult], programs: int, seed: int) -> dict[str, Any]:
    """Return the results as JSON."""
    return {
        "programs": programs,
        "seed": seed,
        "laws": [
            {
                "name": one.law.name,
                "states": one.law.states,
                "rules": list(one.law.rules),
                "applied": one.applied,
                "held": one.held,
                "inapplicable": one.inapplicable,
                "broken": [
                    {
                        "program": attempt.program,
                        "difference": attempt.difference,
                        "changed": dict(attempt.changed),
                    }
                    for attempt in one.broken
                ],
            }
            for one in results
        ],
    }
