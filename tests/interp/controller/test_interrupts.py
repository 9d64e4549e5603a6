"""Interrupts: edges, priorities, nesting, what may be said where, BRAKE and RESUME."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from interp.controller import Profile
from interp.values.values import text_of

Go = Callable[..., Any]

HOME = "PTP {A1 0,A2 0,A3 0,A4 0,A5 0,A6 0}\n"


def program(body: str, routines: str = "", declarations: str = "INT I\n") -> str:
    return f"DEF main()\n{declarations}{body}END\n{routines}"


ONCE = program(
    "INTERRUPT DECL 10 WHEN $IN[1] DO COUNT()\nINTERRUPT ON 10\nI=0\n" + HOME + "PTP {A1 9}\n",
    "DEF COUNT()\n$FLAG[1]=TRUE\nCONTINUE\n$OUT[1]=TRUE\nEND\n",
)


def test_edge(go: Go) -> None:
    """The routine runs when the condition becomes TRUE, at the next cycle [INT-06, INT-18]."""
    ran = go(ONCE, "t=0.5 IN[1]=TRUE\nt=0.6 IN[1]=FALSE")
    assert [0.504] == ran.times("interrupt_enter", priority=10)
    assert [0.504] == ran.times("interrupt_leave", priority=10)
    assert [(0.504, 1, True)] == ran.outputs()


def test_level_is_no_event(go: Go) -> None:
    """What is TRUE at INTERRUPT ON is no event; it has to become FALSE first [INT-06]."""
    assert [] == go(ONCE, "t=0 IN[1]=TRUE").told("interrupt_enter")
    again = go(ONCE, "t=0 IN[1]=TRUE\nt=0.2 IN[1]=FALSE\nt=0.3 IN[1]=TRUE")
    assert [0.3] == again.times("interrupt_enter")


def test_arm_moves_on(go: Go) -> None:
    """The routine runs while the arm goes on [INT-08]."""
    text = ONCE.replace("$FLAG[1]=TRUE", "WAIT SEC 0.3")
    ran = go(text, "t=0.5 IN[1]=TRUE")
    assert [0.804] == ran.times("interrupt_leave")
    assert [1.0, 2.0] == ran.times("motion_end")


def test_off_and_disable(go: Go) -> None:
    """OFF is not watched at all; DISABLE keeps the event until ENABLE [INT-07]."""
    text = program(
        "INTERRUPT DECL 10 WHEN $IN[1] DO COUNT()\nINTERRUPT ON 10\nINTERRUPT {} 10\n"
        "WAIT SEC 0.5\nINTERRUPT {} 10\nWAIT SEC 0.5\n",
        "DEF COUNT()\nEND\n",
    )
    script = "t=0.2 IN[1]=TRUE\nt=0.3 IN[1]=FALSE"
    assert [] == go(text.format("OFF", "ON"), script).told("interrupt_enter")
    assert [0.504] == go(text.format("DISABLE", "ENABLE"), script).times("interrupt_enter")


def test_all_at_once(go: Go) -> None:
    """Without a number all declared interrupts are meant [INT-07]."""
    text = program(
        "INTERRUPT DECL 11 WHEN $IN[1] DO COUNT()\nINTERRUPT DECL 12 WHEN $IN[2] DO COUNT()\n"
        "INTERRUPT ON\nWAIT SEC 0.5\nINTERRUPT OFF\nWAIT SEC 0.5\n",
        "DEF COUNT()\nEND\n",
    )
    ran = go(text, "t=0.1 IN[1]=TRUE\nt=0.2 IN[2]=TRUE\nt=0.6 IN[1]=FALSE\nt=0.7 IN[1]=TRUE")
    assert [0.108, 0.204] == ran.times("interrupt_enter")


NESTED = program(
    "INTERRUPT DECL 20 WHEN $IN[1] DO LOW()\nINTERRUPT DECL 5 WHEN $IN[2] DO HIGH()\n"
    "INTERRUPT ON 20\nINTERRUPT ON 5\nI=1\nWAIT SEC 2\nI=I+100\n",
    "DEF LOW()\nWAIT SEC 0.5\nEND\nDEF HIGH()\nWAIT SEC 0.1\nEND\n",
)


def order(ran: Any) -> list[tuple[float, str, int]]:
    return [
        (one.time / 1e6, one.kind[10:], one.fields["priority"])
        for one in ran.told("interrupt_enter", "interrupt_leave")
    ]


def test_higher_priority_interrupts(go: Go) -> None:
    """A lower number interrupts a routine that runs; only the top runs [INT-05]."""
    ran = go(NESTED, "t=0.1 IN[1]=TRUE\nt=0.2 IN[2]=TRUE")
    assert [
        *((0.108, "enter", 20), (0.204, "enter", 5)),
        *((0.312, "leave", 5), (0.612, "leave", 20)),
    ] == order(ran)
    assert [2.004] == ran.times("end")  # the wait of the program went on meanwhile
    assert 101 == ran.last("I")


def test_lower_priority_waits(go: Go) -> None:
    """A higher number waits until the routine has ended [INT-05]."""
    ran = go(NESTED, "t=0.1 IN[2]=TRUE\nt=0.15 IN[1]=TRUE")
    assert [
        (0.108, "enter", 5),
        (0.216, "leave", 5),
        (0.216, "enter", 20),
        (0.72, "leave", 20),
    ] == order(ran)


def test_coincidence_by_priority(go: Go) -> None:
    """Of events in the same cycle the highest priority comes first [INT-05]."""
    ran = go(NESTED, "t=0.1 IN[1]=TRUE, IN[2]=TRUE")
    assert [("enter", 5), ("leave", 5), ("enter", 20), ("leave", 20)] == [
        one[1:] for one in order(ran)
    ]


def test_declaration_is_replaced(go: Go) -> None:
    """A new declaration of the same number takes the place of the old one [INT-01]."""
    text = program(
        "INTERRUPT DECL 10 WHEN $IN[1] DO A()\nINTERRUPT ON 10\n"
        "INTERRUPT DECL 10 WHEN $IN[2] DO B()\nINTERRUPT ON 10\nWAIT SEC 1\n",
        "DEF A()\nEND\nDEF B()\nEND\n",
    )
    ran = go(text, "t=0.1 IN[1]=TRUE\nt=0.3 IN[2]=TRUE")
    assert ["B"] == [one.fields["name"] for one in ran.told("call")]


@pytest.mark.parametrize(("word", "seen"), [("", []), ("GLOBAL ", [0.708])])
def test_visibility(go: Go, word: str, seen: list[float]) -> None:
    """A declaration ends with its routine, unless it is GLOBAL [INT-04]."""
    text = program(
        "SUB()\nWAIT SEC 0.5\nOTHER()\nWAIT SEC 0.5\n",
        f"DEF SUB()\n{word}INTERRUPT DECL 10 WHEN $IN[1] DO A()\nINTERRUPT ON 10\nEND\n"
        "DEF OTHER()\nWAIT SEC 0.5\nEND\nDEF A()\nEND\n",
    )
    assert seen == go(text, "t=0.7 IN[1]=TRUE").times("interrupt_enter")


@pytest.mark.parametrize("number", [40, 80, 0, 129])
def test_numbers(go: Go, number: int) -> None:
    """40 to 80 are the system's, and there is nothing above 128 [INT-02]."""
    ran = go(program(f"INTERRUPT DECL {number} WHEN $IN[1] DO A()\n", "DEF A()\nEND\n"))
    assert ("fault", "interrupt_number") == (ran.outcome.ending, ran.outcome.error.slug)


