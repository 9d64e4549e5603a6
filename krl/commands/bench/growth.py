"""`krl bench growth`: how the cost of each command grows with its input, by the input's shape."""

from __future__ import annotations

import random
import time
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Final

import typer
from rich.markup import escape

from krl.commands.bench.growth_entries import ENTRIES
from krl.errors import FINE, InputError
from krl.terminal.options import JobsOption, JsonOption, all_cores
from krl.terminal.output_files import check_files, write_json
from krl.terminal.progress import progress_bar
from krl.terminal.text_table import print_figures
from support.files.untrusted import json_of, read_text

if TYPE_CHECKING:
    from support.measure.cost_by_size import Growth

_AIM: Final = 1.15


def growth(
    entry: Annotated[list[str] | None, typer.Option(metavar="NAME")] = None,
    shape: Annotated[list[str] | None, typer.Option(metavar="NAME")] = None,
    largest: Annotated[int, typer.Option(min=32, metavar="KB")] = 512,
    json_file: JsonOption = None,
    jobs: JobsOption = None,
    minutes: Annotated[float | None, typer.Option(min=0)] = None,
    seed: int = 1,
) -> int:
    """Measure how CPU time and memory of each command grow with its input.

    Inputs of each shape have the sizes n, 2n and 4n, where n is the size at which a command takes a
    fifth of a second, and twice as long as for an empty input. A slope is the exponent: 1 is
    linear, 2 quadratic, 0 constant. Each measurement runs in a process of its own. All of them take
    hours: --entry and --shape select some, and with --minutes the results in FILE are not measured
    again.

    Options:
        entry: Only this command; repeatable.
        shape: Only inputs of this shape; repeatable.
        largest: Largest size of an input.
        minutes: Start nothing after N minutes; --json FILE continues later.
        seed: Seed of the order.
    """
    check_files(json_file)
    begun = time.monotonic()
    tasks = [
        (name, title)
        for name in _chosen("--entry", entry, ENTRIES)
        for title in ENTRIES[name].inputs
        if not shape or title in shape
    ]
    if not tasks:
        raise InputError(f"--shape {shape[0] if shape else ''}: no such shape")
    rows = _kept(json_file) if minutes is not None else []
    known = {(row["entry"], row["shape"]) for row in rows}
    tasks = [task for task in tasks if task not in known]
    random.Random(seed).shuffle(tasks)

    from krl.commands.bench.growth_calls import measured_calls
    from support.measure.isolated import call_isolated

    def one(task: tuple[str, str]) -> Growth | None:
        if minutes is not None and time.monotonic() - begun > minutes * 60:
            raise TimeoutError
        return call_isolated(measured_calls, *task, largest * 1_000)

    with (
        progress_bar("measuring", len(tasks)) as advance,
        ThreadPoolExecutor(all_cores(jobs)) as threads,
        suppress(TimeoutError),
    ):
        for task, found in zip(tasks, threads.map(one, tasks), strict=True):
            rows.append(_row(*task, found))
            rows.sort(key=lambda row: (list(ENTRIES).index(row["entry"]), row["shape"]))
            write_json({"bench": "growth", "aim": _AIM, "rows": rows}, json_file, indent=1)
            advance()
    measured = [row for row in rows if row["costs"]]
    if not measured:
        raise InputError("nothing to measure: no such shape can be made for the command")
    _print(measured)
    return FINE


def _kept(record: Path | None) -> list[dict[str, Any]]:
    """Return the rows of an earlier record."""
    if record is None or not record.is_file():
        return []
    try:
        known: Any = json_of(read_text(record))
        rows = known["rows"]
        return [row for row in rows if row["entry"] in ENTRIES and row["shape"] and "costs" in row]
    except (OSError, ValueError, KeyError, TypeError):
        raise InputError(f"{record}: not a record of krl bench growth") from None


def _chosen(option: str, wanted: list[str] | None, known: Mapping[str, object]) -> list[str]:
    if unknown := set(wanted or ()) - set(known):
        raise InputError(f"{option} {min(unknown)}: not one of {', '.join(known)}")
    return [name for name in known if not wanted or name in wanted]


def _row(entry: str, shape: str, found: Growth | None) -> dict[str, Any]:
    """Return a row of the record; without costs if the input cannot be made from the shape."""
    if found is None:
        return {"entry": entry, "shape": shape, "costs": []}
    return {
        "entry": entry,
        "shape": shape,
        "time_slope": found.time_slope,
        "memory_slope": found.memory_slope,
        "base": asdict(found.base),
        "costs": [asdict(cost) for cost in found.costs],
    }


def _print(rows: list[dict[str, Any]]) -> None:
    steep = [
        row
        for row in rows
        if any(slope is None or slope > _AIM for slope in (row["time_slope"], row["memory_slope"]))
    ]
    rows = sorted(rows, key=lambda row: -(9.0 if row["time_slope"] is None else row["time_slope"]))
    print_figures(
        ("command: shape", "time", "memory", "largest", "seconds", "peak"),
        [
            (
                escape(f"{row['entry']}: {row['shape']}"),
                _slope(row["time_slope"]),
                _slope(row["memory_slope"]),
                f"{last['size'] / 1_000:,.0f} kB",
                f"{last['seconds']:.2f}",
                f"{last['peak'] / 1e6:,.0f} MB",
            )
            for row in rows[: max(10, len(steep))]
            for last in row["costs"][-1:]
        ],
        f"{len(rows) - len(steep)} of {len(rows)} grow with an exponent of at most {_AIM}.",
    )


def _slope(slope: float | None) -> str:
    return "too slow" if slope is None else f"{slope:.2f}"
