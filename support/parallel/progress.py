"""Progress reports of long work."""

from __future__ import annotations

from collections.abc import Callable

#: A callback for a number: of items to do, or of items done since the last call.
Progress = Callable[[int], object]


def no_progress(count: int) -> None:
    """Do nothing."""
    del count
