"""The runner of cases: every executor with every robot, in any number of processes.

Cases of the phases parse and check have one front end and run once. Each result of phase run is
evaluated by the expectations of the case. It is also compared with that of the first executor on
the same robot, or else with the first result: executors that differ have failed, whatever the rule.
"""

from __future__ import annotations

import os
import signal
import tempfile
import threading
import time
import traceback
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from platform import node
from typing import Final, NoReturn

from conformance.evaluation.evaluator import Check, evaluate
from conformance.evaluation.execution import FRONT, Setup, missing, observe
from conformance.evaluation.observation import Observation
from conformance.evaluation.trace_comparison import Divergence, first_divergence
from conformance.evaluation.verdicts import KnownFailures, Verdict, verdict_of
from conformance.suite.case import Case
from support.parallel.ordered_map import ordered_map
from support.parallel.workers import WorkersError

#: The number of cases that a process receives at once.
_SHARE: Final = 8
#: The limits of processor time and of wall-clock time for a case on one executor and robot, in s.
#: All cases need at most a few seconds.
MOST_COMPUTING: Final = 20.0
MOST_LASTING: Final = 120.0

Observe = Callable[[Case, Setup], Observation]


class Stopped(BaseException):
    """What a signal handler raises to end `run_cases` early."""


@dataclass(frozen=True, slots=True)
class Result:
    """The result of a case on one executor and robot; ``seconds`` is wall-clock time."""

    executor: str
    robot: str
    verdict: Verdict
    reason: str
    checks: tuple[Check, ...]
    seconds: float
    divergence: Divergence | None = None
    observation: Observation | None = None


@dataclass(frozen=True, slots=True)
class CaseResult:
    """A case with its results, in the order of executors and robots."""

    case: Case
    results: tuple[Result, ...]

    @property
    def verdict(self) -> Verdict:
        """The worst of its verdicts."""
        order: tuple[Verdict, ...] = ("fail", "known-failure", "unconfirmed", "pass", "skipped")
        return min((one.verdict for one in self.results), key=order.index)


def run_case(
    case: Case,
    setups: Sequence[Setup],
    known: KnownFailures = KnownFailures(),  # noqa: B008 - frozen
    see: Observe = observe,
    absent: Callable[[Setup], str] = missing,
    most: float = MOST_COMPUTING,
) -> CaseResult:
    """Run one case. ``see`` observes it, ``absent`` says why a setup is not available.

    An executor that needs more than ``most`` seconds of processor time, or takes longer than two
    minutes, has failed, whatever the case is about; the case is then not run on the setups after
    it. This is measured only in the main thread of a process on a POSIX system.
    """
    wanted = setups if case.phase == "run" else (Setup(FRONT, "none"),)
    results: list[Result] = []
    endless = ""
    for setup in wanted:
        lacking = endless or (absent(setup) if case.phase == "run" else "")
        if lacking:
            results.append(Result(setup.executor, setup.robot, "skipped", lacking, (), 0.0))
            continue
        begun = time.perf_counter()
        seen = observed_within(case, setup, most, see)
        checks = _checks(case, seen)
        listed = known.reason(case.name, setup.executor, setup.robot)
        verdict, reason = verdict_of(checks, listed)
        if verdict == "fail" and seen.ending == "crash":
            reason = f"crash: {seen.note}"
        took = time.perf_counter() - begun
        if seen.ending == "crash" and took > most:
            endless = f"it does not end on {setup.executor}/{setup.robot}"
        result = Result(setup.executor, setup.robot, verdict, reason, checks, took, None, seen)
        results.append(_compared(result, results))
    return CaseResult(case, tuple(results))


class _TimeOver(BaseException):
    """A case needs too much time; a ``BaseException``, so that no handler in a run catches it.

    The message says how much it took.
    """