def test_unknown_number(go: Go) -> None:
    """Only what is declared is switched on; what is not there may be switched off [INT-07]."""
    assert "interrupt_unknown" == go(program("INTERRUPT ON 7\n")).outcome.error.slug
    assert "end" == go(program("INTERRUPT OFF 7\n")).outcome.ending


def test_list(go: Go) -> None:
    """$RINT_LIST has what is declared: number, line, module [INT-17]."""
    text = program(
        "INTERRUPT DECL 20 WHEN $IN[1] DO A()\nINTERRUPT DECL 7 WHEN $IN[1] DO A()\n"
        "INTERRUPT ON 7\n",
        "DEF A()\nEND\n",
    )
    entries = [go(text).value("$RINT_LIST", place) for place in (1, 2, 3)]
    assert [(7, 4), (20, 3), (0, 0)] == [
        (one.get("INT_PRIO"), one.get("PROG_LINE")) for one in entries
    ]
    assert "MAIN" == text_of(entries[0].get("PROG_NAME"))


def test_too_many(go: Go) -> None:
    """So many as the profile says may be declared [INT-03]."""
    profile = Profile.load()
    profile = replace(profile, most={**profile.most, "interrupts": 2})
    text = program(
        "".join(f"INTERRUPT DECL {one} WHEN $IN[1] DO A()\n" for one in (4, 5, 6)),
        "DEF A()\nEND\n",
    )
    assert "interrupt_count" == go(text, profile=profile).outcome.error.slug
    assert "end" == go(text).outcome.ending


