"""The page of a comparison of two versions: one file without a script or network access."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from reports.programs.diff_view import diff_view
from reports.rendering.page import render
from support.files.atomic_write import write_atomic


def write_diff_page(record: Mapping[str, Any], place: Path) -> Path:
    """Write the page of a comparison into a folder, or to a file ``….html``, and return its path.

    ``record`` is what ``krl diff --json`` writes; every field may be absent. The page is written
    atomically. Raises OSError if the folder cannot be made or written.
    """
    page = render("diff.html.j2", styles=["page.css", "diff.css"], view=diff_view(record))
    is_file = place.suffix.lower() == ".html" and not place.is_dir()
    return write_atomic(place if is_file else place / "index.html", page)
