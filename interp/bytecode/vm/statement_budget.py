"""Counting statements: the budget, the slices, and how long ON_ERROR_PROCEED holds.

It is the same for all executors:

- a statement begins with its LINE. Once so many have begun as `interp.program.load.Limits` allow,
  the next one fails with `interp.values.faults.BudgetExhausted`; where as many as the slice
  has, or all slices that may pass at once, have begun since the last request,
  `interp.port.requests.Slice` is asked before the next one begins;
- a `interp.port.requests.StopAdvance` that may pass without a request begins a slice all the same;
- ON_ERROR_PROCEED holds for the statement that begins next, wherever that is, until another one
  begins.

A statement costs a subtraction: ``State.left`` says when there is more to do.
"""

from __future__ import annotations

from enum import Enum
from typing import Final

from interp.bytecode.vm.state import State
from interp.program.load import Limits

#: The largest ``State.quota``, which C holds in 32 bits.
_LARGEST: Final = 2**31 - 1


class Guard(Enum):
    """Whether ON_ERROR_PROCEED holds."""

    OFF = 0
    NEXT = 1
    NOW = 2


class Pause(Enum):
    """What is to be done before a statement begins."""

    NOTHING = 0
    SLICE = 1
    EXHAUSTED = 2


class Counter:
    """Counts the statements of one machine."""

    def __init__(self, state: State, limits: Limits) -> None:
        self._state = state
        self._limits = limits
        self._guard = Guard.OFF
        self._begun = 0
        self._due = limits.per_slice
        self._slices = 1
        self._passed = 0
        self._allowed = 0
        self._stopped = 0
        self._most_stops = 0
        state.whole = limits.per_slice + 1
        self._refill()

    @property
    def guard(self) -> Guard:
        """Whether ON_ERROR_PROCEED holds."""
        return self._guard

    @guard.setter
    def guard(self, guard: Guard) -> None:
        self._settle()
        self._guard = guard
        self._refill()

    @property
    def begun(self) -> int:
        """How many statements have begun."""
        return self._begun + self._state.quota - self._state.left

    def asked(self) -> None:
        """A request was made: a new slice begins."""
        self.ask_at(self.begun + self._limits.per_slice)

    def ask_at(self, count: int) -> None:
        """The slice that has begun ends once so many statements have begun altogether."""
        self._passed += self._whole_slices()
        self._due = count
        self._refill()

    def allow(self, stops: int) -> None:
        """So many `StopAdvance` may pass before the next request of another kind."""
        self._most_stops = max(self._most_stops, stops)
        if self._guard is Guard.OFF:
            most = min(self._limits.statements - self.begun, _LARGEST) // self._state.whole - 1
            self._allowed = self._state.stops = max(min(stops, most), 0)

    @property
    def standing(self) -> tuple[int, ...] | None:
        """What it continues from, where neither the budget nor ON_ERROR_PROCEED is near."""
        if self._guard is not Guard.OFF or self.spare <= 0:
            return None
        due = self._due - self._begun
        return due, self._slices, self._passed, self._allowed, self._stopped

    @property
    def spare(self) -> int:
        """How many statements may be skipped before the budget limits a slice, or what may pass."""
        return self._limits.statements - self.begun - (self._most_stops + 3) * self._state.whole

    def skip(self, statements: int) -> None:
        """So many more have begun."""
        self._begun += statements
        self._due += statements

    def passes_stop(self) -> bool:
        """Whether a `StopAdvance` need not be asked for: then a slice begins."""
        state = self._state
        if state.stops == 0:
            return False
        state.stops -= 1
        state.quota += state.whole - state.left
        state.left = state.whole
        return True

    def stopped(self) -> int:
        """The `StopAdvance` that have passed before the last request, or the end; returned once."""
        if self._allowed:
            self._settle()
            self._refill()
        count, self._stopped = self._stopped, 0
        return count

    def passed(self) -> int:
        """The slices that have passed before the last request, or the end, though not asked for.

        They are returned once.
        """
        if self._slices == 1 and not self._passed:
            return 0
        count = self._passed + self._whole_slices()
        self._passed = 0
        return count

    def pause(self) -> Pause:
        """What comes before the statement that has used up ``State.left``."""
        self._settle(begins=1)
        self._guard = Guard.NOW if self._guard is Guard.NEXT else Guard.OFF
        if self._begun >= self._limits.statements:
            return Pause.EXHAUSTED
        return Pause.SLICE if self._begun >= self._due else Pause.NOTHING

    def begin(self) -> None:
        """The statement begins, after whatever came before it."""
        self._begun += 1
        self._refill()

    @property
    def is_asking(self) -> bool:
        """Whether the last request came just before the slice that has ended."""
        return self._slices == 1 and not self._passed and not self._stopped

    def free(self, slices: int) -> None:
        """So many slices may pass, the one that is used up or begins now being the first."""
        self._due += (slices - 1) * self._limits.per_slice
        self._slices = slices

    def _settle(self, begins: int = 0) -> None:
        """Count what has begun but what ``begins`` now, and the `StopAdvance` that have passed."""
        state = self._state
        if count := self._allowed - state.stops:
            self._due = self._begun + state.quota - 1
            self._stopped += count
        self._allowed = state.stops = 0
        self._begun += state.quota - state.left - begins
        state.quota = state.left

    def _whole_slices(self) -> int:
        """Those used up before the one that runs, which is the only one from now on."""
        self._settle()
        count = 0
        if self._slices > 1:
            size = self._limits.per_slice
            count = max(self._begun - 1 - self._due + self._slices * size, 0) // size
            self._due -= (self._slices - 1 - count) * size
            self._slices = 1
        self._refill()
        return count

    def _refill(self) -> None:
        free = min(self._due, self._limits.statements) - self._begun
        self._state.quota = self._state.left = 1 + (max(free, 0) if self._guard is Guard.OFF else 0)
