"""Tables in the terminal: text in the first column, figures in the others."""

from collections.abc import Iterable, Sequence

from rich import box
from rich.table import Table


def figures(columns: Sequence[str], rows: Iterable[Sequence[str]] = ()) -> Table:
    """Return a table with these headings whose figures are never wrapped."""
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    for place, heading in enumerate(columns):
        table.add_column(heading, justify="right" if place else "left", no_wrap=place > 0)
    for row in rows:
        table.add_row(*row)
    return table


def plain(figure: float | None) -> str:
    """Return a figure with few digits, or a dash if there is none."""
    return "–" if figure is None else f"{figure:g}"
