"""Interrupts: edges, priorities, nesting, what may be said where, BRAKE and RESUME."""

from collections.abc import Callable
from typing import Any

Go = Callable[..., Any]

HOME = "PTP {A1 0,A2 0,A3 0,A4 0,A5 0,A6 0}\n"


def program(body: str, routines: str = "", declarations: str = "INT I\n") -> str:
    return f"DEF main()\n{declarations}{body}END\n{routines}"


ONCE = program(
    "INTERRUPT DECL 10 WHEN $IN[1] DO COUNT()\nINTERRUPT ON 10\nI=0\n" + HOME + "PTP {A1 9}\n",
    "DEF COUNT()\n$FLAG[1]=TRUE\nCONTINUE\n$OUT[1]=TRUE\nEND\n",
)


def test_unknown_number(go: Go) -> None:
    """Only what is declared is switched on; what is not there may be switched off [INT-07]."""
    assert "interrupt_unknown" == go(program("INTERRUPT ON 7\n")).outcome.error.slug
    assert "end" == go(program("INTERRUPT OFF 7\n")).outcome.ending


BRAKING = program(
    "INTERRUPT DECL 10 WHEN $IN[1] DO STOPS()\nINTERRUPT ON 10\n" + HOME + "PTP {A1 100}\n",
    "DEF STOPS()\nBRAKE\nWAIT SEC 0.5\nEND\n",
)


def test_brake_where_nothing_moves(go: Go) -> None:
    """BRAKE of an arm that stands changes nothing [INT-09]."""
    text = BRAKING.replace("PTP {A1 100}\n", "WAIT SEC 5\n")
    ran = go(text, "t=1.5 IN[1]=TRUE")
    assert [] == ran.arm.calls
    assert [2.004] == ran.times("interrupt_leave")


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


def test_motion_in_a_routine_without_brake(go: Go) -> None:
    """Without BRAKE its motions come behind those that are planned [INT-08]."""
    text = BRAKING.replace("BRAKE\nWAIT SEC 0.5", "PTP {A1 -30}\n$OUT[1]=TRUE")
    ran = go(text, "t=1.5 IN[1]=TRUE")
    assert [2.0] == ran.times("motion_start", motion=3)
    assert [(3.0, 1, True)] == ran.outputs()


SEARCH = program(
    "INTERRUPT DECL 10 WHEN $IN[1] DO FOUND()\n" + HOME + "INTERRUPT ON 10\nSEARCH()\n"
    "INTERRUPT OFF 10\nI=I+1\nPTP {A1 5}\n",
    "DEF SEARCH()\nPTP {A1 100}\nWAIT SEC 0\n$OUT[9]=TRUE\nEND\n"
    "DEF FOUND()\nBRAKE\nRESUME\n$OUT[8]=TRUE\nEND\n",
    "INT I\nI=0\n",
)


def test_search_without_a_find(go: Go) -> None:
    """Without the event the search ends by itself [INT-10]."""
    ran = go(SEARCH)
    assert [(2.0, 9, True)] == ran.outputs()
    assert 3.0 == ran.times("motion_end")[-1]


def test_resume_without_brake(go: Go) -> None:
    """A RESUME while the arm moves stops it on its path first [INT-10]."""
    ran = go(SEARCH.replace("BRAKE\nRESUME", "RESUME"), "t=1.5 IN[1]=TRUE")
    assert ["discard"] == ran.arm.calls
    assert [1.51] == ran.times("motion_start", motion=3)


def test_resume_only_in_interrupts(go: Go) -> None:
    """Elsewhere RESUME is a fault [INT-11]."""
    assert "resume_place" == go(program("RESUME\n")).outcome.error.slug


def test_interrupt_behind_the_last_line(go: Go) -> None:
    """The program has run ahead to its end, and the arm is still on its way [INT-08]."""
    ran = go(ONCE, "t=1.5 IN[1]=TRUE")
    assert [1.5] == ran.times("interrupt_enter")
    assert [2.0] == ran.times("end")


def test_halt_waits_for_the_advance_run(go: Go) -> None:
    """In an interrupt routine HALT takes effect when all that was planned is done [CTL-08]."""
    text = BRAKING.replace("BRAKE\nWAIT SEC 0.5", "HALT")
    ran = go(text, "t=0.5 IN[1]=TRUE\non HALT press START")
    assert [2.0] == ran.times("halt")


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
