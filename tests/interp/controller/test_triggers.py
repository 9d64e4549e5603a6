"""TRIGGER: outputs with exact timing, routines with a priority, and where there may be none."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from interp.controller import Profile

Go = Callable[..., Any]

HOME = "PTP {A1 0,A2 0,A3 0,A4 0,A5 0,A6 0}\n"


def program(body: str, routines: str = "") -> str:
    return (
        f"DEF main()\nINT I\nI=0\n$BASE=$NULLFRAME\n$TOOL=$NULLFRAME\n{HOME}{body}END\n{routines}"
    )


@pytest.mark.parametrize(
    ("place", "delay", "time"),
    [("DISTANCE=0", 20, 1.02), ("DISTANCE=1", -50, 1.95), ("PATH=-300", 0, 1.7)],
)
def test_time(go: Go, place: str, delay: int, time: float) -> None:
    """The output is switched at its very µs, which is no tick [TRG-01, TRG-03, TRG-04]."""
    ran = go(program(f"TRIGGER WHEN {place} DELAY={delay} DO $OUT[3]=TRUE\nLIN {{X 1}}\n"))
    assert [(time, 3, True)] == ran.outputs()
    assert [time] == ran.times("trigger", sets="$OUT[3]", value=True)
    assert ["main.src:7"] == [one.place for one in ran.told("out")]


def test_order_of_cause(go: Go) -> None:
    """What is switched at the start of a motion is told behind its start [TRG-01]."""
    ran = go(program("TRIGGER WHEN DISTANCE=0 DELAY=0 DO $OUT[3]=TRUE\nPTP {A1 1}\n"))
    kinds = [one.kind for one in ran.events if one.time == 1_000_000]
    assert kinds.index("motion_start") < kinds.index("trigger") < kinds.index("out")


def test_apex(go: Go) -> None:
    """With an approximated end DISTANCE=1 is the middle of the blend [TRG-02]."""
    ran = go(
        program("TRIGGER WHEN DISTANCE=1 DELAY=0 DO $OUT[3]=TRUE\nPTP {A1 1} C_PTP\nPTP {A1 2}\n")
    )
    assert ran.times("blend_apex") == [ran.outputs()[0][0]] == [2.0]


def test_belongs_to_the_next_motion(go: Go) -> None:
    """Several triggers stand before the motion they belong to [TRG-13]."""
    lines = "".join(
        f"TRIGGER WHEN DISTANCE=0 DELAY={one}00 DO $OUT[{one}]=TRUE\n" for one in (2, 1)
    )
    ran = go(program(lines + "PTP {A1 1}\nPTP {A1 2}\n"))
    assert [(1.1, 1, True), (1.2, 2, True)] == ran.outputs()


def test_flag_is_set(go: Go) -> None:
    """Any system variable can be set [TRG-05]."""
    ran = go(program("TRIGGER WHEN DISTANCE=0 DELAY=0 DO $FLAG[3]=TRUE\nPTP {A1 1}\nWAIT SEC 0\n"))
    assert [1.0] == ran.times("trigger", sets="$FLAG[3]")
    assert True is ran.value("$FLAG", 3)


def test_computed_assignment(go: Go) -> None:
    """What has to be computed is computed when it fires [TRG-05]."""
    body = "TRIGGER WHEN DISTANCE=0 DELAY=30 DO $OUT[1]=$IN[1]\nPTP {A1 1}\nPTP {A1 2}\n"
    assert [(1.03, 1, True)] == go(program(body), "t=1.01 IN[1]=TRUE").outputs()
    assert [] == go(program(body), "t=1.04 IN[1]=TRUE").outputs()


def test_pulse(go: Go) -> None:
    """PULSE is a possible action [TRG-05, IOT-07]."""
    ran = go(
        program(
            "TRIGGER WHEN DISTANCE=0 DELAY=0 DO PULSE($OUT[1],TRUE,0.1)\nPTP {A1 1}\nPTP {A1 2}\n"
        )
    )
    assert [(1.0, 1, True), (1.104, 1, False)] == ran.outputs()


def call(priority: int) -> str:
    return program(
        f"TRIGGER WHEN DISTANCE=0 DELAY=30 DO DONE(I) PRIO={priority}\n"
        "PTP {A1 1}\nPTP {A1 2}\nWAIT SEC 0\n",
        "DEF DONE(N)\nINT N\nN=N+1\n$OUT[1]=TRUE\nEND\n",
    )


@pytest.mark.parametrize(("priority", "shown"), [(8, 8), (128, 128), (-1, 40)])
def test_call(go: Go, priority: int, shown: int) -> None:
    """A routine is entered as an interrupt of its priority, at its very time [TRG-06]."""
    ran = go(call(priority))
    assert [1.03] == ran.times("interrupt_enter", priority=shown)
    assert [1.03] == ran.times("interrupt_leave", priority=shown)
    assert [(1.03, 1, True)] == ran.outputs()
    assert 1 == ran.last("N")


@pytest.mark.parametrize("priority", [0, 3, 40, 80, 129])
def test_priorities(go: Go, priority: int) -> None:
    """Only some priorities are for programs [TRG-06]."""
    assert "trigger_priority" == go(call(priority)).outcome.error.slug


@pytest.mark.parametrize("place", ["DISTANCE=0 DELAY=20000000", "PATH=-1.0E+08 DELAY=0"])
def test_range(go: Go, place: str) -> None:
    """Places and delays have a limit [TRG-03, TRG-04]."""
    ran = go(program(f"TRIGGER WHEN {place} DO $OUT[1]=TRUE\nLIN {{X 1}}\n"))
    assert "trigger_range" == ran.outcome.error.slug


def test_call_waits_for_a_higher_priority(go: Go) -> None:
    """A trigger's routine waits while one of a higher priority runs [TRG-06, INT-05]."""
    text = call(20).replace(HOME, "INTERRUPT DECL 5 WHEN $IN[1] DO LONG()\nINTERRUPT ON 5\n" + HOME)
    ran = go(text + "DEF LONG()\nWAIT SEC 0.3\nEND\n", "t=0.95 IN[1]=TRUE")
    assert [0.96, 1.26] == ran.times("interrupt_enter")
    assert [1.03] == ran.times("trigger")


