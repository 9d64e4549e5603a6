"""Progress reports of long work."""

from __future__ import annotations

from collections.abc import Callable

#: Is given a number: of things there are to do, or of things done since the last call.
Progress = Callable[[int], object]


def no_progress(count: int) -> None:
    """Do nothing."""
    del count
