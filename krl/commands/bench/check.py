"""`krl bench check`: what checking a corpus costs, and how many planted mistakes it finds."""

from collections.abc import Mapping
from typing import Annotated, Any, Literal

import typer
from rich.console import Console

from krl.commands.bench.phases import phases_table
from krl.errors import FINE, as_input_errors
from krl.terminal.options import JsonOption, ProgramsArgument, programs_or_ours
from krl.terminal.output_files import check_files, write_json
from krl.terminal.progress import progress_bar
from krl.terminal.text_table import figures, plain
from reports.rendering.number_format import counted
from support.measure.speed import MB

Damage = Literal["mistakes", "names", "arguments", "tokens", "lines"]
_PLANTED_FIGURES = ("planted", "found", "in_place", "median", "p95", "most")


def _missing(value: str) -> str:
    """Return the value of ``--missing`` if it is valid."""
    try:
        is_share = 0 <= float(value) < 1
    except ValueError:
        is_share = value in ("dat", "others", "cut")
    if not is_share:
        raise typer.BadParameter("a share below 1, 'dat', 'others' or 'cut'")
    return value


def check(
    paths: ProgramsArgument = None,
    json_file: JsonOption = None,
    planted: Annotated[int, typer.Option(min=0)] = 120,
    seed: int = 1,
    missing: Annotated[str, typer.Option(metavar="WHAT", callback=_missing)] = "0",
    damage: Damage = "mistakes",
    speed: Annotated[bool, typer.Option("--speed/--no-speed")] = True,
) -> int:
    """Measure the check: seconds per MB on one core, by phase, and with a cache.

    Then plant random mistakes in the programs, and count how many are found.

    Options:
        planted: Number of mistakes, planted one at a time.
        seed: Seed of the mistakes.
        missing: Leave files out: a random share, 'dat' for all data lists, 'others' for all but the
            checked one; 'cut' truncates three of ten.
        damage: Damage: typical mistakes, only names, lost arguments, any token, or whole lines.
        speed: Measure the speed.
    """
    from grammar.bench.check_speed import measure_check, steps
    from grammar.bench.planted_mistakes import measure_planted
    from grammar.bench.slips import KINDS
    from support.files.discovery import IngestError

    check_files(json_file)
    roots = programs_or_ours(paths)
    record: dict[str, Any] = {"bench": "check"}
    with as_input_errors(IngestError):
        if speed:
            with progress_bar("measuring", steps()) as advance:
                record |= measure_check(roots, on_step=advance)
        if planted:
            with progress_bar("planting mistakes", planted) as advance:
                record["planted"] = measure_planted(
                    roots, planted, seed, KINDS[damage], missing=missing, on_step=advance
                )
    write_json(record, json_file, indent=1)
    _print(record)
    return FINE


def _print(record: Mapping[str, Any]) -> None:
    console = Console(highlight=False)
    if "s_per_mb" in record:
        _print_speed(console, record)
    if "planted" in record:
        _print_planted(console, record["planted"])


def _print_speed(console: Console, record: Mapping[str, Any]) -> None:
    counts = record["findings"]
    found = ", ".join(
        counted(counts[word], word) for word in ("error", "warning", "note") if word in counts
    )
    console.print(
        f"{counted(record['files'], 'file')} of {counted(record['projects'], 'project')}, "
        f"{record['bytes'] / MB:.2f} MB; {found or 'no findings'}; Python {record['python']}",
        soft_wrap=True,
    )
    console.print(
        figures(
            ("figure", "", "aim"),
            [
                ("first check", f"{record['s_per_mb']:.2f} s/MB", "1 s/MB"),
                ("nothing changed", f"{record['unchanged_s_per_mb']:.3f} s/MB", ""),
                ("one file changed", _seconds(record["one_changed_seconds"]), "0.3 s"),
            ],
        )
    )
    console.print(phases_table(record))


def _print_planted(console: Console, planted: Mapping[str, Any]) -> None:
    for title, rows in (
        ("planted mistakes", [*planted["kinds"], {"kind": "all", **planted}]),
        ("misspelt names", planted["names"]),
    ):
        if rows:
            console.print(
                figures(
                    (title, "planted", "found", "in place", "findings, median", "p95", "most"),
                    [(row["kind"], *(plain(row[n]) for n in _PLANTED_FIGURES)) for row in rows],
                )
            )
    console.print(f"findings each in the median file: {plain(planted['median_file'])}")
    before = planted["unplanted"]
    console.print(
        figures(
            ("before planting", "findings", "per 1,000 lines", "for what is missing"),
            [
                (
                    code,
                    f"{count:,}",
                    f"{1000 * count / before['lines']:.2f}",
                    f"{before['caused'].get(code, 0):,}",
                )
                for code, count in before["codes"].items()
            ],
        )
    )


def _seconds(value: float | None) -> str:
    return "–" if value is None else f"{value:.2f} s"
