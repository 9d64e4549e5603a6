"""Random decisions: a generated program follows from the results of `Choices.below` alone.

A smaller number means a simpler decision, so that a test that draws the numbers itself can shrink a
program.
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
    """Items of which some are drawn more often than others."""

    __slots__ = ("items", "limits")

    def __init__(self, *weights: tuple[int, _T]) -> None:
        self.items = [item for _, item in weights]
        self.limits = list(accumulate(weight for weight, _ in weights))


class Choices(ABC):
    """A source of decisions."""

    __slots__ = ()

    @abstractmethod
    def below(self, end: int) -> int:
        """A number from 0 to below ``end``, which is at least 1."""

    def between(self, low: int, high: int) -> int:
        """A number from ``low`` to ``high``, both included."""
        return low + self.below(high - low + 1)

    def chance(self, percent: int) -> bool:
        """Whether something happens that has this probability."""
        return self.below(100) >= 100 - percent

    def pick(self, items: Sequence[_T]) -> _T:
        """One of them; there is at least one."""
        return items[self.below(len(items))]

    def weighted(self, weighted: Weighted[_T]) -> _T:
        """One of them, by its weight; a single one is returned without a decision."""
        limits = weighted.limits
        if len(limits) == 1:
            return weighted.items[0]
        return weighted.items[bisect(limits, self.below(limits[-1]))]

    def few(self, items: Sequence[_T], count: int) -> Sequence[_T]:
        """``count`` different ones, or all if there are no more, in their order."""
        if count >= len(items):
            return items
        left = list(range(len(items)))
        return [
            items[place] for place in sorted(left.pop(self.below(len(left))) for _ in range(count))
        ]


class SeededChoices(Choices):
    """Decisions by chance that are the same on every machine and release.

    Only `random.Random.random` is drawn from, seeded with a text: Python documents both to stay.
    """

    __slots__ = ("_real",)

    def __init__(self, seed: str) -> None:
        self._real = Random(seed).random  # no secret depends on it

    def below(self, end: int) -> int:
        """A number from 0 to below ``end``."""
        return int(self._real() * end)

    # The same as above without a call more: half of the time goes into decisions.

    def between(self, low: int, high: int) -> int:
        """A number from ``low`` to ``high``, both included."""
        return low + int(self._real() * (high - low + 1))

    def chance(self, percent: int) -> bool:
        """Whether something happens that has this probability."""
        return self._real() * 100 >= 100 - percent

    def pick(self, items: Sequence[_T]) -> _T:
        """One of them; there is at least one."""
        return items[int(self._real() * len(items))]
