"""An executor around another one, which a debugger can stop before every statement.

The executor inside is asked to ask for time where the debugger wants to look. Slices that would
not have come are kept from the outside: there, a program that is debugged makes the same requests
as without a debugger.
"""

from __future__ import annotations

from typing import Any, Protocol

from interp.controller.state.trace import TaskName
from interp.port.events import Sink
from interp.port.executor import Executor, Reader
from interp.port.inspection import Breaks, Inspectable
from interp.port.requests import At, CodeHandle, End, Fail, Request, Slice, StopAdvance, Value
from interp.values.faults import Fault


class Hook(Protocol):
    """What is shown the statements and faults of debugged executors: the debugger."""

    @property
    def places(self) -> Breaks:
        """The lines whose statements are shown, at least where the guard of a line holds.

        It is the same object while they stay.
        """

    def unseen(self, shows_places: bool) -> int:
        """How many statements may begin before one has to be shown, but for those of `places`.

        Without ``shows_places`` these count too.
        """

    def begins(self, executor: DebuggedExecutor) -> int | None:
        """A statement is about to begin; the line to continue at instead, if any."""

    def fails(self, executor: DebuggedExecutor, request: Fail) -> None:
        """The program has come to a fault that it does not handle."""

    def around(self, inside: Any, per_slice: int, task: TaskName) -> DebuggedExecutor:
        """An executor that is shown too."""


class DebuggedExecutor:
    """Runs ``inside``, and shows ``hook`` every statement it wants to see; see `Executor`."""

    def __init__(self, hook: Hook, task: TaskName, inside: Inspectable, per_slice: int) -> None:
        self.task: TaskName = task
        self.inside = inside
        self.at = At("", 0, 0)
        self._hook = hook
        self._per_slice = per_slice
        self._places: Breaks = {}
        self._shows_places = True
        #: When the slice ends that the outside has given.
        self._due = inside.begun + per_slice
        self._open: Request | None = None
        self._again: Request | None = None
        #: For each action that runs: the depth it was entered at, and the request it interrupted.
        self._actions: list[tuple[int, Request | None]] = []

    @property
    def height(self) -> int:
        """How many calls and actions are open."""
        return self.at.depth + len(self._actions)

    # ----------------------------------------------------------------------- the port

    @property
    def depth(self) -> int:
        """How many calls deep the program is."""
        return self.inside.depth

    @property
    def begun(self) -> int:
        """How many statements have begun."""
        return self.inside.begun

    def advance(self, reply: Value | Fault | None = None) -> Request:
        """Compute until the controller is needed."""
        inside, hook = self.inside, self._hook
        if self._again is not None:  # behind an action, as it was asked before
            self._open, self._again = self._again, None
            return inside.advance(None)
        if isinstance(self._open, Slice | StopAdvance):
            reply = None  # it may ask sooner than the controller would have it
        while True:
            if self._places is not (places := hook.places):
                self._places, self._shows_places = places, inside.break_at(places)
            inside.ask_at(min(self._due, inside.begun + hook.unseen(self._shows_places)))
            request = inside.advance(reply)
            reply = None
            self.at = request.at
            if isinstance(request, Slice):
                line = hook.begins(self)
                if line is not None:  # its statement asks before it begins, as every one does
                    inside.select(line)
                    continue
                if inside.begun < self._due:
                    continue
            elif isinstance(request, End) and self._actions:
                self._again = self._actions.pop()[1]
                return request
            elif isinstance(request, Fail):
                hook.fails(self, request)
            if not isinstance(request, End):
                self._due = inside.begun + self._per_slice
            self._open = request
            return request

    def enter(self, code: CodeHandle) -> None:
        """Push an action, which runs before the program continues."""
        self._actions.append((self.inside.depth, self._again or self._open))
        self._open = self._again = None
        self.inside.enter(code)

    def evaluate(self, code: CodeHandle, read: Reader) -> Value:
        """The value of a condition; nothing stops in it."""
        return self.inside.evaluate(code, read)

    def unwind(self, depth: int) -> None:
        """Leave all routines deeper than ``depth``, and what was entered there."""
        self._actions = [one for one in self._actions if one[0] < depth]
        self._open = self._again = None
        self.inside.unwind(depth)

    def companion(self, routine: str, sink: Sink | None = None) -> Executor:
        """A second executor over the same data lists, the submit's, which is debugged too."""
        companion = self.inside.companion(routine, sink)
        return self._hook.around(companion, self._per_slice, "submit")
