"""Random decisions: a generated program depends on the results of `Choices.below` alone.

A smaller number means a simpler decision, so a test that draws the numbers itself (property-based
testing) can shrink a program.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from bisect import bisect
from collections.abc import Sequence
from itertools import accumulate
from random import Random
from typing import Generic, TypeVar

_T = TypeVar("_T")


class Weighted(Generic[_T]):
    """Items that are drawn in proportion to their weights."""

    __slots__ = ("items", "limits")

    def __init__(self, *weights: tuple[int, _T]) -> None:
        self.items = [item for _, item in weights]
        self.limits = list(accumulate(weight for weight, _ in weights))


class Choices(ABC):
    """A source of random decisions."""

    __slots__ = ()

    @abstractmethod
    def below(self, end: int) -> int:
        """Return a number from 0 up to ``end``, which is excluded and at least 1."""

    def between(self, low: int, high: int) -> int:
        """Return a number from ``low`` to ``high``, both included."""
        return low + self.below(high - low + 1)

    def chance(self, percent: int) -> bool:
        """Return ``True`` with this probability."""
        return self.below(100) >= 100 - percent

    def pick(self, items: Sequence[_T]) -> _T:
        """Return one of the items, of which there is at least one."""
        return items[self.below(len(items))]

    def weighted(self, weighted: Weighted[_T]) -> _T:
        """Return an item according to the weights; no number is drawn if there is only one."""
        limits = weighted.limits
        if len(limits) == 1:
            return weighted.items[0]
        return weighted.items[bisect(limits, self.below(limits[-1]))]


class SeededChoices(Choices):
    """Decisions from a seed that are the same on every machine and Python release.

    Only `random.Random.random` is used, seeded with a text: Python guarantees both to be stable.
    """

    __slots__ = ("_real",)

    def __init__(self, seed: str) -> None:
        self._real = Random(seed).random  # no secret depends on it

    def below(self, end: int) -> int:
        """Return a number from 0 up to ``end``, which is excluded."""
        return int(self._real() * end)

    # The same as above with one call less: half of the run time is spent on decisions.

    def between(self, low: int, high: int) -> int:
        """Return a number from ``low`` to ``high``, both included."""
        return low + int(self._real() * (high - low + 1))

    def chance(self, percent: int) -> bool:
        """Return ``True`` with this probability."""
        return self._real() * 100 >= 100 - percent

    def pick(self, items: Sequence[_T]) -> _T:
        """Return one of the items, of which there is at least one."""
        return items[int(self._real() * len(items))]
