"""Choices drawn by chance that are the same on every machine.

Only `random.Random.random` is drawn from, seeded with a text: Python documents both to give the
same numbers in every release. Neither the hash seed nor the platform has a say.
"""

from __future__ import annotations

from bisect import bisect
from collections.abc import Sequence
from itertools import accumulate
from random import Random
from typing import Generic, TypeVar

__all__ = ["Chance", "Weighted"]

T = TypeVar("T")


class Weighted(Generic[T]):
    """Things of which some are drawn more often than others."""

    __slots__ = ("items", "limits")

    def __init__(self, weights: Sequence[tuple[float, T]]) -> None:
        self.items = [item for _, item in weights]
        self.limits = list(accumulate(weight for weight, _ in weights))


class Chance:
    """A source of choices; ``real`` draws a number from 0 to below 1."""

    __slots__ = ("real",)

    def __init__(self, seed: str) -> None:
        self.real = Random(seed).random

    def below(self, end: int) -> int:
        """A number from 0 to below ``end``."""
        return int(self.real() * end)

    def between(self, low: int, high: int) -> int:
        """A number from ``low`` to ``high``, both included."""
        return low + int(self.real() * (high - low + 1))

    def pick(self, items: Sequence[T]) -> T:
        """One of them, each as likely as the others."""
        return items[int(self.real() * len(items))]

    def draw(self, weighted: Weighted[T]) -> T:
        """One of them, by its weight."""
        limits = weighted.limits
        return weighted.items[bisect(limits, self.real() * limits[-1], 0, len(limits) - 1)]

    def few(self, items: Sequence[T], count: int) -> list[T]:
        """As many different ones, or all there are, in the order they are given."""
        left = len(items)
        chosen = []
        for item in items:
            if self.real() * left < count:
                chosen.append(item)
                count -= 1
            left -= 1
        return chosen
