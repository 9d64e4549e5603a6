"""`krl bench recover`: how fast a corpus is surveyed."""

from krl.commands.bench.bench_command import Record, bench, print_phases
from krl.errors import say
from krl.terminal.options import JsonOption, ProgramsArgument, programs_or_ours
from krl.terminal.progress import progress_bar
from krl.terminal.text_table import or_dash, print_figures
from reports.rendering.number_format import counted
from support.measure.speed import MB


def _print(record: Record) -> None:
    say(
        f"{counted(record['files'], 'file')}, {record['bytes'] / MB:.2f} MB; {record['parsed']:,} "
        f"parse; {counted(record['failures'], 'failure')}; Python {record['python']}"
    )
    times, cold = "{:.1f} times", _in_mb(record["bytes_per_s"])
    print_figures(
        ("figure", "", "aim"),
        [
            ("all failures, cold", f"{cold} MB/s", "2 MB/s"),
            ("all failures, warm", f"{_in_mb(record['warm_bytes_per_s'])} MB/s", ""),
            ("accept or reject, cold", f"{_in_mb(record['recognise_bytes_per_s'])} MB/s", ""),
            (
                "against ANTLR's Python runtime",
                or_dash(record["ratio_vs_antlr_python"], times),
                "20 times",
            ),
            ("nothing changed", f"{record['unchanged_s_per_mb']:.3f} s/MB", "0.1 s/MB"),
        ],
    )
    print_phases(record)
    sides = {"valid, yes or no": "valid", "failing, all errors": "failing"}
    print_figures(
        ("beside ANTLR, MB/s", "files", "MB", "tokens", "ANTLR", "ours", ""),
        [
            (
                label,
                f"{side['files']:,}",
                _in_mb(side["bytes"]),
                f"{side['tokens']:,}",
                _in_mb(side["antlr_bytes_per_s"]),
                _in_mb(side["our_bytes_per_s"]),
                or_dash(side["ratio"], times),
            )
            for label, name in sides.items()
            for side in [record["antlr"][name]]
        ],
    )


def _in_mb(size: float | None) -> str:
    return "–" if size is None else f"{size / MB:.2f}"


@bench(_print)
def recover(
    paths: ProgramsArgument = None,
    _json_file: JsonOption = None,
) -> Record:
    """Measure the survey: bytes per second, beside ANTLR, and with a cache.

    One core and one process at a time; some minutes, most of them ANTLR's.
    """
    from grammar.notation.generate import GRAMMAR
    from grammar.notation.krl_grammar import krl_grammar
    from recovery.bench.survey_speed import measure, steps

    roots = programs_or_ours(paths)
    grammar = krl_grammar()
    with progress_bar("measuring", steps()) as advance:
        return {"grammar": GRAMMAR.name, **measure(roots, grammar, on_step=advance)}
