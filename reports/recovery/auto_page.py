"""The page of an automatic recovery: growth, and accepted and refused edits with the reasons."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from reports.rendering.number_format import Figure, counted, percent, share
from reports.rendering.page import render
from reports.rendering.record_fields import Record, count, nested, number, records, text, texts
from reports.rendering.sanitizing import shown, shown_texts
from support.files.atomic_write import write_atomic

_MAX_ROUNDS = 200
_MAX_ROWS = 400
_LONGEST = 600
_WIDTH, _HEIGHT, _LEFT, _BOTTOM = 640, 220, 68, 24

Json = dict[str, Any]


def write_auto_page(record: Mapping[str, Any], folder: Path) -> Path:
    """Write ``folder``/index.html and return its path; any field of the record may be absent.

    ``record`` is what ``krl recover --auto --json`` writes. The page is written atomically. Raises
    OSError if the folder cannot be made or written.
    """
    page = render("auto.html.j2", styles=["page.css", "auto.css"], view=_view(record))
    return write_atomic(folder / "index.html", page)


def _view(record: Record) -> Json:
    rounds = records(record, "rounds")[:_MAX_ROUNDS]
    last = rounds[-1] if rounds else {}
    figures = [_figure(name, nested(last, key)) for name, key in _HALVES if nested(last, key)]
    taken = [row for n, done in enumerate(rounds, 1) for row in _taken(n, done)]
    refused = _refused(rounds)
    figures.append(Figure("steps taken", f"{len(taken):,}", counted(len(rounds), "round")))
    minutes = number(record, "seconds") / 60
    rules = count(record, "rules") or count(last, "rules")
    figures.append(Figure("rules", f"{rules:,}", f"grown in {minutes:.1f} minutes"))
    figures += _target(nested(record, "target"))
    curves = [
        {"name": key, "points": _points([nested(done, key) for done in rounds])}
        for _, key in _HALVES
        if count(nested(last, key), "files")
    ]
    return {
        "headline": percent(*_of(nested(last, "shown"))) if rounds else "",
        **shown_texts(record, start=_LONGEST),
        "figures": [f for f in figures if f.value != "–"],
        "curves": curves,
        "grid": [(_y(part), f"{100 * part:.0f} %") for part in (0.0, 0.5, 1.0)],
        "held_out": [shown(origin, _LONGEST) for origin in texts(record, "held_out")[:_MAX_ROWS]],
        "taken": taken[:_MAX_ROWS],
        "refused": refused[:_MAX_ROWS],
        "is_finished": record.get("finished") is True,
        "width": _WIDTH,
        "height": _HEIGHT,
        "left": _LEFT,
    }


_HALVES = (("of the files shown parse", "shown"), ("of the files held out parse", "held"))


def _of(reading: Record) -> tuple[int, int]:
    return count(reading, "parsed"), count(reading, "files")


def _figure(name: str, reading: Record) -> Figure:
    parsed, files = _of(reading)
    note = f"{parsed:,} of {files:,}; {counted(count(reading, 'failing'), 'line')} fail"
    return Figure(name, percent(parsed, files), note, share(parsed, files))


def _target(target: Record) -> list[Figure]:
    """Return figures that compare the grown grammar with the one it should become."""
    name = shown(text(target, "name"), _LONGEST)
    labels = {
        "shown": f"of the files shown that {name} parses",
        "held": f"of the files held out that {name} parses",
        "held_known_words": "of those of them whose words some file shown has, or the start",
        "held_within_reach": "of those of them within reach: no neighbours that no file shown has",
        "sentences_rejected": f"of its random sentences are rejected by {name}",
        "sentences_rejected_for_growth": "of them are so at a line that the start rejects too",
        "negatives_accepted": "of the negatives are accepted",
    }
    found = []
    for key, label in labels.items():
        some, every = (count(nested(target, key), part) for part in ("count", "of"))
        if every:
            note = f"{some:,} of {every:,}"
            found.append(Figure(label, percent(some, every), note, share(some, every)))
    return found


def _points(readings: Sequence[Record]) -> str:
    step = (_WIDTH - _LEFT - 12) / max(1, len(readings) - 1)
    return " ".join(
        f"{_LEFT + n * step:.1f},{_y(share(*_of(reading))):.1f}"
        for n, reading in enumerate(readings)
    )


def _y(part: float) -> float:
    return 12 + (1 - part) * (_HEIGHT - _BOTTOM - 12)


def _taken(number: int, done: Record) -> list[Json]:
    return [
        _row(
            number,
            step,
            f"{counted(count(step, 'files'), 'file')}, {counted(count(step, 'origins'), 'origin')}"
            if count(step, "lines")
            else "no line needs it",
        )
        for step in records(done, "taken")
    ]


def _refused(rounds: Sequence[Record]) -> list[Json]:
    """Return the steps refused since lines last showed one that was taken.

    Those refused before may have been taken since. The rounds at the end look for different things.
    """
    shown_by_lines = [any(count(s, "lines") for s in records(r, "taken")) for r in rounds]
    since = max((n for n, is_one in enumerate(shown_by_lines) if is_one), default=0)
    found: dict[tuple[str, ...], Json] = {}
    for place, done in enumerate(rounds[since:], since + 1):
        for step in records(done, "refused"):
            row = _row(place, {**step, "id": ""}, text(step, "reason"))
            found[text(step, "title"), *row["edits"]] = row
        for step in records(done, "taken"):
            found.pop((text(step, "title"), *_row(place, step, "")["edits"]), None)
    return list(found.values())


def _row(number: int, step: Record, note: str) -> Json:
    """Return an accepted or refused step; ``note`` is the evidence or the reason."""
    return {
        "round": number,
        **shown_texts(step, id=_LONGEST, title=_LONGEST),
        "edits": [shown(edit, _LONGEST) for edit in texts(step, "edits")],
        "note": shown(note, _LONGEST),
    }
