"""The record of `krl bench conform`: mutants and planted faults that cases notice, and speed."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final, get_args

from conformance.evaluation.case_run import run_case
from conformance.evaluation.execution import Setup
from conformance.evaluation.verdicts import KnownFailures
from conformance.sensitivity.detection import OF_DETECTION, Detection, Fate
from conformance.sensitivity.mutants import Mutant
from conformance.sensitivity.mutated_code import OF_CASES
from conformance.sensitivity.planted_faults import Fault
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


def planted_record(detections: Sequence[Detection[Fault]], executor: str) -> dict[str, Any]:
    """Return the record of planted faults by group; ``executor`` ran the cases."""
    groups = list(dict.fromkeys(one.fault.group for one in detections))
    return {
        "mutants": len(detections),
        **_counts(detections),
        "aim": AIM,
        "groups": [
            {"group": group, "mutants": len(own), **_counts(own)}
            for group in groups
            if (own := [one for one in detections if one.fault.group == group])
        ],
        "survivors": [
            {"group": one.fault.group, "fault": one.fault.words, "runs": one.runs}
            for one in detections
            if not one.case
        ],
        "verdicts": [
            {
                "group": one.fault.group,
                "fault": one.fault.words,
                "case": one.case or None,
                "verdict": {"red": "fail", "soft": "unconfirmed"}.get(one.fate, ""),
                "runs": one.runs,
            }
            for one in detections
        ],
        "faults_executor": executor,
    }


def _counts(detections: Sequence[Detection[Fault]]) -> dict[str, Any]:
    """Return how many faults any case noticed, and how many of them made one fail."""
    killed = sum(bool(one.case) for one in detections)
    failing = sum(one.fate == "red" for one in detections)
    return {
        "killed": killed,
        "failing": failing,
        "share": round(killed / len(detections), 4) if detections else 0.0,
        "failing_share": round(failing / len(detections), 4) if detections else 0.0,
    }


def mutants_record(detections: Mapping[int, Sequence[Detection[Mutant]]]) -> dict[str, Any]:
    """Return the record of mutants, by the seed with which they were drawn.

    A share is that of the red ones among those that are neither invalid nor equivalent.
    """
    every = [one for of_seed in detections.values() for one in of_seed]
    return {
        **_fates(every),
        "aim": MUTANT_AIM,
        "seeds": [
            {"seed": seed, **_fates(found), "packages": _by_package(found)}
            for seed, found in detections.items()
        ],
        "packages": _by_package(every),
        "trials": [
            {
                "mutant": one.fault.name,
                **_fields(one.fault, _OF_MUTANT),
                **_fields(one, OF_DETECTION),
            }
            for one in every
        ],
    }


def _by_package(detections: Sequence[Detection[Mutant]]) -> list[dict[str, Any]]:
    return [
        {"package": package, **_fates(own)}
        for package in OF_CASES
        if (own := [one for one in detections if one.fault.package == package])
    ]


def _fields(of: object, names: Sequence[str]) -> dict[str, Any]:
    return {name: getattr(of, name) for name in names}


def _fates(found: Sequence[Detection[Mutant]]) -> dict[str, Any]:
    counts = Counter(one.fate for one in found)
    counted = len(found) - counts["invalid"] - counts["equivalent"]
    survived = [one for one in found if one.fate == "survived"]
    return {
        "mutants": len(found),
        **{fate: counts[fate] for fate in get_args(Fate)},
        "by_profile": sum(one.by_profile for one in found if one.fate == "red"),
        "unreached": sum(not one.reached for one in survived),
        "unsure": sum(
            bool(one.reached) and not one.sure for one in found if one.fate in ("soft", "survived")
        ),
        "unchanged": sum(bool(one.reached) and not one.changed for one in survived),
        "share": round(counts["red"] / counted, 4) if counted else 0.0,
    }
