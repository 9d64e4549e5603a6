"""`krl bench`: how good and how fast the tools themselves are."""

from collections.abc import Mapping
from typing import Annotated, Any

import typer
from rich.console import Console
from rich.table import Table

from krl.commands.bench_arm import arm
from krl.commands.bench_conform import conform
from krl.commands.bench_fuzz import fuzz
from krl.commands.bench_mutation import mutation
from krl.commands.bench_programs import programs
from krl.commands.bench_real_code import real_code
from krl.commands.bench_vm import bench_vm
from krl.errors import FINE, InputError
from krl.options import JsonOption, ProgramsArgument, programs_or_ours
from krl.output_files import check_files, write_json
from krl.progress import progress_bar
from krl.text_table import figures

__all__ = ["app"]

_MB = 1_000_000
_LARGEST = 2_000

app = typer.Typer(help="Measure the tools themselves.")
app.command("mutation")(mutation)
app.command("vm")(bench_vm)
app.command("arm")(arm)
app.command("programs")(programs)
app.command("conform")(conform)
app.command("fuzz")(fuzz)
app.command("real-code")(real_code)


@app.callback()
def _bench() -> None:
    """Measure the tools themselves: figures, and never a verdict."""


@app.command("recover")
def recover(
    paths: ProgramsArgument = None,
    json_file: JsonOption = None,
    sizes: Annotated[
        str,
        typer.Option(
            metavar="MB,…",
            help="Sizes of the synthetic corpora that show how cost grows; '' for none.",
        ),
    ] = "1,10,100",
) -> int:
    """Measure the survey: bytes a second, beside ANTLR, unchanged, and as the corpus grows.

    One core and one process at a time; some minutes with the default sizes, most of them ANTLR's.
    """
    from grammar.notation.g4 import read_file
    from grammar.notation.generate import GRAMMAR
    from grammar.notation.model import GrammarError
    from recovery.bench.survey_speed import measure, steps
    from support.files.discovery import IngestError

    check_files(json_file)
    wanted = _sizes(sizes)
    roots = programs_or_ours(paths)
    try:
        grammar = read_file(GRAMMAR)
        with progress_bar("measuring", steps(wanted)) as advance:
            record = measure(roots, grammar, sizes=wanted, on_step=advance)
    except (GrammarError, IngestError) as error:
        raise InputError(str(error)) from error
    record = {"bench": "recover", "grammar": GRAMMAR.name, **record}
    write_json(record, json_file, indent=1)
    _print_speed(record)
    return FINE


@app.command("check")
def check(
    paths: ProgramsArgument = None,
    json_file: JsonOption = None,
    sizes: Annotated[
        str,
        typer.Option(
            metavar="MB,…",
            help="Sizes of the synthetic corpora that show how cost grows; '' for none.",
        ),
    ] = "1,10",
) -> int:
    """Measure the check: seconds a MB on one core, by phase, unchanged, and as there is more."""
    from recovery.bench.check_speed import measure_check, steps
    from support.files.discovery import IngestError

    check_files(json_file)
    wanted = _sizes(sizes)
    roots = programs_or_ours(paths)
    try:
        with progress_bar("measuring", steps(wanted)) as advance:
            record = measure_check(roots, sizes=wanted, on_step=advance)
    except IngestError as error:
        raise InputError(str(error)) from error
    record = {"bench": "check", **record}
    write_json(record, json_file, indent=1)
    _print_check(record)
    return FINE


def _sizes(given: str) -> list[float]:
    """Sizes in MB from a list with commas."""
    try:
        sizes = [float(size) for size in given.split(",") if size.strip()]
    except ValueError:
        sizes = [0]
    if not all(0 < size <= _LARGEST for size in sizes):
        raise InputError(f"--sizes {given}: not a list of MB, each above 0 and up to {_LARGEST:,}")
    return sizes


# -- in the terminal -------------------------------------------------------------------------------


def _print_speed(record: Mapping[str, Any]) -> None:
    console = Console(highlight=False)
    console.print(
        f"{record['files']:,} files, {record['bytes'] / _MB:.2f} MB; {record['parsed']:,} parse; "
        f"{record['failures']:,} failures; Python {record['python']}",
        soft_wrap=True,
    )
    console.print(_speeds(record))
    console.print(_shares(record))
    console.print(_beside_antlr(record["antlr"]))
    if record["scaling"]:
        console.print(_scaling(record))
        console.print(_growth(record), soft_wrap=True)


