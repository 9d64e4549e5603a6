"""The page of the growth of the grammar: one file without network access."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from reports.recovery.construct_data import construct_data
from reports.recovery.growth_view import growth_view
from reports.rendering.embedding import embedded_json
from reports.rendering.page import joined, render
from reports.rendering.record_fields import Record, count, nested, number, records, text, texts
from reports.rendering.sanitizing import shown
from support.files.atomic_write import write_atomic

_MAX_STEPS = 2000
_MAX_FILES = 100
_SCRIPTS = (
    "vendor/uPlot.iife.min",
    "page",
    "source",
    "construct",
    "line-chart",
    "growth-chart",
    "growth-table",
)

Json = dict[str, Any]


def write_growth_page(record: Mapping[str, Any], folder: Path) -> Path:
    """Write ``folder``/index.html, the page of one replay of the ledger, and return its path.

    ``record`` is what ``krl growth --json`` writes; every field may be absent. Equal records give
    equal bytes. The page is written atomically.

    Raises OSError if the folder cannot be made or written.
    """
    steps, meanings = records(record, "steps")[:_MAX_STEPS], nested(record, "meanings")
    data = embedded_json(
        {
            "files": count(record, "files"),
            "bytes": number(record, "bytes"),
            "meanings": {shown(name, 20): shown(text(meanings, name), 200) for name in meanings},
            "steps": [_step(step) for step in steps],
        }
    )
    page = render(
        "growth.html.j2",
        script=joined(_SCRIPTS),
        styles=["vendor/uPlot.min.css", "page.css", "growth.css"],
        data=data,
        view=growth_view(record),
    )
    return write_atomic(folder / "index.html", page)


def _step(step: Record) -> Json:
    """Return a step as the page's script reads it."""
    metrics = nested(step, "metrics")
    return {
        **construct_data(step),
        "parsed": count(step, "parsed"),
        "parsedBytes": number(step, "parsed_bytes"),
        "restored": count(step, "restored"),
        "broken": count(step, "broken"),
        "restoredFiles": [shown(one) for one in texts(step, "restored_files")[:_MAX_FILES]],
        "brokenFiles": [shown(one) for one in texts(step, "broken_files")[:_MAX_FILES]],
        "failing": count(step, "failing_lines"),
        "metrics": {shown(name, 20): number(metrics, name) for name in metrics},
    }
