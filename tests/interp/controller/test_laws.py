"""Laws: one program has one trace; what is nested comes back to where it was."""

from collections.abc import Callable
from typing import Any

from hypothesis import given, settings
from hypothesis import strategies as st

Go = Callable[..., Any]

HOME = "PTP {A1 0,A2 0,A3 0,A4 0,A5 0,A6 0}\n"
TIMES = st.integers(0, 250).map(lambda one: one / 100)

NESTING = (
    "DEF main()\nINT I\nI=0\n"
    + "".join(
        f"INTERRUPT DECL {10 * one} WHEN $IN[{one}] DO R{one}()\nINTERRUPT ON {10 * one}\n"
        for one in (1, 2, 3)
    )
    + HOME
    + "FOR I=1 TO 5\nWAIT SEC 0.1\nENDFOR\nPTP {A1 10} C_PTP\nPTP {A1 20}\nEND\n"
    + "".join(
        f"DEF R{one}()\nINT K\n$BASE={{X {one},Y 0,Z 0,A 0,B 0,C 0}}\nWAIT SEC 0.0{one}\nEND\n"
        for one in (1, 2, 3)
    )
)


def pulses(times: list[tuple[int, float]]) -> str:
    """A script that pulses inputs."""
    return "\n".join(
        f"t={time} IN[{one}]=TRUE\nt={time + 0.013} IN[{one}]=FALSE" for one, time in times
    )


EVENTS = st.lists(st.tuples(st.integers(1, 3), TIMES), max_size=8)


@settings(max_examples=12)
@given(EVENTS)
def test_one_trace(go: Go, events: list[tuple[int, float]]) -> None:
    """The same program in the same world has the same trace, and time never goes back."""
    first, second = go(NESTING, pulses(events)), go(NESTING, pulses(events))
    assert [one.line() for one in first.events] == [one.line() for one in second.events]
    times = [one.time for one in first.events]
    assert sorted(times) == times


@settings(max_examples=12)
@given(EVENTS)
def test_nesting(go: Go, events: list[tuple[int, float]]) -> None:
    """Routines nest by rising priority and unwind to the state before."""
    ran = go(NESTING, pulses(events))
    stack: list[int] = []
    for one in ran.events_of("interrupt_enter", "interrupt_leave"):
        priority = one.fields["priority"]
        if one.kind == "interrupt_enter":
            assert not stack or priority < stack[-1]
            stack.append(priority)
        else:
            assert priority == stack.pop()
    assert [] == stack
    assert "end" == ran.outcome.ending
    assert 6 == ran.last("I")
    assert [0.0] * 6 == list(ran.value("$BASE").members)  # as the program left it
    assert [1, 2, 3] == [one.fields["motion"] for one in ran.events_of("motion_end")]


STOPPING = (
    "DEF main()\nINTERRUPT DECL 10 WHEN $IN[1] DO STOPS()\nINTERRUPT ON 10\n"
    + HOME
    + "PTP {A1 50} C_PTP\nPTP {A1 100}\nEND\nDEF STOPS()\nBRAKE\nWAIT SEC 0.12\nEND\n"
)


@settings(max_examples=12)
@given(st.lists(TIMES, max_size=4))
def test_brakes_cost_time_only(go: Go, times: list[float]) -> None:
    """However often the arm is stopped, it comes to the same place, later by the stops."""
    ran = go(STOPPING, pulses([(1, time) for time in times]))
    stops = zip(ran.times("brake"), ran.times("interrupt_leave"), strict=True)
    lost = sum(leave - brake for brake, leave in stops if brake < ran.times("motion_end")[-1])
    assert abs(3.0 + lost - ran.times("motion_end")[-1]) < 1e-5
    assert 100.0 == ran.arm.position(ran.outcome.time).axes[0]


@settings(max_examples=10)
@given(EVENTS, st.integers(2, 400))
def test_in_pieces(go: Go, events: list[tuple[int, float]], pieces: int) -> None:
    """A run that is stopped and taken up again at any time has the trace of one run."""
    whole = go(NESTING, pulses(events), until=5)
    parts = go(NESTING, pulses(events), until=5, pieces=pieces)
    assert [one.line() for one in whole.events] == [one.line() for one in parts.events]
    assert whole.outcome == parts.outcome
