"""The record of `krl bench conform`: how many faults the cases find, and how fast cases run."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from typing import Any, Final

from conformance.evaluation.execution import Setup
from conformance.evaluation.verdicts import KnownFailures
from conformance.runner import run_case
from conformance.sensitivity.planted_fault import Fault
from conformance.sensitivity.trial import Verdict, try_faults
from conformance.suite.case import Case

__all__ = ["AIM", "measure", "record_of", "speed_of"]

#: The share of faults that the cases have to find.
AIM: Final = 0.95
_EXECUTOR: Final = "tree"


def speed_of(
    cases: Sequence[Case], on_done: Callable[[int], None] = lambda _count: None
) -> dict[str, Any]:
    """Run all cases once, on one executor without a robot and in one process: cases a second.

    ``on_done`` is called for each case.
    """
    known = KnownFailures.load()
    begun = time.perf_counter()
    for case in cases:
        run_case(case, [Setup(_EXECUTOR, "none")], known)
        on_done(1)
    took = time.perf_counter() - begun
    return {
        "executor": _EXECUTOR,
        "robot": "none",
        "cases": len(cases),
        "cases_seconds": round(took, 3),
        "cases_per_s": round(len(cases) / took, 1) if took > 0 else 0.0,
    }


def measure(
    faults: Sequence[Fault],
    cases: Sequence[Case],
    jobs: int = 1,
    on_done: Callable[[int], None] = lambda _count: None,
) -> dict[str, Any]:
    """Try the faults; ``on_done`` is called for each as soon as it has its verdict."""
    begun = time.perf_counter()
    verdicts = try_faults(faults, cases, jobs, on_done)
    return {**record_of(verdicts), "seconds": round(time.perf_counter() - begun, 3)}


def record_of(verdicts: Sequence[Verdict]) -> dict[str, Any]:
    """What is written as JSON, but for the times."""
    groups = list(dict.fromkeys(one.group for one in verdicts))
    return {
        "mutants": len(verdicts),
        **_counts(verdicts),
        "aim": AIM,
        "groups": [
            {"group": group, "mutants": len(own), **_counts(own)}
            for group in groups
            if (own := [one for one in verdicts if one.group == group])
        ],
        "survivors": [
            {"group": one.group, "fault": one.words, "runs": one.runs}
            for one in verdicts
            if one.case is None
        ],
        "verdicts": [
            {
                "group": one.group,
                "fault": one.words,
                "case": one.case,
                "verdict": one.verdict,
                "runs": one.runs,
            }
            for one in verdicts
        ],
    }


def _counts(verdicts: Sequence[Verdict]) -> dict[str, Any]:
    """``failing`` are those that fail a case, the others only change a verdict."""
    killed = sum(one.case is not None for one in verdicts)
    failing = sum(one.verdict == "fail" for one in verdicts)
    return {
        "killed": killed,
        "failing": failing,
        "share": round(killed / len(verdicts), 4) if verdicts else 0.0,
        "failing_share": round(failing / len(verdicts), 4) if verdicts else 0.0,
    }
