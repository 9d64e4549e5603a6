"""Messages of the controller by number, faults made of them, and the messages of programs.

The numbers and what they mean are data in `grammar.semantics.predefined` [MSG-01 to MSG-31]. What a
program shows by SET_KRLMSG and SET_KRLDLG stays until it is taken away or answered [FCT-10].
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from grammar.semantics.predefined import System
from interp.values.faults import Fault

__all__ = ["Board", "Dialogue", "message_fault", "own_fault"]

#: What no message at hand says, in our words.
_OWN: Final = {
    "interrupt_number": ("an interrupt cannot have this number", "INT-02"),
    "interrupt_unknown": ("there is no interrupt of this number", "INT-07"),
    "interrupt_count": ("too many interrupts are declared or active", "INT-03"),
    "brake_place": ("BRAKE stands in no interrupt routine", "INT-09"),
    "resume_place": ("RESUME stands in no interrupt routine", "INT-11"),
    "resume_level": ("RESUME comes while the program is in the declaring level", "INT-11"),
    "spline_place": ("a spline motion is not allowed in an interrupt routine", "SPL-11"),
    "submit_motion": ("a submit program cannot move the robot", "SUB-05"),
    "trigger_priority": ("a trigger that calls a routine needs a valid PRIO", "TRG-06"),
    "trigger_range": ("a trigger is too far away from its point", "TRG-03"),
    "unsupported": ("the routine acts on something that is not simulated", "FCT-11"),
    "motion_kind": ("this kind of motion is not simulated", "MOT-01"),
    "channel": ("the channel is not open", "FCT-08"),
    "cyclic_signal": ("no further cyclic output or digital input is free", "IOT-05"),
    "raised": ("a program has raised an error", "FCT-07"),
}


def message_fault(number: int) -> Fault:
    """The fault that a message of the catalogue tells; `KeyError` for an unknown number."""
    found = System.load().message(number)
    if found is None:
        raise KeyError(number)
    rules = tuple(key for key in found.source if "-" in key)
    return Fault(f"message_{number}", found.text, number=number, rules=rules)


def own_fault(slug: str) -> Fault:
    """A fault of the controller for which no message number is at hand."""
    text, rule = _OWN[slug]
    return Fault(slug, text, rules=(rule,))


@dataclass(slots=True)
class Dialogue:
    """A message or a dialogue of a program; ``answer`` is the button that was pressed, from 1."""

    handle: int
    kind: str
    number: int
    text: str
    is_dialogue: bool = False
    answer: int | None = None


class Board:
    """What is shown to the operator and not taken away yet."""

    def __init__(self) -> None:
        self._shown: dict[int, Dialogue] = {}
        self._handle = 0
        #: Numbers of the controller's messages that wait to be acknowledged.
        self.waiting: list[int] = []

    def show(self, kind: str, number: int, text: str, *, is_dialogue: bool = False) -> Dialogue:
        """Show a message; notifications are not kept."""
        self._handle += 1
        made = Dialogue(self._handle, kind, number, text, is_dialogue)
        if is_dialogue or kind != "NOTIFY":
            self._shown[made.handle] = made
        return made

    def find(self, handle: int) -> Dialogue | None:
        """What is shown under a handle."""
        return self._shown.get(handle)

    def clear(self, handle: int) -> bool:
        """Take one away, or all for -1; whether there was any."""
        if handle == -1:
            had_any = bool(self._shown)
            self._shown.clear()
            return had_any
        return self._shown.pop(handle, None) is not None

    def dialogues(self) -> list[Dialogue]:
        """The dialogues that wait for an answer, oldest first."""
        return [one for one in self._shown.values() if one.is_dialogue and one.answer is None]

    def is_set(self, number: int) -> bool:
        """Whether a message of this number is shown."""
        return number in self.waiting or any(one.number == number for one in self._shown.values())

    def acknowledge(self, number: int | None) -> bool:
        """Acknowledge a message, or all; whether there was any."""
        shown = [
            one.handle
            for one in self._shown.values()
            if one.kind == "QUIT" and number in (None, one.number)
        ]
        for handle in shown:
            del self._shown[handle]
        left = [] if number is None else [one for one in self.waiting if one != number]
        had_any = len(left) < len(self.waiting) or bool(shown)
        self.waiting = left
        return had_any