def _print_check(record: Mapping[str, Any]) -> None:
    console = Console(highlight=False)
    counts = record["findings"]
    told = ", ".join(
        f"{counts[word]:,} {word}s" for word in ("error", "warning", "note") if word in counts
    )
    console.print(
        f"{record['files']:,} files of {record['projects']:,} projects, "
        f"{record['bytes'] / _MB:.2f} MB; {told or 'no findings'}; Python {record['python']}",
        soft_wrap=True,
    )
    console.print(
        figures(
            ("figure", "", "aim"),
            [
                ("first check", f"{record['s_per_mb']:.2f} s/MB", "6 s/MB"),
                ("nothing changed", f"{record['unchanged_s_per_mb']:.3f} s/MB", ""),
            ],
        )
    )
    console.print(_shares(record))
    if record["scaling"]:
        rows = [
            (
                f"{entry['bytes'] / _MB:,.1f} MB",
                f"{entry['files']:,}",
                f"{entry['seconds']:.1f}",
                f"{entry['s_per_mb']:.2f} s/MB",
                "–" if entry["peak_mb"] is None else f"{entry['peak_mb']:,.0f} MB",
            )
            for entry in record["scaling"]
        ]
        console.print(
            figures(("synthetic corpus", "files", "seconds", "cost", "peak memory"), rows)
        )
        growth = record["memory_growth_mb"]
        more = "" if growth is None else f", {growth:+,.0f} MB of memory"
        console.print(
            f"The last against the first: {record['linear']:.2f} times the cost of a MB{more}",
            soft_wrap=True,
        )


def _shares(record: Mapping[str, Any]) -> Table:
    return figures(
        ("where the time goes", "seconds", "share"),
        [
            (phase["name"], f"{phase['seconds']:.3f}", f"{100 * phase['share']:.1f} %")
            for phase in record["phases"]
        ],
    )


def _speeds(record: Mapping[str, Any]) -> Table:
    ratio = record["ratio_vs_antlr_python"]
    return figures(
        ("figure", "", "aim"),
        [
            ("all failures, cold", _rate(record["bytes_per_s"]), "2 MB/s"),
            ("all failures, warm", _rate(record["warm_bytes_per_s"]), ""),
            ("accept or reject, cold", _rate(record["recognise_bytes_per_s"]), ""),
            ("against ANTLR's Python runtime", _times(ratio), "20 times"),
            ("nothing changed", f"{record['unchanged_s_per_mb']:.3f} s/MB", "0.1 s/MB"),
        ],
    )


def _beside_antlr(antlr: Mapping[str, Any]) -> Table:
    rows = []
    for name, label in (("valid", "valid, yes or no"), ("failing", "failing, all errors")):
        side = antlr[name]
        rows.append(
            (
                label,
                f"{side['files']:,}",
                _in_mb(side["bytes"]),
                f"{side['tokens']:,}",
                _in_mb(side["antlr_bytes_per_s"]),
                _in_mb(side["our_bytes_per_s"]),
                _times(side["ratio"]),
            )
        )
    return figures(("beside ANTLR, MB/s", "files", "MB", "tokens", "ANTLR", "ours", ""), rows)


def _scaling(record: Mapping[str, Any]) -> Table:
    rows = [
        (
            f"{entry['bytes'] / _MB:,.1f} MB",
            f"{entry['files']:,}",
            f"{entry['seconds']:.1f}",
            _rate(entry["bytes_per_s"]),
            "–" if entry["peak_mb"] is None else f"{entry['peak_mb']:,.0f} MB",
            f"{entry['cores']:,}",
        )
        for entry in record["scaling"]
    ]
    return figures(("synthetic corpus", "files", "seconds", "speed", "peak memory", "cores"), rows)


def _growth(record: Mapping[str, Any]) -> str:
    growth = record["memory_growth_mb"]
    more = "" if growth is None else f", {growth:+,.0f} MB of memory"
    return f"The last against the first: {record['linear']:.2f} times the speed{more}"


def _rate(bytes_per_s: float) -> str:
    return f"{_in_mb(bytes_per_s)} MB/s"


def _in_mb(size: float | None) -> str:
    return "–" if size is None else f"{size / _MB:.2f}"


def _times(ratio: float | None) -> str:
    return "–" if ratio is None else f"{ratio:.1f} times"
