"""The runner of cases: every executor with every robot, in any number of processes.

`conformance.evaluation.case_run` says what happens to one case.
"""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from platform import node
from typing import Final

from conformance.evaluation.case_result import CaseResult, Result
from conformance.evaluation.case_run import repeated, run_case
from conformance.evaluation.execution import Setup, missing, observe
from conformance.evaluation.observation import Observation
from conformance.evaluation.verdicts import KnownFailures
from conformance.suite.case import Case
from support.parallel.ordered_map import ordered_map
from support.parallel.workers import WorkersError

#: The number of cases that a process receives at once.
_SHARE: Final = 8


class Stopped(BaseException):
    """What a signal handler raises to end `run_cases` early."""


def run_cases(
    cases: Sequence[Case],
    executors: Sequence[str] = ("tree",),
    robots: Sequence[str] = ("none",),
    known: KnownFailures | None = None,
    jobs: int | None = None,
    on_done: Callable[[int], None] = lambda _count: None,
    scheduler: str | None = None,
    on_stopped: Callable[[list[str]], object] = lambda _running: None,
) -> list[CaseResult]:
    """Run cases in ``jobs`` processes, by default one per core; return results in their order.

    ``scheduler`` is the address of a Dask cluster that runs them instead. ``on_done`` is called
    with the number of finished cases. A case that kills its process has failed, but does not affect
    others. If a signal handler raises `Stopped`, ``on_stopped`` is called with the cases that were
    running here, each with its setup, and the results are those of the first cases. Raises
    `support.parallel.workers.WorkersError`, also if a worker lacks a setup that is available here.
    """
    listed = known if known is not None else KnownFailures.load()
    setups = tuple(Setup(executor, robot) for robot in robots for executor in executors)
    lacking = {setup: missing(setup) for setup in setups}
    shares = [cases[at : at + _SHARE] for at in range(0, len(cases), _SHARE)]
    wanted = max(1, min(jobs or os.cpu_count() or 1, len(shares)))
    if wanted == 1:
        shares = [[case] for case in cases]  # nothing is sent anywhere, and progress is seen
    done: list[CaseResult] = []
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as name:
        given = _Conditions(lacking, listed, Path(name) if scheduler is None else None)
        tasks = ((share, given) for share in shares)
        lost = partial(_run_singly, scheduler=scheduler)
        try:
            for results in ordered_map(
                _run_share, tasks, jobs=wanted, scheduler=scheduler, lost=lost
            ):
                done += results
                on_done(len(results))
        except Stopped:
            running = sorted(Path(name).iterdir())
            on_stopped([one.read_text(encoding="utf-8") for one in running])
    return done


@dataclass(frozen=True, slots=True)
class _Conditions:
    """What all cases of a run are run with.

    ``lacking`` says for each setup why the caller does not have it, or "". In the folder ``notes``
    a file of each process says what it is running.
    """

    lacking: Mapping[Setup, str]
    known: KnownFailures
    notes: Path | None


def _run_share(cases: Sequence[Case], given: _Conditions) -> list[CaseResult]:
    """Run cases in this process."""
    for setup, why in given.lacking.items():
        if not why and missing(setup):
            raise WorkersError(f"a worker on {node()} lacks what is here: {missing(setup)}")
    note = None if given.notes is None else given.notes / str(os.getpid())

    def see(case: Case, setup: Setup) -> Observation:
        if note is not None:
            note.write_text(f"{case.name} on {setup.executor}/{setup.robot}", encoding="utf-8")
        return observe(case, setup)

    setups, absent = tuple(given.lacking), given.lacking.__getitem__
    run = partial(run_case, setups=setups, known=given.known, see=see, absent=absent)
    done = [repeated(partial(run, case)) for case in cases]
    if note is not None:
        note.unlink(missing_ok=True)
    return done


def _run_singly(
    share: Sequence[Case], given: _Conditions, *, scheduler: str | None
) -> list[CaseResult]:
    """Run each case by itself, because one of them killed its process."""
    singles = (([case], given) for case in share)
    found = ordered_map(_run_share, singles, jobs=2, scheduler=scheduler, lost=_process_died)
    return [result for results in found for result in results]


def _process_died(cases: Sequence[Case], given: _Conditions) -> list[CaseResult]:
    why = "the process died"
    failed = tuple(Result(one.executor, one.robot, "fail", why, (), 0.0) for one in given.lacking)
    return [CaseResult(case, failed) for case in cases]
