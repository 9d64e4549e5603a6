"""Automatic inputs: those that a WAIT FOR reads change until it is fulfilled.

Behind real programs stand grippers, spindles and a PLC whose scripts are not available. A line
``fulfil waits after 1`` stands for all of them: once the robot's program has waited so long, the
digital inputs that its condition has read change one at a time, a cycle each, through all their
combinations, beginning with the one it read first. Inputs that a script sets itself stay as they
are. If no combination makes the condition TRUE, they end as they began, and the program continues
waiting. Flags that nothing has set by five times then are set by an option package, for a message
that has come for instance: they change like inputs, but last.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from typing import Final

from interp.controller.inputs.input_script import Assign, Script
from interp.controller.state.state import ControllerState
from interp.controller.state.trace import path_text
from interp.port.requests import At, Path

#: What the person at the panel and the cell do, as lines of a script.
OPERATOR: Final = """\
on HALT after 1 press START
on message after 1 press CONFIRM
on dialogue after 1 answer 1
fulfil waits after 1
"""

#: More inputs than these are not tried: there would be too many combinations.
_MOST: Final = 10
#: So many times as long as inputs do flags stay as they are: mostly the program sets them itself.
_PATIENCE: Final = 5

#: ``$IN`` or ``$FLAG``, and a number.
_Place = tuple[str, int]


class AutomaticInputs:
    """Fulfils the waits of one script; does nothing where that has no such line."""

    def __init__(self, script: Script, state: ControllerState) -> None:
        self._after = script.fulfils
        self._state = state
        actions = (action for step in script.steps for action in step.actions)
        paths = [action.path for action in actions if isinstance(action, Assign)]
        self._scripted = frozenset(place for path in paths for place in _places(path))
        self._read: dict[_Place, None] = {}
        self._since: tuple[At, int] | None = None
        self._changes: deque[tuple[_Place, bool]] = deque()
        #: How many inputs were changed.
        self.count = 0
        #: Where the program has waited, for how long in µs, and the variables that it read there.
        self.waited: dict[At, tuple[int, tuple[str, ...]]] = {}
        self._names: dict[str, None] = {}
        self._before = 0

    @property
    def is_on(self) -> bool:
        """Whether anything is to be fulfilled."""
        return self._after is not None

    @property
    def wake(self) -> int | None:
        """When it will change an input, in µs, if it knows that it will."""
        then = self.next_change
        return then if then is not None and then > self._before else None

    @property
    def next_change(self) -> int | None:
        """The time in µs from which on it changes the next input, if there is one to change."""
        return self._since[1] + self._delay if self._since is not None and self._changes else None

    @property
    def _delay(self) -> int:
        """How long the program has to wait for the next change, in µs."""
        assert self._after is not None, "it fulfils waits"
        return self._after * (_PATIENCE if self._changes[0][0][0] == "$FLAG" else 1)

    def was_read(self, path: Path) -> None:
        """The program reads a variable, perhaps an input for the condition of a WAIT FOR."""
        self._read |= dict.fromkeys(_places(path))
        self._names[path_text(path)] = None

    def begin(self) -> None:
        """The program comes to a WAIT FOR."""
        self._read.clear()
        self._names.clear()
        self._since = None

    def was_false(self, at: At, now: int) -> None:
        """The condition there was FALSE at a time in µs."""
        if self._after is None:
            return
        if self._since is None or self._since[0] != at:
            self._since, self._before = (at, now), now
            self._changes.clear()
            found = [place for place in self._read if place not in self._scripted]
            if len(found) <= _MOST:
                inputs = [place for place in found if place[0] == "$IN"]
                self._changes += _combinations({place: self._has(place) for place in inputs})
                flags = [place for place in found if place[0] == "$FLAG"]
                if flags:
                    every = (*flags, *inputs)
                    self._changes += _combinations({place: self._has(place) for place in every})
        before = self.waited.get(at, (0, ()))[0]
        self.waited[at] = before + now - self._before, tuple(self._names)
        self._before = now
        if self._changes and now - self._since[1] >= self._delay:
            place, value = self._changes.popleft()
            self.count += 1
            self._state.assign(place, value)

    def _has(self, place: _Place) -> bool:
        parts = self._state.signals if place[0] == "$IN" else self._state.variables
        return parts.read(place) is True


def _places(path: Path) -> Iterator[_Place]:
    """The digital inputs of a path, or its flag."""
    if path[0] in ("$IN", "$FLAG") and len(path) > 1:
        first, last = path[1], path[-1]
        if isinstance(first, int) and isinstance(last, int):
            yield from ((str(path[0]), number) for number in range(first, last + 1))


def _combinations(values: dict[_Place, bool]) -> Iterator[tuple[_Place, bool]]:
    """One change after the other that lead through all combinations and back (a Gray code)."""
    places = list(values)
    for count in range(1, 2 ** len(places) + 1) if places else ():
        place = places[min((count & -count).bit_length(), len(places)) - 1]
        values[place] = not values[place]
        yield place, values[place]
