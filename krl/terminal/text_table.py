"""Tables in the terminal."""

from collections.abc import Iterable, Sequence

import typer

from krl.errors import one_line


def print_figures(columns: Sequence[str], rows: Iterable[Sequence[str]], *notes: str) -> None:
    """Print a table, first a text and then figures, which are never wrapped; then some notes."""
    from rich import box
    from rich.console import Console
    from rich.table import Table

    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    for place, heading in enumerate(columns):
        table.add_column(heading, justify="right" if place else "left", no_wrap=place > 0)
    for row in rows:
        table.add_row(*row)
    for part in (table, *notes):
        Console(highlight=False).print(part)


def print_columns(*rows: Sequence[str]) -> None:
    """Print rows in columns as wide as their text, one line per row in pipes and logs."""
    lines = [[one_line(cell) for cell in row] for row in rows]
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    for line in lines:
        cells = (cell.ljust(width) for cell, width in zip(line, widths, strict=True))
        typer.echo(f"  {'  '.join(cells)}".rstrip())


def or_dash(figure: float | None, form: str = "{:g}") -> str:
    """Return a figure in a form, with few digits by default, or a dash if there is none."""
    return "–" if figure is None else form.format(figure)
