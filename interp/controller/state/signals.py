"""Signals: digital and analog inputs and outputs, groups of bits, pulses.

Digital signals begin as FALSE, except input 1025, which is always TRUE; 1026 is always FALSE
[IOT-02]. A group ``("$OUT", 3, "TO", 6)`` is an INT whose lowest bit is its first signal [IOT-03];
with 32 bits it is signed. Analog values are limited to [-1, 1] [IOT-06].
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from typing import Final

from grammar.semantics.types import BOOL, REAL
from interp.controller.state.clock import Clock, TimedAction
from interp.controller.state.profile import Profile
from interp.port.requests import Path, Value
from interp.values.faults import fault
from interp.values.values import converted, index, single

ALWAYS_TRUE: Final = 1025
ALWAYS_FALSE: Final = 1026
_SHORTEST: Final = 0.1
_LONGEST: Final = 3.0

#: A change of a signal: the array, the index, the new value.
Change = tuple[str, int, Value]
Report = Callable[[str, int, Value], None]
Later = Callable[[int, Callable[[], None]], TimedAction]


class Signals:
    """All signals, by the names of their arrays.

    ``later`` schedules an action at a time in µs; ``report`` is called with every change.
    """

    def __init__(self, profile: Profile, clock: Clock, later: Later, report: Report) -> None:
        sizes = profile.sizes
        self._digital = {
            "$IN": [False] * (sizes["inputs"] + 1),
            "$OUT": [False] * (sizes["outputs"] + 1),
        }
        self._analog = {
            "$ANIN": [0.0] * (sizes["analog_inputs"] + 1),
            "$ANOUT": [0.0] * (sizes["analog_outputs"] + 1),
        }
        if sizes["inputs"] >= ALWAYS_TRUE:
            self._digital["$IN"][ALWAYS_TRUE] = True
        self._clock = clock
        self._later = later
        self._report = report
        self._pulses: dict[int, tuple[bool, TimedAction]] = {}

    def read(self, path: Path) -> Value:
        """Return the value of a signal or of a group; faults ``index``."""
        name, first, last = self._range(path)
        if name in self._analog:
            return self._analog[name][first]
        bits = self._digital[name]
        if len(path) == 2:
            return bits[first]
        number = sum(bits[place] << (place - first) for place in range(first, last + 1))
        return number - 2**32 if number >= 2**31 else number

    def write(self, path: Path, value: Value) -> None:
        """Set an output; faults ``read_only``, ``index``, ``inadmissible``."""
        if path[0] in ("$IN", "$ANIN"):
            raise fault("read_only")
        self.put(path, value)

    def put(self, path: Path, value: Value) -> None:
        """Set a signal; from outside this may be an input too."""
        name, first, last = self._range(path)
        if name in self._analog:
            self._put_analog(name, first, value)
        elif len(path) == 2:
            self._put_bit(name, first, converted(value, BOOL) is True)
        else:
            number = index(value)
            for place in range(first, last + 1):
                self._put_bit(name, place, bool(number >> (place - first) & 1))

    def pulse(self, number: int, level: bool, seconds: float) -> None:
        """PULSE: set an output to a level for a time in s, then to the other level [IOT-07].

        The time is rounded to tenths of a second and limited to 0.1 to 3 s. A new pulse restarts
        the time. Setting the other level meanwhile ends the pulse.
        """
        tenths = min(max(round(seconds * 10) / 10, _SHORTEST), _LONGEST)
        self._end_pulse(number)
        self.put(("$OUT", number), level)
        end = self._clock.tick_after(round(tenths * 1_000_000))

        over = partial(self.put, ("$OUT", number), not level)  # ends the pulse too
        self._pulses[number] = level, self._later(end, over)

    @contextmanager
    def deferred(self) -> Iterator[list[Change]]:
        """Collect the changes within this context instead of reporting them."""
        changes: list[Change] = []
        before, self._report = self._report, lambda *change: changes.append(change)
        try:
            yield changes
        finally:
            self._report = before

    def _end_pulse(self, number: int) -> None:
        running = self._pulses.pop(number, None)
        if running is not None:
            running[1].is_cancelled = True

    def _put_bit(self, name: str, place: int, value: bool) -> None:
        if name == "$IN" and place in (ALWAYS_TRUE, ALWAYS_FALSE):
            return
        if name == "$OUT" and place in self._pulses and self._pulses[place][0] != value:
            self._end_pulse(place)
        if self._digital[name][place] != value:
            self._digital[name][place] = value
            self._report(name, place, value)

    def _put_analog(self, name: str, place: int, value: Value) -> None:
        number = converted(value, REAL)
        assert isinstance(number, float), "converted"
        number = single(min(max(number, -1.0), 1.0))
        if self._analog[name][place] != number:
            self._analog[name][place] = number
            self._report(name, place, number)

    def _range(self, path: Path) -> tuple[str, int, int]:
        """Return the array and the first and last index of a path."""
        name = str(path[0])
        size = len(self._digital.get(name) or self._analog[name]) - 1
        if len(path) == 2 and isinstance(path[1], int):
            first = last = path[1]
        elif len(path) == 4 and isinstance(path[1], int) and isinstance(path[3], int):
            first, last = path[1], path[3]
        else:
            raise fault("inadmissible")
        if not 1 <= first <= last <= size or last - first >= 32:
            raise fault("index")
        return name, first, last