BRAKING = program(
    "INTERRUPT DECL 10 WHEN $IN[1] DO STOPS()\nINTERRUPT ON 10\n" + HOME + "PTP {A1 100}\n",
    "DEF STOPS()\nBRAKE\nWAIT SEC 0.5\nEND\n",
)


def test_brake(go: Go) -> None:
    """BRAKE stops the arm on its path; when the routine ends it goes on [INT-09]."""
    ran = go(BRAKING, "t=1.5 IN[1]=TRUE")
    assert [1.5] == ran.times("brake", mode=None)
    assert ["brake", "proceed"] == ran.arm.calls
    # Stands at 1.51, waits half a second to the next tick, and has half a second left.
    assert [2.016] == ran.times("interrupt_leave")
    assert [1.0, 2.516] == ran.times("motion_end")
    assert 50.0 == ran.value("$AXIS_RET", "A1")


def test_brake_hard(go: Go) -> None:
    """BRAKE F takes the hardest ramp [INT-09]."""
    ran = go(BRAKING.replace("BRAKE\n", "BRAKE F\n"), "t=1.5 IN[1]=TRUE")
    assert [1.5] == ran.times("brake", mode="F")
    assert "hard" == ran.arm.calls[0]


def test_brake_where_nothing_moves(go: Go) -> None:
    """BRAKE of an arm that stands changes nothing [INT-09]."""
    text = BRAKING.replace("PTP {A1 100}\n", "WAIT SEC 5\n")
    ran = go(text, "t=1.5 IN[1]=TRUE")
    assert [] == ran.arm.calls
    assert [2.004] == ran.times("interrupt_leave")


def test_brake_only_in_interrupts(go: Go) -> None:
    """Elsewhere BRAKE is a fault [INT-09]."""
    assert "brake_place" == go(program("BRAKE\n")).outcome.error.slug


def test_motion_in_a_braked_routine(go: Go) -> None:
    """The routine moves the arm, which then returns to where it left its path [INT-09, INT-15]."""
    text = BRAKING.replace("WAIT SEC 0.5", "PTP {A1 -30}\nI=1").replace(
        "DEF STOPS()\n", "DEF STOPS()\nINT I\n"
    )
    ran = go(text, "t=1.5 IN[1]=TRUE")
    started = [(one.fields["motion"], one.time / 1e6) for one in ran.told("motion_start")]
    assert [(1, 0.0), (2, 1.0), (3, 1.51), (4, 2.51)] == started
    assert [3.51] == ran.times("interrupt_leave")
    assert [4.01] == ran.times("motion_end", motion=2)
    assert 100.0 == ran.arm.position(ran.outcome.time).axes[0]


NESTED_MOTIONS = program(
    "INTERRUPT DECL 20 WHEN $IN[1] DO STOPS()\nINTERRUPT DECL 10 WHEN $IN[2] DO MOVES()\n"
    "INTERRUPT ON\n" + HOME + "PTP {A1 100}\n",
    "DEF STOPS()\nBRAKE\nWAIT SEC 0.5\nEND\nDEF MOVES()\nPTP {A1 -30}\nEND\n",
)


