"""Routines of the controller that act on the robot, or on nothing that is simulated."""

from collections.abc import Callable
from typing import Any

import pytest

Go = Callable[..., Any]


def program(body: str, declarations: str = "INT I\n") -> str:
    return f"DEF main()\n{declarations}{body}END\n"


def test_what_is_not_simulated(go: Go) -> None:
    """A routine that acts on something else is a clear fault, never silence [FCT-11]."""
    ran = go(program("I=DIAG_STOP()\n"))
    assert ("fault", "unsupported") == (ran.outcome.ending, ran.outcome.error.slug)


def test_robot_is_stopped(go: Go) -> None:
    """ROB_STOP holds the arm until ROB_STOP_RELEASE [FCT-11]."""
    text = (
        program(
            "INTERRUPT DECL 10 WHEN $IN[1] DO HOLD()\nINTERRUPT ON 10\n"
            "PTP {A1 0,A2 0,A3 0,A4 0,A5 0,A6 0}\n",
            "BOOL B\n",
        )
        + "DEF HOLD()\nBOOL B\nB=ROB_STOP(#RAMP_DOWN)\nWAIT SEC 0.48\nROB_STOP_RELEASE()\nEND\n"
    )
    assert [1.48] == go(text, "t=0.504 IN[1]=TRUE").times("motion_end")


@pytest.mark.parametrize("body", ["", "I=1\n", "WAIT SEC 0.1\n"])
def test_trace_ends_with_the_end(go: Go, body: str) -> None:
    """The last event is the end of the program."""
    assert "end" == go(program(body)).events[-1].kind
