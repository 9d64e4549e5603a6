"""Slices of programs that compute or poll, and how a run ends."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from interp.controller.state.profile import Profile
from interp.program.load import Limits

Go = Callable[..., Any]


def program(body: str) -> str:
    return f"DEF main()\nINT I\nBOOL B\nREAL X\n{body}END\n"


def test_slices(go: Go) -> None:
    """A loop that asks nothing lets time pass: so many statements a cycle."""
    ran = go(program("$TIMER_STOP[1]=FALSE\nFOR I=1 TO 2500\nX=I\nENDFOR\nI=$TIMER[1]\n"))
    assert 5 * 12 == ran.last("I")  # 2 statements a pass, 1000 a cycle


def test_polling_lets_time_pass(go: Go) -> None:
    """A loop that asks all the time does so too: so many requests a cycle."""
    ran = go(program("WHILE NOT $IN[1]\nENDWHILE\n"), "t=0.5 IN[1]=TRUE")
    assert [0.504] == ran.times("end")


def test_endless_program(go: Go) -> None:
    """A program that never ends uses up its statements: a clear end."""
    ran = go(program("LOOP\nI=1\nENDLOOP\n"), limits=Limits(statements=5000))
    assert ("budget", "it has not ended after 5,000 statements") == (
        ran.outcome.ending,
        str(ran.outcome.error),
    )


def test_time_is_over(go: Go) -> None:
    """A run ends when its time is over, at exactly that time."""
    ran = go(program("WAIT FOR $IN[1]\n"), until=2.5)
    assert ("time", 2_500_000) == (ran.outcome.ending, ran.outcome.time)
    ran = go(program("WAIT FOR $IN[1]\n"), "stop at 1.25")
    assert ("time", 1_250_000) == (ran.outcome.ending, ran.outcome.time)


def test_halt(go: Go) -> None:
    """HALT ends a run that nobody starts again; START goes on behind it [CTL-08]."""
    text = program("I=1\nHALT\nI=2\nWAIT SEC 0.1\nHALT\nI=3\n")
    ran = go(text)
    assert ("halt", 1) == (ran.outcome.ending, ran.last("I"))
    assert "main.src:6" == ran.events_of("halt")[0].place
    assert [0.206] == go(text, "on HALT after 0.05 press START").times("end")


def test_what_is_not_simulated(go: Go) -> None:
    """A routine that acts on something else is a clear fault, never silence [FCT-11]."""
    ran = go(program("I=DIAG_STOP()\n"))
    assert ("fault", "unsupported") == (ran.outcome.ending, ran.outcome.error.slug)


@pytest.mark.parametrize("body", ["", "I=1\n", "WAIT SEC 0.1\n"])
def test_trace_ends_with_the_end(go: Go, body: str) -> None:
    """The last event is the end of the program."""
    assert "end" == go(program(body)).events[-1].kind


@pytest.mark.parametrize(("every", "passes"), [(1, 10), (4, 4)])
def test_slices_of_a_submit_program(go: Go, every: int, passes: int) -> None:
    """It computes in slices: so many requests every so many cycles [SUB-03]."""
    profile = replace(Profile.load(), submit_every=every, submit_requests=10)
    body = "LOOP\nCOUNT=COUNT+1\n" + "$FLAG[1]=TRUE\n" * 10 + "ENDLOOP\n"
    files = {
        "sps.sub": f"DEF SPS()\n{body}END\n",
        "$config.dat": "DEFDAT $CONFIG\nDECL INT COUNT=0\nENDDAT\n",
    }
    text = "DEF main()\nINT I\nWAIT SEC 0.1\nI=COUNT\nEND\n"
    ran = go(text, files=files, submit="SPS", profile=profile)
    assert passes == ran.last("I")
