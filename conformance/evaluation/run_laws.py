"""Laws of the order of events in a trace."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from conformance.evaluation.laws import Deviations, Laws, Run, whole
from conformance.evaluation.observation import Event

LAWS: Final = Laws()
#: $ADVANCE is at most 5, not counting the running motion [ADV-01].
_MOST_AHEAD: Final = 5


@LAWS.law("events stand in the order of their times", of=whole)
def _in_time(run: Run) -> Deviations:
    now = 0
    for one in run.seen.events:
        if one.time is not None and one.time < now:
            yield one, f"{one.time} us"
        now = one.time or now


@LAWS.law("signals are reported where they change", of=whole)
def _changes(run: Run) -> Deviations:
    values: dict[tuple[object, object], object] = {}
    for one in run.seen.of_kind("in", "out", "anout"):
        key = one.fields.get("signal"), one.fields.get("number")
        value = one.fields.get("value")
        if key in values and values[key] == value:
            yield one, f"{key[0]}[{key[1]}] is {value} already"
        values[key] = value


def _levels(run: Run) -> Iterator[tuple[Event, object, list[object]]]:
    """Yield entries and exits of interrupts and ends, each with its priority and those under way.

    An exit takes the last priority away.
    """
    levels: dict[str, list[object]] = {}
    for one in run.seen.of_kind("interrupt_enter", "interrupt_leave", "end"):
        priority, under_way = one.fields.get("priority"), levels.setdefault(one.task, [])
        yield one, priority, under_way
        if one.kind == "interrupt_enter":
            under_way.append(priority)
        elif one.kind == "interrupt_leave" and under_way:
            under_way.pop()


@LAWS.law("an interrupt interrupts lower ones", "INT-05", of=whole)
def _lower(run: Run) -> Deviations:
    for one, priority, under_way in _levels(run):
        if one.kind == "interrupt_enter" and under_way:
            numbers = [each for each in (priority, under_way[-1]) if isinstance(each, int)]
            if len(numbers) == 2 and numbers[0] >= numbers[1]:
                yield one, f"{priority}: {under_way}"


@LAWS.law("what was entered last is left first", of=whole)
def _left(run: Run) -> Deviations:
    for one, priority, under_way in _levels(run):
        if one.kind == "interrupt_leave" and under_way[-1:] != [priority]:
            yield one, str(priority)


@LAWS.law("no interrupt is under way at the end", of=whole)
def _none_left(run: Run) -> Deviations:
    for one, _, under_way in _levels(run):
        if one.kind == "end" and under_way:
            yield one, str(under_way)


@LAWS.law("motions follow one another", of=whole)
def _motions(run: Run) -> Deviations:
    """Motions begin in the order of planning, one after the other.

    This is checked up to a BRAKE or RESUME. After that the arm may leave the path, and other
    motions may come before it continues.
    """
    planned = started = 0
    is_moving = False
    blending: object = None
    for one in run.seen.events:
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
            yield one, f"{one.kind} {number}"


@LAWS.law(f"at most {_MOST_AHEAD} motions are planned ahead", "ADV-01", of=whole)
def _ahead(run: Run) -> Deviations:
    started = 0
    for one in run.seen.of_kind("motion_planned", "motion_start"):
        number = one.fields.get("motion")
        if isinstance(number, int):
            if one.kind == "motion_start":
                started = number
            elif number - max(started, 1) > _MOST_AHEAD:
                yield one, str(number)


@LAWS.law("the message of a fault is shown", of=whole)
def _faults(run: Run) -> Deviations:
    """The message of a fault with a number appears before it, at the same place and time."""
    shown: set[tuple[object, ...]] = set()
    for one in run.seen.of_kind("message", "fault"):
        number = one.fields.get("number")
        key = one.task, one.file, one.line, one.time, number
        if one.kind == "message":
            shown.add(key)
        elif number is not None and key not in shown:
            yield one, str(number)


@LAWS.law("a program that is over does nothing more", of=whole)
def _ends(run: Run) -> Deviations:
    """A program ends or fails once, and begins no statement after that."""
    over: set[str] = set()
    for one in run.seen.of_kind("line", "end", "fault"):
        if one.task in over:
            yield one, one.kind
        if one.kind != "line":
            over.add(one.task)


@LAWS.law("the end of the program is an event", of=whole)
def _is_told(run: Run) -> Deviations:
    is_told = any(one.task == "robot" for one in run.seen.of_kind("end"))
    if run.seen.ending == "end" and not is_told:
        yield None, "none"
