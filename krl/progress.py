"""The progress bar of commands that take a while."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.progress import Progress, TaskID

__all__ = ["Bar", "progress_bar"]


class Bar:
    """A bar on the terminal, or nothing at all; calling it advances it."""

    def __init__(self, shown: tuple[Progress, TaskID] | None = None) -> None:
        self._shown = shown

    def __call__(self, count: int = 1) -> None:
        """Advance by `count`."""
        if self._shown is not None:
            progress, task = self._shown
            progress.advance(task, count)

    def note(self, line: str) -> None:
        """Say something above the bar, where there is a terminal."""
        if self._shown is not None:
            console = self._shown[0].console
            console.print(line, markup=False, highlight=False, soft_wrap=True)

    def expect(self, total: int) -> None:
        """Say how many there will be in all, once that is known."""
        if self._shown is not None:
            progress, task = self._shown
            progress.update(task, total=total)


@contextmanager
def progress_bar(label: str, total: int | None = None) -> Iterator[Bar]:
    """Show a bar on stderr while the block runs.

    The bar goes away at the end, and never shows where stderr is not a terminal, so that logs and
    pipes stay clean.
    """
    if not sys.stderr.isatty():
        yield Bar()
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
        yield Bar((progress, progress.add_task(label, total=total)))
