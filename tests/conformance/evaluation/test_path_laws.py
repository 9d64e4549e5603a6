"""Each law of a path is broken by a path that breaks it, and by no other."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from conformance.evaluation.evaluator import evaluate
from conformance.evaluation.laws import Run, Violation
from conformance.evaluation.observation import Event, Observation
from conformance.evaluation.path_laws import LAWS
from conformance.suite.case import Case
from grammar.syntax.source import Source
from interp.robot.models import default_machine
from interp.robot.simulation.tracking import PathRecord

CYCLE = 12_000
COUNT = 101
STILL = np.tile((0.0, -90.0, 90.0, 0.0, 90.0, 0.0), (COUNT, 1))
TIMES = np.arange(COUNT, dtype=np.int64) * CYCLE


def seen(kind: str, points: Any = None, axes: Any = None) -> Observation:
    """A run of one motion that lasts from the first to the last row of its path."""
    rows = np.zeros((COUNT, 6))
    if points is not None:
        rows[:, :3] = points
    path = PathRecord(TIMES, STILL if axes is None else axes, rows, rows[:, :3], None, None, None)
    ends = (("motion_start", 0), ("motion_end", int(TIMES[-1])))
    events = [
        Event(time, "robot", name, "a.src", 3, {"motion": 1, "motion_kind": kind})
        for name, time in ends
    ]
    return Observation(events=tuple(events), path=path, machine=default_machine())


def path_violations(run: Observation) -> list[Violation]:
    return list(LAWS.broken(Run(run)))


def turned(turn: Any) -> list[str]:
    """The rules that are broken where axis 1 turns so, in degrees by seconds."""
    axes = STILL.copy()
    axes[:, 0] = turn(TIMES / 1e6)
    return [one.rule for one in path_violations(seen("PTP", axes=axes))]


def test_a_path_keeps_the_limits_of_the_axes() -> None:
    """Axis 1 does 360 degrees a second, 1,200 a second squared, and 170 degrees either way."""
    assert [] == turned(lambda t: -np.cos(2 * t) * 80)
    assert ["MOT-06"] == turned(lambda t: -160 + 400 * t * (t < 0.8) + 320 * (t >= 0.8))[:1]
    assert ["MOT-02", ""] == turned(lambda t: 0.5 * (t > 0.5))
    assert ["MOT-15"] == turned(lambda t: 160 + 12 * np.sin(t))


def test_a_path_keeps_the_jerk_of_the_axes() -> None:
    """Axis 1 does 12,000 degrees a second cubed, which is machine data and no rule of KRL."""
    assert [] == turned(lambda t: 10 * np.cos(10 * t))
    assert [""] == turned(lambda t: 2 * np.cos(20 * t))


@pytest.mark.parametrize(("until", "count"), [(COUNT, 0), (COUNT - 9, 1)])
def test_the_arm_stands_between_motions(until: int, count: int) -> None:
    """It moves while its motion is under way, and not behind it."""
    axes = STILL.copy()
    axes[:, 0] = 10 * np.sin(TIMES / 1e6)
    first, last = seen("PTP", axes=axes).events
    ends = (
        first,
        replace(last, time=int(TIMES[until - 1])),
        Event(2_000_000, "robot", "end", "", 0),
    )
    found = path_violations(replace(seen("PTP", axes=axes), events=ends))
    assert count == sum(one.law.startswith("the arm stands") for one in found)


ANGLES = np.linspace(0.0, 2.0, COUNT)
RING = np.stack((100 * np.cos(ANGLES), 100 * np.sin(ANGLES), 0 * ANGLES), axis=1)
LINE = np.linspace((0.0, 0.0, 0.0), (100.0, 0.0, 0.0), COUNT)
BULGE = np.sin(np.linspace(0.0, np.pi, COUNT))[:, None]


@pytest.mark.parametrize(
    ("kind", "points", "law"),
    [
        ("LIN", LINE, ""),
        ("LIN_REL", LINE + BULGE * 0.003, "the path of a LIN is a line"),
        ("SLIN", RING, "the path of a LIN is a line"),
        ("CIRC", RING, ""),
        ("SCIRC", RING + BULGE**2 * (0.0, 0.0, 0.02), "the path of a CIRC is a circle"),
        ("SPLINE", RING + BULGE, ""),
    ],
)
def test_a_motion_has_its_shape(kind: str, points: Any, law: str) -> None:
    """Lines are straight, circles are round; a spline has a shape of its own."""
    assert [law] * bool(law) == [one.law for one in path_violations(seen(kind, points))]


def _late() -> Observation:
    """A PTP of which one axis comes too late."""
    share = np.linspace(0.0, 1.0, COUNT)
    axes = STILL.copy()
    axes[:, 0], axes[:, 5] = 20 * share, 10 * share**1.0003
    return seen("PTP", axes=axes)


def test_a_motion_is_synchronous() -> None:
    """An axis that comes too late breaks an unconfirmed clause."""
    share = np.linspace(0.0, 1.0, COUNT)
    axes = STILL.copy()
    axes[:, 0], axes[:, 5] = 20 * share, 10 * share
    assert [] == [*path_violations(seen("PTP", axes=axes))]
    assert ["MOT-01.b"] == [one.rule for one in path_violations(_late())][-1:]


def test_a_broken_law_fails_every_case_unless_its_clause_is_unconfirmed() -> None:
    """It is told at the line of the motion under way, whatever the case is about."""
    source = Source("DEF a()\nEND\n", "a.src")
    path: Any = None
    case = Case("s/a", path, "t", ("CTL-01",), "run", "kss8", (source,), ())
    bent = seen("LIN", LINE + BULGE * 0.2)
    unmet = [
        [(one.basis, one.line, one.is_sure) for one in evaluate(case, each) if one.state == "unmet"]
        for each in (bent, _late())
    ]
    assert [[("", 3, True)], [("MOT-01.b", 3, False)]] == [found[-1:] for found in unmet]
