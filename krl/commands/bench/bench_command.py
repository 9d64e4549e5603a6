"""What the benches share: a command that writes and shows a record, and how they show phases."""

from collections.abc import Callable, Mapping
from functools import wraps
from typing import Any

from krl.errors import FINE
from krl.terminal.output_files import check_files, write_json
from krl.terminal.text_table import print_figures

Record = Mapping[str, Any]


def bench(show: Callable[[Record], None]) -> Callable[[Callable[..., Record]], Callable[..., int]]:
    """Return a decorator that makes a command of a function that measures.

    The function has the name of the bench. What it returns is written to its ``_json_file`` and
    shown.
    """

    def decorated(measure: Callable[..., Record]) -> Callable[..., int]:
        @wraps(measure)
        def command(**given: Any) -> int:
            check_files(given["_json_file"])
            record = {"bench": measure.__name__, **measure(**given)}
            write_json(record, given["_json_file"], indent=1)
            show(record)
            return FINE

        return command

    return decorated


def print_phases(record: Record) -> None:
    """Print a row with the time of each phase."""
    print_figures(
        ("where the time goes", "seconds", "share"),
        [
            (phase["name"], f"{phase['seconds']:.3f}", f"{100 * phase['share']:.1f} %")
            for phase in record["phases"]
        ],
    )
