"""Single motions to a nanometre and a microsecond; the cases state what each instruction does."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from interp.robot.kinematics.placement import IpoMode, Placement
from interp.values.faults import Fault
from interp.values.poses import Pose

if TYPE_CHECKING:
    from tests.interp.robot.conftest import Driver

POINT = {"X": 500.0, "Y": 100.0, "Z": 600.0, "A": 0.0, "B": 160.0, "C": 0.0}


# ---------------------------------------------------------------------------------------- LIN, CIRC


def test_wrist_axes_in_step(driver: Driver) -> None:
    """With #JOINT the wrist axes turn evenly while the tool keeps to its line [ORI-03]."""
    driver.move("PTP", POINT)
    driver.play()
    begin = driver.now
    tool = Pose.of(z=120.0, x=20.0)
    placement = Placement(tool=tool)
    start = placement.point(driver.arm.position(begin).flange)
    x, y, z, _, b, c = start.components
    target = {"X": x, "Y": y - 150.0, "Z": z, "A": 25.0, "B": b - 10.0, "C": c}
    driver.move("LIN", target, orientation="#JOINT", placement=placement, velocity=0.3)
    driver.play()
    times = np.linspace(begin, driver.now, 60).astype(np.int64)
    axes = driver.arm.sample(times).axes
    places = np.array(
        [placement.point(driver.arm.position(t).flange).position for t in times.tolist()]
    )
    share = (y - places[:, 1]) / 150.0
    assert np.allclose(places[:, [0, 2]], (x, z), atol=1e-6)
    assert np.allclose(axes[:, 3:6], axes[0, 3:6] + share[:, None] * (axes[-1] - axes[0])[3:6])
    driver.check_limits()


def test_fixed_tool(driver: Driver) -> None:
    """With #TCP the path is that of the base in the tool, a straight line there [ORI-07]."""
    driver.move("PTP", POINT)
    driver.play()
    begin = driver.now
    placement = Placement(
        base=Pose.of(700.0, 0.0, 500.0, 0, 90, 0), tool=Pose.of(z=80.0), mode=IpoMode.TCP
    )
    x, y, z, a, b, c = placement.point(driver.arm.position(begin).flange).components
    target = {"X": x + 30.0, "Y": y + 60.0, "Z": z - 40.0, "A": a + 20.0, "B": b, "C": c}
    driver.move("LIN", target, placement=placement, velocity=0.2)
    driver.play()
    times = np.linspace(begin, driver.now, 60).astype(int)
    points = [placement.point(driver.arm.position(int(t)).flange).inverse() for t in times]
    places = np.array([point.position for point in points])
    way = places[-1] - places[0]
    share = (places - places[0]) @ way / (way @ way)
    assert np.allclose(places[0] + share[:, None] * way, places, atol=1e-7)


# --------------------------------------------------------------------------------------- what it is


def test_what_was_travelled_is_known(driver: Driver) -> None:
    """Set-points of the past stay what they were, whatever is planned later."""
    driver.move("PTP", {"A1": 40.0}, criteria=("C_PTP",))
    times = np.arange(0, 100_000, 1000)
    before = driver.arm.sample(times).axes
    driver.play(until=100_000)
    driver.move("PTP", {"A2": -60.0})
    assert np.array_equal(before, driver.arm.sample(times).axes)


def test_undoing_what_was_planned(driver: Driver) -> None:
    """Undone, the arm is as it was, events and all."""
    driver.move("PTP", {"A1": 40.0}, criteria=("C_PTP",))
    rewind = driver.arm.mark()
    before, event = driver.arm.sample(np.arange(0, 10**6, 10**4)).axes, driver.arm.next_event()
    driver.move("PTP", {"A2": -60.0})
    rewind()
    assert np.array_equal(before, driver.arm.sample(np.arange(0, 10**6, 10**4)).axes)
    assert (event, 1) == (driver.arm.next_event(), driver.arm.pending())


# ------------------------------------------------------------------------------------------- faults


def test_through_a_straight_wrist(driver: Driver) -> None:
    """A path on which an axis would have to jump is refused at any speed."""
    driver.move("PTP", {"A4": 0.0, "A5": 0.0})
    driver.play()
    with pytest.raises(Fault) as caught:
        driver.move("LIN", {"Y": 100.0}, speed_type="#VAR_ALL")
    assert 1102 == caught.value.number
