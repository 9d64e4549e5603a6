"""Places of a path, and when they are passed: what triggers are about."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from interp.robot.arm import Approximation, Place

if TYPE_CHECKING:
    from tests.interp.robot.conftest import Driver

FIRST = {"X": 500.0, "Y": 200.0, "Z": 600.0, "A": 0.0, "B": 160.0, "C": 0.0}
SECOND = {**FIRST, "Y": -100.0}
THIRD = {**SECOND, "X": 300.0}
NEAR = {"approximation": Approximation(cdis=40.0), "velocity": 0.5}


def line(driver: Driver, *places: Place) -> int:
    """A line of 300 mm between exact stops; returns when it begins."""
    driver.move("PTP", FIRST)
    driver.play()
    begin = driver.now
    driver.move("LIN", SECOND, places=places, **NEAR)
    driver.play()
    return begin


def blended(driver: Driver, *places: Place) -> None:
    """A line with places between two others, blended on both sides."""
    driver.move("PTP", FIRST)
    driver.play()
    driver.move("LIN", SECOND, criteria=("C_DIS",), **NEAR)
    driver.move("LIN", THIRD, criteria=("C_DIS",), places=places, **NEAR)
    driver.move("LIN", {**THIRD, "Z": 700.0}, **NEAR)
    driver.play()


def test_millimetres_along_a_blend(driver: Driver) -> None:
    """On a blend, PATH counts the way that the tool really takes."""
    blended(driver, Place(1, "PATH", -15.0), Place(2, "PATH", 15.0))
    times = [driver.time("place", 3, key) for key in (1, 2)]
    apex = driver.time("blend_apex", 3)
    for start, end in ((times[0], apex), (apex, times[1])):
        places = np.array([driver.tool(int(t)) for t in np.linspace(start, end, 400)])
        assert 15.0 == pytest.approx(
            float(np.linalg.norm(np.diff(places, axis=0), axis=1).sum()), abs=1e-2
        )


def test_places_and_ends_in_their_order(driver: Driver) -> None:
    """At one time the start comes first, then what lies there, and the end last."""
    line(driver, Place(1, "DISTANCE", 0.0), Place(2, "DISTANCE", 1.0))
    kinds = [(event.kind, event.key) for event in driver.events if event.motion == 2]
    assert [("motion_start", None), ("place", 1), ("place", 2), ("motion_end", None)] == kinds


def test_a_place_moves_with_the_plan(driver: Driver) -> None:
    """When the override changes, the places ahead get another time, and those behind do not."""
    driver.move("PTP", FIRST)
    driver.play()
    begin = driver.now
    driver.move("LIN", SECOND, places=(Place(1, "PATH", -250.0), Place(2, "PATH", -30.0)), **NEAR)
    driver.play(until=begin + 400_000)
    early = driver.time("place", 2, 1)
    driver.arm.override(driver.now, 20.0)
    driver.play()
    assert early == driver.time("place", 2, 1)
    assert -70.0 == pytest.approx(driver.tool(driver.time("place", 2, 2))[1], abs=1e-3)


def test_no_place_beyond_a_brake(driver: Driver) -> None:
    """A place that the arm does not come to is not passed before it goes on."""
    driver.move("PTP", FIRST)
    driver.play()
    begin = driver.now
    driver.move("LIN", SECOND, places=(Place(1, "PATH", -30.0),), **NEAR)
    driver.play(until=begin + 200_000)
    driver.arm.brake(driver.now, False)
    driver.play()
    assert "place" not in {event.kind for event in driver.events}
    driver.arm.proceed(driver.now + 10_000)
    driver.play()
    assert -70.0 == pytest.approx(driver.tool(driver.time("place", 2, 1))[1], abs=1e-3)
