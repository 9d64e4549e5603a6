"""An executor around another one, which lets a debugger stop it before any statement.

The inner executor is made to return a slice wherever the debugger wants to look. The outer executor
hides these extra slices: to the controller, a debugged program makes the same requests as without a
debugger.
"""

from __future__ import annotations

from typing import Any, Protocol

from interp.controller.state.trace import TaskName
from interp.port.events import Sink
from interp.port.executor import Executor, Reader
from interp.port.inspection import Breaks, Inspectable
from interp.port.requests import (
    At,
    CodeHandle,
    End,
    Fail,
    Request,
    Skip,
    Slice,
    StopAdvance,
    Value,
)
from interp.values.faults import Fault


class Hook(Protocol):
    """What a debugger does with its executors."""

    @property
    def places(self) -> Breaks:
        """The places that it wants to see."""
        ...

    def unseen(self, shows_places: bool, /) -> int:
        """Return how many statements need not be shown."""

    def begins(self, executor: DebuggedExecutor, /) -> int | None:
        """See a statement that is about to begin; return the line of another one to select."""

    def fails(self, executor: DebuggedExecutor, request: Fail | Skip, /) -> None:
        """See a failure."""

    def around(self, inside: Any, per_slice: int, task: TaskName, /) -> DebuggedExecutor:
        """Return an executor around an `Inspectable` one, of another program."""


class DebuggedExecutor:
    """Runs ``inside`` and shows ``hook`` the statements that it wants to see; see `Executor`."""

    def __init__(self, hook: Hook, task: TaskName, inside: Inspectable, per_slice: int) -> None:
        self.task: TaskName = task
        self.inside = inside
        self.at = At("", 0, 0)
        self._hook = hook
        self._per_slice = per_slice
        self._places: Breaks = {}
        self._shows_places = True
        #: The number of begun statements at which the controller's slice ends.
        self._due = inside.begun + per_slice
        self._open: Request | None = None
        self._again: Request | None = None
        #: For each running action: the depth when it was entered, and the request it interrupted.
        self._actions: list[tuple[int, Request | None]] = []

    @property
    def height(self) -> int:
        """The number of open calls and actions."""
        return self.at.depth + len(self._actions)

    # ----------------------------------------------------------------------- the port

    @property
    def depth(self) -> int:
        """The number of open calls."""
        return self.inside.depth

    @property
    def begun(self) -> int:
        """The number of statements that have begun."""
        return self.inside.begun

    def advance(self, reply: Value | Fault | None = None) -> Request:
        """Run until the controller is needed; see `Executor`."""
        inside, hook = self.inside, self._hook
        if self._again is not None:  # after an action: the interrupted request comes again
            self._open, self._again = self._again, None
            return inside.advance(None)
        if isinstance(self._open, Slice | StopAdvance):
            reply = None  # an executor may ask sooner than the reply allows
        while True:
            if self._places is not (places := hook.places):
                self._places, self._shows_places = places, inside.break_at(places)
            inside.ask_at(min(self._due, inside.begun + hook.unseen(self._shows_places)))
            request = inside.advance(reply)
            reply = None
            self.at = request.at
            if isinstance(request, Slice):
                line = hook.begins(self)
                if line is not None:  # the selected statement asks before it begins, as all do
                    inside.select(line)
                    continue
                if inside.begun < self._due:
                    continue
            elif isinstance(request, End) and self._actions:
                self._again = self._actions.pop()[1]
                return request
            elif isinstance(request, Fail | Skip):
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
        """Return the value of a condition; the debugger never stops in one."""
        return self.inside.evaluate(code, read)

    def unwind(self, depth: int) -> None:
        """Leave all routines deeper than ``depth``, and the actions that were entered there."""
        self._actions = [one for one in self._actions if one[0] < depth]
        self._open = self._again = None
        self.inside.unwind(depth)

    def waited(self) -> None:
        """Count functions anew; see `interp.port.executor.Executor`."""
        self.inside.waited()

    def companion(self, routine: str, sink: Sink | None = None) -> Executor:
        """Return a debugged executor over the same data lists, for the submit interpreter."""
        companion = self.inside.companion(routine, sink)
        return self._hook.around(companion, self._per_slice, "submit")
