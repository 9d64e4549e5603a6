"""Inputs and outputs, groups, pulses, cyclic signals, flags, cyclic flags."""

from collections.abc import Callable
from typing import Any

import pytest

Go = Callable[..., Any]


def program(body: str, declarations: str = "INT I\nBOOL B\nREAL X\n", routines: str = "") -> str:
    return f"DEF main()\n{declarations}{body}END\n{routines}"


def test_outputs_are_read_back(go: Go) -> None:
    """What a program sets it reads [IOT-01]."""
    ran = go(program("$OUT[5]=TRUE\nB=$OUT[5]\n$ANOUT[2]=-0.5\nX=$ANOUT[2]\n"))
    assert (True, -0.5) == (ran.last("B"), ran.last("X"))
    assert [(0.0, 5, True)] == ran.outputs()
    assert [-0.5] == [one.fields["value"] for one in ran.told("anout")]


def test_only_changes_are_told(go: Go) -> None:
    """An output that is set to what it has is no event."""
    assert [] == go(program("$OUT[5]=FALSE\n$ANOUT[1]=0.0\n")).told("out", "anout")


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


def test_groups(go: Go) -> None:
    """A SIGNAL of several bits is an INT, the first bit the lowest [IOT-03]."""
    declarations = "INT I\nSIGNAL NR $OUT[3] TO $OUT[6]\nSIGNAL GIVEN $IN[11] TO $IN[18]\n"
    ran = go(program("NR=9\nI=NR+GIVEN\n", declarations), "t=0 IN[11..18]=130")
    assert [(0.0, 3, True), (0.0, 6, True)] == ran.outputs()
    assert 139 == ran.last("I")


def test_wide_group(go: Go) -> None:
    """32 bits have a sign [IOT-03]."""
    declarations = "INT I\nSIGNAL NR $OUT[1] TO $OUT[32]\n"
    assert -2 == go(program("NR=-2\nI=NR\n", declarations)).last("I")


def test_pulse(go: Go) -> None:
    """PULSE goes on while the program does, in tenths of a second [IOT-07]."""
    ran = go(program("PULSE($OUT[4],TRUE,0.26)\n$OUT[5]=TRUE\nWAIT SEC 1\n"))
    assert [(0.0, 4, True), (0.0, 5, True), (0.3, 4, False)] == ran.outputs()
    assert ["main.src:5", "main.src:6", "main.src:5"] == [one.place for one in ran.told("out")]


def test_pulse_through_a_signal(go: Go) -> None:
    """The output may be named by a SIGNAL [IOT-07]."""
    text = program("PULSE(GLUE,TRUE,0.1)\nWAIT SEC 1\n", "SIGNAL GLUE $OUT[4]\n")
    assert [(0.0, 4, True), (0.108, 4, False)] == go(text).outputs()


def test_pulse_of_what_is_on(go: Go) -> None:
    """An output that is TRUE already falls at the end of the pulse [IOT-07]."""
    ran = go(program("$OUT[4]=TRUE\nPULSE($OUT[4],TRUE,0.5)\nWAIT SEC 1\n"))
    assert [(0.0, 4, True), (0.504, 4, False)] == ran.outputs()


def test_pulse_restarts(go: Go) -> None:
    """A new pulse restarts it [IOT-07]."""
    ran = go(
        program("PULSE($OUT[4],TRUE,0.5)\nWAIT SEC 0.3\nPULSE($OUT[4],TRUE,0.5)\nWAIT SEC 1\n")
    )
    assert [(0.0, 4, True), (0.804, 4, False)] == ran.outputs()


def test_pulse_is_ended(go: Go) -> None:
    """The other level, set meanwhile, ends it [IOT-07]."""
    ran = go(
        program("PULSE($OUT[4],TRUE,0.5)\nWAIT SEC 0.1\n$OUT[4]=FALSE\n$OUT[4]=TRUE\nWAIT SEC 1\n")
    )
    assert [(0.0, 4, True), (0.108, 4, False), (0.108, 4, True)] == ran.outputs()


