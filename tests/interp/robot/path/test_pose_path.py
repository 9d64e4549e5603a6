"""Paths of poses: how far it is along them, and back from the way to the place."""

import math

import numpy as np
import pytest

from interp.robot.path.arc_length import ArcLength
from interp.robot.path.circle import circle_through
from interp.robot.path.orientation import turning
from interp.robot.path.pose_path import Blend, Line, OrientedPath, PosePath
from interp.robot.path.transition import Rounding

STILL = turning(np.eye(3), np.eye(3))
FIRST = OrientedPath(Line(np.zeros(3), np.array([100.0, 0.0, 0.0])), STILL)
SECOND = OrientedPath(Line(np.array([100.0, 0.0, 0.0]), np.array([100.0, 50.0, 0.0])), STILL)
ARC = OrientedPath(
    circle_through(
        np.array([100.0, 0.0, 0.0]), np.array([150.0, 50.0, 0.0]), np.array([100.0, 100.0, 0.0])
    ),
    STILL,
)
PATHS = [
    FIRST,
    ARC,
    Blend(FIRST, SECOND, Rounding(0.3, 0.5, (30.0, 50.0), 1.0)),
    Blend(FIRST, ARC, Rounding(0.2, 0.4, (20.0, 60.0), 2.0)),
]


@pytest.mark.parametrize("pose_path", PATHS, ids=lambda pose_path: type(pose_path).__name__)
def test_way_and_tangents(pose_path: PosePath) -> None:
    """The way is the length of the curve, and tangents are its derivative."""
    u = np.linspace(0.0, 1.0, 20001)
    places, _ = pose_path.at(u)
    chords = np.concatenate(([0.0], np.cumsum(np.linalg.norm(np.diff(places, axis=0), axis=1))))
    assert np.allclose(chords, ArcLength(pose_path.tangents).at(u), atol=1e-4)
    assert np.allclose(np.gradient(places, u, axis=0)[1:-1], pose_path.tangents(u)[1:-1], atol=1e-3)


@pytest.mark.parametrize("pose_path", PATHS, ids=lambda pose_path: type(pose_path).__name__)
def test_from_the_way_to_the_place(pose_path: PosePath) -> None:
    """The parameter at a length has that length before it."""
    way = ArcLength(pose_path.tangents)
    lengths = np.linspace(0.0, way.length, 57)
    assert np.allclose(lengths, way.at(way.parameters(lengths)), atol=1e-9)


def test_a_rounded_corner_is_nearly_a_parabola() -> None:
    """Its apex is that of the parabola with the same ends, all of it within 0.3 per cent."""
    other = OrientedPath(Line(np.array([100.0, 0.0, 0.0]), np.array([100.0, 100.0, 0.0])), STILL)
    corner = Blend(FIRST, other, Rounding(0.4, 0.4, (40.0, 40.0), 1.0))
    places, _ = corner.at(np.linspace(0.0, 1.0, 101))
    assert (90.0, 10.0) == pytest.approx(tuple(places[50, :2]))
    roots = np.sqrt(100.0 - places[:, 0]) + np.sqrt(places[:, 1])
    beside = np.abs(roots - math.sqrt(40.0)) * np.sqrt(
        np.minimum(100.0 - places[:, 0], places[:, 1])
    )
    assert 0.003 * 40.0 > beside.max()


def test_a_way_that_turns_back() -> None:
    """Where a line goes back on itself the blend does too, and its way is that of both legs."""
    back = OrientedPath(Line(np.array([100.0, 0.0, 0.0]), np.zeros(3)), STILL)
    blend = Blend(FIRST, back, Rounding(0.4, 0.4, (40.0, 40.0), 1.0))
    places, _ = blend.at(np.array([0.0, 0.5, 1.0]))
    assert [60.0, 80.0, 60.0] == pytest.approx(places[:, 0])
    assert 40.0 == pytest.approx(ArcLength(blend.tangents).length, rel=1e-6)
