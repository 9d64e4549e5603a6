"""Approximate positioning: where a blend is, what it looks like, and when there is none."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import nullcontext
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from interp.port.requests import At
from interp.robot.arm import Approximation, Motion, Settings
from interp.robot.path.axis_path import BlendedAxes, JointCurve
from interp.robot.path.pose_path import Blend
from interp.robot.path.programmed_targets import Programmed
from interp.robot.planning.blend_zones import Zone
from interp.robot.planning.blending import blend_of
from interp.robot.planning.tracks import Tracks
from interp.values.faults import Fault
from tests.interp.robot.conftest import Driver

if TYPE_CHECKING:
    from interp.robot.kinematics.machine_data import MachineData
    from interp.robot.planning.timeline import Section

START = {"A1": 0.0, "A2": -90.0, "A3": 100.0, "A4": 0.0, "A5": 60.0, "A6": 0.0}
FIRST = {"X": 500.0, "Y": 200.0, "Z": 600.0, "A": 0.0, "B": 160.0, "C": 0.0}
CORNER = {**FIRST, "Y": -100.0}
LAST = {**CORNER, "X": 400.0}


def corner(driver: Driver, criteria: tuple[str, ...], velocity: float = 2.0, **values: Any) -> None:
    """A line of 300 mm, and across it one of 100 mm."""
    driver.move("PTP", FIRST)
    driver.play()
    near = Approximation(**values)
    driver.move("LIN", CORNER, criteria=criteria, approximation=near, velocity=velocity)
    driver.move("LIN", LAST, velocity=velocity)


def blend(driver: Driver) -> Section:
    """The section of the only blend."""
    sections = [leg.section for leg in driver.arm.path() if leg.section.following]
    (found,) = {section.key: section for section in sections}.values()
    return found


def corners(section: Section) -> np.typing.NDArray[np.float64]:
    """Where a blend of lines leaves the first, its point, and where it joins the second."""
    path = section.curve.pose_path
    assert isinstance(path, Blend)
    (leaves, joins), (point,) = path.at(np.array([0.0, 1.0]))[0], path.first.at(np.ones(1))[0]
    return np.array([leaves, point, joins])


def test_a_blend_of_lines_is_nearly_a_parabola(driver: Driver) -> None:
    """Where nothing is gained otherwise, it has the ends of one and keeps 0.12 mm to it."""
    corner(driver, ("C_DIS",), 0.2, cdis=40.0)
    driver.play()
    section = blend(driver)
    points = corners(section)
    wanted = [(500.0, -60.0, 600.0), (500.0, -100.0, 600.0), (460.0, -100.0, 600.0)]
    assert np.allclose(wanted, points, atol=1e-9)
    begin, end = driver.time("blend_start", 2), driver.time("blend_end", 3)
    places = np.array([driver.tool(time) for time in range(begin, end, 2000)])
    # On that parabola the roots of the distances from both lines add to that of the zone.
    across, along = 500.0 - places[:, 0], places[:, 1] + 100.0
    least, most = np.minimum(across, along), np.maximum(across, along)
    assert 0.12 > np.abs((np.sqrt(40.0) - np.sqrt(most)) ** 2 - least).max()
    driver.check_limits()


def test_ptp_blends_in_the_space_of_axes(driver: Driver) -> None:
    """Between PTP all axes go over into the next; the zone is that of $APO_DIS_PTP [BLD-03]."""
    values = {"approximation": Approximation(cptp=50)}
    driver.move("PTP", {"A1": 100.0}, criteria=("C_PTP",), **values)
    driver.move("PTP", {"A2": 0.0}, **values)
    curve = blend(driver).curve
    assert isinstance(curve, JointCurve)
    axes = curve.axes(np.linspace(0.0, 1.0, 50))[:, :2]
    # 50 % of 90 degrees on the first side; half of the path is that on the second.
    assert np.allclose([(55.0, -90.0), (100.0, -45.0)], axes[[0, -1]])
    assert (np.diff(axes, axis=0) > -1e-12).all()
    driver.play()
    driver.check_limits()


@pytest.mark.parametrize(("target", "is_blended"), [({"A1": 60.0}, True), ({"E1": 100.0}, False)])
def test_an_axis_that_may_not_leave_its_point_matters_if_it_moves(
    machine: MachineData, target: Mapping[str, float], is_blended: bool
) -> None:
    """Machine data often have the distance zero for external axes [BLD-03]."""
    slide = replace(machine.externals[0], approximation=0.0)
    driver = Driver(replace(machine, externals=(slide,)))
    values = {"approximation": Approximation(cdis=30.0, cptp=50), "velocity": 0.5}
    driver.move("PTP", FIRST)
    driver.move("LIN", CORNER, criteria=("C_DIS", "C_PTP"), **values)
    driver.move("PTP", target, **values)
    assert is_blended == any(leg.section.following for leg in driver.arm.path())


@pytest.mark.parametrize("kinds", [("PTP", "LIN"), ("LIN", "PTP")])
def test_mixed_blends(driver: Driver, kinds: tuple[str, str]) -> None:
    """Between PTP and a path of the tool the axes blend, tangent to both [BLD-12]."""
    driver.move("PTP", FIRST)
    driver.play()
    values = {"approximation": Approximation(cdis=30.0, cptp=20)}
    criteria = ("C_PTP", "C_DIS") if kinds[0] == "PTP" else ("C_DIS", "C_PTP")
    driver.move(kinds[0], CORNER, criteria=criteria, velocity=0.5, **values)
    driver.move(kinds[1], LAST, velocity=0.5, **values)
    curve = blend(driver).curve
    assert isinstance(curve, JointCurve)
    path = curve.path
    assert isinstance(path, BlendedAxes)
    share = path.transition.after if kinds[1] == "LIN" else path.transition.before
    assert 30.0 / (100.0 if kinds[1] == "LIN" else 300.0) == pytest.approx(share)
    (rates, bends, _), zone = curve.rates(np.array([0.0, 1.0])), path.transition
    leaving, leaving_bend, _ = path.first.rates(np.array([1.0 - zone.before]))
    joining, joining_bend, _ = path.second.rates(np.array([zone.after]))
    one, other = zone.rates(np.array([0.0]))[0], zone.rates(np.array([1.0]))[1]
    assert np.allclose(rates, [one[0] * leaving[0], other[0] * joining[0]])
    one_bend = one[0] ** 2 * leaving_bend[0] + one[1] * leaving[0]
    other_bend = other[0] ** 2 * joining_bend[0] + other[1] * joining[0]
    assert np.allclose(bends, [one_bend, other_bend])
    driver.play()
    driver.check_limits()


@pytest.mark.parametrize("others", [{"circle": "#BASE"}, {"circle": "#PATH"}])
def test_line_into_circle(driver: Driver, others: dict[str, str]) -> None:
    """The blend leaves the line and joins the circle where the zone ends, in their directions."""
    driver.move("PTP", FIRST)
    driver.play()
    values = {"approximation": Approximation(cdis=20.0), "velocity": 0.5}
    driver.move("LIN", CORNER, criteria=("C_DIS",), **values)
    driver.move(
        "CIRC", {"X": 400.0, "Y": -200.0}, auxiliary={"X": 430.0, "Y": -130.0}, **values, **others
    )
    pose_path = blend(driver).curve.pose_path
    assert isinstance(pose_path, Blend)
    (start, end), _ = pose_path.at(np.array([0.0, 1.0]))
    assert (500.0, -80.0, 600.0) == pytest.approx(start)
    assert np.allclose(pose_path.second.at(np.array([pose_path.transition.after]))[0][0], end)
    tangents = pose_path.tangents(np.array([0.0, 1.0]))
    wanted = np.stack(
        (
            pose_path.first.tangents(np.ones(1))[0],
            pose_path.second.tangents(np.array([pose_path.transition.after]))[0],
        )
    )
    cosines = (tangents * wanted).sum(axis=1)
    lengths = np.linalg.norm(tangents, axis=1) * np.linalg.norm(wanted, axis=1)
    assert np.allclose(1.0, cosines / lengths)
    driver.play()
    driver.check_limits()


@pytest.mark.parametrize("way", [(-49, -50, -14), (46, -39, 34), (43, 25, 49), (-21, -28, 17)])
def test_c_vel_where_the_hand_turns_on_a_line(driver: Driver, way: tuple[int, int, int]) -> None:
    """Between lines in one direction too, whatever rounding makes of the angle between them."""
    driver.move("PTP", FIRST)
    driver.play()
    near = Approximation(cvel=100.0)
    for times, criteria, turn in ((1.0, ("C_VEL",), 0.0), (1.5, (), 30.0)):
        place = {word: FIRST[word] + times * by for word, by in zip("XYZ", way, strict=True)}
        target = {**FIRST, **place, "A": turn}
        driver.move("LIN", target, criteria=criteria, velocity=0.3, approximation=near)
    driver.play()
    assert isinstance(blend(driver).curve.pose_path, Blend)


def test_a_blend_of_axes_keeps_within_software_limits(driver: Driver) -> None:
    """Beside a line axes may swing, so the blend itself is looked at; else it is none [MOT-15]."""
    tracks = Tracks(driver.machine)
    here = Programmed(tracks.arm, np.array(driver.machine.standing(tuple(START.values()))))
    turn = Motion(1, At("test.src", 1, 0), "PTP", Settings(), {"A1": 30.0}, criteria=("C_DIS",))
    line = Motion(2, At("test.src", 2, 0), "LIN", Settings(), {"Y": -100.0})
    first, there = tracks.track(turn, here)
    second, _ = tracks.track(line, there)
    zone = Zone(0.4, 0.4)
    curve = blend_of(tracks, first, second, zone).curve
    most = float(curve.axes(np.linspace(0.0, 1.0, 500))[:, 0].max())
    axis = driver.machine.axes[0]
    for upper, is_beyond in ((most + 0.01, False), (most - 0.5, True)):
        axes = (replace(axis, upper=upper), *driver.machine.axes[1:])
        limited = Tracks(replace(driver.machine, axes=axes))
        with pytest.raises(Fault) if is_beyond else nullcontext():
            blend_of(limited, first, second, zone)
