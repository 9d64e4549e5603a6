"""Where decisions come from: one interface, so that chance and hypothesis make the same programs.

Everything is decided by `Choices.below` alone. A smaller number stands for a simpler decision
wherever there is one, so that hypothesis shrinks towards simple programs.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from random import Random
from typing import TypeVar

__all__ = ["Choices", "SeededChoices"]

_T = TypeVar("_T")


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
        """Whether something comes to pass that does in so many of a hundred cases."""
        return self.below(100) >= 100 - percent

    def pick(self, items: Sequence[_T]) -> _T:
        """One of them; there is at least one."""
        return items[self.below(len(items))]

    def weighted(self, items: Sequence[tuple[int, _T]]) -> _T:
        """One of them, by its weight."""
        place = self.below(sum(weight for weight, _ in items))
        for weight, item in items:
            place -= weight
            if place < 0:
                return item
        raise AssertionError("the weights are as they were")


class SeededChoices(Choices):
    """Chance that is the same on every machine and release.

    Only `random.Random.random` is drawn from, seeded with a text: Python documents both to stay.
    """

    __slots__ = ("_real",)

    def __init__(self, seed: str) -> None:
        self._real = Random(seed).random  # nobody's secret depends on it

    def below(self, end: int) -> int:
        """A number from 0 to below ``end``."""
        return int(self._real() * end)
