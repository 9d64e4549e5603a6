"""The record of a conformance run: what ``krl conform --json`` writes and the page shows.

CASES.md describes its fields. Other programs read it, so fields may be added but not changed.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from datetime import UTC, datetime
from typing import Any, Final

import numpy as np

from conformance.evaluation.case_result import CaseResult, Result
from conformance.evaluation.observation import Observation
from conformance.evaluation.path_geometry import drawn
from conformance.evaluation.verdicts import VERDICTS
from conformance.suite.case import SUITES, Case
from conformance.suite.registry import registry
from conformance.suite.rule_coverage import coverage
from interp.robot.simulation.tracking import PathRecord

#: Kinds of events of single statements; the record contains only the others.
_STATEMENTS: Final = frozenset({"line", "assign", "branch", "call", "return"})
#: The largest numbers of events and of path points in the record, and of points if a case passes.
_MOST_EVENTS: Final = 400
_MOST_POINTS: Final = 300
_POINTS_SHOWN: Final = 150


def record_of(
    results: Sequence[CaseResult],
    executors: Sequence[str],
    robots: Sequence[str],
    *,
    version: str,
    seconds: float,
) -> dict[str, Any]:
    """Return the record of a run, ready for `json.dumps`."""
    cases = [one.case for one in results]
    covered = coverage(cases)
    counts = [covered.count(hard=hard) for hard in (False, True)]
    return {
        "version": version,
        "generated": datetime.now(UTC).isoformat(timespec="seconds"),
        "seconds": round(seconds, 3),
        "executors": list(executors),
        "robots": list(robots),
        "cases_total": len(cases),
        "negative": sum(case.is_negative for case in cases),
        "runs": sum(len(one.results) for one in results),
        "verdicts": _verdicts(result for one in results for result in one.results),
        "case_verdicts": {
            verdict: sum(one.verdict == verdict for one in results) for verdict in VERDICTS
        },
        "suites": [_suite(suite, results) for suite in _suites(cases)],
        "coverage": {
            "rules": counts[0][1],
            "covered": counts[0][0],
            "hard": counts[1][1],
            "hard_covered": counts[1][0],
            "uncovered": [rule.id for rule in covered.uncovered],
        },
        "rules": _rules(results),
        "cases": [_case(one) for one in results],
    }


def _verdicts(results: Any) -> dict[str, int]:
    counted = Counter(result.verdict for result in results)
    return {verdict: counted[verdict] for verdict in VERDICTS}


def _suites(cases: Sequence[Case]) -> list[str]:
    there = {case.suite for case in cases}
    return [suite for suite in SUITES if suite in there] + sorted(there.difference(SUITES))


def _suite(suite: str, results: Sequence[CaseResult]) -> dict[str, Any]:
    its = [one for one in results if one.case.suite == suite]
    cells: dict[tuple[str, str], list[Result]] = {}
    for one in its:
        for result in one.results:
            cells.setdefault((result.executor, result.robot), []).append(result)
    return {
        "name": suite,
        "cases": len(its),
        "negative": sum(one.case.is_negative for one in its),
        "cells": [
            {"executor": executor, "robot": robot, "verdicts": _verdicts(found)}
            for (executor, robot), found in cells.items()
        ],
    }


def _rules(results: Sequence[CaseResult]) -> list[dict[str, Any]]:
    by_rule: dict[str, list[CaseResult]] = {rule: [] for rule in registry()}
    for one in results:
        for rule in one.case.rules:
            by_rule[rule].append(one)
    return [
        {
            "id": rule.id,
            "tier": rule.tier,
            "may_fail": rule.may_fail,
            "profile": rule.profile,
            "statement": rule.statement,
            "source": rule.source,
            "unshown": rule.unshown,
            "clauses": [asdict(one) for one in rule.clauses],
            "cases": [one.case.name for one in by_rule[rule.id]],
            "verdicts": dict(Counter(one.verdict for one in by_rule[rule.id])),
        }
        for rule in registry().values()
    ]


def _case(one: CaseResult) -> dict[str, Any]:
    case = one.case
    return {
        "name": case.name,
        "suite": case.suite,
        "title": case.title,
        "rules": list(case.rules),
        "phase": case.phase,
        "profile": case.profile,
        "negative": case.is_negative,
        "may_fail": case.may_fail,
        "unconfirmed": case.unconfirmed,
        "digest": case.digest,
        "io": list(case.io),
        "verdict": one.verdict,
        "files": [{"name": each.path, "text": each.text} for each in case.sources],
        "results": _results(one),
    }


def _results(one: CaseResult) -> list[dict[str, Any]]:
    """Return all results; if the case is about the path, the first with a path includes it."""
    is_about_path = any(each.needs != "none" for each in one.case.expectations)
    found = []
    for at, result in enumerate(one.results):
        record = _result(result, is_first=not at)
        seen = result.observation
        if is_about_path and seen is not None and seen.path is not None and len(seen.path.times):
            record.setdefault("path", _path(seen.path, _POINTS_SHOWN))
            record["path"]["analytic"] = _analytic(one.case)
            is_about_path = False
        found.append(record)
    return found


def _result(result: Result, *, is_first: bool) -> dict[str, Any]:
    found: dict[str, Any] = {
        "executor": result.executor,
        "robot": result.robot,
        "verdict": result.verdict,
        "reason": result.reason,
        "seconds": round(result.seconds, 4),
        "checks": [
            {
                "file": check.file,
                "line": check.line,
                "text": check.text,
                "state": check.state,
                "actual": check.actual,
                "basis": check.basis,
                "is_sure": check.is_sure,
            }
            for check in result.checks
        ],
        "divergence": None if result.divergence is None else asdict(result.divergence),
    }
    if result.observation is not None:
        is_whole = is_first or result.verdict == "fail"
        found |= _seen(result.observation, is_whole=is_whole)
    return found


def _seen(seen: Observation, *, is_whole: bool) -> Mapping[str, Any]:
    """Return what was observed, completely or only what differs between robots."""
    record: dict[str, Any] = {"ending": seen.ending}
    if is_whole:
        kept = [event.record() for event in seen.events if event.kind not in _STATEMENTS]
        record["events"] = kept[:_MOST_EVENTS]
        record["events_total"] = len(seen.events)
        record["findings"] = [asdict(one) for one in seen.findings]
    if (
        seen.path is not None
        and len(seen.path.times)
        and (is_whole or seen.path.axes_measured is not None)
    ):
        record["path"] = _path(seen.path)
    return record


def _analytic(case: Case) -> list[list[float]]:
    """Return points of the lines, circles and arcs that the case expects, one after the other."""
    found: list[list[float]] = []
    for one in case.expectations:
        if one.kind == "path" and one.arguments[0] != "joint":
            numbers = [float(word) for word in one.arguments if word[-1].isdigit()]
            points = np.array(numbers).reshape(-1, 3)
            found += drawn(one.arguments[0], points).round(4).tolist()
    return found


def _path(path: PathRecord, most: int = _MOST_POINTS) -> dict[str, Any]:
    """Return points of a path, every n-th if there are many."""
    every = max(1, -(-len(path.times) // most))
    record: dict[str, Any] = {
        "t": path.times[::every].tolist(),
        "axes": path.axes[::every].round(5).tolist(),
        "poses": path.points[::every].round(4).tolist(),
    }
    if path.axes_measured is not None:
        record["axes_meas"] = path.axes_measured[::every].round(5).tolist()
    if path.points_measured is not None:
        record["poses_meas"] = path.points_measured[::every].round(4).tolist()
    return record
