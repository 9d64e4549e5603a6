"""Automatic inputs: digital inputs that change until the WAIT FOR that reads them is fulfilled.

Real programs communicate with grippers, spindles and a PLC, for which no scripts are available. The
script line ``fulfil waits after 1`` stands in for all of them. When the robot's program has waited
for that time, the digital inputs that its condition has read change one at a time, one in each
cycle, through all their combinations, beginning with the one that was read first. Inputs that the
script sets itself do not change. If no combination makes the condition TRUE, the inputs end as they
began, and the program continues to wait.

Flags change too, but only after five times the delay, and after the inputs: a flag that the program
itself does not set by then is probably set by an option package, for example when a message comes.

A line that reads inputs again and again for a second counts as a WAIT FOR from then on, if the
program has changed no output, no system variable and not the place of the arm meanwhile. Many main
programs switch a heartbeat output or restart a timer in such a loop. So after five seconds it is
enough that the program has not moved the arm.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator
from dataclasses import field
from typing import Final

from interp.controller.inputs.input_script import Assign, Script
from interp.controller.state.state import ControllerState
from interp.controller.state.trace import TaskName
from interp.port.requests import At, Path, path_text
from support.lazy_dataclass import dataclass

#: The actions of the operator and of the cell, as lines of a script.
OPERATOR: Final = """\
on HALT after 1 press START
on message after 1 press CONFIRM
on dialogue after 1 answer 1
fulfil waits after 1
"""

#: The largest number of inputs that are tried: more would have too many combinations.
_MOST_INPUTS: Final = 10
#: The time in µs after which a line that reads inputs counts as a wait: if nothing has changed, and
#: if the arm has not moved.
_POLLED: Final = 1_000_000
_STOOD: Final = 5_000_000
#: The delay of flags as a multiple of that of inputs: usually the program sets its flags itself.
_FLAG_DELAY: Final = 5

#: ``$IN`` or ``$FLAG``, and the number.
_Place = tuple[str, int]
#: A wait: the place of a WAIT FOR, or the `_Polls` of a loop.
_Key = At | tuple[int, int]


@dataclass(slots=True)
class _Polls:
    """Inputs that lines have read, and when each line first did, in µs.

    After ``delay`` µs a line counts as a wait.
    """

    delay: int
    read: dict[_Place, None] = field(default_factory=dict)
    since: dict[At, int] = field(default_factory=dict)

    def note(self, places: dict[_Place, None], at: At, now: int) -> bool:
        """Note that a line has read inputs at a time in µs; return whether it counts as a wait."""
        self.read |= places
        return now - self.since.setdefault(at, now) >= self.delay

    @property
    def key(self) -> _Key:
        """The wait that these polls are; another one as soon as another input is read."""
        return self.delay, len(self.read)

    def clear(self) -> None:
        self.read.clear()
        self.since.clear()


class AutomaticInputs:
    """Fulfils the waits of a run; does nothing if the script has no ``fulfil waits`` line."""

    def __init__(self, script: Script, state: ControllerState) -> None:
        self._after = script.fulfils
        self._state = state
        actions = (action for step in script.steps for action in step.actions)
        paths = [action.path for action in actions if isinstance(action, Assign)]
        self._scripted = frozenset(place for path in paths for place in _places(path))
        #: The wait that the program is in, and since when.
        self._since: tuple[_Key, int] | None = None
        #: Since a WAIT FOR or a change of anything, and since a WAIT FOR or a motion.
        self._polls = _Polls(_POLLED)
        self._standing = _Polls(_STOOD)
        self._changes: deque[tuple[_Place, bool]] = deque()
        #: The number of changes that were made.
        self.count = 0
        #: For each WAIT FOR: the time waited in µs, and the variables that its condition has read.
        self.waited: dict[At, tuple[int, tuple[str, ...]]] = {}
        self._names: dict[str, None] = {}
        self._before = 0
        #: The number of motions that the program had planned when it last changed something.
        self._planned = 0

    @property
    def is_on(self) -> bool:
        """Whether the script asks for automatic inputs."""
        return self._after is not None

    @property
    def wake(self) -> int | None:
        """The time in µs of the next change or of the next wait; ``None`` if it is unknown."""
        if self._since is not None and self._changes:
            then = self._since[1] + self._delay
            return then if then > self._before else None
        now = self._state.clock.now
        every = (self._polls, self._standing)
        dues = (since + polls.delay for polls in every for since in polls.since.values())
        return min((due for due in dues if due > now), default=None)

    @property
    def _delay(self) -> int:
        """How long the program must wait until the next change, in µs."""
        assert self._after is not None, "it fulfils waits"
        return self._after * (_FLAG_DELAY if self._changes[0][0][0] == "$FLAG" else 1)

    def was_read(self, task: TaskName, path: Path, at: At) -> None:
        """Note that a line has read a variable; change an input if it has waited long enough."""
        if not self.is_on or task != "robot":
            return
        self._names[path_text(path)] = None
        places = dict.fromkeys(_places(path))
        if places:
            now = self._state.clock.now
            due = [polls for polls in (self._polls, self._standing) if polls.note(places, at, now)]
            if due:
                self._go_on(at, due[0].key, due[0].read)

    def changed(self, planned: int) -> None:
        """Note that the robot's program has changed something, and has ``planned`` motions."""
        if planned != self._planned:
            self._planned = planned
            self._standing.clear()
            self._since = None
        self._begin()

    def begin(self, task: TaskName) -> None:
        """Note that a program has come to a WAIT FOR."""
        if task == "robot":
            self._begin()

    def _begin(self) -> None:
        self._polls.clear()
        self._names.clear()
        if self._since is not None and self._since[0] != self._standing.key:
            self._since = None

    def was_false(self, task: TaskName, at: At) -> None:
        """Note that the condition of a WAIT FOR was FALSE; change an input if due."""
        if task != "robot":
            return
        self._polls.since.clear()
        self._standing.since.clear()
        self._go_on(at, at, self._polls.read)

    def _go_on(self, at: At, key: _Key, read: Iterable[_Place]) -> None:
        """Note that the program waits at a line, which has read inputs; change one if due.

        If ``key`` is another one than before, a new wait begins.
        """
        if self._after is None:
            return
        now = self._state.clock.now
        if self._since is None or self._since[0] != key:
            self._since, self._before = (key, now), now
            self._changes.clear()
            found = [place for place in read if place not in self._scripted]
            if len(found) <= _MOST_INPUTS:
                inputs = [place for place in found if place[0] == "$IN"]
                self._changes += _combinations({place: self._has(place) for place in inputs})
                flags = [place for place in found if place[0] == "$FLAG"]
                if flags:
                    every = (*flags, *inputs)
                    self._changes += _combinations({place: self._has(place) for place in every})
        elif self._before == now:
            return  # one change a cycle
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
    """Yield the digital inputs, or the flag, that a path denotes."""
    if path[0] in ("$IN", "$FLAG") and len(path) > 1:
        first, last = path[1], path[-1]
        if isinstance(first, int) and isinstance(last, int):
            yield from ((str(path[0]), number) for number in range(first, last + 1))


def _combinations(values: dict[_Place, bool]) -> Iterator[tuple[_Place, bool]]:
    """Yield single changes that lead through all combinations of values and back (a Gray code)."""
    places = list(values)
    for count in range(1, 2 ** len(places) + 1) if places else ():
        place = places[min((count & -count).bit_length(), len(places)) - 1]
        values[place] = not values[place]
        yield place, values[place]
