"""The static parts of the growth page: headline, steps, remaining files.

All texts can be printed as they are: untrusted ones have passed through `printable`.
"""

from collections.abc import Sequence
from typing import Any

from reports.recovery.construct_data import anchor
from reports.recovery.skipped_files import skipped_files
from reports.rendering.embedding import printable
from reports.rendering.number_format import Figure, clip, counted, moment, percent, share, size
from reports.rendering.record_fields import Record, count, nested, number, records, text, texts
from reports.rendering.sanitizing import shown, shown_texts

_BIGGEST = 40
_MAX_FILES = 400
_MAX_LINES = 40
_MAX_OTHERS = 60


_NO_KRL = frozenset({"invalid", "template", "damaged"})

Json = dict[str, Any]


def growth_view(record: Record) -> Json:
    """Return what the template shows; ``state`` is no-files, no-steps or steps."""
    steps = records(record, "steps")
    rows = _rows(steps)
    version = text(record, "version")
    made = [version and f"krl {version}", moment(text(record, "generated"))]
    left = records(record, "remaining_files")
    look, ambiguous = nested(record, "lookahead"), nested(record, "ambiguous")
    undecided = texts(look, "others")
    return {
        "state": _state(record, steps),
        **shown_texts(record, grammar=400),
        "grammar_hash": shown(text(record, "grammar_sha256"), 64),
        "made": " · ".join(shown(part, 80) for part in made if part),
        "headline": _headline(record, steps),
        "figures": _figures(record, steps),
        "rows": rows,
        "biggest": sorted(rows, key=lambda row: -row["restored"])[:_BIGGEST],
        "remaining": len(left),
        "left": _left(record, left),
        "left_out": max(0, len(left) - _MAX_FILES),
        "explained": sum(text(file, "kind") in _NO_KRL for file in left),
        "decisions": count(look, "decisions"),
        "one": percent(number(look, "one"), 100),
        "two": percent(number(look, "two"), 100),
        "undecided": [shown(line) for line in undecided[:_MAX_OTHERS]],
        "undecided_total": len(undecided),
        "ambiguous": count(ambiguous, "lines"),
        "ambiguous_of": count(ambiguous, "of"),
        "ambiguous_examples": [
            (f"{shown(text(e, 'path'), 300)}:{count(e, 'line')}", shown(text(e, "text"), 300))
            for e in records(ambiguous, "examples")
        ],
        "skipped": [*skipped_files(record, _MAX_FILES)],
    }


def _state(record: Record, steps: Sequence[Record]) -> str:
    if count(record, "files") == 0:
        return "no-files"
    return "steps" if len(steps) > 1 else "no-steps"


def _headline(record: Record, steps: Sequence[Record]) -> str:
    """Return the growth in one sentence."""
    if len(steps) < 2 or not count(record, "files"):
        return ""
    files = count(record, "files")
    first, last = (percent(count(s, "parsed"), files) for s in (steps[0], steps[-1]))
    return f"From {first} of the files to {last} in {counted(len(steps) - 1, 'construct')}."


def _figures(record: Record, steps: Sequence[Record]) -> tuple[Figure, ...]:
    files, octets = count(record, "files"), number(record, "bytes")
    first: Record = steps[0] if steps else {}
    last: Record = steps[-1] if steps else {}
    parsed, parsed_octets = count(last, "parsed"), number(last, "parsed_bytes")
    metrics = nested(last, "metrics")
    left = count(record, "remaining_files")
    return (
        Figure(
            "files parse",
            percent(parsed, files),
            f"{parsed:,} of {counted(files, 'file')}; {count(first, 'parsed'):,} at the start",
            share(parsed, files),
        ),
        Figure(
            "bytes in them",
            percent(parsed_octets, octets),
            f"{size(parsed_octets)} of {size(octets)}",
            share(parsed_octets, octets),
        ),
        Figure("constructs", f"{max(0, len(steps) - 1):,}", "accepted, each with its evidence"),
        Figure(
            "failing lines",
            f"{count(last, 'failing_lines'):,}",
            f"{count(first, 'failing_lines'):,} at the start",
        ),
        Figure(
            "different files left", f"{left:,}", "listed below" if left else "every file parses"
        ),
        Figure("rules", f"{count(metrics, 'VAR'):,}", f"{count(metrics, 'TERM'):,} kinds of token"),
    )


def _rows(steps: Sequence[Record]) -> list[Json]:
    """Return the steps; ``bar`` is its restored files relative to the largest such number."""
    most = max((count(step, "restored") for step in steps), default=0)
    rows = []
    before: Record | None = None
    for step in steps:
        evidence = nested(step, "evidence")
        failing = count(step, "failing_lines")
        rows.append(
            {
                "anchor": anchor(step),
                "number": count(step, "number"),
                "title": shown(text(step, "title") or text(step, "id"), 200),
                "grounds": [shown(ground, 20) for ground in texts(step, "grounds")],
                "files": count(evidence, "files"),
                "origins": count(evidence, "origins"),
                "restored": count(step, "restored"),
                "broken": count(step, "broken"),
                "bar": share(count(step, "restored"), most),
                "parsed": percent(count(step, "parsed"), count(step, "files")),
                "parsed_bytes": percent(number(step, "parsed_bytes"), number(step, "bytes")),
                "failing": failing,
                "mended": count(before, "failing_lines") - failing if before is not None else 0,
            }
        )
        before = step
    return rows


def _left(record: Record, files: Sequence[Record]) -> list[Json]:
    """Return the files that do not parse after the last step.

    ``kind`` is invalid, template, damaged, waiting or empty; ``why`` is the reason and ``why_line``
    its line.
    """
    lines: dict[str, list[Record]] = {}
    for line in records(record, "remaining"):
        lines.setdefault(text(line, "path"), []).append(line)
    rows = []
    for file in files[:_MAX_FILES]:
        own = lines.get(text(file, "path"), [])
        rows.append(
            {
                **shown_texts(file, path=400, kind=20),
                "failing": count(file, "failing"),
                "why": shown(text(file, "reason"), 200),
                "why_line": count(file, "fact_line") * (text(file, "fact") == text(file, "reason")),
                "lines": [_left_line(line) for line in own[:_MAX_LINES]],
                "more": max(0, len(own) - _MAX_LINES),
            }
        )
    return rows


def _left_line(line: Record) -> Json:
    """Return a failing line: before, in and after the offending token."""
    source, token, at = text(line, "text"), text(line, "token"), count(line, "column") - 1
    at = min(max(at, 0), len(source))
    return {
        "line": count(line, "line"),
        "before": printable(source[:at].lstrip()[-160:]),
        "token": printable(clip(token, 80)),
        "after": printable(clip(source[at + len(token) :], 160)),
    }
