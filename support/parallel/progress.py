"""How long work tells that it goes on."""

from __future__ import annotations

from collections.abc import Callable

__all__ = ["Progress", "unheard"]

#: Is told a number: of things there are to do, or of things done since it was last told.
Progress = Callable[[int], object]


def unheard(count: int) -> None:
    """Tell nobody."""
    del count
