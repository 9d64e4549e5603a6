"""The page of a night: what changed, how its steps went, and the curves over all nights."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from reports.embed import embedded_json
from reports.fields import Record, count, nested, number, records, text, texts
from reports.page import render, source, write_page
from reports.plain import plain, shown
from reports.spelling import Figure, percent, share

__all__ = ["write_night_page"]

_MAX_NIGHTS = 400
_MAX_CHANGES = 300
_BAD = ("new failure", "case vanished", "slower", "step ", "survey: new cluster", "fuzz:")
_GOOD = ("fixed", "survey: gone cluster")

Json = dict[str, Any]


@dataclass(frozen=True, slots=True)
class _Step:
    name: str
    status: str
    is_fine: bool
    seconds: float
    page: str


@dataclass(frozen=True, slots=True)
class _NightView:
    date: str
    figures: tuple[Figure, ...]
    changes: tuple[tuple[str, str], ...]
    steps: tuple[_Step, ...]
    bench: tuple[tuple[str, str], ...]
    nights: int


def write_night_page(record: Mapping[str, Any], folder: Path) -> Path:
    """Write ``folder``/index.html, the page of one night, and return its path.

    ``record`` is a line of the history with ``changes``, the sentences of
    `reports.history.changes`, and ``history``, the lines up to it; every field may be absent. The
    page appears whole or not at all. Raises OSError when the folder cannot be made or written.
    """
    nights = records(record, "history")[-_MAX_NIGHTS:]
    data = embedded_json({"nights": [_short(night) for night in nights]})
    scripts = "\n".join(source(f"{name}.js") for name in ("page", "night"))
    page = render(
        "night.html.j2",
        script=f'"use strict";\n{{\n{scripts}}}\n',
        styles=["page.css", "conform.css", "night.css"],
        data=data,
        view=_view(record, len(nights)),
    )
    return write_page(page, folder / "index.html")


def _short(night: Record) -> Json:
    """A night as its curves need it."""
    recover, conform = nested(night, "recover"), nested(night, "conform")
    verdicts = nested(conform, "verdicts")
    return {
        "date": shown(text(night, "date"), 40),
        "parsed": share(count(recover, "parsed"), count(recover, "files")),
        "passed": count(verdicts, "pass"),
        "failed": count(verdicts, "fail"),
        "divergences": count(nested(night, "fuzz"), "divergences"),
        "bench": {
            shown(name, 80): plain(value)
            for name, value in nested(night, "bench").items()
            if isinstance(value, int | float)
        },
    }


def _view(record: Mapping[str, Any], nights: int) -> _NightView:
    recover, conform = nested(record, "recover"), nested(record, "conform")
    verdicts, fuzz = nested(conform, "verdicts"), nested(record, "fuzz")
    files, parsed = count(recover, "files"), count(recover, "parsed")
    hard, covered = count(conform, "hard"), count(conform, "hard_covered")
    return _NightView(
        date=shown(text(record, "date"), 40),
        figures=(
            Figure("files parse", percent(parsed, files), f"{parsed:,} of {files:,}"),
            Figure(
                "runs of cases pass",
                f"{count(verdicts, 'pass'):,}",
                f"{count(verdicts, 'fail'):,} fail, {count(verdicts, 'skipped'):,} skipped",
            ),
            Figure(
                "rules covered", percent(covered, hard), f"{covered:,} of {hard:,} that may fail"
            ),
            Figure(
                "programs fuzzed",
                f"{count(fuzz, 'programs'):,}",
                f"{count(fuzz, 'divergences'):,} divergences",
            ),
        ),
        changes=tuple(
            (_tone(one), shown(one, 400)) for one in texts(record, "changes")[:_MAX_CHANGES]
        ),
        steps=tuple(_step(name, step) for name, step in nested(record, "steps").items()),
        bench=tuple(
            (shown(name, 80), f"{value:,.4g}")
            for name, value in nested(record, "bench").items()
            if isinstance(value, int | float)
        ),
        nights=nights,
    )


def _tone(change: str) -> str:
    return "bad" if change.startswith(_BAD) else "good" if change.startswith(_GOOD) else ""


def _step(name: str, step: Any) -> _Step:
    fields: Record = step if isinstance(step, Mapping) else {}
    status, page = text(fields, "status"), text(fields, "page")
    # a link of ours: a relative one without any scheme
    is_ours = page.replace("/", "").replace(".", "").replace("-", "").isalnum()
    return _Step(
        shown(name, 60),
        shown(status, 300),
        status in ("ok", "findings"),
        number(fields, "seconds"),
        page if is_ours and not page.startswith("/") else "",
    )
