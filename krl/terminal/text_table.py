"""Tables in the terminal."""

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

import typer

from krl.errors import one_line

if TYPE_CHECKING:
    from rich.table import Table


def figures(columns: Sequence[str], rows: Iterable[Sequence[str]] = ()) -> "Table":
    """Return a table with these headings: text, then figures, which are never wrapped."""
    from rich import box
    from rich.table import Table

    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    for place, heading in enumerate(columns):
        table.add_column(heading, justify="right" if place else "left", no_wrap=place > 0)
    for row in rows:
        table.add_row(*row)
    return table


def print_columns(*rows: Sequence[str]) -> None:
    """Print rows in columns as wide as their text, one line per row in pipes and logs."""
    lines = [[one_line(cell) for cell in row] for row in rows]
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    for line in lines:
        cells = (cell.ljust(width) for cell, width in zip(line, widths, strict=True))
        typer.echo(f"  {'  '.join(cells)}".rstrip())


def plain(figure: float | None) -> str:
    """Return a figure with few digits, or a dash if there is none."""
    return "–" if figure is None else f"{figure:g}"
