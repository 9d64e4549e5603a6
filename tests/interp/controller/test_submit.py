"""The submit interpreter: a second program on the same clock and data."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from interp.controller import Profile

Go = Callable[..., Any]

SPS = "DEF SPS()\n{}END\n"
CONFIG = {"$config.dat": "DEFDAT $CONFIG\nDECL INT COUNT=0\nENDDAT\n"}


def sub(body: str, **more: str) -> dict[str, str]:
    return {"sps.sub": SPS.format(body), **CONFIG, **more}


@pytest.mark.parametrize(("every", "passes"), [(1, 10), (4, 4)])
def test_slices(go: Go, every: int, passes: int) -> None:
    """It computes in slices: so many requests every so many cycles [SUB-03]."""
    profile = replace(Profile.load(), submit_every=every, submit_requests=10)
    files = sub("LOOP\nCOUNT=COUNT+1\n" + "$FLAG[1]=TRUE\n" * 10 + "ENDLOOP\n")
    text = "DEF main()\nINT I\nWAIT SEC 0.1\nI=COUNT\nEND\n"
    ran = go(text, files=files, submit="SPS", profile=profile)
    assert passes == ran.last("I")


def test_is_not_stopped_by_halt(go: Go) -> None:
    """It goes on while the robot's program halts [SUB-01]."""
    files = sub("LOOP\nCOUNT=COUNT+1\nWAIT SEC 0.1\nENDLOOP\n")
    text = "DEF main()\nINT I\nHALT\nI=COUNT\nEND\n"
    ran = go(text, "t=1 press START", files=files, submit="SPS")
    assert 10 == ran.last("I")
