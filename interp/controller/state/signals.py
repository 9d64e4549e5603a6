"""Signals: digital and analog inputs and outputs, groups of bits, pulses.

Digital signals begin as FALSE, except input 1025, which is always TRUE; 1026 is always FALSE
[IOT-02]. A group ``("$OUT", 3, "TO", 6)`` is an INT whose lowest bit is its first signal [IOT-03];
with 32 bits it is signed. Analog values are limited to [-1, 1] [IOT-06].
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, Final

from grammar.semantics.types import BOOL, REAL
from interp.controller.state.clock import Clock
from interp.controller.state.profile import Profile
from interp.port.requests import Path, Value
from interp.values.faults import fault
from interp.values.values import converted, index, single

#: Inputs that have always the same value.
_FIXED: Final = {("$IN", 1025): True, ("$IN", 1026): False}
#: The values at the start, by arrays of signals.
_INITIAL: Final = {"$IN": False, "$OUT": False, "$ANIN": 0.0, "$ANOUT": 0.0}
_SHORTEST: Final = 0.1
_LONGEST: Final = 3.0

#: A change of a signal: the array, the index, the new value.
Change = tuple[str, int, Value]
Report = Callable[[str, int, Value], None]
Later = Callable[[int, Callable[[], None]], None]


@dataclass(frozen=True, slots=True, eq=False)
class _Pulse:
    """A pulse that holds an output at a level."""

    level: bool


class Signals:
    """All signals, by the names of their arrays.

    ``later`` schedules an action at a time in µs; ``report`` is called with every change.
    """

    def __init__(self, profile: Profile, clock: Clock, later: Later, report: Report) -> None:
        sizes = profile.sizes
        self._sizes = {
            "$IN": sizes["inputs"],
            "$OUT": sizes["outputs"],
            "$ANIN": sizes["analog_inputs"],
            "$ANOUT": sizes["analog_outputs"],
        }
        #: The values of the signals that have changed, and of those that never do.
        self._values: dict[tuple[str, int], Any] = {**_FIXED}
        self._clock = clock
        self._later = later
        self._report = report
        self._pulses: dict[tuple[str, int], _Pulse] = {}

    def read(self, path: Path) -> Value:
        """Return the value of a signal or of a group; faults ``index``."""
        name, places = self._range(path)
        values = [self._values.get((name, place), _INITIAL[name]) for place in places]
        if "TO" not in path:
            return values[0]
        number = sum(value << bit for bit, value in enumerate(values))
        return number - 2**32 if number >= 2**31 else number

    def write(self, path: Path, value: Value) -> None:
        """Set an output; faults ``read_only``, ``index``, ``inadmissible``."""
        if path[0] in ("$IN", "$ANIN"):
            raise fault("read_only")
        self.put(path, value)

    def put(self, path: Path, value: Value) -> None:
        """Set a signal; from outside this may be an input too."""
        name, places = self._range(path)
        if "TO" in path:
            number = index(value)
            for bit, place in enumerate(places):
                self._put_bit(name, place, number >> bit & 1 == 1)
        elif name in ("$ANIN", "$ANOUT"):
            level: Any = converted(value, REAL)
            self._set(name, places[0], single(min(max(level, -1.0), 1.0)))
        else:
            self._put_bit(name, places[0], converted(value, BOOL))

    def pulse(self, number: int, level: bool, seconds: float) -> None:
        """PULSE: set an output to a level for a time in s, then to the other level [IOT-07].

        The time is rounded to tenths of a second and limited to 0.1 to 3 s. A new pulse restarts
        the time. Setting the other level meanwhile ends the pulse.
        """
        tenths = min(max(round(seconds * 10) / 10, _SHORTEST), _LONGEST)
        self.put(("$OUT", number), level)
        pulse = self._pulses["$OUT", number] = _Pulse(level)

        def end() -> None:
            if self._pulses.get(("$OUT", number)) is pulse:
                self._put_bit("$OUT", number, not level)

        self._later(self._clock.tick_after(round(tenths * 1_000_000)), end)

    @contextmanager
    def deferred(self) -> Iterator[list[Change]]:
        """Collect the changes within this context instead of reporting them."""
        changes: list[Change] = []
        before, self._report = self._report, lambda *change: changes.append(change)
        try:
            yield changes
        finally:
            self._report = before

    def _put_bit(self, name: str, place: int, value: Any) -> None:
        if (name, place) in _FIXED:
            return
        pulse = self._pulses.get((name, place))
        if pulse is not None and pulse.level != value:
            del self._pulses[name, place]
        self._set(name, place, value)

    def _set(self, name: str, place: int, value: Value) -> None:
        if self._values.get((name, place), _INITIAL[name]) != value:
            self._values[name, place] = value
            self._report(name, place, value)

    def _range(self, path: Path) -> tuple[str, range]:
        """Return the array and the indices of a signal or of a group."""
        match path:
            case (str() as name, int() as first):
                last = first
            case ("$IN" | "$OUT" as name, int() as first, "TO", int() as last):
                pass
            case _:
                raise fault("inadmissible")
        if not 1 <= first <= last <= self._sizes[name] or last - first >= 32:
            raise fault("index")
        return name, range(first, last + 1)
