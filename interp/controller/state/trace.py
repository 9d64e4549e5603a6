"""The trace: the events of a run, one after the other, in the format of docs/trace.md.

Two executors conform to each other if the traces of all programs are equal. So an event contains
nothing about the executor, wall-clock time or memory, and each event has only one form in JSON.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any, Final, Literal

from interp.port.events import EVERY_KIND, Kind
from interp.port.requests import At, Path, Value, path_text
from interp.values.json_form import to_json

TaskName = Literal["robot", "submit"]

#: The kinds of executor events in a trace of the normal level.
WORLD_KINDS: Final = EVERY_KIND - {"line", "assign"}

#: All kinds of events; ``line`` and ``assign`` occur only at the full level.
KINDS: Final = tuple(
    """
    line assign call return branch advance_stop motion_planned motion_start blend_start blend_apex
    blend_end motion_end in out anout trigger interrupt_enter interrupt_leave brake resume wait
    message fault halt end
    """.split()
)

#: One encoder for all events: a long trace has millions.
_json: Final = json.JSONEncoder(ensure_ascii=False, separators=(",", ":")).encode


@dataclass(frozen=True, slots=True)
class TraceEvent:
    """One event: its ``time`` in µs, its task, its kind, the line that causes it, and its fields.

    ``at`` is ``None`` for an event that comes from outside the program, such as an input. The
    values of ``fields`` are ready for JSON.
    """

    time: int
    task: TaskName
    kind: str
    at: At | None
    fields: Mapping[str, Any] = field(default_factory=dict)

    @property
    def place(self) -> str | None:
        """The place as ``file:line``."""
        return None if self.at is None else f"{self.at.file}:{self.at.line}"

    def line(self) -> str:
        """Return the event as a line of JSON, without the line end."""
        head = {"t": self.time, "task": self.task, "kind": self.kind, "at": self.place}
        return _json({**head, **self.fields})


class Trace:
    """Records events with the time of the controller's clock.

    ``take`` receives each event when it happens; by default events are stored in ``events``.
    ``kinds`` are the kinds that executors report. By default these are all but lines and
    assignments, which are the most frequent ones and cost time. ``origin`` is the task and the line
    that cause what changes now; the line is ``None`` for changes from outside. ``arguments`` are
    the arguments to report with calls, as written, by file, line and name in upper case.
    """

    def __init__(
        self,
        take: Callable[[TraceEvent], None] | None = None,
        *,
        kinds: frozenset[Kind] = WORLD_KINDS,
        arguments: Mapping[tuple[str, int, str], str] | None = None,
    ) -> None:
        self.arguments = arguments or {}
        self.events: list[TraceEvent] = []
        self.now = 0
        #: The number of events so far.
        self.count = 0
        self.kinds = kinds
        self.origin: tuple[TaskName, At | None] = ("robot", None)
        #: The WAIT FOR of each task whose waiting is recorded.
        self._waiting: dict[TaskName, At] = {}
        self._take = take or self.events.append

    def record(self, task: TaskName, kind: str, at: At | None, **fields: Any) -> None:
        """Record an event that happens now."""
        self.count += 1
        self._take(TraceEvent(self.now, task, kind, at, fields))

    def polled(self, task: TaskName, at: At, is_first: bool) -> None:
        """Record that a program waits for a condition, when it was FALSE for the first time."""
        if is_first:
            self._waiting.pop(task, None)
        elif self._waiting.get(task) != at:
            self._waiting[task] = at
            self.record(task, "wait", at)

    def record_change(self, kind: str, **fields: Any) -> None:
        """Record a change that `origin` has caused."""
        self.record(self.origin[0], kind, self.origin[1], **fields)

    @contextmanager
    def attributed(self, task: TaskName, at: At | None) -> Iterator[None]:
        """Attribute the changes within this context to a line of a task."""
        before, self.origin = self.origin, (task, at)
        try:
            yield
        finally:
            self.origin = before

    def sink(
        self,
        task: TaskName = "robot",
        kinds: frozenset[Kind] | None = None,
        *,
        keeps_calls: bool = True,
    ) -> TaskSink:
        """Return a sink for an executor whose events go into this trace."""
        return TaskSink(self, task, self.kinds if kinds is None else kinds, keeps_calls)


class TaskSink:
    """Records the events of one executor.

    ``left`` are called with the depth of each routine that has ended: the interrupts that it
    declared end with it [INT-04]. ``kinds`` are the kinds that the sink receives. Without
    ``keeps_calls``, calls are not recorded, and only serve to know which routines are open.
    """

    def __init__(
        self, trace: Trace, task: TaskName, kinds: frozenset[Kind], keeps_calls: bool
    ) -> None:
        self.task: TaskName = task
        self.kinds = kinds
        self.left: Sequence[Callable[[int], None]] = ()
        self._trace = trace
        self._keeps_calls = keeps_calls
        self._names: dict[int, str] = {}

    def routine(self, depth: int) -> str:
        """Return the name of the routine that was called last to this depth."""
        return self._names.get(depth, "")

    def line(self, at: At) -> None:
        """A statement begins."""
        self._trace.record(self.task, "line", at)

    def assign(self, at: At, path: Path, value: Value | None) -> None:
        """A variable of the program was assigned."""
        self._trace.record(self.task, "assign", at, name=path_text(path), value=to_json(value))

    def call(self, at: At, name: str) -> None:
        """A routine is called."""
        self._names[at.depth + 1] = name
        if not self._keeps_calls:
            return
        given = self._trace.arguments.get((at.file, at.line, name.upper()))
        fields = {} if given is None else {"arguments": given}
        self._trace.record(self.task, "call", at, name=name, **fields)

    def leave(self, at: At, name: str) -> None:
        """A routine has ended."""
        if self._keeps_calls:
            self._trace.record(self.task, "return", at, name=name)
        for tell in self.left:
            tell(at.depth)

    def branch(self, at: At, way: int) -> None:
        """A statement chose a branch."""
        self._trace.record(self.task, "branch", at, way=way)
