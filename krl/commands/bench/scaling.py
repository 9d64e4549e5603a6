"""Synthetic corpora of several sizes, and tables of phases, for the benches of survey and check."""

from collections.abc import Mapping
from typing import Annotated, Any, Final

import typer
from rich.console import Console
from rich.table import Table

from krl.errors import InputError
from krl.terminal.text_table import figures

_LARGEST: Final = 2_000

SizesOption = Annotated[
    str,
    typer.Option(
        metavar="MB,…", help="Sizes of the synthetic corpora that show how cost grows; '' for none."
    ),
]


def sizes_of(given: str) -> list[float]:
    """Return the sizes in MB from a list with commas."""
    try:
        sizes = [float(size) for size in given.split(",") if size.strip()]
    except ValueError:
        sizes = [0]
    if not all(0 < size <= _LARGEST for size in sizes):
        raise InputError(f"--sizes {given}: not a list of MB, each above 0 and up to {_LARGEST:,}")
    return sizes


def phases_table(record: Mapping[str, Any]) -> Table:
    """Return a row with the time of each phase."""
    return figures(
        ("where the time goes", "seconds", "share"),
        [
            (phase["name"], f"{phase['seconds']:.3f}", f"{100 * phase['share']:.1f} %")
            for phase in record["phases"]
        ],
    )


def peak(entry: Mapping[str, Any]) -> str:
    """Return the peak memory for a corpus."""
    return "–" if entry["peak_mb"] is None else f"{entry['peak_mb']:,.0f} MB"


def print_growth(console: Console, record: Mapping[str, Any], what: str) -> None:
    """Print how the largest corpus compares with the smallest in ``what``, and in memory."""
    growth = record["memory_growth_mb"]
    more = "" if growth is None else f", {growth:+,.0f} MB of memory"
    console.print(
        f"The last against the first: {record['linear']:.2f} times the {what}{more}", soft_wrap=True
    )
