"""The page of the paper's claims, with our measurements beside them."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from reports.conformance.claims_view import claims_view
from reports.rendering.page import render
from support.files.atomic_write import write_atomic


def write_claims_page(records: Mapping[str, Mapping[str, Any]], folder: Path) -> Path:
    """Write ``folder``/index.html, the page of the paper's claims, and return its path.

    ``records`` are what commands wrote with ``--json``, by the names of the steps of a nightly run:
    growth, recover, conform, conform-arm, bench-vm, bench-arm, bench-conform. Any of them may be
    absent; the page then names the command that measures it. The page is written atomically. Raises
    OSError if the folder cannot be made or written.
    """
    page = render(
        "claims.html.j2",
        styles=["page.css", "conform.css", "claims.css"],
        view=claims_view(records),
    )
    return write_atomic(folder / "index.html", page)
