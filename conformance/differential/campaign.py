"""Fuzzing campaigns: many programs on several executors, in shards that any process can run."""

from __future__ import annotations

import gc
import time
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import count, takewhile
from platform import node
from types import MappingProxyType
from typing import Any, Final

from conformance.differential.construct_coverage import (
    Counts,
    Needs,
    counted,
    language,
    missing,
    reached,
)
from conformance.differential.divergence import Difference, Files, diverged, prepared
from conformance.differential.reduction import reduce_program
from conformance.differential.runs import EXECUTORS, trace_of
from grammar.generation.programs import seeded
from grammar.syntax.build import builder
from interp.executors import Prepared, is_available
from interp.values.faults import LinkError
from support.parallel.ordered_map import ordered_map
from support.parallel.workers import WorkersError

_SHARD: Final = 50
#: After so many shards, a process clears the caches of the front end, which grow by about 100 kB
#: for each program.
_LIFE: Final = 20
#: A reduced program may need another seed for its random world to show the difference again; so
#: many are tried.
_SEEDS: Final = 4
#: The largest number of findings that are reduced; of the others only the numbers are reported.
_MOST_REDUCED: Final = 20


@dataclass(frozen=True, slots=True)
class Finding:
    """A program on which an executor diverges from the reference, reduced if it was its turn.

    ``number`` is that of the program, ``statements`` the size of a reduced program.
    """

    number: int
    difference: Difference
    files: Files
    statements: int | None = None


@dataclass(frozen=True, slots=True)
class Findings:
    """The result of a campaign; ``ends`` counts how programs ended.

    A program that the check rejects ends with "LinkError". ``counts`` has, among others, the number
    of programs that reached each of the ``rules``, with the kind "rule".
    """

    programs: int
    seed: int
    executors: tuple[str, ...]
    findings: tuple[Finding, ...]
    counts: Counts
    ends: Counter[str]
    facts: int
    rules: Needs


@dataclass(frozen=True, slots=True)
class _Shard:
    """The unit of work of a process: programs from ``first`` to before ``end``."""

    seed: int
    first: int
    end: int
    executors: tuple[str, ...]
    rules: Needs


@dataclass(frozen=True, slots=True)
class _ShardResult:
    findings: list[Finding]
    counts: Counts
    ends: Counter[str]
    facts: int


def world_seed(seed: int, number: int, attempt: int = 0) -> str:
    """Return the seed of the random world of a program."""
    return f"world/{seed}/{number}/{attempt}"


def fuzz(
    programs: int,
    seed: int,
    executors: Sequence[str],
    jobs: int = 1,
    on_done: Callable[[int], None] = lambda _count: None,
    scheduler: str | None = None,
    rules: Needs = MappingProxyType({}),
    minutes: float | None = None,
) -> Findings:
    """Run ``programs`` random programs on executors, of which the first is the reference.

    Use ``jobs`` processes of this machine, or the Dask cluster whose ``scheduler`` has this
    address. The calling process reduces the findings. ``on_done`` is called with the number of
    programs since its last call. The programs that reach each of the ``rules`` are counted. After
    ``minutes`` no more are started. The result depends only on the number of programs that were
    run, ``seed``, ``executors`` and ``rules``.

    Raises `support.parallel.workers.WorkersError`, also if a worker does not have these executors.
    """
    names = tuple(executors)
    wanted = dict(rules)
    shards = [
        _Shard(seed, first, min(first + _SHARD, programs), names, wanted)
        for first in range(0, programs, _SHARD)
    ]
    end = float("inf") if minutes is None else time.monotonic() + 60 * minutes
    tasks = ((shard,) for shard in takewhile(lambda _shard: time.monotonic() < end, shards))
    findings: list[Finding] = []
    counts: Counts = Counter()
    ends: Counter[str] = Counter()
    facts, run = 0, 0
    done = ordered_map(_run, tasks, jobs=min(jobs, len(shards)), scheduler=scheduler)
    for shard, outcome in zip(shards, done, strict=False):
        run = shard.end
        findings += outcome.findings
        counts.update(outcome.counts)
        ends.update(outcome.ends)
        facts += outcome.facts
        on_done(shard.end - shard.first)
    reduced = [
        _reduced(one, seed, names[0]) if place < _MOST_REDUCED else one
        for place, one in enumerate(findings)
    ]
    return Findings(run, seed, names, tuple(reduced), counts, ends, facts, rules)


#: Counts the shards that this process has run.
_shards_run = count(1)


@contextmanager
def _gc_relaxed() -> Iterator[None]:
    """Collect garbage less often within this context, and ignore objects that existed before.

    Syntax trees are many small objects, so this saves a third of the time.
    """
    before = gc.get_threshold()
    gc.collect()
    gc.freeze()
    gc.set_threshold(50_000, 20, 100)
    try:
        yield
    finally:
        gc.set_threshold(*before)
        gc.unfreeze()


def _run(shard: _Shard) -> _ShardResult:
    absent = [name for name in shard.executors if not is_available(name)]
    if absent:
        raise WorkersError(f"a worker on {node()} has no executor {min(absent)}")
    if next(_shards_run) % _LIFE == 0:
        builder.cache_clear()
    with _gc_relaxed():
        return _run_all(shard)


def _run_all(shard: _Shard) -> _ShardResult:
    found = _ShardResult([], Counter(), Counter(), 0)
    facts = 0
    for number in range(shard.first, shard.end):
        files = seeded(shard.seed, number).files
        program = loaded(files)
        if program is None:
            found.ends["LinkError"] += 1
            continue
        world = world_seed(shard.seed, number)
        reference, *others = shard.executors
        expected = trace_of(program, EXECUTORS[reference], world)
        for name in others:
            where = diverged(program, name, expected, world)
            if where is not None:
                found.findings.append(Finding(number, where, files))
        executed = counted(program, expected)
        found.counts.update(executed)
        found.counts.update(("rule", rule) for rule in reached(shard.rules, executed))
        found.ends[str(expected[-1][0])] += 1
        facts += len(expected)
    return _ShardResult(found.findings, found.counts, found.ends, facts)


def _reduced(finding: Finding, seed: int, reference: str) -> Finding:
    """Return a difference of the same kind on the same executor, in a program of minimal size."""
    attempts = range(_SEEDS if finding.difference.is_disturbed else 1)
    last = [finding.difference]

    def diverges(files: Files) -> bool:
        program = loaded(files)
        if program is None:
            return False
        for attempt in attempts:
            world = world_seed(seed, finding.number, attempt)
            expected = trace_of(program, EXECUTORS[reference], world)
            name = finding.difference.executor
            where = diverged(program, name, expected, world)
            if where is not None and where.kind == finding.difference.kind:
                last[0] = where
                return True
        return False

    reduced = reduce_program(finding.files, diverges)
    return Finding(finding.number, last[0], reduced.files, reduced.statements)


def loaded(files: Files) -> Prepared | None:
    """Return a program ready for executors; ``None`` if the check rejects it."""
    try:
        return prepared(files)
    except LinkError:
        return None


def record_of(found: Findings, seconds: float) -> dict[str, Any]:
    """Return the result of a campaign as JSON."""
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
        "rules": {rule: found.counts["rule", rule] for rule in found.rules},
    }
