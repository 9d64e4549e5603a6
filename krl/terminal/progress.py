"""Progress of long-running commands."""

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
    """How far a step of a command is; calling it advances it.

    A bar where stderr is a terminal. Elsewhere a line each 10 s, so that logs of short commands
    stay clean; ``KRL_PROGRESS`` says after how many seconds, and 0 never.
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
        """Say something above the bar, where there is a terminal."""
        if self._shown is not None:
            console = self._shown[0].console
            console.print(line, markup=False, highlight=False, soft_wrap=True)

    def expect(self, total: int) -> None:
        """Say how many there will be in all, once that is known."""
        self._total = total
        if self._shown is not None:
            progress, task = self._shown
            progress.update(task, total=total)


def _interval() -> float:
    """Seconds between lines; those by default where the environment has no number."""
    try:
        return float(os.environ.get("KRL_PROGRESS", ""))
    except ValueError:
        return _SECONDS


@contextmanager
def progress_bar(label: str, total: int | None = None) -> Iterator[Bar]:
    """Show on stderr how far the block is; a bar of a terminal goes away at its end."""
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
