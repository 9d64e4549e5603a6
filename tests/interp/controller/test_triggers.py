"""TRIGGER: outputs with exact timing, routines with a priority, and where there may be none."""

from collections.abc import Callable
from typing import Any

import pytest

Go = Callable[..., Any]

HOME = "PTP {A1 0,A2 0,A3 0,A4 0,A5 0,A6 0}\n"


def program(body: str, routines: str = "") -> str:
    return (
        f"DEF main()\nINT I\nI=0\n$BASE=$NULLFRAME\n$TOOL=$NULLFRAME\n{HOME}{body}END\n{routines}"
    )


def test_order_of_cause(go: Go) -> None:
    """What is switched at the start of a motion is told behind its start [TRG-01]."""
    ran = go(program("TRIGGER WHEN DISTANCE=0 DELAY=0 DO $OUT[3]=TRUE\nPTP {A1 1}\n"))
    kinds = [one.kind for one in ran.events if one.time == 1_000_000]
    assert kinds.index("motion_start") < kinds.index("trigger") < kinds.index("out")


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


def call(priority: int) -> str:
    return program(
        f"TRIGGER WHEN DISTANCE=0 DELAY=30 DO DONE(I) PRIO={priority}\n"
        "PTP {A1 1}\nPTP {A1 2}\nWAIT SEC 0\n",
        "DEF DONE(N)\nINT N\nN=N+1\n$OUT[1]=TRUE\nEND\n",
    )


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


def test_discarded_with_its_motion(go: Go) -> None:
    """What a RESUME aborts fires no more [INT-10]."""
    text = (
        f"DEF main()\nINTERRUPT DECL 10 WHEN $IN[1] DO FOUND()\n{HOME}INTERRUPT ON 10\nSEARCH()\n"
        "PTP {A1 3}\nEND\nDEF SEARCH()\nTRIGGER WHEN DISTANCE=1 DELAY=0 DO $OUT[1]=TRUE\n"
        "PTP {A1 1}\nWAIT SEC 0\nEND\nDEF FOUND()\nBRAKE\nRESUME\nEND\n"
    )
    assert [(2.0, 1, True)] == go(text).outputs()
    assert [] == go(text, "t=1.5 IN[1]=TRUE").outputs()