def test_error_in_a_trigger(go: Go) -> None:
    """$ERR tells that it is one of a trigger [TRG-12]."""
    text = call(8).replace("N=N+1\n", "ON_ERROR_PROCEED\n$OUT[N]=TRUE\n")
    ran = go(text)
    assert "#TRG_REGULAR" == repr(ran.value("$ERR", "TRIGGER_TYPE"))
    assert 1444 == ran.value("$ERR", "NUMBER")


def test_too_many(go: Go) -> None:
    """Too many that wait are message 1524 [TRG-09]."""
    lines = "TRIGGER WHEN DISTANCE=0 DELAY=0 DO $OUT[1]=TRUE\n" * 3
    profile = Profile.load()
    profile = replace(profile, most={**profile.most, "triggers": 2})
    assert [1524] == go(program(lines + "PTP {A1 1}\n"), profile=profile).messages()


def test_discarded_with_its_motion(go: Go) -> None:
    """What a RESUME aborts fires no more [INT-10]."""
    text = (
        f"DEF main()\nINTERRUPT DECL 10 WHEN $IN[1] DO FOUND()\n{HOME}INTERRUPT ON 10\nSEARCH()\n"
        "PTP {A1 3}\nEND\nDEF SEARCH()\nTRIGGER WHEN DISTANCE=1 DELAY=0 DO $OUT[1]=TRUE\n"
        "PTP {A1 1}\nWAIT SEC 0\nEND\nDEF FOUND()\nBRAKE\nRESUME\nEND\n"
    )
    assert [(2.0, 1, True)] == go(text).outputs()
    assert [] == go(text, "t=1.5 IN[1]=TRUE").outputs()
