"""Messages and dialogues of programs, errors, and routines that act on the robot."""

from collections.abc import Callable
from typing import Any

import pytest

from interp.controller import Profile

Go = Callable[..., Any]

DECLARATIONS = """DECL KRLMSG_T MSG
DECL KRLMSGPAR_T PAR[3]
DECL KRLMSGOPT_T OPT
DECL KRLMSGDLGSK_T SK[7]
INT H,I
BOOL B
"""


def program(body: str, declarations: str = DECLARATIONS) -> str:
    return f"DEF main()\n{declarations}{body}END\n"


FILL = (
    'MSG={MODUL[] "TEST",NR 17,MSG_TXT[] "part %1 of %2"}\nPAR[1]={PAR_TYPE #VALUE,PAR_INT 3}\n'
    'PAR[2]={PAR_TYPE #VALUE,PAR_TXT[] "all"}\n'
)


def test_notification(go: Go) -> None:
    """A message is told with its parameters filled in, and does not stay [FCT-10]."""
    ran = go(program(FILL + "H=SET_KRLMSG(#NOTIFY,MSG,PAR[],OPT)\nB=EXISTS_KRLMSG(H)\n"))
    assert [{"number": 17, "text": "part 3 of all", "type": "notify"}] == [
        dict(one.fields) for one in ran.events_of("message")
    ]
    assert False is ran.last("B")


def test_confirm_statement(go: Go) -> None:
    """CONFIRM acknowledges a message from the program [FCT-10]."""
    body = (
        FILL
        + "H=SET_KRLMSG(#QUIT,MSG,PAR[],OPT)\nB=ISMESSAGESET(17)\nI=1\nCONFIRM 17\n"
        + "B=ISMESSAGESET(17)\n"
    )
    values = [
        one.fields["value"]
        for one in go(program(body)).events_of("assign")
        if one.fields["name"] == "B"
    ]
    assert [True, False] == values


def test_dialogue(go: Go) -> None:
    """A dialogue waits for an answer, which the program gets [FCT-10]."""
    body = (
        FILL
        + "H=SET_KRLDLG(MSG,PAR[],SK[],OPT)\nWHILE EXISTS_KRLDLG(H,I)\nWAIT SEC 0.1\nENDWHILE\n"
    )
    ran = go(program(body), "on dialogue after 0.5 answer 2")
    assert (2, [0.54]) == (ran.last("I"), ran.times("end"))


def test_message_may_stop_the_advance_run(go: Go) -> None:
    """VL_STOP has the message wait for the arm [FCT-10]."""
    home = "PTP {A1 0,A2 0,A3 0,A4 0,A5 0,A6 0}\n"
    for word, time in (("TRUE", 1.0), ("FALSE", 0.0)):
        option = f"OPT={{VL_STOP {word},CLEAR_P_RESET TRUE,CLEAR_P_SAW FALSE,LOG_TO_DB FALSE}}\n"
        ran = go(program(FILL + option + home + "H=SET_KRLMSG(#NOTIFY,MSG,PAR[],OPT)\n"))
        assert [time] == ran.times("message", number=17)


def test_no_error_is_raised_from_none(go: Go) -> None:
    """ERR_RAISE of an error with the number 0 does nothing."""
    assert "end" == go(program("ERR_RAISE($ERR)\n")).outcome.ending


def test_what_is_not_simulated(go: Go) -> None:
    """A routine that acts on something else is a clear fault, never silence [FCT-11]."""
    ran = go(program("I=DIAG_STOP()\n"))
    assert ("fault", "unsupported") == (ran.outcome.ending, ran.outcome.error.slug)


def test_size_of_a_variable(go: Go) -> None:
    """GETVARSIZE tells the elements of a system variable [FCT-11]."""
    body = "I=GETVARSIZE(#TIMER)\nI=GETVARSIZE(#AN_IN)\nI=GETVARSIZE(#COUNT_I)\n"
    assert [64, 32, 160] == [one.fields["value"] for one in go(program(body)).events_of("assign")]
    old = go(program(body), profile=Profile.load("kss5"))
    assert [32, 32, 160] == [one.fields["value"] for one in old.events_of("assign")]


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
