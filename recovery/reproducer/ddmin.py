"""Delta debugging: a smallest subsequence that still passes a test.

This is ddmin (Zeller and Hildebrandt, "Simplifying and Isolating Failure-Inducing Input", 2002),
with additions that short sequences allow: every stretch is tried and not only halves and quarters,
and pairs of items are removed together. The result is 1-minimal: without any single item it would
not pass.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeVar

from recovery.tuning import EXHAUSTIVE_ITEMS

_T = TypeVar("_T")


def minimized(items: Sequence[_T], passes: Callable[[list[_T]], bool]) -> list[_T]:
    """Return a subsequence from which nothing can be removed."""
    left, size = list(items), -1
    while len(left) != size:
        size = len(left)
        left = _without_stretches(left, passes)
        if size <= EXHAUSTIVE_ITEMS:
            left = _without_pairs(left, passes)
    return left


def _without_stretches(items: list[_T], passes: Callable[[list[_T]], bool]) -> list[_T]:
    """Return the items with stretches removed, from long ones down to single items."""
    size = len(items)
    while size:
        shorter = _without(items, size, passes)
        if size > 1 or len(shorter) == len(items):
            size = min(
                len(shorter),
                size - 1 if size <= EXHAUSTIVE_ITEMS else max(size // 2, EXHAUSTIVE_ITEMS),
            )
        items = shorter
    return items


def _without(items: list[_T], size: int, passes: Callable[[list[_T]], bool]) -> list[_T]:
    """Return the items with stretches of one size removed, from the end on."""
    for start in range(len(items) - size, -1, -1 if size <= EXHAUSTIVE_ITEMS else -size):
        shorter = items[:start] + items[start + size :]
        if passes(shorter):
            items = shorter
    return items


def _without_pairs(items: list[_T], passes: Callable[[list[_T]], bool]) -> list[_T]:
    """Return the items without pairs that can only be removed together, such as brackets."""
    for end in range(len(items) - 1, -1, -1):
        for start in range(end):
            shorter = items[:start] + items[start + 1 : end] + items[end + 1 :]
            if passes(shorter):
                return _without_pairs(shorter, passes)
    return items