def test_cyclic_input(go: Go) -> None:
    """ANIN ON reads in every cycle until ANIN OFF [IOT-05]."""
    text = program(
        "ANIN ON X=10*VOLTS+1\nWAIT SEC 0.5\nANIN OFF VOLTS\nWAIT SEC 0.5\n",
        "SIGNAL VOLTS $ANIN[2]\nREAL X\n",
    )
    ran = go(text, "t=0.3 ANIN[2]=0.5\nt=0.7 ANIN[2]=0.9")
    assert [(0.012, 1.0), (0.3, 6.0)] == [
        (one.time / 1e6, one.fields["value"])
        for one in ran.told("assign")
        if one.time in (12_000, 300_000)
    ]
    assert 6.0 == ran.last("X")


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
        (one.time / 1e6, one.fields["value"]) for one in ran.told("anout")
    ]


def test_cyclic_digital_input(go: Go) -> None:
    """DIGIN ON reads a digital input group [IOT-04, IOT-05]."""
    text = program("DIGIN ON X=0.5*$DIGIN1\nWAIT SEC 1\nDIGIN OFF $DIGIN1\n")
    assert 4.0 == go(text, "t=0.3 DIGIN1=8").last("X")


def test_too_many_cyclic_inputs(go: Go) -> None:
    """No further cyclic analog input is message 1543 [IOT-05]."""
    lines = "".join(f"ANIN ON X=1.0*$ANIN{one}\n" for one in "ABCD")
    signals = "".join(f"SIGNAL $ANIN{one} $ANIN[{place}]\n" for place, one in enumerate("ABCD", 1))
    text = program(
        lines.replace("$ANIN", "VOLT"), "REAL X\n" + signals.replace("SIGNAL $ANIN", "SIGNAL VOLT")
    )
    assert [1543] == go(text).messages()


def test_flags(go: Go) -> None:
    """Flags are for free use [IOT-10]."""
    ran = go(program("$FLAG[1024]=TRUE\nB=$FLAG[1024]\nI=1025\n$FLAG[I]=TRUE\n"))
    assert (True, 1444) == (ran.last("B"), ran.outcome.error.number)


def test_cyclic_flag(go: Go) -> None:
    """$CYCFLAG[n] keeps the expression, and is looked at anew in every cycle [IOT-11, IOT-12]."""
    text = program(
        "$CYCFLAG[3]=$IN[1] AND NOT $IN[2]\nWAIT FOR $CYCFLAG[3]\nWAIT FOR NOT $CYCFLAG[3]\n"
    )
    ran = go(text, "t=0.5 IN[1]=TRUE\nt=0.8 IN[2]=TRUE")
    assert [0.804] == ran.times("end")


def test_cyclic_flag_at_once(go: Go) -> None:
    """It has its value from the assignment on [IOT-11]."""
    assert True is go(program("$CYCFLAG[3]=NOT $IN[1]\nB=$CYCFLAG[3]\n")).last("B")


def test_cyclic_flag_in_an_interrupt(go: Go) -> None:
    """An interrupt may depend on one [IOT-12]."""
    text = program(
        "$CYCFLAG[1]=$IN[1] AND $IN[2]\nINTERRUPT DECL 10 WHEN $CYCFLAG[1] DO A()\n"
        "INTERRUPT ON 10\nWAIT SEC 1\n",
        routines="DEF A()\nEND\n",
    )
    assert [0.504] == go(text, "t=0.2 IN[1]=TRUE\nt=0.5 IN[2]=TRUE").times("interrupt_enter")


def test_too_many_cyclic_flags(go: Go) -> None:
    """Only so many may be active [IOT-11]."""
    ran = go(program("FOR I=1 TO 100\n$CYCFLAG[I]=$IN[1]\nENDFOR\n"))
    assert ([2940], 65) == (ran.messages(), ran.last("I"))
