"""Motions planned in batches, as in the paper, and what that costs."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from interp.controller.state.profile import Profile
from interp.robot.api.batch import BatchCore

Go = Callable[..., Any]

HOME = "PTP {A1 0,A2 0,A3 0,A4 0,A5 0,A6 0}\n"


def program(body: str) -> str:
    """A program with its first motion and a body."""
    return f"DEF main()\nINT I\n{HOME}{body}END\n"


def test_batch_waits_for_its_last_motion(go: Go) -> None:
    """A batch goes when a motion comes that is not approximated; all its blends are there."""
    body = "PTP {A1 1} C_PTP\nWHILE NOT $FLAG[1]\nENDWHILE\nPTP {A1 2}\n"
    script = "t=1.5 FLAG[1]=TRUE"
    profile = replace(Profile.load(), requests=2)  # of the loop in each cycle
    ahead = go(program(body), script, profile=profile)
    batch = go(program(body), script, profile=profile, core=BatchCore)
    assert [0.0, 1.0, 2.0] == ahead.times("motion_start")
    assert [0.0, 1.5, 2.5] == batch.times("motion_start")
    assert [2.0] == ahead.times("blend_apex")
    assert [2.5] == batch.times("blend_apex")


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


def test_advance_stop_lets_it_go(go: Go) -> None:
    """What stops the advance run ends a batch: its last point is exact [ADV-04]."""
    ran = go(program("PTP {A1 1} C_PTP\n$OUT[1]=TRUE\nPTP {A1 2} C_PTP\n"), core=BatchCore)
    assert [(2.0, 1, True)] == ran.outputs()
    assert [1442, 1442] == ran.messages()
    assert [3.0] == ran.times("end")


def test_output_in_step(go: Go) -> None:
    """$OUT_C belongs to the motion before it, even if that is still held back [ADV-11]."""
    ran = go(program("PTP {A1 1} C_PTP\n$OUT_C[1]=TRUE\nPTP {A1 2}\n"), core=BatchCore)
    assert [(2.0, 1, True)] == ran.outputs()


def test_fault_is_found_late(go: Go) -> None:
    """A point that cannot be reached is found when the batch goes, and nothing of it moves."""
    ran = go(program("PTP {A1 500} C_PTP\nI=1\nPTP {A1 2}\n"), core=BatchCore)
    assert ([1447], 1) == (ran.messages(), ran.last("I"))
    assert [1] == [one.fields["motion"] for one in ran.events_of("motion_start")]
