"""`krl bench vm`: how fast the executors compute, beside other languages."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from statistics import median
from typing import Annotated

import typer
from rich import box
from rich.console import Console
from rich.table import Table

from krl.commands.bench.bench_command import Record, bench
from krl.errors import InputError, as_input_errors, say
from krl.terminal.options import JsonOption
from krl.terminal.progress import progress_bar
from krl.terminal.text_table import or_dash, print_figures

_HEADINGS = {
    "tree": "tree",
    "vm": "Python",
    "native": "C",
    "compiled": "compiled",
    "lua": "Lua",
    "luajit": "LuaJIT",
    "c": "C -O2",
    "python": "CPython",
}
_AIMS = (
    ("vm_vs_tree", "machine in Python against tree", "6 times"),
    ("native_vs_tree", "machine in C against tree", "300 times"),
    ("native_vs_vm", "machine in C against Python", ""),
    ("native_vs_lua", "machine in C against Lua", "1 times"),
    ("compiled_vs_native", "native code against machine in C", ""),
    ("c_vs_compiled", "C -O2 against native code", "≤ 3 times"),
)


def _print(record: Record) -> None:
    lua = record["lua"] or "no Lua 5.4 here"
    missing = "" if record["native"] else "; the machine in C was not built"
    say(f"Python {record['python']}, {lua}{missing}")
    shown = [name for name in _HEADINGS if any(row["ns"][name] for row in record["kernels"])]
    print_figures(
        ("µs", "N", *map(_HEADINGS.__getitem__, shown)),
        [
            (row["name"], f"{row['amount']:,}", *(_figure(row["ns"][name]) for name in shown))
            for row in record["kernels"]
        ],
    )
    summary = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    for heading in ("geometric mean", "", "aim"):
        summary.add_column(heading, justify="right" if heading == "" else "left", no_wrap=True)
    for key, label, aim in _AIMS:
        summary.add_row(label, or_dash(record[key], "{:,.2f} times"), aim)
    for name, costs in record["request_us"].items():
        listed = ", ".join(f"{cost:.1f} µs to {kind}" for kind, cost in costs.items())
        summary.add_row(f"a request: {_HEADINGS[name]}", listed, "")
    for name, times in record["controlled_vs_bare"].items():
        label = f"time in `krl run`: {_HEADINGS[name]}"
        summary.add_row(label, f"{times:.2f} times", "≤ 1.3 times")
    Console(highlight=False).print(summary)
    before = (f"{label} {ms:.1f} ms" for label, ms in _before_running(record["kernels"]))
    say(f"before it runs: {', '.join(before)}")


def _before_running(rows: Sequence[Record]) -> Iterator[tuple[str, float]]:
    """Yield the time of each phase before the first statement of a kernel: medians in ms."""
    yield "check", median(row["load_ms"] for row in rows)
    yield "bytecode", median(row["translate_ms"] for row in rows)
    for name in rows[0]["start_ms"]:
        yield f"start of {_HEADINGS[name]}", median(row["start_ms"][name] for row in rows)


def _figure(ns: float | None) -> str:
    return "–" if ns is None else f"{ns / 1e3:,.{0 if ns >= 1e5 else 1}f}"


@bench(_print)
def vm(
    kernels: Annotated[str, typer.Option(metavar="NAMES")] = "",
    rounds: Annotated[int, typer.Option(min=1, max=100)] = 3,
    _json_file: JsonOption = None,
) -> Record:
    """Measure the executors: KRL kernels on each of them and in other languages; a request's cost.

    A kernel is NAME.src with DEFFCT INT WORK(N:IN); NAME.lua (a chunk that returns a function),
    NAME.py (a function work) or NAME.c (int work(int n)) beside it do the same in Lua 5.4 and
    LuaJIT, Python, and C with -O2. The figures are microseconds for
    one WORK(N), with the same N for all.

    Options:
        kernels: Kernels, separated by commas, or a folder of them. Default: all of ours.
        rounds: Rounds; the best one counts.
    """
    from interp.bench.executor_speed import MeasurementError, measure_executors, steps
    from interp.bench.kernels import HERE, kernels_in

    is_folder = bool(kernels) and Path(kernels).is_dir()
    found = kernels_in(Path(kernels) if is_folder else HERE)
    if is_folder and not found:
        raise InputError(f"--kernels {kernels}: there is no .src file in it")
    names = [name.strip() for name in kernels.split(",") if name.strip()]
    names = list(found) if is_folder or not names else names
    unknown = [name for name in names if name not in found]
    if unknown:
        raise InputError(
            f"--kernels {kernels}: there is no {unknown[0]}, only {', '.join(found)}, or a folder"
        )
    chosen = [found[name] for name in names]
    with as_input_errors(MeasurementError), progress_bar("measuring", steps(chosen)) as advance:
        return measure_executors(chosen, rounds, on_step=advance)
