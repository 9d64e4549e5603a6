"""The progress bar of commands that take a while."""

from collections.abc import Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    TaskID,
    TextColumn,
    TimeRemainingColumn,
)

__all__ = ["Bar", "progress_bar"]


class Bar:
    """A bar on the terminal; calling it advances it."""

    def __init__(self, progress: Progress, task: TaskID) -> None:
        self._progress = progress
        self._task = task

    def __call__(self, count: int = 1) -> None:
        """Advance by `count`."""
        self._progress.advance(self._task, count)

    def note(self, line: str) -> None:
        """Say something above the bar, where there is a terminal."""
        if not self._progress.disable:
            self._progress.console.print(line, markup=False, highlight=False, soft_wrap=True)

    def expect(self, total: int) -> None:
        """Say how many there will be in all, once that is known."""
        self._progress.update(self._task, total=total)


@contextmanager
def progress_bar(label: str, total: int | None = None) -> Iterator[Bar]:
    """Show a bar on stderr while the block runs.

    The bar goes away at the end, and never shows where stderr is not a terminal, so that logs and
    pipes stay clean.
    """
    console = Console(stderr=True)
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn())
    with Progress(
        *columns,
        TimeRemainingColumn(),
        console=console,
        transient=True,
        disable=not console.is_terminal,
    ) as progress:
        yield Bar(progress, progress.add_task(label, total=total))
