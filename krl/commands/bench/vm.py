"""`krl bench vm`: how fast the executors compute, beside Lua."""

from collections.abc import Mapping
from typing import Annotated, Any

import typer
from rich import box
from rich.console import Console
from rich.table import Table

from krl.errors import FINE, InputError, as_input_errors
from krl.options import JsonOption
from krl.output_files import check_files, write_json
from krl.progress import progress_bar
from krl.text_table import figures

__all__ = ["vm"]

_HEADINGS = {"tree": "tree", "vm": "Python", "native": "C", "compiled": "compiled", "lua": "Lua"}
_AIMS = (
    ("vm_vs_tree", "machine in Python against tree", "6 times"),
    ("native_vs_tree", "machine in C against tree", "300 times"),
    ("native_vs_vm", "machine in C against Python", ""),
    ("native_vs_lua", "machine in C against Lua", "1 times"),
    ("compiled_vs_native", "native code against machine in C", ""),
)


def vm(
    kernels: Annotated[
        str,
        typer.Option(metavar="NAME,…", help="Which kernels; default: all of them."),
    ] = "",
    rounds: Annotated[
        int, typer.Option(min=1, max=100, metavar="N", help="The best of so many runs counts.")
    ] = 3,
    json_file: JsonOption = None,
) -> int:
    """Measure the executors: KRL kernels on each of them and in Lua 5.4, and what a request costs.

    Slow executors get less of the same work; the figures are times for a unit of it.
    """
    from interp.bench.executor_speed import MeasurementError, measure_executors, steps
    from interp.bench.kernels import KERNELS

    check_files(json_file)
    names = [name.strip() for name in kernels.split(",") if name.strip()] or list(KERNELS)
    unknown = [name for name in names if name not in KERNELS]
    if unknown:
        raise InputError(
            f"--kernels {kernels}: there is no {unknown[0]}, only {', '.join(KERNELS)}"
        )
    with as_input_errors(MeasurementError), progress_bar("measuring", steps(names)) as advance:
        record = measure_executors(names, rounds, on_step=advance)
    record = {"bench": "vm", **record}
    write_json(record, json_file, indent=1)
    _print(record)
    return FINE


def _print(record: Mapping[str, Any]) -> None:
    console = Console(highlight=False)
    lua = record["lua"] or "no Lua 5.4 here"
    missing = "" if record["native"] else "; the machine in C was not built"
    console.print(f"Python {record['python']}, {lua}{missing}", soft_wrap=True)
    table = figures(("ns", *_HEADINGS.values(), "C/tree", "C/Lua"))
    for row in record["kernels"]:
        ns = row["ns"]
        table.add_row(
            f"{row['name']}, {row['unit']}",
            *(_figure(ns[name]) for name in _HEADINGS),
            _ratio(ns["tree"], ns["native"]),
            _ratio(ns["lua"], ns["native"]),
        )
    console.print(table)
    summary = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    for heading in ("geometric mean", "", "aim"):
        summary.add_column(heading, justify="right" if heading == "" else "left", no_wrap=True)
    for key, label, aim in _AIMS:
        value = record[key]
        summary.add_row(label, "–" if value is None else f"{value:,.2f} times", aim)
    for name, costs in record["request_us"].items():
        told = ", ".join(f"{cost:.1f} µs to {kind}" for kind, cost in costs.items())
        summary.add_row(f"a request: {_HEADINGS[name]}", told, "")
    console.print(summary)


def _figure(ns: float | None) -> str:
    return "–" if ns is None else f"{ns:,.{0 if ns >= 100 else 1}f}"


def _ratio(slow: float | None, fast: float | None) -> str:
    if slow is None or fast is None:
        return "–"
    ratio = slow / fast
    return f"{ratio:,.{0 if ratio >= 100 else 1}f}"
