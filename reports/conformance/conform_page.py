"""The page of a conformance run: suites by executor and robot, and the details of each case."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from reports.conformance.conform_view import VERDICTS, conform_view
from reports.rendering.embedding import embedded_json
from reports.rendering.page import render, source
from reports.rendering.record_fields import Record, count, nested, number, records, text, texts
from reports.rendering.sanitizing import plain, shown
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
    for has_details in (_always, _is_not_fine, _never):
        listed = [_case(case, has_details=has_details(case)) for case in cases]
        data = embedded_json({**shared, "cases": listed})
        if len(data) <= _MAX_DATA_CHARACTERS:
            break
    script = "\n".join(source(f"{name}.js") for name in _SCRIPTS)
    page = render(
        "conform.html.j2",
        script=f'"use strict";\n{{\n{script}}}\n',
        styles=["vendor/uPlot.min.css", "page.css", "conform.css"],
        data=data,
        view=conform_view(record),
    )
    return write_atomic(folder / "index.html", page)


def _always(_case: Record) -> bool:
    return True


def _is_not_fine(case: Record) -> bool:
    return text(case, "verdict") != "pass"


def _never(_case: Record) -> bool:
    return False


def _case(case: Record, *, has_details: bool) -> Json:
    """Return a case as the page's script reads it.

    Without details its files are omitted, as are the events, paths and findings of its results.
    """
    return {
        "name": shown(text(case, "name"), 200),
        "suite": shown(text(case, "suite"), 80),
        "title": shown(text(case, "title"), 300),
        "rules": [shown(rule, 20) for rule in texts(case, "rules")],
        "phase": shown(text(case, "phase"), 20),
        "profile": shown(text(case, "profile"), 40),
        "negative": bool(case.get("negative")),
        "unconfirmed": shown(text(case, "unconfirmed"), 300),
        "verdict": shown(text(case, "verdict"), 20),
        "io": [shown(line, 200) for line in texts(case, "io")],
        "files": [
            {
                "name": shown(text(file, "name"), 200),
                "lines": [shown(line, 400) for line in text(file, "text").splitlines()[:3000]],
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
        "executor": shown(text(result, "executor"), 40),
        "robot": shown(text(result, "robot"), 40),
        "verdict": shown(text(result, "verdict"), 20),
        "reason": shown(text(result, "reason"), 600),
        "ending": shown(text(result, "ending"), 60),
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
        "tier": shown(text(rule, "tier"), 10),
        "mayFail": bool(rule.get("may_fail")),
        "statement": shown(text(rule, "statement"), 600),
        "source": shown(text(rule, "source"), 100),
        "unshown": shown(text(rule, "unshown"), 300),
        "cases": count(rule, "cases"),
    }


def _run(run: Record) -> Json:
    conform = nested(run, "conform") or run
    return {
        "date": shown(text(run, "date") or text(run, "generated"), 40),
        "verdicts": {name: count(nested(conform, "verdicts"), name) for name in VERDICTS},
        "seconds": number(conform, "seconds"),
    }
