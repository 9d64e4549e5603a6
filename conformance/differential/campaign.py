"""Fuzzing campaigns: many programs on several executors, in shards that any process can run."""

from __future__ import annotations

import gc
import time
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
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


@dataclass(slots=True)
class Findings:
    """The result of a campaign, or of a part of it; ``ends`` counts how programs ended.

    A program that the check rejects ends with "LinkError". ``counts`` has, among others, the number
    of programs that reached each of the ``rules``, with the kind "rule".
    """

    seed: int
    executors: tuple[str, ...]
    rules: Needs
    programs: int = 0
    findings: list[Finding] = field(default_factory=list)
    counts: Counts = field(default_factory=Counter)
    ends: Counter[str] = field(default_factory=Counter)
    facts: int = 0

    def add(self, other: Findings) -> None:
        """Add the result of another part."""
        self.programs += other.programs
        self.findings += other.findings
        self.counts.update(other.counts)
        self.ends.update(other.ends)
        self.facts += other.facts


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
    given = seed, tuple(executors), dict(rules)
    whole = Findings(*given)
    numbers = range(programs)
    shards = [numbers[first : first + _SHARD] for first in range(0, programs, _SHARD)]
    end = float("inf") if minutes is None else time.monotonic() + 60 * minutes
    started = takewhile(lambda _shard: time.monotonic() < end, shards)
    tasks = ((*given, shard) for shard in started)
    done = ordered_map(_run, tasks, jobs=min(jobs, len(shards)), scheduler=scheduler)
    for part in done:
        whole.add(part)
        on_done(part.programs)
    for place, one in enumerate(whole.findings[:_MOST_REDUCED]):
        whole.findings[place] = _reduced(one, seed, whole.executors[0])
    return whole


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


def _run(seed: int, executors: tuple[str, ...], rules: Needs, numbers: range) -> Findings:
    """Return the result of the programs with some numbers; a process does that at once."""
    absent = [name for name in executors if not is_available(name)]
    if absent:
        raise WorkersError(f"a worker on {node()} has no executor {min(absent)}")
    if next(_shards_run) % _LIFE == 0:
        builder.cache_clear()
    found = Findings(seed, executors, rules, len(numbers))
    with _gc_relaxed():
        for number in numbers:
            _run_program(found, number)
    return found


def _run_program(found: Findings, number: int) -> None:
    files = seeded(found.seed, number).files
    program = loaded(files)
    if program is None:
        found.ends["LinkError"] += 1
        return
    world = world_seed(found.seed, number)
    reference, *others = found.executors
    expected = trace_of(program, EXECUTORS[reference], world)
    for name in others:
        where = diverged(program, name, expected, world)
        if where is not None:
            found.findings.append(Finding(number, where, files))
    executed = counted(program, expected)
    found.counts.update(executed)
    found.counts.update(("rule", rule) for rule in reached(found.rules, executed))
    found.ends[str(expected[-1][0])] += 1
    found.facts += len(expected)


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
