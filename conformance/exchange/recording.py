"""Recordings: what a real controller did with the cases, in one JSON file.

CASES.md says how to make a recording, and describes its fields. A recording is evaluated like the
run of an executor. Expectations about kinds of events that it did not watch stay open. Its purpose
is to confirm or refute unconfirmed rules.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from conformance.evaluation.case_result import CaseResult, Result
from conformance.evaluation.evaluator import evaluate
from conformance.evaluation.observation import Event, Finding, Observation
from conformance.evaluation.verdicts import verdict_of
from conformance.suite.case import Case
from conformance.suite.registry import registry
from interp.controller.state.trace import KINDS
from interp.robot.simulation.tracking import PathRecord
from support.files.untrusted import json_of, read_bytes

FORMAT: Final = "krl-recording/1"
#: mm and degrees beyond the reach of any robot.
_BEYOND: Final = 1e9
_ENDINGS: Final = ("", "end", "fault", "halt", "running")


class RecordingError(ValueError):
    """A recording is malformed; the text is one line with the place."""


@dataclass(frozen=True, slots=True)
class Recording:
    """A recording: its controller, and for each case its digest then and what was observed."""

    controller: str
    seen: Mapping[str, tuple[str, Observation]]

    @staticmethod
    def read(path: Path) -> Recording:
        """Read a recording from a file. Raises `RecordingError`."""
        try:
            data = json_of(read_bytes(path).decode("utf-8"), float)
        except (OSError, ValueError) as error:
            raise RecordingError(f"{path}: cannot be read: {error}") from error
        if not isinstance(data, dict) or data.get("format") != FORMAT:
            raise RecordingError(f"{path}: its format is not {FORMAT}")
        controller = data.get("controller")
        if not isinstance(controller, dict) or not controller.get("name"):
            raise RecordingError(f"{path}: it does not name its controller")
        cycle = data.get("cycle", 12_000)
        if not isinstance(cycle, int) or cycle < 1:
            raise RecordingError(f"{path}: the cycle is in whole microseconds")
        seen = {}
        entries = data.get("cases", [])
        if not isinstance(entries, list):
            raise RecordingError(f"{path}: its cases are no list")
        for number, entry in enumerate(entries, start=1):
            if not isinstance(entry, dict):
                raise RecordingError(f"{path}: case {number} is not an object")
            name = entry.get("case", number)
            try:
                _check_finite(entry)
                seen[str(entry["case"])] = (str(entry["digest"]), _observation(entry, cycle))
            except KeyError as error:
                raise RecordingError(f"{path}: case {name} has no {error}") from error
            except (AttributeError, OverflowError, TypeError, ValueError) as error:
                raise RecordingError(f"{path}: case {name}: {error}") from error
        name = " ".join(
            str(controller[key]) for key in ("name", "release", "machine") if controller.get(key)
        )
        return Recording(name, seen)


def _check_finite(value: object) -> None:
    """Raise `ValueError` for a number without end anywhere in a value of JSON."""
    if isinstance(value, float) and not math.isfinite(value):
        raise ValueError(f"{value} is no finite number")
    parts = value.values() if isinstance(value, dict) else value if isinstance(value, list) else ()
    for part in parts:
        _check_finite(part)


def _observation(entry: Mapping[str, Any], cycle: int) -> Observation:
    ending = str(entry.get("ending", ""))
    if ending not in _ENDINGS:
        raise ValueError(f"the ending is {', '.join(_ENDINGS[1:])} or empty, not {ending!r}")
    findings = [
        Finding(
            str(one["file"]),
            int(one["line"]),
            str(one.get("severity", "error")),
            str(one.get("code", "")),
            str(one.get("message", "")),
        )
        for one in _list(entry, "findings")
    ]
    events, watched = tuple(map(Event.of, _list(entry, "events"))), _list(entry, "watched")
    if unknown := [
        one for one in (*(event.kind for event in events), *watched) if one not in KINDS
    ]:
        raise ValueError(f"there is no kind of event {unknown[0]!r}")
    path = entry.get("path")
    return Observation(
        findings=tuple(findings),
        events=events,
        ending=ending,
        path=None if path is None else _path(path),
        cycle=cycle,
        is_exact=False,
        robot="none" if path is None else "mujoco" if "points_meas" in path else "kinematic",
        watched=frozenset(watched),
    )


def _list(entry: Mapping[str, Any], key: str) -> list[Any]:
    found = entry.get(key, [])
    if not isinstance(found, list):
        raise ValueError(f"its {key} are no list")
    return found


def _path(data: Mapping[str, Any]) -> PathRecord:
    times = np.array(data["t"], dtype=np.int64)
    axes, points = _rows(data, "axes", times), _rows(data, "points", times)
    if axes is None or points is None:
        raise ValueError("a path has axes and points")
    if len(times) < 2 or not (np.diff(times) > 0).all():
        raise ValueError("the times of a path rise")
    measured = _rows(data, "axes_meas", times), _rows(data, "points_meas", times)
    tips = None if measured[1] is None else measured[1][:, :3]
    return PathRecord(times, axes, points, points[:, :3], *measured, tips)


def _rows(
    data: Mapping[str, Any], key: str, times: npt.NDArray[np.int64]
) -> npt.NDArray[np.float64] | None:
    if key not in data:
        return None
    rows = np.array(data[key], dtype=np.float64)
    if rows.shape != (len(times), 6):
        raise ValueError(f"{key} has six columns and a row for each time")
    if not (np.abs(rows) < _BEYOND).all():  # also false for NaN
        raise ValueError(f"{key} has values that no robot reaches")
    return rows


def evaluate_recording(
    recording: Recording, cases: Sequence[Case]
) -> tuple[list[CaseResult], list[str]]:
    """Return the results of a recording, and its errors: cases that are unknown or changed."""
    known = {case.name: case for case in cases}
    results, wrong = [], []
    for name, (digest, seen) in sorted(recording.seen.items()):
        case = known.get(name)
        if case is None:
            wrong.append(f"{name}: there is no such case")
            continue
        if digest != case.digest:
            wrong.append(f"{name}: the case has changed since it was recorded")
            continue
        checks = tuple(evaluate(case, seen))
        verdict, reason = verdict_of(checks)
        result = Result(recording.controller, seen.robot, verdict, reason, checks, 0.0, None, seen)
        results.append(CaseResult(case, (result,)))
    return results, wrong


@dataclass(frozen=True, slots=True)
class Answer:
    """How many cases of an unconfirmed rule a recording meets, and which it does not meet."""

    rule: str
    met: int
    against: tuple[str, ...]


def answers(results: Iterable[CaseResult]) -> list[Answer]:
    """Return what a recording says about unconfirmed rules, if a case of them was evaluated."""
    met: dict[str, int] = {}
    against: dict[str, list[str]] = {}
    for one in results:
        rule = one.case.rules[0]
        if one.case.may_fail or one.verdict == "skipped":
            continue
        met.setdefault(rule, 0)
        against.setdefault(rule, [])
        if one.verdict == "pass":
            met[rule] += 1
        else:
            against[rule].append(one.case.name)
    return [Answer(rule, met[rule], tuple(against[rule])) for rule in registry() if rule in met]
