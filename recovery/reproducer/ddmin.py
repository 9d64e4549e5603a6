"""Delta debugging: the fewest items of a sequence that still pass a test.

Ddmin with what short sequences afford besides: every stretch is tried and not only halves and
quarters, pairs that can only go together, and one item in place of many. What comes out
is 1-minimal: without any single item it would not pass.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence
from typing import TypeVar

from recovery.tuning import EXHAUSTIVE_ITEMS, SUBSTITUTED_ITEMS

_T = TypeVar("_T")


def without_loops(items: Sequence[_T], places: Sequence[Hashable]) -> list[_T]:
    """The items without those between two equal places; ``places[i]`` lies before item ``i``.

    Untested. Takes one pass, so that the longest sequences are short before the search begins.
    """
    last = {place: i for i, place in enumerate(places)}
    out = []
    i = 0
    while i < len(items):
        i = last[places[i]]
        out.append(items[i])
        i += 1
    return out


def minimized(
    items: Sequence[_T], substitutes: Sequence[_T], passes: Callable[[list[_T]], bool]
) -> list[_T]:
    """The items with nothing left that can go or of which a substitute can take the place."""
    left, size = list(items), -1
    while len(left) != size:
        size = len(left)
        left = without_stretches(left, passes)
        if size <= SUBSTITUTED_ITEMS:
            left = _substituted(left, substitutes, passes)
        if size <= EXHAUSTIVE_ITEMS:
            left = _without_pairs(left, passes)
    return left


def without_stretches(items: list[_T], passes: Callable[[list[_T]], bool]) -> list[_T]:
    """The items without stretches, long ones first, down to single items until none can go."""
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
    """Without stretches of one size, from the end on."""
    for start in range(len(items) - size, -1, -1 if size <= EXHAUSTIVE_ITEMS else -size):
        shorter = items[:start] + items[start + size :]
        if passes(shorter):
            items = shorter
    return items


def _without_pairs(items: list[_T], passes: Callable[[list[_T]], bool]) -> list[_T]:
    """Without two items that can only go together, such as brackets around something."""
    for end in range(len(items) - 1, -1, -1):
        for start in range(end):
            shorter = items[:start] + items[start + 1 : end] + items[end + 1 :]
            if passes(shorter):
                return _without_pairs(shorter, passes)
    return items


def _substituted(
    items: list[_T], substitutes: Sequence[_T], passes: Callable[[list[_T]], bool]
) -> list[_T]:
    """With a substitute in place of stretches of two and more."""
    for size in range(len(items), 1, -1):
        for start in range(len(items) - size, -1, -1):
            for substitute in substitutes:
                shorter = [*items[:start], substitute, *items[start + size :]]
                if passes(shorter):
                    return _substituted(shorter, substitutes, passes)
    return items
