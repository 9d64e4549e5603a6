"""Progress display of long-running commands."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from time import monotonic
from typing import TYPE_CHECKING, ClassVar, Final

if TYPE_CHECKING:
    from rich.progress import Progress, TaskID

_SECONDS: Final = 10.0


class Bar:
    """The progress of one step of a command; call it to advance.

    In a terminal it is a bar on stderr. Otherwise it prints a line every 10 s, so that logs of
    short commands stay clean; ``KRL_PROGRESS`` sets other seconds, 0 means never.
    """

    #: When the last line was written, or the command began (s).
    _written: ClassVar[float] = monotonic()

    def __init__(
        self, label: str, total: int | None, shown: tuple[Progress, TaskID] | None = None
    ) -> None:
        self._label, self._total, self._shown = label, total, shown
        self._done = 0
        self(0)

    def __call__(self, count: int = 1) -> None:
        """Advance by `count`."""
        self._done += count
        if self._shown is not None:
            progress, task = self._shown
            progress.advance(task, count)
        elif 0 < _interval() <= monotonic() - Bar._written:
            Bar._written = monotonic()
            of = "" if self._total is None else f" of {self._total:,}"
            sys.stderr.write(f"krl: {self._label}: {self._done:,}{of}\n")
            sys.stderr.flush()

    def note(self, line: str) -> None:
        """Print a line above the bar, in a terminal only."""
        if self._shown is not None:
            console = self._shown[0].console
            console.print(line, markup=False, highlight=False, soft_wrap=True)

    def expect(self, total: int) -> None:
        """Set the total, once it is known."""
        self._total = total
        if self._shown is not None:
            progress, task = self._shown
            progress.update(task, total=total)


def _interval() -> float:
    """Return the seconds between lines, from the environment or the default."""
    try:
        return float(os.environ.get("KRL_PROGRESS", ""))
    except ValueError:
        return _SECONDS


@contextmanager
def progress_bar(label: str, total: int | None = None) -> Iterator[Bar]:
    """Yield a progress display; the bar in a terminal disappears at the end of the context."""
    if not sys.stderr.isatty():
        yield Bar(label, total)
        return
    # only here: importing it takes as long as checking a small program
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        Progress,
        TextColumn,
        TimeRemainingColumn,
    )

    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn())
    with Progress(
        *columns, TimeRemainingColumn(), console=Console(stderr=True), transient=True
    ) as progress:
        yield Bar(label, total, (progress, progress.add_task(label, total=total)))
