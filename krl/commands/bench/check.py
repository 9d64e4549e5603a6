"""`krl bench check`: what checking a corpus costs, and how many planted mistakes it finds."""

from typing import Annotated, Any, Literal

import typer

from krl.commands.bench.bench_command import Record, bench, print_phases
from krl.errors import say
from krl.terminal.options import JsonOption, ProgramsArgument, programs_or_ours
from krl.terminal.progress import progress_bar
from krl.terminal.text_table import or_dash, print_figures
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


def _print(record: Record) -> None:
    if "s_per_mb" in record:
        _print_speed(record)
    if "planted" in record:
        _print_planted(record["planted"])


def _print_speed(record: Record) -> None:
    counts = record["findings"]
    found = ", ".join(
        counted(counts[word], word) for word in ("error", "warning", "note") if word in counts
    )
    say(
        f"{counted(record['files'], 'file')} of {counted(record['projects'], 'project')}, "
        f"{record['bytes'] / MB:.2f} MB; {found or 'no findings'}; Python {record['python']}"
    )
    print_figures(
        ("figure", "", "aim"),
        [
            ("first check", f"{record['s_per_mb']:.2f} s/MB", "1 s/MB"),
            ("nothing changed", f"{record['unchanged_s_per_mb']:.3f} s/MB", ""),
            ("one file changed", or_dash(record["one_changed_seconds"], "{:.2f} s"), "0.3 s"),
        ],
    )
    print_phases(record)


def _print_planted(planted: Record) -> None:
    for title, rows in (
        ("planted mistakes", [*planted["kinds"], {"kind": "all", **planted}]),
        ("misspelt names", planted["names"]),
    ):
        if rows:
            print_figures(
                (title, "planted", "found", "in place", "findings, median", "p95", "most"),
                [(row["kind"], *(or_dash(row[n]) for n in _PLANTED_FIGURES)) for row in rows],
            )
    say(f"findings each in the median file: {or_dash(planted['median_file'])}")
    before = planted["unplanted"]
    print_figures(
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


@bench(_print)
def check(
    paths: ProgramsArgument = None,
    _json_file: JsonOption = None,
    planted: Annotated[int, typer.Option(min=0)] = 120,
    seed: int = 1,
    missing: Annotated[str, typer.Option(metavar="WHAT", callback=_missing)] = "0",
    damage: Damage = "mistakes",
    speed: Annotated[bool, typer.Option("--speed/--no-speed")] = True,
) -> Record:
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

    roots = programs_or_ours(paths)
    record: dict[str, Any] = {}
    if speed:
        with progress_bar("measuring", steps()) as advance:
            record |= measure_check(roots, on_step=advance)
    if planted:
        with progress_bar("planting mistakes", planted) as advance:
            record["planted"] = measure_planted(
                roots, planted, seed, KINDS[damage], missing=missing, on_step=advance
            )
    return record
