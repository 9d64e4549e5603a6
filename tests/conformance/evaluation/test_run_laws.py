"""Each law of a run is broken by a trace that breaks it, and by no other."""

from typing import Any

import pytest

from conformance.evaluation.laws import Run
from conformance.evaluation.observation import Event, Observation
from conformance.evaluation.run_laws import LAWS


def event(kind: str, time: int = 0, **fields: Any) -> Event:
    """An event of the robot's program."""
    return Event(time, "robot", kind, "a.src", 3, fields)


def out(*, value: bool) -> Event:
    """A change of an output."""
    return event("out", signal="$OUT", number=1, value=value)


def motion(kind: str, number: int) -> Event:
    """An event of a motion."""
    return event(f"motion_{kind}", motion=number)


ENTER_9, ENTER_5 = (event("interrupt_enter", priority=one) for one in (9, 5))
LEAVE_9, LEAVE_5 = (event("interrupt_leave", priority=one) for one in (9, 5))
PLANNED = [motion("planned", number) for number in range(1, 8)]


@pytest.mark.parametrize(
    ("events", "laws"),
    [
        ([event("line", 5), event("line", 5)], []),
        ([event("line", 5), event("line", 4)], ["events stand in the order of their times"]),
        ([out(value=True), out(value=False)], []),
        ([out(value=True), out(value=True)], ["signals are reported where they change"]),
        ([ENTER_9, ENTER_5, LEAVE_5, LEAVE_9, event("end")], []),
        ([ENTER_5, ENTER_9], ["an interrupt interrupts lower ones"]),
        ([ENTER_9, ENTER_5, LEAVE_9], ["what was entered last is left first"]),
        ([ENTER_9, event("end")], ["no interrupt is under way at the end"]),
        ([*PLANNED[:2], motion("start", 1), motion("end", 1), motion("start", 2)], []),
        ([*PLANNED[:2], motion("start", 1), motion("start", 2)], ["motions follow one another"]),
        ([PLANNED[0], motion("start", 2)], ["motions follow one another"]),
        ([PLANNED[1]], ["motions follow one another"]),
        (PLANNED[:6], []),
        (PLANNED, ["at most 5 motions are planned ahead"]),
        ([motion("start", 1), event("brake"), motion("start", 2)], []),
        ([event("message", number=1444), event("fault", number=1444)], []),
        ([event("fault", number=None)], []),
        ([event("fault", number=1444)], ["the message of a fault is shown"]),
        (
            [event("message", number=1422), event("fault", number=1444)],
            ["the message of a fault is shown"],
        ),
        ([event("end"), out(value=True)], []),
        ([event("end"), event("line")], ["a program that is over does nothing more"]),
        ([event("end"), event("end")], ["a program that is over does nothing more"]),
    ],
)
def test_a_law_is_broken_by_what_breaks_it(events: list[Event], laws: list[str]) -> None:
    """The violations of a trace are those of the laws that it breaks."""
    found = [one.law for one in LAWS.broken(Run(Observation(events=tuple(events))))]
    assert laws == found


def test_a_program_that_has_ended_says_so() -> None:
    """A run that was over by the end of its program has the event."""
    for events, laws in (((event("end"),), []), ((), ["the end of the program is an event"])):
        found = [one.law for one in LAWS.broken(Run(Observation(events=events, ending="end")))]
        assert laws == found
