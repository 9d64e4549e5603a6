"""Interrupts where several levels brake, move or resume; the cases state all else."""

from collections.abc import Callable
from typing import Any

Go = Callable[..., Any]

HOME = "PTP {A1 0,A2 0,A3 0,A4 0,A5 0,A6 0}\n"


def program(body: str, routines: str = "", declarations: str = "INT I\n") -> str:
    return f"DEF main()\n{declarations}{body}END\n{routines}"


def test_unknown_number(go: Go) -> None:
    """Only what is declared is switched on; what is not there may be switched off [INT-07]."""
    assert "interrupt_unknown" == go(program("INTERRUPT ON 7\n")).outcome.error.slug
    assert "end" == go(program("INTERRUPT OFF 7\n")).outcome.ending


NESTED_MOTIONS = program(
    "INTERRUPT DECL 20 WHEN $IN[1] DO STOPS()\nINTERRUPT DECL 10 WHEN $IN[2] DO MOVES()\n"
    "INTERRUPT ON\n" + HOME + "PTP {A1 100}\n",
    "DEF STOPS()\nBRAKE\nWAIT SEC 0.5\nEND\nDEF MOVES()\nPTP {A1 -30}\nEND\n",
)


def test_brake_of_a_routine_that_moves(go: Go) -> None:
    """A higher priority stops the motion of a routine, which then goes on with it [INT-09]."""
    text = NESTED_MOTIONS.replace("WAIT SEC 0.5", "PTP {A1 -30}\nWAIT SEC 0")
    text = text.replace("DEF MOVES()\nPTP {A1 -30}", "DEF MOVES()\nBRAKE\nWAIT SEC 0.12")
    ran = go(text, "t=1.5 IN[1]=TRUE\nt=2 IN[2]=TRUE")
    assert ["brake", "brake", "proceed", "proceed"] == ran.arm.calls
    assert [2.004] == ran.times("brake")[1:]
    assert [2.136] == ran.times("interrupt_leave", priority=10)
    assert [2.642] == ran.times("motion_end", motion=3)  # 1.51, a second, and 0.132 of standing
    assert 100.0 == ran.arm.position(ran.outcome.time).axes[0]


def test_interrupt_behind_the_last_line_of_a_routine(go: Go) -> None:
    """A routine whose motions have not ended can still be interrupted [INT-05, INT-09]."""
    text = NESTED_MOTIONS.replace("WAIT SEC 0.5", "PTP {A1 -30}")
    text = text.replace("DEF MOVES()\nPTP {A1 -30}", "DEF MOVES()\nBRAKE\nWAIT SEC 0.12")
    ran = go(text, "t=1.5 IN[1]=TRUE\nt=2 IN[2]=TRUE")
    assert [(2.136, 10), (3.642, 20)] == [
        (one.time / 1e6, one.fields["priority"]) for one in ran.events_of("interrupt_leave")
    ]
    assert [4.142] == ran.times("motion_end", motion=2)
    assert "end" == ran.outcome.ending


def test_an_interrupt_that_waits_for_a_resume(go: Go) -> None:
    """What came before a RESUME is entered behind it, and the program goes on where that leads."""
    text = program(
        "INTERRUPT DECL 5 WHEN $IN[1] DO BACK()\nINTERRUPT DECL 20 WHEN $FLAG[2] DO LAST()\n"
        + f"{HOME}INTERRUPT ON\nWAY()\n$OUT[2]=TRUE\n",
        "DEF WAY()\nPTP {A1 100}\nWAIT SEC 0\n$OUT[1]=TRUE\nEND\n"
        "DEF BACK()\nBRAKE\n$FLAG[2]=TRUE\nWAIT SEC 0.1\nRESUME\nEND\n"
        "DEF LAST()\n$OUT[3]=TRUE\nEND\n",
    )
    ran = go(text, "t=0.5 IN[1]=TRUE")
    assert "end" == ran.outcome.ending
    assert [False, True, True] == [ran.value("$OUT", place) for place in (1, 2, 3)]
