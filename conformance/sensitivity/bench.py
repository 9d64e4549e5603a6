"""The record of `krl bench conform`: what mutants and planted faults cases find, and how fast."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final, get_args

from conformance.evaluation.execution import Setup
from conformance.evaluation.verdicts import KnownFailures
from conformance.runner import run_case
from conformance.sensitivity.mutant_trial import OF_TRIAL, Fate, Trial
from conformance.sensitivity.mutants import OF_CASES
from conformance.sensitivity.planted_faults import Fault
from conformance.sensitivity.trial import Verdict, try_faults
from conformance.suite.case import Case

#: The share of planted faults that the cases have to find.
AIM: Final = 0.95
#: The share of mutants that have to make a case fail.
MUTANT_AIM: Final = 0.85
_EXECUTOR: Final = "tree"
_OF_MUTANT: Final = ("package", "file", "line", "function", "operator", "source", "was", "now")


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
    executor: str = _EXECUTOR,
) -> dict[str, Any]:
    """Try the faults under an executor; ``on_done`` is called for each when it has its verdict."""
    begun = time.perf_counter()
    verdicts = try_faults(faults, cases, jobs, on_done, executor)
    return {
        **record_of(verdicts),
        "faults_executor": executor,
        "seconds": round(time.perf_counter() - begun, 3),
    }


def record_of(verdicts: Sequence[Verdict]) -> dict[str, Any]:
    """What is written as JSON, but for the times."""
    groups = list(dict.fromkeys(one.group for one in verdicts))
    rows = [
        {"group": one.group, "fault": one.words, **_fields(one, ("case", "verdict", "runs"))}
        for one in verdicts
    ]
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
            {key: row[key] for key in ("group", "fault", "runs")}
            for row in rows
            if row["case"] is None
        ],
        "verdicts": rows,
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


def mutants_record(trials: Mapping[int, Sequence[Trial]]) -> dict[str, Any]:
    """What is written of mutants, by the seed they were drawn with.

    A share is that of the red ones among those that some case could notice.
    """
    every = [one for of_seed in trials.values() for one in of_seed]
    return {
        **_fates(every),
        "aim": MUTANT_AIM,
        "seeds": [
            {"seed": seed, **_fates(found), "packages": _by_package(found)}
            for seed, found in trials.items()
        ],
        "packages": _by_package(every),
        "trials": [
            {
                "mutant": one.mutant.name,
                **_fields(one.mutant, _OF_MUTANT),
                **_fields(one, OF_TRIAL),
            }
            for one in every
        ],
    }


def _by_package(trials: Sequence[Trial]) -> list[dict[str, Any]]:
    return [
        {"package": package, **_fates(own)}
        for package in OF_CASES
        if (own := [one for one in trials if one.mutant.package == package])
    ]


def _fields(of: object, names: Sequence[str]) -> dict[str, Any]:
    return {name: getattr(of, name) for name in names}


def _fates(trials: Sequence[Trial]) -> dict[str, Any]:
    counts = Counter(one.fate for one in trials)
    counted = len(trials) - counts["invalid"] - counts["equivalent"]
    survived = [one for one in trials if one.fate == "survived"]
    return {
        "mutants": len(trials),
        **{fate: counts[fate] for fate in get_args(Fate)},
        "unreached": sum(not one.reached for one in survived),
        "unsure": sum(
            bool(one.reached) and not one.sure for one in trials if one.fate in ("soft", "survived")
        ),
        "unchanged": sum(bool(one.reached) and not one.changed for one in survived),
        "share": round(counts["red"] / counted, 4) if counted else 0.0,
    }
