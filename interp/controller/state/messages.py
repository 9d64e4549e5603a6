"""Messages of the controller by number, the faults made from them, and messages of programs.

The numbers and texts are data in `grammar.semantics.predefined` [MSG-01 to MSG-31]. A message of
SET_KRLMSG or SET_KRLDLG stays until it is cleared or answered [FCT-10].
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from grammar.semantics.predefined import System
from interp.controller.state.trace import TaskName, Trace
from interp.port.requests import At
from interp.values.faults import Fault

#: Faults for which no known message fits, with texts of our own.
OWN_FAULTS: Final = {
    "interrupt_number": ("an interrupt cannot have this number", "INT-02"),
    "interrupt_unknown": ("there is no interrupt of this number", "INT-07"),
    "interrupt_count": ("too many interrupts are declared or active", "INT-03"),
    "brake_place": ("BRAKE stands in no interrupt routine", "INT-09"),
    "resume_place": ("RESUME stands in no interrupt routine", "INT-11"),
    "resume_level": ("RESUME comes while the program is in the declaring level", "INT-11"),
    "spline_place": ("a spline motion is not allowed in an interrupt routine", "SPL-11"),
    "submit_motion": ("a submit program cannot move the robot", "SUB-05"),
    "trigger_priority": ("a trigger that calls a routine needs a valid PRIO", "TRG-06"),
    "trigger_path": ("a trigger with PATH stands before a motion that has no path", "TRG-04"),
    "trigger_range": ("a trigger is too far away from its point", "TRG-03"),
    "unsupported": ("the routine acts on something that is not simulated", "FCT-11"),
    "motion_kind": ("this kind of motion is not simulated", "MOT-01"),
    "channel": ("the channel is not open", "FCT-08"),
    "cyclic_signal": ("no further cyclic output or digital input is free", "IOT-05"),
    "raised": ("a program has raised an error", "FCT-07"),
}


def message_fault(number: int) -> Fault:
    """Return the fault of a catalogued message; raise `KeyError` for an unknown number."""
    found = System.load().message(number)
    if found is None:
        raise KeyError(number)
    rules = tuple(key for key in found.source if "-" in key)
    return Fault(f"message_{number}", found.text, number=number, rules=rules)


def own_fault(slug: str) -> Fault:
    """Return a fault of the controller for which no message number is known."""
    text, rule = OWN_FAULTS[slug]
    return Fault(slug, text, rules=(rule,))


@dataclass(slots=True)
class ProgramMessage:
    """A message or dialogue of a program; ``answer`` is the pressed button, counted from 1."""

    handle: int
    kind: str
    number: int
    answer: int | None = None

    @property
    def is_dialogue(self) -> bool:
        """Whether it asks for an answer."""
        return self.kind == "DIALOGUE"


class Messages:
    """The messages of the controller and of its programs.

    ``listeners`` are called with the number and the kind of each message that appears.
    """

    def __init__(self, trace: Trace) -> None:
        self.listeners: list[Callable[[int, str], None]] = []
        self._trace = trace
        self._shown: dict[int, ProgramMessage] = {}
        self._handle = 0
        #: The numbers of the controller's messages that must still be acknowledged.
        self.unacknowledged: list[int] = []

    def post(
        self, task: TaskName, at: At | None, number: int, text: str, kind: str = "notification"
    ) -> None:
        """Show a message of the controller."""
        if kind == "acknowledgement":
            self.unacknowledged.append(number)
        self._show(task, at, number, text, kind)

    def post_number(
        self, at: At | None, number: int, kind: str = "notification", task: TaskName = "robot"
    ) -> None:
        """Show a message of the catalogue."""
        self.post(task, at, number, str(message_fault(number)), kind)

    def show(self, task: TaskName, at: At, kind: str, number: int, text: str) -> int:
        """Show a message or dialogue of a program, and return its handle.

        A notification is not stored.
        """
        self._handle += 1
        if kind != "NOTIFY":
            self._shown[self._handle] = ProgramMessage(self._handle, kind, number)
        self._show(task, at, number, text, kind.lower())
        return self._handle

    def _show(self, task: TaskName, at: At | None, number: int, text: str, kind: str) -> None:
        self._trace.record(task, "message", at, number=number, text=text, type=kind)
        for listener in self.listeners:
            listener(number, kind)

    def find(self, handle: int) -> ProgramMessage | None:
        """Return the message with a handle, ``None`` if it is no longer shown."""
        return self._shown.get(handle)

    def clear(self, handle: int) -> bool:
        """Clear one message, or all for -1; return whether there was any."""
        if handle == -1:
            had_any = bool(self._shown)
            self._shown.clear()
            return had_any
        return self._shown.pop(handle, None) is not None

    def answer(self, button: int) -> None:
        """Answer the oldest open dialogue, if there is one."""
        for one in self._shown.values():
            if one.is_dialogue and one.answer is None:
                one.answer = button
                return

    def is_set(self, number: int) -> bool:
        """Return whether a message of this number is shown."""
        return number in self.unacknowledged or any(
            one.number == number for one in self._shown.values()
        )

    def acknowledge(self, number: int | None) -> None:
        """Acknowledge the messages of this number, or all for ``None``."""
        self._shown = {
            handle: one
            for handle, one in self._shown.items()
            if one.kind != "QUIT" or number not in (None, one.number)
        }
        self.unacknowledged = [one for one in self.unacknowledged if number not in (None, one)]
