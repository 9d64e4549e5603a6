"""Motions planned in batches, as in the paper, and what that costs."""

from collections.abc import Callable
from typing import Any

from interp.robot.api.batch import BatchCore

Go = Callable[..., Any]

HOME = "PTP {A1 0,A2 0,A3 0,A4 0,A5 0,A6 0}\n"


def program(body: str) -> str:
    """A program with its first motion and a body."""
    return f"DEF main()\nINT I\n{HOME}{body}END\n"


def test_batch_is_longer_than_the_advance_run(go: Go) -> None:
    """However long a chain of approximated motions is, it is one batch."""
    body = "FOR I=1 TO 9\nPTP {A1 1} C_PTP\nENDFOR\nPTP {A1 2}\n"
    ran = go(program(body), core=BatchCore)
    assert [0.0] * 11 == ran.times("motion_planned")
    assert 9 == len(ran.events_of("blend_apex"))
    assert [11.0] == ran.times("end")


def test_a_batch_that_might_never_end_goes(go: Go) -> None:
    """A loop over approximated motions moves the arm: a batch has at most 256 of them."""
    body = "LOOP\nPTP {A1 1} C_PTP\nENDLOOP\n"
    ran = go(program(body), until=5.0, core=BatchCore)
    assert [0.0, 1.0, 2.0, 3.0, 4.0, 5.0] == ran.times("motion_start")
    assert 1 + 256 == len(ran.times("motion_planned"))


def test_output_in_step(go: Go) -> None:
    """$OUT_C belongs to the motion before it, even if that is still held back [ADV-11]."""
    ran = go(program("PTP {A1 1} C_PTP\n$OUT_C[1]=TRUE\nPTP {A1 2}\n"), core=BatchCore)
    assert [(2.0, 1, True)] == ran.outputs()
