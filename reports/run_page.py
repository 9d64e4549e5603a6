"""The page of one run: where the arm went, how fast, what was switched when, and by which line."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from reports.embedding import embedded_json, printable
from reports.number_format import clip
from reports.page import render, source
from reports.record_fields import Record, count, nested, number, records, text
from reports.run_view import run_view
from reports.sanitizing import plain
from support.files.atomic_write import write_atomic

__all__ = ["write_run_page"]

_MAX_SAMPLES = 6_000
_MAX_EVENTS = 20_000
_MAX_FILES = 40
_MAX_LINES = 5_000
_SCRIPTS = ("page", "run-cursor", "run-scene", "run-charts", "run-signals", "run-program")

Json = dict[str, Any]


def write_run_page(record: Mapping[str, Any], target: Path) -> Path:
    """Write the page of a run to the file ``target`` and return its path.

    ``record`` is what `interp.run_record` makes of a run; every field may be absent. Times are µs,
    lengths mm, angles degrees, speeds of the tool m/s. The same record gives the same bytes, and
    the page appears whole or not at all.

    Raises OSError when the file cannot be written.
    """
    data = embedded_json(
        {
            "end": count(nested(record, "outcome"), "time"),
            "events": [plain(one, 200) for one in records(record, "events")[:_MAX_EVENTS]],
            "files": [_file(one) for one in records(record, "files")[:_MAX_FILES]],
            "path": _path(nested(record, "path")),
            "limits": _limits(nested(record, "limits")),
            "points": [_point(one) for one in records(record, "points")],
        }
    )
    script = "\n".join(source(f"{name}.js") for name in _SCRIPTS)
    page = render(
        "run.html.j2",
        script=f'"use strict";\n{{\n{script}}}\n',
        styles=["page.css", "run.css"],
        data=data,
        view=run_view(record),
    )
    return write_atomic(target, page)


def _file(file: Record) -> Json:
    lines = text(file, "text").splitlines()[:_MAX_LINES]
    return {
        "path": printable(clip(text(file, "path"), 400)),
        "lines": [printable(clip(line.replace("\t", "    "), 400)) for line in lines],
    }


def _path(path: Record) -> Json:
    """Set-points, thinned out evenly where there are more than a page can show."""
    times = _numbers(path.get("t"))
    stride = 1 + len(times) // _MAX_SAMPLES
    return {
        "t": times[::stride],
        "tool": _rows(path.get("tool"))[::stride],
        "measured": _rows(path.get("tool_measured"))[::stride],
        "speed": _numbers(path.get("speed"))[::stride],
        "axes": [_numbers(axis)[::stride] for axis in path.get("axis_speeds") or ()],
    }


def _limits(limits: Record) -> Json:
    return {"axes": _numbers(limits.get("axis_speeds")), "speed": number(limits, "speed") or None}


def _point(point: Record) -> Json:
    return {
        "motion": count(point, "motion"),
        "kind": printable(clip(text(point, "kind"), 20)),
        "at": printable(clip(text(point, "at"), 400)),
        "place": _numbers(point.get("place")),
        "blended": bool(point.get("blended")),
    }


def _numbers(values: Any) -> list[float]:
    """Finite numbers to five digits behind the point; anything else counts as 0."""
    if not isinstance(values, Sequence) or isinstance(values, str):
        return []
    return [
        round(float(one), 5) if isinstance(one, int | float) and abs(one) < float("inf") else 0.0
        for one in values
    ]


def _rows(rows: Any) -> list[list[float]]:
    return [_numbers(row) for row in rows] if isinstance(rows, Sequence) else []
