"""The page of a conformance run: suites by executor and robot, and the details of each case."""

import math
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from reports.conformance.conform_view import VERDICTS, conform_view
from reports.rendering.embedding import embedded_json
from reports.rendering.page import joined, render
from reports.rendering.record_fields import Record, count, nested, number, records, text, texts
from reports.rendering.sanitizing import plain, shown, shown_texts
from support.files.atomic_write import write_atomic

Json = dict[str, Any]

_MAX_CASES = 5_000
_MAX_RUNS = 400
# The embedded data stays below this, which keeps the whole page below 5 MB.
_MAX_DATA_CHARACTERS = 4_500_000
#: The fields of a result that are emptied if the page would be too large.
_WITHOUT: Json = {
    "events": [],
    "path": {},
    "checks": [],
    "findings": [],
    "divergence": None,
    "reason": "",
    "events_total": 0,
}
_SCRIPTS = (
    "vendor/uPlot.iife.min",
    "page",
    "line-chart",
    "conform-trend",
    "conform-timing",
    "conform-path",
    "conform-case",
    "conform",
)
_CHECK = ("file", "line", "text", "state", "actual")


def write_conformance_page(record: Mapping[str, Any], folder: Path) -> Path:
    """Write ``folder``/index.html, the page of one conformance run, and return its path.

    ``record`` is what ``krl conform --json`` writes; every field may be absent. Its optional
    ``history`` has the lines of ``history.jsonl`` of earlier nightly runs. Equal records give equal
    bytes. The page is written atomically.

    Raises OSError if the folder cannot be made or written.
    """
    cases = records(record, "cases")[:_MAX_CASES]
    shared = {
        "verdicts": list(VERDICTS),
        "rules": {shown(text(rule, "id"), 20): _rule(rule) for rule in records(record, "rules")},
        "runs": [_run(one) for one in records(record, "history")[-_MAX_RUNS:]],
    }
    room = _MAX_DATA_CHARACTERS - len(embedded_json(shared)) - len(cases)
    listed = (
        _listed(cases, lambda _case: True, room)
        or _listed(cases, lambda case: text(case, "verdict") != "pass", room)
        or _listed(cases, lambda _case: False, math.inf)
    )
    page = render(
        "conform.html.j2",
        script=joined(_SCRIPTS),
        styles=["vendor/uPlot.min.css", "page.css", "conform.css"],
        data=embedded_json({**shared, "cases": listed}),
        view=conform_view(record),
    )
    return write_atomic(folder / "index.html", page)


def _listed(cases: list[Record], has_details: Callable[[Record], bool], room: float) -> list[Json]:
    """Return the cases as the page's script reads them; none if they exceed ``room`` characters."""
    listed = []
    for case in cases:
        listed.append(_case(case, has_details=has_details(case)))
        room -= len(embedded_json(listed[-1]))
        if room < 0:
            return []
    return listed


def _case(case: Record, *, has_details: bool) -> Json:
    """Return a case as the page's script reads it.

    Without details its files are omitted, as are the events, paths and findings of its results.
    """
    return {
        **shown_texts(case, name=200, suite=80, title=300, phase=20, profile=40),
        **shown_texts(case, unconfirmed=300, verdict=20),
        "rules": [shown(rule, 20) for rule in texts(case, "rules")],
        "negative": bool(case.get("negative")),
        "io": [shown(line, 200) for line in texts(case, "io")],
        "files": [
            {
                **shown_texts(file, name=200),
                "lines": [shown(line) for line in text(file, "text").splitlines()[:3000]],
            }
            for file in (records(case, "files") if has_details else ())
        ],
        "isShort": not has_details,
        "results": [
            _result(one if has_details else {**one, **_WITHOUT}) for one in records(case, "results")
        ],
    }


def _result(result: Record) -> Json:
    """Return a result as the page's script reads it; the script completes what is empty."""
    path = nested(result, "path")
    whole = {
        **shown_texts(result, executor=40, robot=40, verdict=20, reason=600, ending=60),
        "checks": [
            {name: plain(check.get(name)) for name in _CHECK} for check in records(result, "checks")
        ],
        "divergence": plain(result.get("divergence")),
        "events": [plain(event) for event in records(result, "events")],
        "eventsTotal": count(result, "events_total"),
        "findings": [plain(one) for one in records(result, "findings")],
        "path": {
            name: plain(path[name])
            for name in ("t", "poses", "poses_meas", "analytic")
            if name in path
        },
    }
    return {name: value for name, value in whole.items() if value}


def _rule(rule: Record) -> Json:
    return {
        **shown_texts(rule, tier=10, statement=600, source=100, unshown=300),
        "mayFail": bool(rule.get("may_fail")),
        "cases": count(rule, "cases"),
    }


def _run(run: Record) -> Json:
    conform = nested(run, "conform") or run
    return {
        "date": shown(text(run, "date") or text(run, "generated"), 40),
        "verdicts": {name: count(nested(conform, "verdicts"), name) for name in VERDICTS},
        "seconds": number(conform, "seconds"),
    }
