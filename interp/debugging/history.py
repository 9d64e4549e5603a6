"""Going back: a run is repeated up to an earlier moment.

A program and its setup have one run. So to go back is to begin anew and to stop earlier: all that
makes up the state is as it was, the arm and the clock too, and nothing has to be kept but the
changes that were made from outside, which are made again at their moments. Where exactly to
go back to, to the last breakpoint for instance, a first repetition finds out: it looks at the
statements of the last stretch, and where it finds nothing there, at those of a longer one.
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
#: More than there are.
_MANY: Final = 1 << 62
#: Statements that are looked at first, and by what that grows.
_STRETCH, _GROWTH = 2_000, 100


@dataclass(frozen=True, slots=True)
class Assigned:
    """A variable was given a value from outside.

    It is one of the program, by its name in a frame of a task, or the path of a system variable.
    """

    task: TaskName
    frame: int
    target: str | Path
    value: Value


@dataclass(frozen=True, slots=True)
class Selected:
    """A line was selected, with which the program continues."""

    line: int


Change = Assigned | Selected
#: Why to go back to the moment at which a program is about to begin a statement, if at all.
Fits = Callable[[DebuggedExecutor], Stop | None]


@dataclass(slots=True)
class _Search:
    """For the last moment before ``end`` that ``fits``, from so many statements on."""

    fits: Fits
    is_of_places: bool
    end: Position
    first: int
    found: tuple[Position, Stop | None] = START, None


class History:
    """Where a run is, what was changed in it from outside, and where a repetition is to stop."""

    def __init__(self) -> None:
        self.here: Position = START
        self.changes: list[tuple[Position, Change]] = []
        self._goal: Position | None = None
        self._stop: Stop | None = None
        self._search: _Search | None = None

    @property
    def is_repeating(self) -> bool:
        """Whether what happens has happened before."""
        return self._goal is not None or self._search is not None

    @property
    def is_idle(self) -> bool:
        """Whether there is nothing to return to, to look for, or to change."""
        return self._goal is None and self._search is None and not self.changes

    def begin(self) -> None:
        """A run begins."""
        self.here = (0, -1)

    def comes(self, count: int) -> None:
        """So many statements have begun, and another one is about to begin."""
        self.here = (count, self.here[1] + 1 if count == self.here[0] else 0)

    def ends(self, count: int) -> None:
        """The run has ended, behind all moments."""
        self.here = (count, _MANY)

    def is_looking(self, count: int) -> bool:
        """Whether what begins behind so many statements may be what is searched for."""
        return self._search is not None and count >= self._search.first

    def unseen(self, count: int, shows_places: bool) -> int:
        """How many more statements may begin before one has to be looked at.

        Where only breakpoints are searched for and executors show them, no other has to be.
        """
        ahead = [moment[0] for moment, _ in self.changes if moment > self.here]
        if self._goal is not None:
            ahead.append(self._goal[0])
        if (search := self._search) is not None:
            is_shown = search.is_of_places and shows_places and count >= search.first
            ahead.append(search.end[0] if is_shown else search.first)
        return max(0, min(ahead, default=_MANY) - count)

    def due(self) -> list[Change]:
        """The changes that were made at this moment."""
        return [change for moment, change in self.changes if moment == self.here]

    def change(self, change: Change) -> None:
        """A change is made now; what was changed later is no longer true."""
        self.changes = [one for one in self.changes if one[0] <= self.here]
        self.changes.append((self.here, change))

    def look_back(self, fits: Fits, is_of_places: bool) -> None:
        """The next run is to stop at the last moment before this one that fits, or at its start.

        ``is_of_places``: only statements with a breakpoint can fit.
        """
        first = max(0, self.here[0] - _STRETCH)
        self._search = _Search(fits, is_of_places, self.here, first)

    def forget(self) -> None:
        """Changes are no longer made."""
        self.changes.clear()

    def arrived(self, executor: DebuggedExecutor) -> Stop | None:
        """Why the program stops where the moment that was to be returned to has come."""
        if self._search is None and self._goal is not None and self.here >= self._goal:
            self._goal = None
            # Whoever goes back to where a line was selected goes back behind that selection.
            undone = next((one for one in self.due() if isinstance(one, Selected)), None)
            if undone is not None:
                self.changes = self.changes[: self.changes.index((self.here, undone))]
            return self._stop or Stop("back", executor.task, executor.at)
        return None

    def is_searched(self, executor: DebuggedExecutor | None = None) -> bool:
        """Whether all moments that a search is about have been looked at, as the next one is."""
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
        """Return to what was found, or look at more."""
        search = self._search
        if search is None:
            return
        if search.found[1] is None and search.first > 0:
            stretch = (search.end[0] - search.first) * _GROWTH
            search.first = max(0, search.end[0] - stretch)
        else:
            (self._goal, self._stop), self._search = search.found, None
