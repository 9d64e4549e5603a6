"""Reading line by line: what a line does in a state is worked out once.

Real source repeats few kinds of line. Each is given a number, and the step from one state over a
whole line to the next is remembered, so that reading a line known there costs one look-up, also
where several readings of the same lines are weighed against each other (`grammar.parser.failures`).
"""

from __future__ import annotations

from collections.abc import Sequence

from grammar.parser.lazy_automaton import Core, Tail
from grammar.parser.recognizer import Recognizer, State


class Spot(dict[int, "Spot | None"]):
    """A state between two lines; the same state is the same object.

    As a dictionary: number of a line to the spot after it, ``None`` where it cannot be read.
    """

    __slots__ = ("state",)

    def __init__(self, state: State) -> None:
        self.state = state

    __hash__ = object.__hash__  # type: ignore[assignment]  # a dict has none
    __eq__ = object.__eq__


class LineReader:
    """Reads lines under one grammar. Numbers and spots hold until `forget`."""

    def __init__(self, recognizer: Recognizer) -> None:
        self.recognizer = recognizer
        self.kinds: list[tuple[int, ...]] = []  # of each line, by its number
        self._numbers: dict[tuple[int, ...], int] = {}
        self._spots: dict[tuple[Core, Tail], Spot] = {}

    def __len__(self) -> int:
        """How many lines and spots are remembered."""
        return len(self.kinds) + len(self._spots)

    def forget(self) -> None:
        """Start afresh."""
        self.kinds.clear()
        self._numbers.clear()
        self._spots.clear()

    def numbers(self, kinds: Sequence[int]) -> list[int]:
        """The lines of a file, given by its token kinds; the end of file is a line of its own."""
        known, kind = self._numbers, self.recognizer.line_kind
        found: list[int] = []
        start, last = 0, len(kinds) - 1
        while start <= last:
            try:
                end = kinds.index(kind, start, last) + 1
            except ValueError:
                end = last if start < last else last + 1
            line = tuple(kinds[start:end])
            number = known.get(line)
            if number is None:
                number = known[line] = len(self.kinds)
                self.kinds.append(line)
            found.append(number)
            start = end
        return found

    def spot(self, state: State) -> Spot:
        """The spot of a state."""
        key = (state.core, state.tail)
        found = self._spots.get(key)
        if found is None:
            found = self._spots[key] = Spot(state)
        return found

    def after(self, spot: Spot, line: int) -> Spot | None:
        """The spot after a line, or ``None`` where the line cannot be read."""
        try:
            return spot[line]
        except KeyError:
            state, failed = self.recognizer.run(spot.state, self.kinds[line])
            found = spot[line] = self.spot(state) if failed is None else None
            return found
