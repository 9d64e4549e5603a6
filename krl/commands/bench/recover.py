"""`krl bench recover`: how fast a corpus is surveyed."""

from collections.abc import Mapping
from typing import Any

from rich.console import Console
from rich.table import Table

from krl.commands.bench.phases import phases_table
from krl.errors import FINE, as_input_errors
from krl.terminal.options import JsonOption, ProgramsArgument, programs_or_ours
from krl.terminal.output_files import check_files, write_json
from krl.terminal.progress import progress_bar
from krl.terminal.text_table import figures
from reports.rendering.number_format import counted
from support.measure.speed import MB


def recover(
    paths: ProgramsArgument = None,
    json_file: JsonOption = None,
) -> int:
    """Measure the survey: bytes per second, beside ANTLR, and with a cache.

    One core and one process at a time; some minutes, most of them ANTLR's.
    """
    from grammar.notation.generate import GRAMMAR
    from grammar.notation.krl_grammar import krl_grammar
    from grammar.notation.model import GrammarError
    from recovery.bench.survey_speed import measure, steps
    from support.files.discovery import IngestError

    check_files(json_file)
    roots = programs_or_ours(paths)
    with as_input_errors(GrammarError, IngestError):
        grammar = krl_grammar()
        with progress_bar("measuring", steps()) as advance:
            record = measure(roots, grammar, on_step=advance)
    record = {"bench": "recover", "grammar": GRAMMAR.name, **record}
    write_json(record, json_file, indent=1)
    _print(record)
    return FINE


def _print(record: Mapping[str, Any]) -> None:
    console = Console(highlight=False)
    console.print(
        f"{counted(record['files'], 'file')}, {record['bytes'] / MB:.2f} MB; {record['parsed']:,} "
        f"parse; {counted(record['failures'], 'failure')}; Python {record['python']}",
        soft_wrap=True,
    )
    console.print(_speeds(record))
    console.print(phases_table(record))
    console.print(_beside_antlr(record["antlr"]))


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


def _rate(bytes_per_s: float) -> str:
    return f"{_in_mb(bytes_per_s)} MB/s"


def _in_mb(size: float | None) -> str:
    return "–" if size is None else f"{size / MB:.2f}"


def _times(ratio: float | None) -> str:
    return "–" if ratio is None else f"{ratio:.1f} times"
