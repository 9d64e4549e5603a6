"""Circles through three points, and the faults of points that make none."""

import math
from typing import Any

import numpy as np
import pytest

from interp.robot.path.circle import circle_through
from interp.values.faults import Fault

START, MIDDLE, END = (np.array(p) for p in ((0.0, 0.0, 5.0), (10.0, 10.0, 5.0), (20.0, 0.0, 5.0)))


def test_through_three_points() -> None:
    """The arc starts, passes and ends at its points, on the radius around its centre."""
    circle = circle_through(START, MIDDLE, END)
    assert [10.0, 0.0, 5.0] == pytest.approx(circle.centre)
    places = circle.at(np.array([0.0, 0.5, 1.0]))
    assert np.allclose(places, (START, MIDDLE, END), atol=1e-12)
    assert 10 * math.pi == pytest.approx(circle.length)


@pytest.mark.parametrize(
    ("degrees", "place"),
    [
        (90.0, (10.0, 10.0)),
        (180.0, (20.0, 0.0)),
        (270.0, (10.0, -10.0)),
        (450.0, (10.0, 10.0)),
        (-90.0, (10.0, -10.0)),
        (-450.0, (10.0, -10.0)),
    ],
)
def test_an_angle_of_its_own(degrees: float, place: tuple[float, float]) -> None:
    """A positive angle goes the way of the auxiliary point, a negative one the other [MOT-13]."""
    circle = circle_through(START, MIDDLE, END, degrees)
    assert (*place, 5.0) == pytest.approx(circle.at(np.ones(1))[0])
    assert math.radians(abs(degrees)) * 10 == pytest.approx(circle.length)


def test_where_the_programmed_end_is() -> None:
    """The programmed end lies on the circle, the way the arm goes round."""
    assert math.pi == pytest.approx(circle_through(START, MIDDLE, END, 90.0).programmed)
    assert -math.pi == pytest.approx(circle_through(START, MIDDLE, END, -90.0).programmed)


@pytest.mark.parametrize(
    ("points", "number"),
    [
        ((START, MIDDLE, START), 1456),
        ((START, START, END), 1457),
        ((START, END, END), 1458),
        ((START, (START + END) / 2, END), 1506),
    ],
)
def test_degenerate(points: Any, number: int) -> None:
    """Each way of giving no circle has its message [MOT-12]."""
    with pytest.raises(Fault) as caught:
        circle_through(*points)
    assert number == caught.value.number


@pytest.mark.parametrize("degrees", [math.nan, math.inf])
def test_an_angle_that_is_no_number(degrees: float) -> None:
    """No motion comes of an angle that is no number."""
    with pytest.raises(Fault) as caught:
        circle_through(START, MIDDLE, END, degrees)
    assert 1506 == caught.value.number
