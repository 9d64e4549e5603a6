"""The run of a case: on one executor and robot after another, evaluated and compared.

Each result is evaluated by the expectations of the case. It is also compared with that of the first
executor on the same robot, or else with the first result: executors that differ have failed,
whatever the rule.
"""

from __future__ import annotations

import time
import traceback
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Final

from conformance.evaluation.case_result import CaseResult, Result
from conformance.evaluation.evaluator import Check, evaluate
from conformance.evaluation.execution import FRONT, Setup, missing, observe
from conformance.evaluation.observation import Observation
from conformance.evaluation.time_limit import TimeOver, time_limited
from conformance.evaluation.trace_comparison import first_divergence
from conformance.evaluation.verdicts import KnownFailures, verdict_of
from conformance.suite.case import Case

#: The limits of processor time and of wall-clock time for a case on one executor and robot, in s.
#: All cases need at most a few seconds.
MOST_COMPUTING: Final = 20.0
MOST_LASTING: Final = 120.0

Observe = Callable[[Case, Setup], Observation]


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


def observed_within(
    case: Case, setup: Setup, most: float = MOST_COMPUTING, see: Observe = observe
) -> Observation:
    """Return what was observed of a case in ``most`` s of computing; an exception is a crash."""
    try:
        with time_limited(most, MOST_LASTING):
            return see(case, setup)
    except TimeOver as error:
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
