"""The orientation along a path: swivel and rotation."""

import math
from itertools import pairwise

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from interp.robot.path.orientation import Carried, rotations_about, turning
from interp.values.poses import Pose

ENDS = np.array([0.0, 1.0])


def rotation(a: float, b: float, c: float) -> np.ndarray:
    return np.array(Pose.of(a=a, b=b, c=c).rows)[:, :3]


def test_it_starts_and_ends_as_given() -> None:
    """Between any two rotations, both ends are met."""
    many = Rotation.random(100, rng=5).as_matrix()
    for one, other in pairwise(many):
        assert np.allclose(turning(one, other).at(ENDS), (one, other), atol=1e-12)


def test_the_tool_direction_takes_the_shortest_way() -> None:
    """Half-way the tool's direction lies half-way on the great circle [ORI-06]."""
    one, other = rotation(10, 20, 30), rotation(80, -40, 170)
    turned = turning(one, other)
    (half,) = turned.at(np.array([0.5]))
    middle = one[:, 0] + other[:, 0]
    assert np.allclose(half[:, 0], middle / np.linalg.norm(middle), atol=1e-12)
    assert math.acos(one[:, 0] @ other[:, 0]) == pytest.approx(turned.swivel)


def test_rotation_about_the_tool_direction() -> None:
    """A change of C alone is rotation, and no swivel."""
    turned = turning(rotation(10, 20, 30), rotation(10, 20, -45))
    assert (0.0, math.radians(75)) == pytest.approx((turned.swivel, turned.rotation))


@pytest.mark.parametrize("change", [(70, 0, 0), (0, 50, 0), (0, 0, 60)])
def test_one_angle_is_one_even_turn(change: tuple[float, float, float]) -> None:
    """Where only one angle changes, the orientation turns about one axis at an even rate."""
    one, other = rotation(0, 0, 0), rotation(*change)
    turned = one.T @ np.array([*turning(one, other).at(np.linspace(0, 1, 5)), other])
    angles = Rotation.from_matrix(turned).magnitude()
    assert np.allclose(angles[:-1], np.linspace(0, angles[-1], 5), atol=1e-12)


def test_a_tool_that_is_reversed() -> None:
    """Where no way is the shortest one is taken, and the end is met."""
    one, other = rotation(0, 0, 0), rotation(180, 0, 40)
    turned = turning(one, other)
    assert math.pi == pytest.approx(turned.swivel)
    assert np.allclose(turned.at(ENDS), (one, other), atol=1e-12)


def test_beyond_the_end() -> None:
    """An extent of three goes three times as far, the same way [MOT-13]."""
    one, other = rotation(0, 0, 0), rotation(30, 0, 0)
    assert np.allclose(turning(one, other, 3.0).at(ENDS)[1], rotation(90, 0, 0), atol=1e-12)


def test_carried_by_a_circle() -> None:
    """What is told in the frame of a path turns with it [ORI-04]."""
    start, axis = rotation(0, 90, 0), np.array([0.0, 0.0, 1.0])
    carried = Carried(turning(start, start), axis, math.pi / 2)
    assert np.allclose(
        carried.at(ENDS)[1], rotations_about(axis, np.array([math.pi / 2]))[0] @ start
    )
