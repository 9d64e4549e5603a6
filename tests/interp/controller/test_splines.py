"""Spline blocks and WITH as the controller hands them to the arm."""

from collections.abc import Callable
from typing import Any

import pytest

Go = Callable[..., Any]

HOME = "PTP {A1 0,A2 0,A3 0,A4 0,A5 0,A6 0}\n"
FRAMES = "$BASE=$NULLFRAME\n$TOOL=$NULLFRAME\n"


def program(body: str, before: str = HOME) -> str:
    """A program with its frames, its first motion, and a body."""
    return f"DEF main()\n{FRAMES}{before}{body}END\n"


def planned(ran: Any) -> list[Any]:
    """All motions that the arm was given."""
    return [motion for _, motion in ran.arm.queue.motions]


def test_block_is_one_motion(go: Go) -> None:
    """A block is planned and executed as one motion [SPL-01]."""
    ran = go(program("SPLINE\nSPL {X 1}\nSLIN {X 2}\nSCIRC {X 3},{X 4}\nENDSPLINE C_SPL\n"))
    block = planned(ran)[1]
    assert ("SPLINE", ("C_SPL",)) == (block.kind, block.criteria)
    assert [("SPL", None), ("SLIN", None), ("SCIRC", {"X": 3.0})] == [
        (part.kind, part.auxiliary) for part in block.parts
    ]
    assert ["PTP", "SPLINE"] == [one.fields["motion_kind"] for one in ran.events_of("motion_start")]


def test_values_of_one_motion(go: Go) -> None:
    """What stands behind WITH holds for its motion or segment only [SPL-08]."""
    ran = go(
        program(
            "SLIN {X 1} WITH $VEL.CP=0.5\nSLIN {X 2}\n"
            "SPLINE WITH $VEL.CP=0.25\nSLIN {X 3}\nSLIN {X 4} WITH $VEL.CP=0.125\nENDSPLINE\n"
        )
    )
    _, first, second, block = planned(ran)
    assert (0.5, 2.0, 0.25) == tuple(one.settings.velocity for one in (first, second, block))
    assert [0.25, 0.125] == [part.settings.velocity for part in block.parts]
    assert 2.0 == ran.controller.variables.read(("$VEL", "CP"))


def test_value_of_the_main_run(go: Go) -> None:
    """A value behind WITH is what the main run has while the motion runs [ADV-10, SPL-08]."""
    ran = go(program("SLIN {X 1} WITH $VEL.CP=0.5\nWAIT SEC 0\n"))
    assert 0.5 == ran.value("$VEL_C", "CP")


def test_place_from_the_start(go: Go) -> None:
    """ONSTART counts a PATH from the start of its segment [SPL-07]."""
    ran = go(
        program(
            "SPLINE\nSPL {X 1}\nTRIGGER WHEN PATH=5 ONSTART DELAY=7 DO $OUT[1]=TRUE\nSPL {X 2}\n"
            "ENDSPLINE\n"
        )
    )
    place = planned(ran)[1].parts[1].places[0]
    assert ("PATH", 5.0, True, 7000) == (place.kind, place.position, place.on_start, place.delay)


def test_ranges(go: Go) -> None:
    """CONST_VEL and TIME_BLOCK go to the segment behind them, the last to the block [SPL-05]."""
    ran = go(
        program(
            "SPLINE\nCONST_VEL START=5 ONSTART\nSPL {X 1}\nSPL {X 2}\nCONST_VEL END=-5\nENDSPLINE\n"
        )
    )
    block = planned(ran)[1]
    first = block.parts[0].ranges[0]
    assert ("CONST_VEL", "START", 5.0, True) == (
        *(first.keyword, first.edge, first.value, first.on_start),
    )
    assert ["END"] == [one.edge for one in block.ranges]


@pytest.mark.parametrize(
    ("block", "ending"),
    [
        ("SPLINE\nSLIN {X 1}\nENDSPLINE\n", "fault"),
        ("PTP_SPLINE\nSPTP {A1 1}\nENDSPLINE\n", "fault"),
        ("PTP_SPLINE\nSPTP {A1 0,A2 0,A3 0,A4 0,A5 0,A6 0}\nENDSPLINE\n", "end"),
    ],
)
def test_first_block(go: Go, block: str, ending: str) -> None:
    """A block may be the first motion if its first segment leaves nothing open [MOT-10]."""
    assert ending == go(program(block, "")).outcome.ending
