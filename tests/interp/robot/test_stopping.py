"""Braking on the path, going on, forgetting the rest, and the override."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from interp.robot.arm import Approximation
from interp.values.faults import Fault
from tests.interp.robot.conftest import Driver
from tests.interp.robot.test_random_motions import do

if TYPE_CHECKING:
    from interp.robot.kinematics.machine_data import MachineData

FIRST = {"X": 500.0, "Y": 200.0, "Z": 600.0, "A": 0.0, "B": 160.0, "C": 0.0}
SECOND = {**FIRST, "Y": -100.0}
THIRD = {**SECOND, "X": 400.0}
APART = [50_000, 300_000, 420_000, 640_000, 800_000, 1_000_000]


@pytest.fixture
def moving(driver: Driver) -> Driver:
    """Two lines with a blend between them, just begun, and a PTP behind them."""
    driver.move("PTP", FIRST)
    driver.play()
    near = {"approximation": Approximation(cdis=40.0, cptp=20), "velocity": 0.5}
    driver.move("LIN", SECOND, criteria=("C_DIS",), **near)
    driver.move("LIN", THIRD, criteria=("C_DIS",), **near)
    driver.move("PTP", {**THIRD, "Z": 500.0})
    return driver


def rehearsed(driver: Driver) -> np.ndarray:
    """The path as it is when nothing disturbs it; then all is as before."""
    rewind, begin, events = driver.arm.mark(), driver.now, list(driver.events)
    driver.play()
    path = geometry(driver, begin)
    rewind()
    driver.now, driver.events = begin, events
    return path


def geometry(driver: Driver, start: int) -> np.ndarray:
    """The places of the tool from a time to now, without those where it stands."""
    axes = driver.arm.sample(np.arange(start, driver.now + 1, 2000)).axes
    kept = np.append(True, np.abs(np.diff(axes, axis=0)).max(axis=1) > 0)
    places = driver.arm._tracks.arm.forward(axes[kept, :6])[:, :3, 3]
    assert isinstance(places, np.ndarray)
    return places


def distance(places: np.ndarray, path: np.ndarray) -> float:
    """How far the places are at most from a polygon through a path."""
    starts, ways = path[:-1], np.diff(path, axis=0)
    lengths = np.maximum((ways * ways).sum(axis=1), 1e-12)
    share = ((places[:, None] - starts) * ways).sum(axis=2) / lengths
    feet = starts + np.clip(share, 0, 1)[:, :, None] * ways
    return float(np.linalg.norm(places[:, None] - feet, axis=2).min(axis=1).max())


@pytest.mark.parametrize("is_hard", [False, True])
@pytest.mark.parametrize("after", APART)
def test_braking_stays_on_the_path(moving: Driver, after: int, is_hard: bool) -> None:
    """Wherever the brake comes, the arm stops on its path and goes on along it [INT-09]."""
    begin, path = moving.now, rehearsed(moving)
    moving.play(until=begin + after)
    moving.arm.brake(moving.now, is_hard)
    moving.play()
    assert "stopped" == moving.events[-1].kind
    stood = moving.now
    assert 0.0 == pytest.approx(moving.arm.speed(stood), abs=1e-6)
    moving.now += 500_000
    moving.arm.proceed(moving.now)
    moving.play()
    assert moving.time("motion_end", 4) > stood
    assert distance(geometry(moving, begin), path) < 0.01
    moving.check_limits()


def test_braking_at_rest(driver: Driver) -> None:
    """An arm that stands is told to have stopped at once."""
    driver.move("PTP", FIRST)
    driver.play()
    driver.arm.brake(driver.now, False)
    event = driver.arm.next_event()
    assert event is not None
    assert ("stopped", driver.now) == (event.kind, event.time)


def test_moving_after_a_brake_before_the_first_motion(driver: Driver) -> None:
    """An arm that never moved can be braked and then moved."""
    driver.arm.brake(0, False)
    driver.move("PTP", {"A1": 10.0})
    driver.play()
    assert 10.0 == driver.arm.position(driver.now).axes[0]


@pytest.mark.parametrize("is_hard", [None, False, True])
@pytest.mark.parametrize("has_next", [False, True])
def test_stopping_again_before_it_stands(
    moving: Driver, has_next: bool, is_hard: bool | None
) -> None:
    """Who stops already is not stopped sooner, whatever was planned meanwhile."""
    moving.play(until=moving.now + 420_000)
    moving.arm.discard(moving.now)
    stop = moving.arm.path()[-1].ends
    if has_next:
        moving.move("PTP", FIRST)
    moving.now += 20_000
    if is_hard is None:
        moving.arm.discard(moving.now)
    else:
        moving.arm.brake(moving.now, is_hard)
    assert stop == moving.arm.path()[-1].ends
    moving.play()
    moving.check_limits()


def test_going_on_before_it_stands(moving: Driver) -> None:
    """Who goes on while the arm brakes finds it on its path, still moving."""
    moving.play(until=moving.now + 300_000)
    moving.arm.brake(moving.now, False)
    moving.play(until=moving.now + 60_000)
    moving.arm.proceed(moving.now)
    moving.play()
    assert "stopped" not in {event.kind for event in moving.events}
    moving.check_limits()


def test_moving_while_braked(moving: Driver) -> None:
    """Between brake and going on the arm can be moved about, and comes back to go on [INT-09]."""
    moving.play(until=moving.now + 300_000)
    moving.arm.brake(moving.now, False)
    moving.play()
    left = moving.arm.position(moving.now)
    away = dict(zip(("A1", "A2", "A3", "A4", "A5", "A6"), left.axes, strict=False))
    moving.move("LIN", {"Z": 30.0}, is_relative=True)
    moving.play()
    assert left.flange.position[2] + 30.0 == pytest.approx(moving.tool(moving.now)[2])
    with pytest.raises(ValueError, match="not where the brake has left it"):
        moving.arm.proceed(moving.now)
    moving.move("PTP", away)
    moving.play()
    moving.arm.proceed(moving.now)
    moving.play()
    assert moving.time("motion_end", 2) > moving.time("motion_end", 6)
    assert (400.0, -100.0, 500.0) == pytest.approx(moving.tool(moving.now))
    moving.check_limits()


@pytest.mark.parametrize("is_moving", [False, True])
def test_a_brake_within_a_brake(moving: Driver, is_moving: bool) -> None:
    """Each brake holds what it interrupted; going on undoes the latest of them."""
    moving.play(until=moving.now + 300_000)
    moving.arm.brake(moving.now, False)
    moving.play()
    left = moving.arm.position(moving.now).axes
    if is_moving:
        moving.move("PTP", {"A1": left[0] + 3.0})
        moving.play(until=moving.now + 30_000)
    moving.arm.brake(moving.now, True)
    moving.play()
    moving.arm.proceed(moving.now)
    moving.play()
    assert not [event for event in moving.events if (event.kind, event.motion) == ("motion_end", 2)]
    if is_moving:
        assert left[0] + 3.0 == pytest.approx(moving.arm.position(moving.now).axes[0])
        moving.move("PTP", {f"A{i}": value for i, value in enumerate(left[:6], start=1)})
        moving.play()
    moving.arm.proceed(moving.now)
    moving.play()
    assert moving.time("motion_end", 4) == moving.now
    moving.check_limits()


@pytest.mark.parametrize("after", range(9))
def test_going_on_at_the_very_end(driver: Driver, after: int) -> None:
    """Whatever a microsecond cuts off, a brake at the end of a motion loses nothing."""
    driver.move("PTP", {**FIRST, "Y": 200.0 - after})
    driver.play()
    driver.move("LIN", SECOND)
    driver.arm.brake(driver.now, False)
    driver.play()
    driver.move("LIN", {"Z": 20.0 + after}, is_relative=True)
    driver.move("LIN", {"Z": -20.0 - after}, is_relative=True)
    driver.play()
    driver.arm.proceed(driver.now)
    driver.play()
    assert (500.0, -100.0, 600.0) == pytest.approx(driver.tool(driver.time("motion_end", 2)))


@pytest.mark.parametrize("is_braked", [False, True])
def test_forgetting_the_rest(moving: Driver, is_braked: bool) -> None:
    """What is discarded never happens; the next motion starts where the arm stands [INT-14]."""
    moving.play(until=moving.now + 300_000)
    if is_braked:
        moving.arm.brake(moving.now, True)
        moving.play()
    moving.arm.discard(moving.now)
    assert 0 == moving.arm.pending()
    moving.play()
    assert "stopped" == moving.events[-1].kind
    stood = moving.tool(moving.now)
    moving.move("LIN", {"Z": 40.0}, is_relative=True)
    moving.play()
    assert stood + np.array([0, 0, 40.0]) == pytest.approx(moving.tool(moving.now))
    assert not [event for event in moving.events if event.motion == 3]
    moving.check_limits()


@pytest.mark.parametrize("after", APART)
@pytest.mark.parametrize("percents", [(30, 100), (0, 100), (100, 1, 60), (50, 0, 0, 75)])
def test_the_override_changes_on_the_way(
    moving: Driver, after: int, percents: tuple[int, ...]
) -> None:
    """The override changes when a place is passed, never where the path is [MOT-09]."""
    begin, path = moving.now, rehearsed(moving)
    moving.play(until=begin + after)
    for percent in percents:
        moving.arm.override(moving.now, percent)
        moving.play(until=moving.now + 130_000)
    moving.play()
    assert moving.time("motion_end", 4)
    assert distance(geometry(moving, begin), path) < 0.01
    moving.check_limits()


@pytest.mark.parametrize("percent", [0.0, 5.0, 40.0])
def test_a_fallen_override_prevents_no_blend(driver: Driver, percent: float) -> None:
    """A motion planned while the arm is still too fast for the new override blends all the same."""
    near = {"criteria": ("C_DIS",), "approximation": Approximation(cdis=30.0), "velocity": 0.5}
    driver.move("PTP", FIRST)
    driver.play()
    for target in (SECOND, FIRST, SECOND):
        driver.move("LIN", target, **near)
    while driver.play(until=driver.now + 1_000)[-1].kind != "blend_start":
        pass
    driver.play(until=driver.now + 10_000)
    driver.arm.override(driver.now, percent)
    driver.move("LIN", FIRST, velocity=0.5)
    driver.play(until=driver.now + 2_000_000)
    driver.arm.override(driver.now, 100.0)
    driver.play()
    assert [2, 3, 4] == [one.motion for one in driver.events if one.kind == "blend_apex"]
    assert not any(event.is_exact_unwanted for event in driver.events)
    driver.check_limits()


@pytest.mark.parametrize("percent", [-1.0, 100.5, float("nan")])
def test_override_that_is_none(driver: Driver, percent: float) -> None:
    """$OV_PRO lies between 0 and 100."""
    with pytest.raises(Fault) as caught:
        driver.arm.override(0, percent)
    assert 1422 == caught.value.number


def test_an_override_in_the_moment_of_a_brake_changes_no_stop(machine: MachineData) -> None:
    """The override scales no acceleration [MOT-09], of blends that are slower by it neither."""
    near = Approximation(cdis=300.0, cptp=100.0)
    ends = set()
    for override in (100.0, 5.0):
        driver = Driver(machine)
        for x in (350.0, 595.0):
            target = {"X": x, "Y": 0.0, "Z": 400.0, "A": 0.0, "B": 180.0, "C": 0.0}
            driver.move("LIN", target, approximation=near, criteria=("C_DIS",), velocity=2.0)
        for share in (1.0, 1.0, 1.0, 0.1):
            do(driver, ("wait", share))
        driver.arm.override(driver.now, override)
        do(driver, ("brake", False))
        ends.add(driver.now)
    assert 1 == len(ends)
