"""Export of the cases as one archive, for third parties who test an executor or a parser.

``expectations.json`` has the cases with their expectations, in the format of
``expectations.schema.json``. ``cases/`` has their files, as a controller holds them.
``rules.json`` has the rules on which they rest, ``faults.json`` our names of faults with their
numbers, ``machines/`` and ``profiles/`` the arm and the controllers of the cases, ``docs/`` the
documents to which the README refers (a checkout has all of them, a wheel only the rules).
``reference.json`` is what the tree interpreter and the planned arm do with them, in the form of a
recording (`conformance.exchange.recording`), so that it can be compared with one's own results and
evaluated like them. A fault is identified by its message number; if none is known, any fault meets
the expectation, because our names of faults are not binding.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict
from importlib import resources
from pathlib import Path
from typing import Any, Final
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

from conformance.evaluation.case_result import CaseResult
from conformance.evaluation.observation import Observation
from conformance.exchange.recording import FORMAT
from conformance.suite.case import Case
from conformance.suite.expectations import (
    KINDS,
    PHASES,
    Anchor,
    Expectation,
    When,
    expected_ending,
)
from conformance.suite.registry import basis, registry
from conformance.suite.rules_page import page
from interp.controller import state
from interp.controller.state.messages import OWN_FAULTS
from interp.controller.state.profile import profile_names
from interp.robot.models import DEFAULT, model_file
from interp.values.faults import FAULTS

#: Names of faults that stand in no table, because their texts differ.
_FAULTS: Final = {
    "link": ("the program cannot begin: a name is declared nowhere, or a file is wrong", "SCO-01"),
    "spline": ("a spline block cannot be planned", "SPL-10"),
}
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
                        "main": _TEXT,
                        "files": _TEXTS,
                        "machine": _TEXT,
                        "unconfirmed": _TEXT,
                        "ending": _object({"accepted": _TEXTS, "basis": _TEXT, "may_fail": _TRUTH}),
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
        "main": case.main,
        "files": [source.path for source in case.sources],
        "machine": "$machine.dat" if case.machine else f"machines/{DEFAULT}.dat",
        "unconfirmed": case.unconfirmed,
        "ending": _ending(case),
        "may_fail": case.may_fail,
        "expectations": [_expectation(one, case) for one in case.expectations],
    }


def _ending(case: Case) -> dict[str, Any]:
    """Return how the program may end; nothing is accepted before a program runs."""
    accepted, causes = expected_ending(case.expectations)
    surest = max(causes, key=case.is_sure, default=None)
    return {
        "accepted": list(accepted) if case.phase == "run" else [],
        "basis": case.basis if surest is None else surest.basis or case.basis,
        "may_fail": case.may_fail if surest is None else case.is_sure(surest),
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
        found["number"] = int(word) if word.isdigit() else None
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
        "rules.json": _json({"rules": [asdict(one) for one in registry().values()]}),
        "faults.json": _json({"faults": list(_faults())}),
        "docs/semantics.md": page(),
        **dict(_companions()),
        "expectations.json": _json(expectations_of(cases)),
        "expectations.schema.json": _json(SCHEMA),
        "reference.json": _json(reference_of(results, version)),
        "README.md": resources.files("conformance")
        .joinpath("CASES.md")
        .read_text(encoding="utf-8"),
    }
    for case in cases:
        texts |= {f"cases/{case.name}/{one.path}": one.text for one in case.sources}
    with ZipFile(path, "w", ZIP_DEFLATED) as archive:
        for name, text in texts.items():
            entry = ZipInfo(name)
            entry.compress_type = ZIP_DEFLATED
            archive.writestr(entry, text)


def _faults() -> Iterator[dict[str, Any]]:
    """Yield our faults; a fault ``message_N`` is the controller's message N."""
    for one in FAULTS.values():
        yield {"slug": one.slug, "number": one.number, "text": one.text, "rules": list(one.rules)}
    for slug, (text, rule) in (OWN_FAULTS | _FAULTS).items():
        yield {"slug": slug, "number": None, "text": text, "rules": [rule]}


def _companions() -> Iterator[tuple[str, str]]:
    """Yield files of the repository that explain the archive: their names in it and their texts."""
    yield f"machines/{DEFAULT}.dat", model_file(f"{DEFAULT}.dat").read_text(encoding="utf-8")
    profiles = resources.files(state).joinpath("profiles")
    for name in profile_names():
        yield f"profiles/{name}.toml", profiles.joinpath(f"{name}.toml").read_text("utf-8")
    root = Path(__file__).parents[2]
    for name in ("LICENSE", *(f"docs/{one}.md" for one in ("trace", "io-scripts", "controller"))):
        if (root / name).is_file():
            yield name, (root / name).read_text(encoding="utf-8")


def _json(data: Mapping[str, Any]) -> str:
    return json.dumps(data, ensure_ascii=False, separators=(",", ":")) + "\n"
