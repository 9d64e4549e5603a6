"""What the growth page shows beside its record: headline, figures, steps, remaining files."""

from collections.abc import Sequence
from typing import Any

from reports.recovery.construct_data import anchor
from reports.recovery.skipped_files import skipped_files
from reports.rendering.embedding import printable
from reports.rendering.number_format import Figure, clip, counted, percent, share, size
from reports.rendering.record_fields import Record, count, nested, number, records, text
from reports.rendering.sanitizing import made_by

_BIGGEST = 40
_MAX_FILES = 400
_MAX_LINES = 40
_NO_KRL = frozenset({"invalid", "template", "damaged"})

Json = dict[str, Any]


def growth_view(record: Record) -> Json:
    """Return what the template shows beside the record; ``state`` is no-files, no-steps or steps.

    ``most`` is the largest number of files that a step restores.
    """
    steps, left = records(record, "steps"), records(record, "remaining_files")
    return {
        "record": record,
        "state": _state(record, steps),
        "made": made_by(record),
        "headline": _headline(record, steps),
        "figures": _figures(record, steps),
        "steps": steps,
        "anchor": anchor,
        "most": max((count(step, "restored") for step in steps), default=0),
        "biggest": sorted(steps, key=lambda step: -count(step, "restored"))[:_BIGGEST],
        "remaining": len(left),
        "left": _left(record, left[:_MAX_FILES]),
        "explained": sum(text(file, "kind") in _NO_KRL for file in left),
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


def _left(record: Record, files: Sequence[Record]) -> list[tuple[Record, list[Json], int]]:
    """Return the files with their failing lines, and how many of these are left out.

    The ``kind`` of a file is invalid, template, damaged, waiting or empty.
    """
    lines: dict[str, list[Record]] = {}
    for line in records(record, "remaining"):
        lines.setdefault(text(line, "path"), []).append(line)
    each = [(file, lines.get(text(file, "path"), [])) for file in files]
    return [
        (file, [_left_line(line) for line in own[:_MAX_LINES]], max(0, len(own) - _MAX_LINES))
        for file, own in each
    ]


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
