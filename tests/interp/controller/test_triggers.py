"""TRIGGER: outputs with exact timing, routines with a priority, and where there may be none."""

from collections.abc import Callable
from typing import Any

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