@contextmanager
def _limited(computing: float, lasting: float) -> Iterator[None]:
    """Raise `_TimeOver` if the context needs more seconds of processor or wall-clock time."""
    is_main = threading.current_thread() is threading.main_thread()
    if not is_main or not hasattr(signal, "setitimer"):
        yield
        return
    limits = (
        (signal.SIGPROF, signal.ITIMER_PROF, computing, time.process_time, " of computing"),
        (signal.SIGALRM, signal.ITIMER_REAL, lasting, time.monotonic, ""),
    )
    with ExitStack() as stack:
        for number, timer, seconds, clock, kind in limits:
            stack.enter_context(_timer(number, timer, seconds, clock, f"{seconds:g} seconds{kind}"))
        yield


@contextmanager
def _timer(
    number: int, timer: int, seconds: float, clock: Callable[[], float], told: str
) -> Iterator[None]:
    """Raise `_TimeOver` by a signal when the clock of a timer has advanced by ``seconds``."""

    def end(_signal: int, _frame: object) -> NoReturn:
        raise _TimeOver(told)

    latest = clock() + seconds
    before = signal.signal(number, end)
    try:
        signal.setitimer(timer, seconds, 1.0)  # repeats, if a callback swallows it
        yield
        if clock() > latest:  # the timer may be late
            raise _TimeOver(told)
    finally:
        signal.setitimer(timer, 0)
        signal.signal(number, before)


def observed_within(
    case: Case, setup: Setup, most: float = MOST_COMPUTING, see: Observe = observe
) -> Observation:
    """Return what was observed of a case in ``most`` s of computing; an exception is a crash."""
    try:
        with _limited(most, MOST_LASTING):
            return see(case, setup)
    except _TimeOver as error:
        reason = f"it takes more than {error}"
    except Exception as error:
        reason = _told(error)
    return Observation(ending="crash", note=reason, robot=setup.robot)


def _told(error: Exception) -> str:
    """Return an exception with the file and line that raised it, or that cannot be compiled."""
    if isinstance(error, SyntaxError):  # its text has the place
        return f"{type(error).__name__}: {error}"
    place = traceback.extract_tb(error.__traceback__)[-1]
    return f"{type(error).__name__}: {error} ({Path(place.filename).name}:{place.lineno})"


def _checks(case: Case, seen: Observation) -> tuple[Check, ...]:
    """Return the checks of a case; an exception is a defect of the evaluator, reported as unmet."""
    try:
        return tuple(evaluate(case, seen))
    except Exception as error:
        reason = f"the evaluation has failed: {_told(error)}"
        return (Check(case.main, 0, "the case can be evaluated", "unmet", reason, case.may_fail),)


def _compared(result: Result, before: Iterable[Result]) -> Result:
    """Compare a result with the first one on the same robot, or else with the first of all.

    What crashed has failed by itself, and is not compared.
    """
    ran = [one for one in before if _has_ended(one)]
    if not ran or not _has_ended(result):
        return result
    first = next((one for one in ran if one.robot == result.robot), ran[0])
    names = (f"{first.executor}/{first.robot}", f"{result.executor}/{result.robot}")
    assert first.observation is not None, "only what ended was kept"
    assert result.observation is not None, "it has ended"
    seen = first.observation, result.observation
    if first.robot != result.robot:  # programs may read measured positions, which differ by robot
        seen = _without_values(seen[0]), _without_values(seen[1])
    found = first_divergence(names, *seen)
    if found is None:
        return result
    return replace(result, verdict="fail", reason=str(found), divergence=found)


def _has_ended(result: Result) -> bool:
    return result.observation is not None and result.observation.ending != "crash"


def repeated(run: Callable[[], CaseResult]) -> CaseResult:
    """Run a case, and once more if it has failed; it stays failed, and is reported as flaky.

    A run does not depend on time or chance, so a case that passes the second time has a defect too.
    A case that does not end is not run again.
    """
    first = run()
    if first.verdict != "fail" or any(one.seconds > MOST_COMPUTING for one in first.results):
        return first
    results = [
        replace(one, reason=f"flaky, {other.verdict} when run again: {one.reason}")
        if one.verdict == "fail" and other.verdict != "fail"
        else one
        for one, other in zip(first.results, run().results, strict=True)
    ]
    return replace(first, results=tuple(results))


def _without_values(seen: Observation) -> Observation:
    kept = tuple(event for event in seen.events if event.kind != "assign")
    return replace(seen, events=kept)


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