def test_motion_in_a_routine_above_a_braked_one(go: Go) -> None:
    """Whoever has moved the arm, the routine that braked takes it back [INT-09]."""
    ran = go(NESTED_MOTIONS, "t=1.5 IN[1]=TRUE\nt=1.6 IN[2]=TRUE")
    started = [(one.fields["motion"], one.time / 1e6) for one in ran.told("motion_start")]
    assert [(1, 0.0), (2, 1.0), (3, 1.608), (4, 2.608)] == started
    assert [4.108] == ran.times("motion_end", motion=2)
    assert 100.0 == ran.arm.position(ran.outcome.time).axes[0]


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
        (one.time / 1e6, one.fields["priority"]) for one in ran.told("interrupt_leave")
    ]
    assert [4.142] == ran.times("motion_end", motion=2)
    assert "end" == ran.outcome.ending


def test_motion_in_a_routine_without_brake(go: Go) -> None:
    """Without BRAKE its motions come behind those that are planned [INT-08]."""
    text = BRAKING.replace("BRAKE\nWAIT SEC 0.5", "PTP {A1 -30}\n$OUT[1]=TRUE")
    ran = go(text, "t=1.5 IN[1]=TRUE")
    assert [2.0] == ran.times("motion_start", motion=3)
    assert [(3.0, 1, True)] == ran.outputs()


def test_positions(go: Go) -> None:
    """$AXIS_INT is where the event came [INT-15]."""
    ran = go(BRAKING, "t=1.25 IN[1]=TRUE")
    assert pytest.approx(26.0) == ran.value("$AXIS_INT", "A1")  # the tick behind it is at 1.26 s


def test_base_is_local(go: Go) -> None:
    """A routine changes $BASE for itself only [INT-13]."""
    text = program(
        "$BASE={X 1,Y 0,Z 0,A 0,B 0,C 0}\nINTERRUPT DECL 10 WHEN $IN[1] DO A()\nINTERRUPT ON 10\n"
        "WAIT SEC 0.5\nX=$BASE.X\n",
        "DEF A()\n$BASE=$NULLFRAME\nEND\n",
        "REAL X\n",
    )
    ran = go(text, "t=0.1 IN[1]=TRUE")
    assert [0.108] == ran.times("interrupt_enter")
    assert 1.0 == ran.last("X")


def test_advance_is_not_changed(go: Go) -> None:
    """A routine must not change $ADVANCE [INT-13]."""
    text = ONCE.replace("$FLAG[1]=TRUE", "$ADVANCE=1")
    assert 1388 == go(text, "t=0.1 IN[1]=TRUE").outcome.error.number


def test_no_splines(go: Go) -> None:
    """Spline blocks are not allowed in interrupt routines [SPL-11]."""
    text = ONCE.replace("$FLAG[1]=TRUE", "SPLINE\nSLIN {X 1}\nENDSPLINE")
    assert "spline_place" == go(text, "t=0.1 IN[1]=TRUE").outcome.error.slug


def test_no_triggers(go: Go) -> None:
    """Triggers are not allowed in interrupt routines [TRG-09]."""
    text = ONCE.replace("$FLAG[1]=TRUE", "TRIGGER WHEN DISTANCE=0 DELAY=0 DO $OUT[1]=TRUE")
    ran = go(text, "t=0.1 IN[1]=TRUE")
    assert [1409] == ran.messages()


SEARCH = program(
    "INTERRUPT DECL 10 WHEN $IN[1] DO FOUND()\n" + HOME + "INTERRUPT ON 10\nSEARCH()\n"
    "INTERRUPT OFF 10\nI=I+1\nPTP {A1 5}\n",
    "DEF SEARCH()\nPTP {A1 100}\nWAIT SEC 0\n$OUT[9]=TRUE\nEND\n"
    "DEF FOUND()\nBRAKE\nRESUME\n$OUT[8]=TRUE\nEND\n",
    "INT I\nI=0\n",
)


