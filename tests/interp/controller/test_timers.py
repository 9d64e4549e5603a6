"""Timers, date and time, WAIT SEC and WAIT FOR on the virtual clock."""

from collections.abc import Callable
from typing import Any

from interp.program.load import Limits

Go = Callable[..., Any]


def program(body: str) -> str:
    return f"DEF main()\nINT I\nBOOL B\nREAL X\n{body}END\n"


def test_date(go: Go) -> None:
    """$DATE is the profile's start and the virtual time since [TIM-05]."""
    text = program("WAIT SEC 61.5\nI=$DATE.HOUR*10000+$DATE.MIN*100+$DATE.SEC\nX=$DATE.YEAR\n")
    ran = go(text, until=100)
    assert (80101, 2020.0) == (ran.last("I"), ran.last("X"))


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
    assert "halt" == ran.controller.run().ending
    assert 2 == ran.last("I")
    assert "end" == ran.controller.run().ending
    assert 3 == ran.last("I")
    assert [0.206] == go(text, "on HALT after 0.05 press START").times("end")


def test_operator(go: Go) -> None:
    """STOP holds the program and the arm, START lets both go on."""
    text = program("PTP {A1 0,A2 0,A3 0,A4 0,A5 0,A6 0}\nPTP {A1 1}\nWAIT SEC 0\nI=1\n")
    ran = go(text, "t=0.5 press STOP\nt=2 press START")
    assert [2.5, 3.5] == ran.times("motion_end")
    assert ["brake", "proceed"] == ran.arm.calls


def test_wait_while_stopped(go: Go) -> None:
    """A wait that is over while the operator has stopped the program ends with START."""
    ran = go(program("WAIT SEC 0.1\nI=1\n"), "t=0.05 press STOP\nt=1 press START")
    assert [1.0] == ran.times("assign", name="I")
    times = [one.time for one in ran.events]
    assert sorted(times) == times


def test_override(go: Go) -> None:
    """$OV_PRO scales the speed; 0 stops the arm until it is raised [MOT-09]."""
    text = program("PTP {A1 0,A2 0,A3 0,A4 0,A5 0,A6 0}\nPTP {A1 1}\n")
    assert [1.5, 2.5] == go(text, "t=0.5 OV_PRO=50\nt=1.5 OV_PRO=100").times("motion_end")
    assert [3.0, 4.0] == go(text, "t=0.5 OV_PRO=0\nt=2.5 OV_PRO=100").times("motion_end")
    assert [2.0, 4.0] == go(text.replace("REAL X\n", "REAL X\n$OV_PRO=50\n")).times("motion_end")


def test_home(go: Go) -> None:
    """$IN_HOME and $IN_HOME1 to 5 tell whether every axis is within its tolerance of home."""
    home = "{E6AXIS: A1 1,A2 0,A3 0,A4 0,A5 0,A6 0,E1 0,E2 0,E3 0,E4 0,E5 0,E6 0}"
    look = "WAIT SEC 0\nB=$IN_HOME\nB=$IN_HOME2\n"
    ran = go(
        program(
            f"$H_POS={home}\n$AXIS_HOME[2]={home}\n$H_AXIS_TOL[2]={{E6AXIS: A1 0.5}}\n{look}"
            f"PTP {{A1 0.6,A2 0,A3 0,A4 0,A5 0,A6 0}}\n{look}PTP {{A1 1}}\n{look}"
        )
    )
    told = [one.fields["value"] for one in ran.events_of("assign") if one.fields["name"] == "B"]
    assert [False, False, False, True, True, True] == told


def test_states(go: Go) -> None:
    """$PRO_STATE tells what the program does, $ROB_STOPPED whether the arm stands [SUB-08]."""
    text = program("B=$PRO_STATE1==#P_ACTIVE\nB=$PRO_STATE0==#P_FREE\nB=$ROB_STOPPED\nB=$T1\n")
    ran = go(text, "t=0 MODE_OP=#T1")
    assert [True] * 4 == [one.fields["value"] for one in ran.events_of("assign")]
    assert "#P_END" == repr(ran.value("$PRO_STATE1"))
