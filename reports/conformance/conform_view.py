"""The content of the page of a conformance run: headline figures, and the matrix of the suites."""

from collections.abc import Mapping
from typing import Any

from reports.rendering.number_format import Figure, counted, percent, share
from reports.rendering.record_fields import Record, count, nested, number, records, text, texts
from reports.rendering.sanitizing import shown

_RUN = "each case on every executor and robot, against its rule and against one another"
_RECORDED = "what a controller did in each case, against its rule"
_MOST_LEFT = 2_000
VERDICTS = ("pass", "fail", "unconfirmed", "known-failure", "skipped")
_WORST_FIRST = ("fail", "known-failure", "unconfirmed", "pass", "skipped")

Json = dict[str, Any]


def conform_view(record: Mapping[str, Any]) -> Json:
    """Return what the template shows beside a record of `conform_page.write_conformance_page`.

    ``subtitle`` says what was compared with what. ``left`` are cases without a result, with the
    reason why; ``rows`` are the suites with a cell for each column, ``None`` if it did not run
    there.
    """
    suites = records(record, "suites")
    columns = _columns(suites)
    failed = count(nested(record, "case_verdicts"), "fail")
    total = count(record, "cases_total")
    headline = f"{counted(failed, 'case')} of {total:,} failed" if failed else "No case failed"
    cut_off, recording = texts(record, "not_run"), text(record, "recording")
    if cut_off:
        headline = f"{headline}; cut off before {counted(len(cut_off), 'case')}"
    if recording:
        headline = f"Recording of {recording}: {headline[0].lower()}{headline[1:]}"
    left = cut_off or texts(record, "not_recorded")
    return {
        "record": record,
        "headline": shown(headline, 200) if total else "No case was run",
        "subtitle": _RECORDED if recording else _RUN,
        "left": (
            f"{counted(len(left), 'case')} {'not run' if cut_off else 'not recorded'}",
            [shown(name, 80) for name in left[:_MOST_LEFT]],
        ),
        "is_green": bool(total) and not failed and not cut_off,
        "figures": _figures(record),
        "columns": columns,
        "rows": [(suite, _cells(suite, columns)) for suite in suites],
    }


def _columns(suites: list[Record]) -> tuple[tuple[str, str], ...]:
    """Return the executors and robots that occur; the column of the front end is last."""
    found = {_place(cell) for suite in suites for cell in records(suite, "cells")}
    order = {name: place for place, name in enumerate(("tree", "vm", "native"))}
    robots = {name: place for place, name in enumerate(("none", "kinematic", "mujoco"))}
    return tuple(sorted(found, key=lambda c: (robots.get(c[1], 9), order.get(c[0], 9), c)))


def _place(cell: Record) -> tuple[str, str]:
    return shown(text(cell, "executor"), 40), shown(text(cell, "robot"), 40)


def _cells(suite: Record, columns: tuple[tuple[str, str], ...]) -> list[Json | None]:
    cells = {_place(cell): _cell(nested(cell, "verdicts")) for cell in records(suite, "cells")}
    return [cells.get(place) for place in columns]


def _cell(verdicts: Record) -> Json:
    """Return a suite on one executor and robot: the number of cases by verdict, and the worst."""
    counts = [(name, count(verdicts, name)) for name in VERDICTS]
    return {
        "counts": counts,
        "total": sum(number for _, number in counts),
        "worst": next((name for name in _WORST_FIRST if count(verdicts, name)), "none"),
    }


def _figures(record: Mapping[str, Any]) -> list[Figure]:
    verdicts, coverage = nested(record, "case_verdicts"), nested(record, "coverage")
    total, passed = count(record, "cases_total"), count(verdicts, "pass")
    hard, hard_covered = count(coverage, "hard"), count(coverage, "hard_covered")
    seconds = number(record, "seconds")
    figures = [
        Figure("cases pass", f"{passed:,}", f"of {total:,}", share(passed, total)),
        Figure("fail", f"{count(verdicts, 'fail'):,}"),
        Figure(
            "not sure enough to fail",
            f"{count(verdicts, 'unconfirmed'):,}",
            f"{count(verdicts, 'known-failure'):,} known, "
            f"{count(verdicts, 'skipped'):,} skipped everywhere",
        ),
        Figure(
            "rules that may fail have cases",
            percent(hard_covered, hard),
            f"{hard_covered:,} of {hard:,}; "
            f"{count(coverage, 'covered'):,} of all {count(coverage, 'rules'):,}",
            share(hard_covered, hard),
        ),
        Figure("negative", percent(count(record, "negative"), total)),
    ]
    if seconds:
        runs = count(record, "runs")
        figures.append(
            Figure("runs a second", f"{runs / seconds:.1f}", f"{runs:,} in {seconds:.1f} s")
        )
    kill = record.get("kill_rate")
    if isinstance(kill, int | float):
        figures.append(Figure("planted faults found", percent(float(kill), 1.0)))
    return figures
