"""Inputs and outputs, groups, pulses, cyclic signals, flags, cyclic flags."""

from collections.abc import Callable
from typing import Any

import pytest

Go = Callable[..., Any]


def program(body: str, declarations: str = "INT I\nBOOL B\nREAL X\n", routines: str = "") -> str:
    return f"DEF main()\n{declarations}{body}END\n{routines}"


def test_only_changes_are_reported(go: Go) -> None:
    """An output that is set to what it has is no event."""
    assert [] == go(program("$OUT[5]=FALSE\n$ANOUT[1]=0.0\n")).events_of("out", "anout")


@pytest.mark.parametrize(
    ("line", "number"),
    [
        ("I=0\n$OUT[I]=TRUE", 1444),
        ("I=8193\n$OUT[I]=TRUE", 1444),
        ("I=33\nX=$ANIN[I]", 1444),
        ("X=1.5\n$ANOUT[1]=X", 1422),
        ("$IN[1]=TRUE", 1388),
        ("$ANIN[1]=0.5", 1388),
    ],
)
def test_limits(go: Go, line: str, number: int) -> None:
    """Indices, the range of ±1, and inputs that nobody writes [IOT-01, IOT-06, TYP-09]."""
    ran = go(program(line + "\n"))
    assert ("fault", number) == (ran.outcome.ending, ran.outcome.error.number)
    assert [number] == ran.messages()


def test_constant_inputs(go: Go) -> None:
    """Input 1025 is TRUE and 1026 FALSE, whatever a script says [IOT-02]."""
    ran = go(
        program("WAIT SEC 1\nB=$IN[1025]\nIF $IN[1026] THEN\nI=1\nELSE\nI=2\nENDIF\n"),
        "t=0 IN[1025]=FALSE, IN[1026]=TRUE",
    )
    assert (True, 2) == (ran.last("B"), ran.last("I"))


def test_wide_group(go: Go) -> None:
    """32 bits have a sign [IOT-03]."""
    declarations = "INT I\nSIGNAL NR $OUT[1] TO $OUT[32]\n"
    assert -2 == go(program("NR=-2\nI=NR\n", declarations)).last("I")


def test_pulse_through_a_signal(go: Go) -> None:
    """The output may be named by a SIGNAL [IOT-07]."""
    text = program("PULSE(GLUE,TRUE,0.1)\nWAIT SEC 1\n", "SIGNAL GLUE $OUT[4]\n")
    assert [(0.0, 4, True), (0.108, 4, False)] == go(text).outputs()


def test_pulse_of_what_is_on(go: Go) -> None:
    """An output that is TRUE already falls at the end of the pulse [IOT-07]."""
    ran = go(program("$OUT[4]=TRUE\nPULSE($OUT[4],TRUE,0.5)\nWAIT SEC 1\n"))
    assert [(0.0, 4, True), (0.504, 4, False)] == ran.outputs()


def test_cyclic_output(go: Go) -> None:
    """ANOUT ON follows its expression within its limits [IOT-09]."""
    text = program(
        "X=0.25\nANOUT ON SPEED=X DELAY=0.1 MINIMUM=0.1 MAXIMUM=0.5\nWAIT SEC 0.5\n"
        "X=3\nWAIT SEC 0.5\n"
        "ANOUT OFF SPEED\n",
        "SIGNAL SPEED $ANOUT[1]\nREAL X\n",
    )
    ran = go(text)
    assert [(0.112, 0.25), (0.616, 0.5)] == [
        (one.time / 1e6, one.fields["value"]) for one in ran.events_of("anout")
    ]


def test_cyclic_digital_input(go: Go) -> None:
    """DIGIN ON reads a digital input group [IOT-04, IOT-05]."""
    text = program("DIGIN ON X=0.5*$DIGIN1\nWAIT SEC 1\nDIGIN OFF $DIGIN1\n")
    assert 4.0 == go(text, "t=0.3 DIGIN1=8").last("X")


def test_cyclic_flag_at_once(go: Go) -> None:
    """It has its value from the assignment on [IOT-11]."""
    assert True is go(program("$CYCFLAG[3]=NOT $IN[1]\nB=$CYCFLAG[3]\n")).last("B")
