"""Each law of what a block does along its path is broken by a run that breaks it."""

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import Final

import pytest

from conformance.evaluation import blend_laws, block_laws
from conformance.evaluation.execution import Setup, observe
from conformance.evaluation.laws import Run
from conformance.evaluation.observation import Observation
from conformance.suite.case import Case
from grammar.syntax.source import Source
from interp.robot.arm import Motion

_BLOCKS: Final = """DEF a()
  $TOOL = $NULLFRAME
  $BASE = $NULLFRAME
  PTP {A1 0, A2 -90, A3 90, A4 0, A5 90, A6 0}
  $VEL.CP = 0.2
  SPLINE
    SLIN {X 445, Y 100, Z 890}
    TIME_BLOCK START
    SLIN {X 445, Y 0, Z 890}
    TIME_BLOCK PART = 50
    SLIN {X 445, Y -50, Z 890}
    TIME_BLOCK PART = 50
    TIME_BLOCK END = 3
  ENDSPLINE
  SPLINE
    SLIN {X 445, Y 0, Z 890}
    CONST_VEL START = 20 ONSTART
    SLIN {X 445, Y 100, Z 890}
    CONST_VEL END = -20
  ENDSPLINE
  SPLINE
    SLIN {X 445, Y 50, Z 890}
    SLIN {X 445, Y 0, Z 890}
    STOP WHEN PATH = -20 IF $IN[1]
    SLIN {X 445, Y -50, Z 890}
  ENDSPLINE
END
"""
_CORNERS: Final = """DEF a()
  $TOOL = $NULLFRAME
  $BASE = $NULLFRAME
  PTP {A1 0, A2 -90, A3 90, A4 0, A5 90, A6 0}
  $VEL.CP = 0.2
  LIN {Y 100} C_VEL
  LIN {X 345}
  $ACC_AXIS[1] = 5
  $ACC_AXIS[2] = 5
  $APO.CPTP = 25
  PTP {A1 0, A2 -90, A3 90, A4 0, A5 90, A6 0}
  PTP {A1 80} C_PTP
  PTP {A2 0}
END
"""


@cache
def seen(program: str) -> Observation:
    """A run whose input 1 is TRUE for a while."""
    source = Source(program, "a.src")
    path: object = None
    case = Case("s/a", path, "t", ("CTL-01",), "run", "kss8", (source,), ())  # type: ignore[arg-type]
    case = replace(case, io=("t=0 IN[1]=TRUE", "t=20 IN[1]=FALSE"))
    return observe(case, Setup("tree", "kinematic"))


def broken(program: str, change: Callable[[Motion], Motion]) -> list[str]:
    """What is broken, as if other motions had been programmed."""
    run = seen(program)
    assert "end" == run.ending
    assert run.path is not None
    motions = tuple((time, change(motion)) for time, motion in run.path.motions)
    judged = Run(replace(run, path=replace(run.path, motions=motions)))
    laws = block_laws.LAWS, blend_laws.QUICK_LAWS
    return [one.law for each in laws for one in each.broken(judged)]


@pytest.mark.parametrize("program", [_BLOCKS, _CORNERS])
def test_a_right_run_breaks_none(program: str) -> None:
    """It has ranges, a stop and corners."""
    assert [] == broken(program, lambda motion: motion)


def _longer(motion: Motion) -> Motion:
    ranges = (replace(mark, value=4.0) for mark in motion.ranges if mark.keyword == "TIME_BLOCK")
    return replace(motion, ranges=tuple(ranges) or motion.ranges)


def _elsewhere(motion: Motion) -> Motion:
    ranges = (replace(mark, value=0.0) for mark in motion.ranges if mark.keyword == "CONST_VEL")
    return replace(motion, ranges=tuple(ranges) or motion.ranges)


def _without_stop(motion: Motion) -> Motion:
    return replace(motion, parts=tuple(replace(part, stop_places=()) for part in motion.parts))


@pytest.mark.parametrize(
    ("change", "law"),
    [(_longer, "TIME_BLOCK"), (_elsewhere, "CONST_VEL"), (_without_stop, "STOP WHEN PATH")],
)
def test_a_block_keeps_to_its_ranges_and_stops(
    change: Callable[[Motion], Motion], law: str
) -> None:
    """A part that has to take longer, a range up to the end, a stop that is not written."""
    assert any(law in one for one in broken(_BLOCKS, change))


def _faster(motion: Motion) -> Motion:
    settings = replace(
        motion.settings, velocity=3.0, acceleration=50.0, axis_acceleration=(100.0,) * 12
    )
    return replace(motion, settings=settings)


def test_a_blend_is_as_quick_as_its_limits() -> None:
    """With larger ones it is too slow, between PTP."""
    assert ["a blend is no slower than an axis or the path makes it"] == broken(_CORNERS, _faster)
