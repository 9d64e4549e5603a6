"""Counts statements: the budget, the slices, and the scope of ON_ERROR_PROCEED.

All executors follow the same rules:

- A statement begins with its LINE. If the number that `interp.program.load.Limits` allows have
  begun, the next one fails with `interp.values.faults.BudgetExhausted`. If the statements of a
  slice, or of all slices that may pass at once, have begun since the last request, the next one is
  preceded by `interp.port.requests.Slice`.
- A `interp.port.requests.StopAdvance` that may pass without a request begins a slice, too.
- If functions have taken longer than ``Limits`` allows since the program waited last, the one that
  has done so fails in the same way. Those that a condition calls do not count, because how often it
  is evaluated differs.
- ON_ERROR_PROCEED is valid for the statement that begins next, in whichever routine, until another
  one begins.

A statement costs one subtraction: ``State.left`` says when there is more to do.
"""

from __future__ import annotations

from enum import Enum
from typing import Final

from interp.bytecode.vm.state import State
from interp.program.load import Guard, Limits

#: The largest number in the state, as C has 32 bits.
_LARGEST: Final = 2**31 - 1


class Pause(Enum):
    """What has to happen before a statement begins."""

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
        self.waited()
        self._refill()

    @property
    def guard(self) -> Guard:
        """Whether ON_ERROR_PROCEED holds."""
        return self._guard

    @guard.setter
    def guard(self, guard: Guard) -> None:
        """Whether ON_ERROR_PROCEED is active."""
        self._settle()
        self._guard = guard
        self._refill()

    @property
    def begun(self) -> int:
        """The number of statements that have begun."""
        return self._begun + self._state.quota - self._state.left

    def asked(self) -> None:
        """Begin a slice, because a request was made."""
        self.ask_at(self.begun + self._limits.per_slice)

    def ask_at(self, count: int) -> None:
        """End the current slice when this number of statements has begun in all."""
        self._passed += self._whole_slices()
        self._due = count
        self._refill()

    def allow(self, stops: int) -> None:
        """Let this number of `StopAdvance` pass before the next request of another kind."""
        self._most_stops = max(self._most_stops, stops)
        if self._guard is Guard.OFF:
            most = min(self._limits.statements - self.begun, _LARGEST) // self._state.whole - 1
            self._allowed = self._state.stops = max(min(stops, most), 0)

    @property
    def recurrence_state(self) -> tuple[int, ...] | None:
        """The state of the counter; ``None`` close to the budget or with ON_ERROR_PROCEED."""
        if self._guard is not Guard.OFF or self.spare <= 0:
            return None
        due = self._due - self._begun
        functions = self._state.functions
        return due, self._slices, self._passed, self._allowed, self._stopped, functions

    @property
    def spare(self) -> int:
        """The number of statements that may be skipped before the budget limits what may pass."""
        return self._limits.statements - self.begun - (self._most_stops + 3) * self._state.whole

    def skip(self, statements: int) -> None:
        """Count this number of statements as begun."""
        self._begun += statements
        self._due += statements

    def waited(self) -> None:
        """Count functions anew, because the program has waited."""
        self._state.functions = min(self._limits.functions, _LARGEST)

    def passes_stop(self) -> bool:
        """Return whether a `StopAdvance` needs no request; if so, a slice begins."""
        state = self._state
        if state.stops == 0:
            return False
        state.stops -= 1
        state.quota += state.whole - state.left
        state.left = state.whole
        return True

    def stopped(self) -> int:
        """Return the number of `StopAdvance` that passed since the last call."""
        if self._allowed:
            self._settle()
            self._refill()
        count, self._stopped = self._stopped, 0
        return count

    def passed(self) -> int:
        """Return the number of slices that passed without a request since the last call."""
        if self._slices == 1 and not self._passed:
            return 0
        count = self._passed + self._whole_slices()
        self._passed = 0
        return count

    def pause(self) -> Pause:
        """Return what has to happen before the statement that has used up ``State.left``."""
        self._settle(begins=1)
        self._guard = Guard.NOW if self._guard is Guard.NEXT else Guard.OFF
        if self._begun >= self._limits.statements:
            return Pause.EXHAUSTED
        return Pause.SLICE if self._begun >= self._due else Pause.NOTHING

    def begin(self) -> None:
        """Count the statement that begins."""
        self._begun += 1
        self._refill()

    @property
    def is_asking(self) -> bool:
        """Whether the last request came immediately before the slice that has ended."""
        return self._slices == 1 and not self._passed and not self._stopped

    def free(self, slices: int) -> None:
        """Let this number of slices pass; the first is the one that has ended or begins now."""
        self._due += (slices - 1) * self._limits.per_slice
        self._slices = slices

    def _settle(self, begins: int = 0) -> None:
        """Count statements up to now, except ``begins`` that are beginning, and passed stops."""
        state = self._state
        if count := self._allowed - state.stops:
            self._due = self._begun + state.quota - 1
            self._stopped += count
        self._allowed = state.stops = 0
        self._begun += state.quota - state.left - begins
        state.quota = state.left

    def _whole_slices(self) -> int:
        """Return how many slices were used up before the current one; no more will pass."""
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
