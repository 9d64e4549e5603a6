"""Observations of a case: findings, or a trace and a path.

An observation comes from our executors (`conformance.evaluation.execution`) or from a recording of
a controller (`conformance.exchange.recording`), and is evaluated in the same way. Values are in the
form of the trace, that is as JSON (`interp.values.json_form`).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from interp.robot.kinematics.machine_data import MachineData
from interp.robot.simulation.tracking import PathRecord


@dataclass(frozen=True, slots=True)
class Finding:
    """A finding of a front end; ``code`` is KSS or KRL with a number, or ``syntax``."""

    file: str
    line: int
    severity: str
    code: str
    message: str = ""

    @staticmethod
    def may_come_late(code: str) -> bool:
        """Whether a message has a number below 2000: those may come while a program runs."""
        return code.startswith("KSS") and int(code[3:]) < 2000


@dataclass(frozen=True, slots=True)
class Event:
    """An event of the trace.

    ``time`` is in µs of the virtual clock, ``None`` if it was not measured. ``fields`` are the
    further fields of this kind of event, as in docs/trace.md.
    """

    time: int | None
    task: str
    kind: str
    file: str
    line: int
    fields: Mapping[str, Any] = field(default_factory=dict)

    def record(self) -> dict[str, Any]:
        """Return the event as JSON, as in a trace."""
        at = f"{self.file}:{self.line}" if self.file else ""
        return {"t": self.time, "task": self.task, "kind": self.kind, "at": at, **self.fields}

    @staticmethod
    def of(record: Mapping[str, Any]) -> Event:
        """Return the event in a line of a trace; raise `ValueError` if the line is malformed."""
        try:
            rest = dict(record)
            time, task = rest.pop("t", None), rest.pop("task", "robot")
            kind, at = rest.pop("kind"), rest.pop("at", None) or ""
            file, _, line = str(at).rpartition(":")
            return Event(
                None if time is None else round(time),
                str(task),
                str(kind),
                file,
                int(line or 0),
                rest,
            )
        except (KeyError, OverflowError, TypeError, ValueError) as error:
            raise ValueError(f"no event of a trace: {record!r}") from error


@dataclass(frozen=True, slots=True)
class Observation:
    """Everything that was observed of a case.

    ``findings`` belong to a case that was only parsed or checked. ``ending`` is ``end``, ``fault``,
    ``halt``, ``running`` (the time was over), or ``crash`` with the reason in ``note``. ``cycle``
    is the interpolation cycle in µs. ``is_exact`` says that times are known to the µs. ``watched``
    are the kinds of events that a recording contains; ``None`` if all are present. ``machine`` is
    the arm whose limits the path must keep, if known. ``values`` are those of requested variables
    at the end of the run, by name in upper case.
    """

    findings: tuple[Finding, ...] = ()
    events: tuple[Event, ...] = ()
    ending: str = ""
    note: str = ""
    path: PathRecord | None = None
    cycle: int = 12_000
    is_exact: bool = True
    robot: str = "none"
    machine: MachineData | None = None
    watched: frozenset[str] | None = None
    values: Mapping[str, Any] = field(default_factory=dict)

    @property
    def unsure(self) -> int:
        """How many µs a time may be off: a real controller is observed once a cycle."""
        return 0 if self.is_exact else self.cycle

    @property
    def shows_run(self) -> bool:
        """Whether anything shows that the program was run; a recording may be empty."""
        has_lines = self.watched is None or "line" in self.watched
        return bool(self.events) or (bool(self.ending) and not has_lines)

    def of_kind(self, *kinds: str) -> Iterable[Event]:
        """Return the events of some kinds, in their order."""
        return (event for event in self.events if event.kind in kinds)

    def on_line(self, file: str, line: int, *kinds: str) -> list[Event]:
        """Return the events of some kinds at a line; those of all lines if ``file`` is empty."""
        return [
            event
            for event in self.events
            if event.kind in kinds and (not file or (event.line == line and event.file == file))
        ]
