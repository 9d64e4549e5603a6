"""What stops the advance run, and what a profile says about the first motion."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from interp.controller.state.profile import Profile

Go = Callable[..., Any]

# The paths of the tests: HOME takes the first second, each further motion one more.
HOME = "PTP {A1 0,A2 0,A3 0,A4 0,A5 0,A6 0}\n"


def program(*lines: str, declarations: str = "", more: str = "") -> str:
    return f"DEF main()\n{declarations}{HOME}" + "\n".join(lines) + f"\nEND\n{more}"


STOPPING = {
    "ANIN OFF": "ANIN OFF $ANIN[1]",
    "DIGIN OFF": "DIGIN OFF $DIGIN1",
    "$ACT_EX_AX": "$ACT_EX_AX=1",
    "COPEN": "COPEN(:SER_1,I)",
}
PLAIN = {
    "a timer": "$TIMER_STOP[1]=FALSE",
    "the override": "$OV_PRO=100",
}
DECLARATIONS = "INT I\nBOOL B\nREAL X\nSIGNAL LINES $IN[1] TO $IN[4]\n"
SUB = "DEF SUB()\nEND\n"


@pytest.mark.parametrize("line", STOPPING.values(), ids=STOPPING.keys())
def test_stops(go: Go, line: str) -> None:
    """What stops the advance run makes the point before it exact [ADV-04 to ADV-07]."""
    text = program("PTP {A1 1} C_PTP", line, "PTP {A1 2}", declarations=DECLARATIONS, more=SUB)
    ran = go(text, "on HALT press START")
    assert [0.0] == ran.times("advance_stop")[:1]
    assert [2.0] == ran.times("motion_planned", motion=3)
    assert [] == ran.events_of("blend_apex")
    assert [1442] == ran.messages()


@pytest.mark.parametrize("line", PLAIN.values(), ids=PLAIN.keys())
def test_does_not_stop(go: Go, line: str) -> None:
    """All else is executed ahead of the arm, and the point is blended [ADV-13]."""
    text = program("PTP {A1 1} C_PTP", line, "PTP {A1 2}", declarations=DECLARATIONS, more=SUB)
    ran = go(text)
    assert [0.0] == ran.times("motion_planned", motion=3)
    assert [2.0] == ran.times("blend_apex")
    assert [] == ran.messages()


def test_frames_at_the_start(go: Go) -> None:
    """A profile says whether there are any before a program sets them [MOT-15]."""
    profile = Profile.load()
    assert [] == go(program("LIN {X 1}"), profile=profile).messages()
    profile = replace(profile, values={**profile.values, "$TOOL": False})
    assert [1419] == go(program("LIN {X 1}"), profile=profile).messages()
