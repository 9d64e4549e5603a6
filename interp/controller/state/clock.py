"""Virtual time, and what is to be done at a time: pulses that end, inputs of a script."""

from __future__ import annotations

import heapq
import math
from collections.abc import Callable
from dataclasses import field
from itertools import count

from support.lazy_dataclass import dataclass


def microseconds(seconds: float) -> int:
    """Seconds as whole µs, to the nearest."""
    return round(seconds * 1_000_000)


@dataclass(slots=True)
class Clock:
    """Whole µs since the start, and the ticks of the interpolation cycle."""

    cycle: int
    now: int = 0

    @property
    def is_tick(self) -> bool:
        """Whether an interpolation cycle begins now."""
        return self.now % self.cycle == 0

    @property
    def tick(self) -> int:
        """The time of the last tick, now if there is one."""
        return self.now - self.now % self.cycle

    @property
    def next_tick(self) -> int:
        """The time of the first tick after now."""
        return self.tick + self.cycle

    def tick_after(self, duration: float) -> int:
        """The first tick when so many µs have passed [TIM-06]."""
        return math.ceil((self.now + max(duration, 0)) / self.cycle) * self.cycle


@dataclass(slots=True, eq=False)
class TimedAction:
    """Something to do once at ``time``, in µs, unless it is cancelled."""

    time: int
    action: Callable[[], None]
    is_cancelled: bool = False


@dataclass(slots=True)
class ActionQueue:
    """Timed actions by their times; those of one time in the order in which they were added."""

    _entries: list[tuple[int, int, TimedAction]] = field(default_factory=list)
    _order: count[int] = field(default_factory=count)

    def add(self, time: int, action: Callable[[], None]) -> TimedAction:
        """Do something at a time."""
        made = TimedAction(time, action)
        heapq.heappush(self._entries, (time, next(self._order), made))
        return made

    def next_time(self) -> int | None:
        """When something is to be done next."""
        while self._entries and self._entries[0][2].is_cancelled:
            heapq.heappop(self._entries)
        return self._entries[0][0] if self._entries else None

    def run_until(self, now: int) -> None:
        """Do all that is due."""
        while (time := self.next_time()) is not None and time <= now:
            heapq.heappop(self._entries)[2].action()
