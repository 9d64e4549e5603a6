"""The table of phases in the benches of survey and check."""

from collections.abc import Mapping
from typing import Any

from rich.table import Table

from krl.terminal.text_table import figures


def phases_table(record: Mapping[str, Any]) -> Table:
    """Return a row with the time of each phase."""
    return figures(
        ("where the time goes", "seconds", "share"),
        [
            (phase["name"], f"{phase['seconds']:.3f}", f"{100 * phase['share']:.1f} %")
            for phase in record["phases"]
        ],
    )
