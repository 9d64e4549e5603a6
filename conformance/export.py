"""Export of the cases as one archive, for third parties who test an executor or a parser.

``expectations.json`` has the cases with their expectations, in the format of
``expectations.schema.json``. ``cases/`` has their files, as a controller holds them.
``reference.json`` is what the tree interpreter and the planned arm do with them, in the form of a
recording (`conformance.recording`), so that it can be compared with one's own results and evaluated
like them. A fault is identified by its message number; if none is known, any fault meets the
expectation, because our names of faults are not binding.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

from conformance.evaluation.observation import Observation
from conformance.recording import FORMAT
from conformance.runner import CaseResult
from conformance.suite.case import Case
from conformance.suite.expectations import KINDS, PHASES, Anchor, Expectation, When
from conformance.suite.registry import basis
from interp.values.faults import FAULTS

EXPECTATIONS: Final = "krl-expectations/1"
_TEXT: Final = {"type": "string"}
_TEXTS: Final = {"type": "array", "items": _TEXT}
_NUMBER: Final = {"type": "number"}
_TRUTH: Final = {"type": "boolean"}


def _object(required: Mapping[str, Any], **optional: Any) -> dict[str, Any]:
    return {
        "type": "object",
        "properties": {**required, **optional},
        "required": list(required),
        "additionalProperties": False,
    }


_MOMENT: Final = _object({"event": _TEXT, "of": _TEXT, "seconds": _NUMBER})
#: The JSON schema of ``expectations.json``.
SCHEMA: Final[Mapping[str, Any]] = {
    "$schema": "https://json-schema.org/draft/2020-12/schema",
    "title": "What the conformance cases of KRL expect",
    **_object(
        {
            "format": {"const": EXPECTATIONS},
            "cases": {
                "type": "array",
                "items": _object(
                    {
                        "case": _TEXT,
                        "title": _TEXT,
                        "phase": {"enum": list(PHASES)},
                        "rules": _TEXTS,
                        "profile": _TEXT,
                        "io": _TEXTS,
                        "robot": _TEXT,
                        "seconds": _NUMBER,
                        "digest": _TEXT,
                        "files": _TEXTS,
                        "may_fail": _TRUTH,
                        "expectations": {
                            "type": "array",
                            "items": _object(
                                {
                                    "kind": {"enum": sorted(KINDS)},
                                    "arguments": _TEXTS,
                                    "file": _TEXT,
                                    "line": {"type": "integer", "minimum": 1},
                                    "text": _TEXT,
                                    "basis": _TEXT,
                                    "tier": _TEXT,
                                    "may_fail": _TRUTH,
                                },
                                number={"type": ["integer", "null"]},
                                tolerance=_NUMBER,
                                near={"type": "array", "items": _NUMBER},
                                when=_object(
                                    {
                                        "relation": {"enum": ["at", "before", "after", "between"]},
                                        "first": _MOMENT,
                                        "exactly": _TRUTH,
                                    },
                                    last=_MOMENT,
                                ),
                            ),
                        },
                    }
                ),
            },
        }
    ),
}


def expectations_of(cases: Sequence[Case]) -> dict[str, Any]:
    """Return the cases with their expectations, in the format of `SCHEMA`."""
    return {"format": EXPECTATIONS, "cases": [_case(case) for case in cases]}


def _case(case: Case) -> dict[str, Any]:
    return {
        "case": case.name,
        "title": case.title,
        "phase": case.phase,
        "rules": list(case.rules),
        "profile": case.profile,
        "io": list(case.io),
        "robot": case.robot,
        "seconds": case.seconds,
        "digest": case.digest,
        "files": [source.path for source in case.sources],
        "may_fail": case.may_fail,
        "expectations": [_expectation(one, case) for one in case.expectations],
    }


def _expectation(one: Expectation, case: Case) -> dict[str, Any]:
    rests_on = basis(one.basis or case.basis)
    found: dict[str, Any] = {
        "kind": one.kind,
        "arguments": list(one.arguments),
        "file": one.file,
        "line": one.line,
        "text": one.text,
        "basis": rests_on.id,
        "tier": rests_on.tier,
        "may_fail": case.is_sure(one),
    }
    if one.kind == "fault":
        word = one.arguments[0]
        known = FAULTS.get(word)
        found["number"] = int(word) if word.isdigit() else known.number if known else None
    if one.tolerance is not None:
        found["tolerance"] = one.tolerance
    if one.near:
        found["near"] = list(one.near)
    if one.when is not None:
        found["when"] = _when(one.when)
    return found


def _when(when: When) -> dict[str, Any]:
    last = {} if when.last is None else {"last": _moment(when.last)}
    first = _moment(when.first)
    return {"relation": when.relation, "first": first, "exactly": when.exactly, **last}


def _moment(moment: Anchor) -> dict[str, Any]:
    return {"event": moment.event, "of": moment.of, "seconds": moment.seconds}


def reference_of(results: Sequence[CaseResult], version: str) -> dict[str, Any]:
    """Return the first result of each case, as a recording of this project's own executor."""
    seen = [(one.case, one.results[0].observation) for one in results]
    return {
        "format": FORMAT,
        "controller": {"name": "krl-workbench", "release": version},
        "cases": [_seen(case, found) for case, found in seen if found is not None],
    }


def _seen(case: Case, seen: Observation) -> dict[str, Any]:
    kinds = {event.kind for event in seen.events} | set(_WATCHED)
    found: dict[str, Any] = {
        "case": case.name,
        "digest": case.digest,
        "watched": sorted(kinds),
        "events": [event.record() for event in seen.events],
        "ending": seen.ending,
        "findings": [
            {"file": one.file, "line": one.line, "severity": one.severity, "message": one.message}
            for one in seen.findings
            if one.severity != "note"  # a controller does not report our notes
        ],
    }
    if seen.path is not None and len(seen.path.times) > 1:
        found["path"] = {
            "t": seen.path.times.tolist(),
            "axes": seen.path.axes[:, :6].round(5).tolist(),
            "points": seen.path.points.round(4).tolist(),
        }
    return found


#: Kinds of events that the reference observes, even if none of them happened.
_WATCHED: Final = (
    "advance_stop anout assign blend_apex blend_end blend_start brake call end halt "
    "interrupt_enter line "
    "message motion_end motion_planned motion_start out resume trigger"
).split()


def write_export(path: Path, results: Sequence[CaseResult], version: str) -> None:
    """Write the archive; equal results produce equal bytes."""
    cases = [one.case for one in results]
    texts = {
        "expectations.json": _json(expectations_of(cases)),
        "expectations.schema.json": _json(SCHEMA),
        "reference.json": _json(reference_of(results, version)),
        "README.md": (Path(__file__).with_name("CASES.md")).read_text(encoding="utf-8"),
    }
    for case in cases:
        texts |= {f"cases/{case.name}/{one.path}": one.text for one in case.sources}
    with ZipFile(path, "w", ZIP_DEFLATED) as archive:
        for name, text in texts.items():
            entry = ZipInfo(name)
            entry.compress_type = ZIP_DEFLATED
            archive.writestr(entry, text)


def _json(data: Mapping[str, Any]) -> str:
    return json.dumps(data, ensure_ascii=False, separators=(",", ":")) + "\n"
