"""Many programs on several executors: in shards, the same whoever runs them."""

from __future__ import annotations

import gc
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import count
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
from conformance.differential.runs import EXECUTORS, Prepared, is_available, trace_of
from grammar.generation.closed.programs import seeded
from grammar.syntax.build import builder
from interp.values.faults import LinkError
from support.parallel.ordered_map import ordered_map
from support.parallel.workers import WorkersError

_SHARD: Final = 50
#: After so many shards the front end of a process begins anew: what it remembers of programs, some
#: 100 kB each, would fill the memory.
_LIFE: Final = 20
#: When a world interferes, a smaller program may need another seed for it to do so again.
_SEEDS: Final = 4
#: So many are reduced; of the others only the numbers are reported.
_MOST_REDUCED: Final = 20


@dataclass(frozen=True, slots=True)
class Finding:
    """A program on which an executor diverges from the reference, made small if there is time."""

    number: int
    difference: Difference
    files: Files
    statements: int | None = None


@dataclass(frozen=True, slots=True)
class Findings:
    """What a campaign gave; ``ends`` is how programs ended, by the word for it.

    A program that no executor takes, as the check finds an error in it, ends with "LinkError".
    ``counts`` has how many programs reached each of the ``rules``, under the kind "rule".
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
    """What a process does at a time: programs from ``first`` to before ``end``."""

    seed: int
    first: int
    end: int
    executors: tuple[str, ...]
    rules: Needs


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
    scheduler: str | None = None,
    rules: Needs = MappingProxyType({}),
) -> Findings:
    """Run so many programs on executors, of which the first is the reference.

    ``jobs`` processes of this machine do it, or the Dask cluster whose ``scheduler`` has this
    address; reducing what was found is left to the process that asks. ``on_done`` is called with
    how many programs were done since the last call. Of ``rules`` is counted how many programs reach
    them. The result depends on ``programs``, ``seed``, ``executors`` and ``rules`` alone. Raises
    `support.parallel.workers.WorkersError`, also where a worker has not these executors.
    """
    names = tuple(executors)
    wanted = dict(rules)
    shards = [
        _Shard(seed, first, min(first + _SHARD, programs), names, wanted)
        for first in range(0, programs, _SHARD)
    ]
    findings: list[Finding] = []
    counts: Counts = Counter()
    ends: Counter[str] = Counter()
    facts = 0
    done = ordered_map(
        _run, ((shard,) for shard in shards), jobs=min(jobs, len(shards)), scheduler=scheduler
    )
    for shard, outcome in zip(shards, done, strict=True):
        findings += outcome.findings
        counts.update(outcome.counts)
        ends.update(outcome.ends)
        facts += outcome.facts
        on_done(shard.end - shard.first)
    reduced = [
        _reduced(one, seed, names[0]) if place < _MOST_REDUCED else one
        for place, one in enumerate(findings)
    ]
    return Findings(programs, seed, names, tuple(reduced), counts, ends, facts, rules)


#: Counts the shards that this process has run.
_shards_run = count(1)


@contextmanager
def _unlittered() -> Iterator[None]:
    """Garbage is looked for seldom while a shard runs, and not in what was there before.

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


def _run(shard: _Shard) -> _Outcome:
    absent = [name for name in shard.executors if not is_available(name)]
    if absent:
        raise WorkersError(f"a worker on {node()} has no executor {min(absent)}")
    if next(_shards_run) % _LIFE == 0:
        builder.cache_clear()
    with _unlittered():
        return _run_all(shard)


def _run_all(shard: _Shard) -> _Outcome:
    found = _Outcome([], Counter(), Counter(), 0)
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
    return _Outcome(found.findings, found.counts, found.ends, facts)


def _reduced(finding: Finding, seed: int, reference: str) -> Finding:
    """A difference of the same kind on the same executor, in a program as small as can be."""
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
        "rules": {rule: found.counts["rule", rule] for rule in found.rules},
    }
