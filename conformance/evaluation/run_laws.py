"""Laws that every run obeys, whatever its program: the order of events in a trace.

A law needs no expectation. So a case also notices errors that are unrelated to what it states. A
law that no rule of KRL states is stated in docs/trace.md.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final

from conformance.evaluation.observation import Event, Observation

#: $ADVANCE is at most 5, not counting the running motion [ADV-01].
_MOST_AHEAD: Final = 5


@dataclass(frozen=True, slots=True)
class Violation:
    """An event that violates a law: the law, what was observed, and the rule of KRL if any.

    ``event`` is ``None`` if the violation is before all events.
    """

    event: Event | None
    law: str
    actual: str
    rule: str = ""


def run_violations(seen: Observation) -> Iterator[Violation]:
    """Yield the first violation of each law, in a run whose events are all known."""
    for law in (_in_time, _changes, _levels, _motions, _ahead, _faults, _ends):
        found = next(law(seen.events), None)
        if found is not None:
            yield found
    is_told = any(one.kind == "end" and one.task == "robot" for one in seen.events)
    if seen.ending == "end" and not is_told:
        yield Violation(None, "the end of the program is an event", "none")


def _in_time(events: Sequence[Event]) -> Iterator[Violation]:
    now = 0
    for one in events:
        if one.time is not None and one.time < now:
            yield Violation(one, "events stand in the order of their times", f"{one.time} us")
        now = one.time or now


def _changes(events: Sequence[Event]) -> Iterator[Violation]:
    """Inputs and outputs are reported when they change, and only then."""
    values: dict[tuple[object, object], object] = {}
    for one in events:
        if one.kind in ("in", "out", "anout"):
            key = one.fields.get("signal"), one.fields.get("number")
            value = one.fields.get("value")
            if key in values and values[key] == value:
                text = f"{key[0]}[{key[1]}] is {value} already"
                yield Violation(one, "signals are reported where they change", text)
            values[key] = value


def _levels(events: Sequence[Event]) -> Iterator[Violation]:
    """Interrupt routines nest, each with a higher priority than what it interrupts."""
    levels: dict[str, list[object]] = {}
    for one in events:
        priority = one.fields.get("priority")
        under_way = levels.setdefault(one.task, [])
        if one.kind == "interrupt_enter":
            if under_way and not _is_higher(priority, under_way[-1]):
                law, actual = "an interrupt interrupts lower ones", f"{priority}: {under_way}"
                yield Violation(one, law, actual, "INT-05")
            under_way.append(priority)
        elif one.kind == "interrupt_leave":
            if not under_way or under_way.pop() != priority:
                yield Violation(one, "what was entered last is left first", str(priority))
        elif one.kind == "end" and under_way:
            yield Violation(one, "no interrupt is under way at the end", str(under_way))


def _is_higher(priority: object, other: object) -> bool:
    return not isinstance(priority, int) or not isinstance(other, int) or priority < other


def _motions(events: Sequence[Event]) -> Iterator[Violation]:
    """Motions begin in the order of planning, one after the other.

    This is checked up to a BRAKE or RESUME. After that the arm may leave the path, and other
    motions may come before it continues.
    """
    planned = started = 0
    is_moving = False
    blending: object = None
    for one in events:
        number = one.fields.get("motion")
        fits = True
        match one.kind:
            case "motion_planned":
                fits, planned = number == planned + 1, planned + 1
            case "motion_start" if isinstance(number, int):
                fits = started < number <= (planned or number) and not is_moving
                started = number
                is_moving = True
            case "motion_end":
                fits, is_moving = is_moving and number == started, False
            case "blend_start":
                fits, blending = is_moving and number == started, number
            case "blend_apex":
                fits = blending == number
            case "blend_end" if isinstance(number, int):
                fits, blending = blending == number - 1, None
            case "brake" | "resume":
                return
        if not fits:
            yield Violation(one, "motions follow one another", f"{one.kind} {number}")


def _ahead(events: Sequence[Event]) -> Iterator[Violation]:
    """The advance run is at most `_MOST_AHEAD` motions ahead of the robot."""
    planned = started = 0
    for one in events:
        number = one.fields.get("motion")
        if one.kind == "motion_planned" and isinstance(number, int):
            planned = number
            if planned - max(started, 1) > _MOST_AHEAD:
                law, actual = f"at most {_MOST_AHEAD} motions are planned ahead", str(number)
                yield Violation(one, law, actual, "ADV-01")
        elif one.kind == "motion_start" and isinstance(number, int):
            started = number


def _faults(events: Sequence[Event]) -> Iterator[Violation]:
    """The message of a fault with a number appears before it, at the same place and time."""
    shown: set[tuple[object, ...]] = set()
    for one in events:
        number = one.fields.get("number")
        key = one.task, one.file, one.line, one.time, number
        if one.kind == "message":
            shown.add(key)
        elif one.kind == "fault" and number is not None and key not in shown:
            yield Violation(one, "the message of a fault is shown", str(number))


def _ends(events: Sequence[Event]) -> Iterator[Violation]:
    """A program ends or fails once, and begins no statement after that."""
    over: set[str] = set()
    for one in events:
        if one.kind in ("line", "end", "fault") and one.task in over:
            yield Violation(one, "a program that is over does nothing more", one.kind)
        if one.kind in ("end", "fault"):
            over.add(one.task)
