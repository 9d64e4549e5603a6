"""Going back: the run is repeated up to an earlier moment.

Runs are deterministic: a program and its setup have exactly one run. So the debugger goes back by
starting again and stopping earlier. Every part of the state is then as it was, including the arm
and the clock. Only the changes that the user made have to be stored; they are made again at their
moments. A search for the place to go back to, such as the last breakpoint, is a repetition of its
own: it examines the statements of the last stretch and, if it finds nothing, repeats with a longer
stretch.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from interp.controller.state.trace import TaskName
from interp.debugging.client import Position, Stop
from interp.debugging.executor import DebuggedExecutor
from interp.port.requests import Path
from interp.values.values import Value

START: Final[Position] = (0, 0)
#: More statements than any run has.
_MANY: Final = 1 << 62
#: The number of statements that a search examines first, and the factor by which it grows.
_STRETCH, _GROWTH = 2_000, 100


@dataclass(frozen=True, slots=True)
class Assigned:
    """The user assigned a value to a variable.

    ``target`` is the name of a variable in a frame of ``task``, or the path of a system variable.
    """

    task: TaskName
    frame: int
    target: str | Path
    value: Value


@dataclass(frozen=True, slots=True)
class Selected:
    """The user selected the line with which the program continues."""

    line: int


Change = Assigned | Selected
#: Returns the stop to go back to if the statement that is about to begin is the wanted one.
Fits = Callable[[DebuggedExecutor], Stop | None]


@dataclass(slots=True)
class _Search:
    """A search for the last moment before ``end`` that ``fits``.

    It examines the statements from number ``first`` on, only those at breakpoints if it
    ``is_of_places``. ``found`` is the last match so far.
    """

    fits: Fits
    is_of_places: bool
    end: Position
    first: int
    found: tuple[Position, Stop | None] = START, None


class History:
    """The present moment of a run, the user's changes, and where a repetition stops."""

    def __init__(self) -> None:
        self.here: Position = START
        self.changes: list[tuple[Position, Change]] = []
        self._goal: Position | None = None
        self._stop: Stop | None = None
        self._search: _Search | None = None

    @property
    def is_repeating(self) -> bool:
        """Whether the run repeats what has happened before."""
        return self._goal is not None or self._search is not None

    @property
    def is_idle(self) -> bool:
        """Whether there is no moment to return to, no search, and no change."""
        return self._goal is None and self._search is None and not self.changes

    def begin(self) -> None:
        """A run has begun."""
        self.here = (0, -1)

    def comes(self, count: int) -> None:
        """A statement is about to begin after ``count`` statements have begun."""
        self.here = (count, self.here[1] + 1 if count == self.here[0] else 0)

    def ends(self, count: int) -> None:
        """The run has ended after ``count`` statements; this is later than all other moments."""
        self.here = (count, _MANY)

    def is_looking(self, count: int) -> bool:
        """Return whether the search examines the statement after ``count`` statements."""
        return self._search is not None and count >= self._search.first

    def unseen(self, count: int, shows_places: bool) -> int:
        """Return how many more statements may begin before one must be examined.

        A search for breakpoints examines no other statements if the executor shows those at
        breakpoints (``shows_places``).
        """
        ahead = [moment[0] for moment, _ in self.changes if moment > self.here]
        if self._goal is not None:
            ahead.append(self._goal[0])
        if (search := self._search) is not None:
            is_shown = search.is_of_places and shows_places and count >= search.first
            ahead.append(search.end[0] if is_shown else search.first)
        return max(0, min(ahead, default=_MANY) - count)

    def due(self) -> list[Change]:
        """Return the changes that were made at this moment."""
        return [change for moment, change in self.changes if moment == self.here]

    def change(self, change: Change) -> None:
        """Store a change that is made now, and drop those that were made later."""
        self.changes = [one for one in self.changes if one[0] <= self.here]
        self.changes.append((self.here, change))

    def look_back(self, fits: Fits, is_of_places: bool) -> None:
        """Let the next run stop at the last moment before this one that fits, or at its start.

        With ``is_of_places``, only statements at breakpoints can fit.
        """
        first = max(0, self.here[0] - _STRETCH)
        self._search = _Search(fits, is_of_places, self.here, first)

    def forget(self) -> None:
        """Drop all changes."""
        self.changes.clear()

    def arrived(self, executor: DebuggedExecutor) -> Stop | None:
        """Return the stop if this is the moment to return to, else ``None``."""
        if self._search is None and self._goal is not None and self.here >= self._goal:
            self._goal = None
            # Going back to a line selection returns to the moment before the selection.
            undone = next((one for one in self.due() if isinstance(one, Selected)), None)
            if undone is not None:
                self.changes = self.changes[: self.changes.index((self.here, undone))]
            return self._stop or Stop("back", executor.task, executor.at)
        return None

    def is_searched(self, executor: DebuggedExecutor | None = None) -> bool:
        """Examine this moment, and return whether the search has examined all its moments."""
        search = self._search
        if search is None:
            return False
        if self.here >= search.end:
            return True
        stop = search.fits(executor) if executor and self.here[0] >= search.first else None
        if stop is not None:
            search.found = self.here, stop
        return False

    def end_search(self) -> None:
        """Return to the moment that the search found, or prepare a search of a longer stretch."""
        search = self._search
        if search is None:
            return
        if search.found[1] is None and search.first > 0:
            stretch = (search.end[0] - search.first) * _GROWTH
            search.first = max(0, search.end[0] - stretch)
        else:
            (self._goal, self._stop), self._search = search.found, None
