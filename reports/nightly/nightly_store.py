"""The folder of all nightly runs: its index page, and retention of older runs.

The index page leads to the last run. It warns if that was too long ago, because then no run is left
to report it.
"""

from collections.abc import Iterator
from contextlib import suppress
from datetime import datetime
from pathlib import Path
from shutil import rmtree

from reports.nightly.nightly_page import MOST_EARLIER
from reports.rendering.embedding import embedded_json
from reports.rendering.page import joined, render
from support.files.atomic_write import write_atomic

#: The files that are kept of a run whose pages are no longer linked, and the most runs kept.
_SUMS = ("nightly.json", "summary.md")
_MOST_RUNS = 366


def write_entry_page(out: Path, date: str, made: datetime) -> Path:
    """Write ``out``/index.html, which leads to the run ``date`` and has the time ``made``.

    Raises OSError.
    """
    script = joined(("page", "nightly-index"))
    data = embedded_json({"made": made.isoformat()})
    styles = ["page.css", "conform.css", "nightly.css"]
    page = render("nightly-index.html.j2", script=script, styles=styles, data=data, view=date)
    return write_atomic(out / "index.html", page)


def bound_store(folder: Path) -> None:
    """Remove data of earlier runs that is no longer needed.

    ``folder`` is the last run. Caches that it has too are removed from earlier runs. Runs whose
    pages are no longer linked keep only summary and record, for a year; those that were interrupted
    are removed. Only folders with a record of a run are touched, and what cannot be removed stays.
    """
    earlier = sorted(filter(_is_run, folder.parent.iterdir()), reverse=True)
    for number, run in enumerate((one for one in earlier if one.name != folder.name), 1):
        for cache in folder.glob("*/cache"):
            rmtree(run / cache.relative_to(folder), ignore_errors=True)
        is_whole = (run / "nightly.json").is_file()
        if number > (_MOST_RUNS if is_whole else MOST_EARLIER):
            rmtree(run, ignore_errors=True)
        elif number > MOST_EARLIER:
            for one in _pages(run):
                rmtree(one, ignore_errors=True)
                with suppress(OSError):  # a folder that could not be removed
                    one.unlink(missing_ok=True)


def _is_run(folder: Path) -> bool:
    is_ours = any((folder / name).is_file() for name in ("nightly.json", "steps.json"))
    return is_ours and not folder.is_symlink()


def _pages(run: Path) -> Iterator[Path]:
    return (one for one in [*run.iterdir()] if one.name not in _SUMS)