def test_resume(go: Go) -> None:
    """RESUME leaves the search; the program goes on behind its call [INT-10, INT-12]."""
    ran = go(SEARCH, "t=1.5 IN[1]=TRUE")
    assert [1.51] == ran.times("resume", depth=0)
    assert [1.51] == ran.times("interrupt_leave")
    assert 1 == ran.last("I")
    assert [] == ran.outputs()
    assert ["brake", "discard"] == ran.arm.calls
    assert [1.51] == ran.times("motion_start", motion=3)
    assert [] == ran.times("motion_end", motion=2)
    assert "end" == ran.outcome.ending


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


def test_resume_in_the_declaring_level(go: Go) -> None:
    """RESUME faults where the program is in the level of the declaration [INT-11]."""
    text = program(
        "INTERRUPT DECL 10 WHEN $IN[1] DO FOUND()\nINTERRUPT ON 10\nWAIT SEC 1\n",
        "DEF FOUND()\nRESUME\nEND\n",
    )
    ran = go(text, "t=0.5 IN[1]=TRUE")
    assert ("fault", "resume_level") == (ran.outcome.ending, ran.outcome.error.slug)


def test_resume_of_a_global_interrupt(go: Go) -> None:
    """RESUME is not allowed in the routine of a global interrupt: message 72 [INT-11]."""
    ran = go(SEARCH.replace("INTERRUPT DECL", "GLOBAL INTERRUPT DECL"), "t=1.5 IN[1]=TRUE")
    assert [72] == ran.messages()


def test_resume_only_in_interrupts(go: Go) -> None:
    """Elsewhere RESUME is a fault [INT-11]."""
    assert "resume_place" == go(program("RESUME\n")).outcome.error.slug


def test_resume_from_a_nested_interrupt(go: Go) -> None:
    """RESUME ends all routines above the declaring level, nested ones too [INT-10]."""
    text = SEARCH.replace(
        "INTERRUPT ON 10\n",
        "INTERRUPT ON 10\nINTERRUPT DECL 20 WHEN $IN[2] DO SLOW()\nINTERRUPT ON 20\n",
    )
    text += "DEF SLOW()\nWAIT SEC 0.9\n$OUT[7]=TRUE\nEND\n"
    ran = go(text, "t=1.2 IN[2]=TRUE\nt=1.5 IN[1]=TRUE")
    assert [10, 20] == [one.fields["priority"] for one in ran.told("interrupt_leave")]
    assert [] == ran.outputs()
    assert 1 == ran.last("I")


def test_interrupt_behind_the_last_line(go: Go) -> None:
    """The program has run ahead to its end, and the arm is still on its way [INT-08]."""
    ran = go(ONCE, "t=1.5 IN[1]=TRUE")
    assert [1.5] == ran.times("interrupt_enter")
    assert [2.0] == ran.times("end")


def test_halt_in_a_routine(go: Go) -> None:
    """HALT and loops are legal in interrupt routines [INT-16, CTL-08]."""
    text = program(
        "INTERRUPT DECL 3 WHEN $STOPMESS DO STOPPED()\nINTERRUPT ON 3\nWAIT SEC 1\n",
        "DEF STOPPED()\nREPEAT\nHALT\nUNTIL $STOPMESS==FALSE\nEND\n",
    ).replace("$STOPMESS", "$IN[1]")
    script = "t=0.1 IN[1]=TRUE\non HALT after 0.2 press START\nt=0.4 IN[1]=FALSE"
    ran = go(text, script)
    assert [0.108, 0.308] == ran.times("halt")
    assert "end" == ran.outcome.ending


def test_halt_waits_for_the_advance_run(go: Go) -> None:
    """In an interrupt routine HALT takes effect when all that was planned is done [CTL-08]."""
    text = BRAKING.replace("BRAKE\nWAIT SEC 0.5", "HALT")
    ran = go(text, "t=0.5 IN[1]=TRUE\non HALT press START")
    assert [2.0] == ran.times("halt")
