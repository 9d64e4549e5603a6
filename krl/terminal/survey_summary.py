"""The summary of a survey in the terminal: figures, clusters, path of the page."""

import math
from pathlib import Path
from typing import TYPE_CHECKING

from rich import box
from rich.console import Console
from rich.table import Table
from rich.text import Text

from krl.errors import one_line, say
from reports.rendering.number_format import counted

if TYPE_CHECKING:
    from recovery.record.record_types import ClusterRecord, StartRecord, SurveyRecord

_ROWS = 15
_WIDE = 120  # columns; narrower terminals have no room for examples
_WORDS = 12
_SKIPPED = 5


def print_survey(record: "SurveyRecord", page: Path) -> None:
    """Print the figures of `record`, its first clusters, and `page`."""
    console = Console(highlight=False, markup=False, emoji=False)
    files, parsed = record["files"], record["parsed"]
    say(
        f"{counted(files, 'file')}, {record['bytes'] / 1e6:.2f} MB; parsed {parsed:,} "
        f"({percentage(parsed, files)} of files, "
        f"{percentage(record['parsed_bytes'], record['bytes'])} of bytes); "
        f"skipped {len(record['skipped']):,}; surveyed in {record['seconds']:.1f} s"
    )
    for skipped in record["skipped"][:_SKIPPED]:
        console.print(
            f"skipped {one_line(skipped['path'])}: {one_line(skipped['reason'])}", markup=False
        )
    if len(record["skipped"]) > _SKIPPED:
        console.print(f"… and {len(record['skipped']) - _SKIPPED:,} more skipped")
    clusters = record["clusters"]
    if clusters:
        console.print(_table(clusters[:_ROWS], has_examples=console.width >= _WIDE))
        if len(clusters) > _ROWS:
            console.print(f"… and {counted(len(clusters) - _ROWS, 'more cluster')}")
        console.print(_advice(record))
    elif files:
        console.print("Nothing is missing: every file parses under this grammar.")
    start = record.get("start")
    if start is not None:
        say(_story(start))
    if record["swallowed"]:
        words = ", ".join(s["word"] for s in record["swallowed"][:_WORDS])
        console.print(
            f"Read as names everywhere and bound nowhere, perhaps keywords: {one_line(words)}"
        )
    say(f"Page: {one_line(str(page))}")


def percentage(part: float, whole: float) -> str:
    """Return a percentage, rounded down, so that all but one is never shown as 100 %."""
    return f"{math.floor(1000 * part / whole) / 10:.1f} %" if whole else "–"


def _table(clusters: "list[ClusterRecord]", *, has_examples: bool) -> Table:
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, expand=True)
    table.add_column("what fails", no_wrap=True, overflow="ellipsis", ratio=1)
    for heading in ("unlocks", "files", "origins", "lines"):
        table.add_column(heading, justify="right", no_wrap=True, min_width=len(heading))
    table.add_column("cluster", no_wrap=True, min_width=10)
    if has_examples:
        table.add_column("for example", no_wrap=True, overflow="ellipsis", ratio=1)
    for c in clusters:
        # Text, never markup, and nothing that could steer the terminal: source is other people's
        table.add_row(
            Text(one_line(c["title"])),
            f"{c['unlocks']:,}",
            f"{c['files']:,}",
            f"{c['origins']:,}",
            f"{c['failures']:,}",
            c["id"],
            *([Text(one_line(c["example"]["text"]))] if has_examples else ()),
        )
    return table


def _advice(record: "SurveyRecord") -> str:
    """Return how many clusters to repair so that 95 % of the files parse."""
    files = record["files"]
    for number, step in enumerate(record["greedy"], 1):
        if step["parsed"] >= 0.95 * files:
            return (
                f"Mending {number} of {counted(len(record['clusters']), 'cluster')} lets "
                f"{percentage(step['parsed'], files)} of the files parse."
            )
    return ""


def _story(start: "StartRecord") -> str:
    """Return what the ledger achieved, starting from the restrictive start."""
    clusters, constructs = start["clusters"], start["constructs"]
    each = f", {len(clusters) / len(constructs):.1f} clusters each" if constructs else ""
    answered = sum(cluster["answered_by"] is not None for cluster in clusters)
    return (
        f"Under the restrictive start {start['parsed']:,} of {counted(start['files'], 'file')} "
        f"parse; of its {counted(len(clusters), 'cluster')} {answered:,} are "
        f"answered by constructs ({len(constructs):,}{each})."
    )
