"""Many programs on several executors: in shards, the same however many processes there are."""

from __future__ import annotations

import gc
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from multiprocessing import get_context
from typing import Any, Final

from conformance.differential.coverage import Counts, counted, language, missing
from conformance.differential.divergence import Difference, Files, difference, prepared
from conformance.differential.programs import seeded
from conformance.differential.reduction import reduce_program
from conformance.differential.runs import EXECUTORS, Prepared, trace_of
from interp.faults import LinkError

__all__ = ["Finding", "Findings", "fuzz", "record_of"]

_SHARD: Final = 50
#: After so many shards each, processes make way for new ones: what the front end remembers of
#: programs would fill the memory.
_LIFE: Final = 20
#: When a world interferes, a smaller program may need another seed for it to do so again.
_SEEDS: Final = 4
#: So many are reduced; of the others only their numbers are told.
_MOST_REDUCED: Final = 20


@dataclass(frozen=True, slots=True)
class Finding:
    """A program on which an executor parts from the reference, made small if there is time."""

    number: int
    difference: Difference
    files: Files
    statements: int | None = None


@dataclass(frozen=True, slots=True)
class Findings:
    """What a campaign gave; ``ends`` is how programs ended, by the word for it."""

    programs: int
    seed: int
    executors: tuple[str, ...]
    findings: tuple[Finding, ...]
    counts: Counts
    ends: Counter[str]
    facts: int


@dataclass(frozen=True, slots=True)
class _Shard:
    """What a process does at a time: programs from ``first`` to before ``end``."""

    seed: int
    first: int
    end: int
    executors: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class _Outcome:
    findings: list[Finding]
    counts: Counts
    ends: Counter[str]
    facts: int


def world_seed(seed: int, number: int, attempt: int = 0) -> str:
    """What the world of a program is drawn from."""
    return f"world/{seed}/{number}/{attempt}"


def fuzz(
    programs: int,
    seed: int,
    executors: Sequence[str],
    jobs: int = 1,
    on_done: Callable[[int], None] = lambda _count: None,
) -> Findings:
    """Run so many programs on executors, of which the first is the reference.

    ``on_done`` is told how many programs were done since it was told last. The result depends on
    ``programs``, ``seed`` and ``executors`` alone.
    """
    names = tuple(executors)
    shards = [
        _Shard(seed, first, min(first + _SHARD, programs), names)
        for first in range(0, programs, _SHARD)
    ]
    findings: list[Finding] = []
    counts: Counts = Counter()
    ends: Counter[str] = Counter()
    facts = 0
    for shard, outcome in zip(shards, _outcomes(shards, jobs), strict=True):
        findings += outcome.findings
        counts.update(outcome.counts)
        ends.update(outcome.ends)
        facts += outcome.facts
        on_done(shard.end - shard.first)
    reduced = [
        _reduced(one, seed, names[0]) if place < _MOST_REDUCED else one
        for place, one in enumerate(findings)
    ]
    return Findings(programs, seed, names, tuple(reduced), counts, ends, facts)


def _outcomes(shards: Sequence[_Shard], jobs: int) -> Iterator[_Outcome]:
    if len(shards) <= (1 if jobs > 1 else _LIFE):
        yield from map(_run, shards)
        return
    context = get_context("spawn")
    # `max_tasks_per_child` would be shorter, but can hang (CPython issue 115634).
    for first in range(0, len(shards), jobs * _LIFE):
        with ProcessPoolExecutor(jobs, mp_context=context, initializer=_begin) as pool:
            yield from pool.map(_run, shards[first : first + jobs * _LIFE])


def _begin() -> None:
    """A process begins: what it loads once is none of the garbage that is looked for.

    Syntax trees are many small objects, so looking as seldom as this saves a third of the time.
    """
    prepared(seeded(0, 0).files)
    gc.collect()
    gc.freeze()
    gc.set_threshold(50_000, 20, 100)


def _run(shard: _Shard) -> _Outcome:
    found = _Outcome([], Counter(), Counter(), 0)
    facts = 0
    for number in range(shard.first, shard.end):
        files = seeded(shard.seed, number).files
        program = prepared(files)
        world = world_seed(shard.seed, number)
        reference, *others = shard.executors
        expected = trace_of(program, EXECUTORS[reference], world)
        for name in others:
            parted = difference(name, expected, trace_of(program, EXECUTORS[name], world))
            if parted is not None:
                found.findings.append(Finding(number, parted, files))
        found.counts.update(counted(program, expected))
        found.ends[str(expected[-1][0])] += 1
        facts += len(expected)
    return _Outcome(found.findings, found.counts, found.ends, facts)


def _reduced(finding: Finding, seed: int, reference: str) -> Finding:
    """A difference of the same kind on the same executor, in a program as small as can be."""
    attempts = range(_SEEDS if finding.difference.is_disturbed else 1)
    last = [finding.difference]

    def parts(files: Files) -> bool:
        program = loaded(files)
        if program is None:
            return False
        for attempt in attempts:
            world = world_seed(seed, finding.number, attempt)
            expected = trace_of(program, EXECUTORS[reference], world)
            name = finding.difference.executor
            parted = difference(name, expected, trace_of(program, EXECUTORS[name], world))
            if parted is not None and parted.kind == finding.difference.kind:
                last[0] = parted
                return True
        return False

    reduced = reduce_program(finding.files, parts)
    return Finding(finding.number, last[0], reduced.files, reduced.statements)


def loaded(files: Files) -> Prepared | None:
    """A program ready for executors, ``None`` where it does not check."""
    try:
        return prepared(files)
    except LinkError:
        return None


def record_of(found: Findings, seconds: float) -> dict[str, Any]:
    """What is written as JSON."""
    return {
        "programs": found.programs,
        "seed": found.seed,
        "executors": list(found.executors),
        "seconds": round(seconds, 1),
        "facts": found.facts,
        "ends": dict(sorted(found.ends.items())),
        "differences": [
            {
                "program": one.number,
                "executor": one.difference.executor,
                "expected": one.difference.expected_text,
                "actual": one.difference.actual_text,
                "statements": one.statements,
                "files": dict(one.files),
            }
            for one in found.findings
        ],
        "coverage": {
            kind: {name: found.counts[kind, name] for name in names}
            for kind, names in language().items()
        },
        "missing": missing(found.counts),
    }
