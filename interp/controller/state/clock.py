"""Virtual time, and a queue of timed actions, such as ends of pulses and inputs of a script."""

from __future__ import annotations

import heapq
import math
from collections.abc import Callable
from dataclasses import field
from itertools import count

from support.lazy_dataclass import dataclass


def microseconds(seconds: float) -> int:
    """Return seconds as whole µs, rounded to the nearest."""
    return round(seconds * 1_000_000)


@dataclass(slots=True)
class Clock:
    """The virtual time in whole µs since the start, and the ticks of the interpolation cycle.

    ``cycle`` is the interpolation cycle in µs.
    """

    cycle: int
    now: int = 0

    @property
    def is_tick(self) -> bool:
        """Whether an interpolation cycle begins now."""
        return self.now % self.cycle == 0

    @property
    def tick(self) -> int:
        """The time of the last tick, which may be now."""
        return self.now - self.now % self.cycle

    @property
    def next_tick(self) -> int:
        """The time of the first tick after now."""
        return self.tick + self.cycle

    def tick_after(self, duration: float) -> int:
        """Return the time of the first tick at least ``duration`` µs from now [TIM-06]."""
        return math.ceil((self.now + duration) / self.cycle) * self.cycle


@dataclass(slots=True)
class ActionQueue:
    """Timed actions in order of their times; those of equal time in order of addition."""

    _entries: list[tuple[int, int, Callable[[], None]]] = field(default_factory=list)
    _order: count[int] = field(default_factory=count)

    def add(self, time: int, action: Callable[[], None]) -> None:
        """Add an action at a time in µs."""
        heapq.heappush(self._entries, (time, next(self._order), action))

    def next_time(self) -> int | None:
        """Return the time of the next action in µs; ``None`` if there is none."""
        return self._entries[0][0] if self._entries else None

    def run_until(self, now: int) -> None:
        """Perform all actions that are due."""
        while (time := self.next_time()) is not None and time <= now:
            heapq.heappop(self._entries)[2]()
