"""The recogniser line by line, with the step over a whole line cached; builds no trees.

Real source repeats few kinds of line. Each kind gets a number, and the step from one state over a
whole line to the next is cached. A line that was read in the same state before costs one look-up,
also when several readings of the same lines are compared (`grammar.parser.failures`).
"""

from __future__ import annotations

from collections.abc import Sequence

from grammar.parser.lazy_automaton import Core, Tail
from grammar.parser.recognizer import Recognizer, State


class Spot(dict[int, "Spot | None"]):
    """A state between two lines; equal states are the same object.

    As a dictionary it maps the number of a line to the spot after it, or to ``None`` if the line
    cannot be read there.
    """

    __slots__ = ("state",)

    def __init__(self, state: State) -> None:
        self.state = state

    __hash__ = object.__hash__  # type: ignore[assignment]  # a dict has none
    __eq__ = object.__eq__


class LineReader:
    """Reads lines under one grammar. Line numbers and spots are valid until `forget`."""

    def __init__(self, recognizer: Recognizer) -> None:
        self.recognizer = recognizer
        self.kinds: list[tuple[int, ...]] = []  # of each line, by its number
        self._numbers: dict[tuple[int, ...], int] = {}
        self._spots: dict[tuple[Core, Tail], Spot] = {}

    def __len__(self) -> int:
        """Return how many lines and spots are cached."""
        return len(self.kinds) + len(self._spots)

    def forget(self) -> None:
        """Empty the caches."""
        self.kinds.clear()
        self._numbers.clear()
        self._spots.clear()

    def numbers(self, kinds: Sequence[int]) -> list[int]:
        """Return the line numbers of a file given by its token kinds.

        The end of file is a line of its own.
        """
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
        """Return the spot of a state."""
        key = (state.core, state.tail)
        found = self._spots.get(key)
        if found is None:
            found = self._spots[key] = Spot(state)
        return found

    def after(self, spot: Spot, line: int) -> Spot | None:
        """Return the spot after a line, or ``None`` if the line cannot be read."""
        try:
            return spot[line]
        except KeyError:
            state, failed = self.recognizer.run(spot.state, self.kinds[line])
            found = spot[line] = self.spot(state) if failed is None else None
            return found
