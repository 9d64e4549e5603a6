"""Spline blocks: through their points, smooth where they can be, the same at any speed."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from interp.port.requests import SplineRange
from interp.robot.arm import Approximation, Place, Settings, SplinePart
from interp.robot.path.pose_path import Arc, StraightLine
from interp.robot.path.spline import Free
from interp.values.faults import Fault

if TYPE_CHECKING:
    from interp.robot.planning.timeline import Section
    from tests.interp.robot.conftest import Driver

START = {"X": 450.0, "Y": -150.0, "Z": 600.0, "A": 0.0, "B": 160.0, "C": 0.0}


def at(x: float, y: float, z: float = 600.0, **others: float) -> dict[str, float]:
    return {"X": x, "Y": y, "Z": z, **others}


MIXED = (
    SplinePart("SPL", at(500, -50)),
    SplinePart("SPL", at(480, 50, 650, A=10)),
    SplinePart("SLIN", at(480, 150, 650, A=20)),
    SplinePart("SPL", at(440, 200, 680)),
    SplinePart("SCIRC", at(380, 200, 680, A=0), at(410, 230, 680)),
    SplinePart("SPL", at(360, 100, 640)),
)


def run(driver: Driver, parts: tuple[SplinePart, ...], **others: Any) -> list[Section]:
    """Play a block from the start; returns its sections."""
    driver.move("PTP", START)
    driver.play()
    kind = others.pop("kind", "SPLINE")
    settings = {"velocity": 0.3, "speed_type": "#VAR_ALL"} | others
    driver.move(kind, parts=parts, **settings)
    sections = {
        leg.section.key: leg.section for leg in driver.arm.path() if leg.section.number == 2
    }
    driver.play()
    driver.check_limits()
    return list(sections.values())


def test_through_all_points(driver: Driver) -> None:
    """The path passes each point, with its orientation [SPL-03]."""
    sections = run(driver, MIXED)
    assert len(MIXED) == len(sections)
    for section, part in zip(sections, MIXED, strict=True):
        assert section.curve.pose_path is not None
        (place,), _ = section.curve.pose_path.at(np.ones(1))
        assert [part.target[name] for name in "XYZ"] == pytest.approx(place)
    (end,) = sections[-1].curve.axes(np.ones(1))
    assert np.allclose(driver.samples().axes[-1], end)


def test_lines_and_arcs_are_exact(driver: Driver) -> None:
    """SLIN is a straight line and SCIRC an arc, whatever lies beside them."""
    sections = run(driver, MIXED)
    kinds = [type(section.curve.pose_path) for section in sections]
    assert kinds == [Free, Free, StraightLine, Free, Arc, Free]


def test_tangent_and_curvature_go_on(driver: Driver) -> None:
    """From segment to segment direction, curvature and speed of the path go on unbroken."""
    sections = run(driver, MIXED)
    step = 1e-4
    for one, other in pairwise(sections):
        before, behind = one.curve.pose_path, other.curve.pose_path
        assert before is not None
        assert behind is not None
        assert before.length / behind.length == pytest.approx(other.gear)
        first = before.tangents(np.array([1 - 2 * step, 1 - step, 1.0])) / before.length
        second = behind.tangents(np.array([0.0, step, 2 * step])) / behind.length
        assert np.allclose(first[2], second[0], atol=1e-9)
        bend = (1.5 * first[2] - 2 * first[1] + 0.5 * first[0]) / (step * before.length)
        onward = (-1.5 * second[0] + 2 * second[1] - 0.5 * second[2]) / (step * behind.length)
        assert np.allclose(bend, onward, atol=1e-6)
        assert np.allclose(before.at(np.ones(1))[1], behind.at(np.zeros(1))[1], atol=1e-9)


def test_corners_are_exact_stops(driver: Driver) -> None:
    """Where two lines meet at an angle the arm stands, since the point has to be passed."""
    sections = run(driver, (SplinePart("SLIN", at(450, 0)), SplinePart("SLIN", at(350, 0))))
    assert [0.0, 0.0] == [section.gear for section in sections]


def test_a_block_keeps_its_speed(driver: Driver) -> None:
    """Along a smooth block the programmed speed is kept from point to point."""
    run(driver, tuple(SplinePart("SPL", at(450, y)) for y in (-50, 0, 20, 100, 150)), velocity=0.1)
    places = np.linspace(driver.time("motion_start", 2), driver.now, 50).astype(int)[10:-10]
    assert np.allclose([driver.arm.speed(int(time)) for time in places], 0.1, rtol=1e-4)


@pytest.mark.parametrize("others", [{"velocity": 1.0}, {"acceleration": 0.5}])
def test_the_path_is_always_the_same(driver: Driver, others: dict[str, float]) -> None:
    """The geometry depends on neither speed nor acceleration [SPL-03, BLD-09]."""
    u = np.linspace(0, 1, 9)
    one = [section.curve.axes(u) for section in run(driver, MIXED)]
    driver.move("PTP", START)
    driver.move("SPLINE", parts=MIXED, speed_type="#VAR_ALL", **others)
    sections = {
        leg.section.key: leg.section for leg in driver.arm.path() if leg.section.number == 4
    }
    other = [section.curve.axes(u) for section in sections.values()]
    assert np.allclose(one, other, atol=1e-8)


def test_speeds_by_segment(driver: Driver) -> None:
    """A segment may have a speed of its own [SPL-08]."""
    slow = Settings(velocity=0.05)
    run(driver, (SplinePart("SPL", at(450, 0)), SplinePart("SPL", at(450, 150), settings=slow)))
    times = range(driver.time("motion_start", 2), driver.now, 10_000)
    speeds = [driver.arm.speed(time) for time in times]
    assert 0.3 == pytest.approx(max(speeds), rel=1e-3)
    assert 0.05 == pytest.approx(driver.arm.speed(driver.now - 1_000_000), rel=1e-3)


def test_external_axes_pass_their_points_smoothly(driver: Driver) -> None:
    """External axes are a spline of their own over the same path."""
    sections = run(
        driver, tuple(SplinePart("SPL", at(450, y, E1=e)) for y, e in ((0, 90), (90, 60)))
    )
    rates = [
        section.curve.rates(np.array([u])) for section, u in zip(sections, (1.0, 0.0), strict=True)
    ]
    gear = sections[1].gear
    assert rates[0][0][0, 6] == pytest.approx(rates[1][0][0, 6] * gear)
    assert 60.0 == pytest.approx(driver.samples().axes[-1, 6])


def test_a_block_of_ptp(driver: Driver) -> None:
    """SPTP segments are a spline of all axes, smooth in the second derivative."""
    parts = tuple(SplinePart("SPTP", {"A1": a, "A3": b}) for a, b in ((20, 90), (40, 95), (10, 80)))
    sections = run(driver, parts, kind="PTP_SPLINE")
    for section, part in zip(sections, parts, strict=True):
        (axes,) = section.curve.axes(np.ones(1))
        assert (part.target["A1"], part.target["A3"]) == pytest.approx((axes[0], axes[2]))
    for one, other in pairwise(sections):
        (first, bend, _), (second, onward, _) = (
            one.curve.rates(np.ones(1)),
            other.curve.rates(np.zeros(1)),
        )
        assert np.allclose(first, second * other.gear)
        assert np.allclose(bend, onward * other.gear**2)


@pytest.mark.parametrize("kind", ["SPLINE", "PTP_SPLINE"])
def test_swinging_beyond_a_software_limit(driver: Driver, kind: str) -> None:
    """A spline whose points are within the limits, but not all between them, is 1211 [MOT-15]."""
    places = ((500.0, 1900.0), (530.0, 1995.0), (600.0, 100.0))
    segment = "SPL" if kind == "SPLINE" else "SPTP"
    parts = tuple(SplinePart(segment, {"X": x, "E1": e}) for x, e in places)
    with pytest.raises(Fault, match=r"software limit switch: E1 at 2\d\d\d") as caught:
        run(driver, parts, kind=kind)
    assert 1211 == caught.value.number


def test_single_spline_motions(driver: Driver) -> None:
    """SLIN, SCIRC and SPTP exist as motions of their own, and can be blended [SPL-02]."""
    near = {"criteria": ("C_SPL",), "approximation": Approximation(cdis=20.0, cptp=10)}
    driver.move("SPTP", START, **near)
    driver.move("SLIN", at(450, 0), **near)
    driver.move("SCIRC", at(380, 60), auxiliary=at(430, 50), **near)
    driver.move("SPTP", {"A1": 0.0}, **near)
    driver.play()
    assert 3 == sum(event.kind == "blend_apex" for event in driver.events)
    driver.check_limits()


def test_blending_into_and_out_of_a_block(driver: Driver) -> None:
    """A block is blended like any other motion, with its first and its last segment."""
    near = {"criteria": ("C_DIS",), "approximation": Approximation(cdis=15.0), "velocity": 0.3}
    driver.move("PTP", {**START, "Y": -250.0})
    driver.play()
    driver.move("LIN", START, **near)
    driver.move("SPLINE", parts=MIXED[:3], **near)
    driver.move("LIN", at(480, 150, 550))
    driver.play()
    assert 2 == sum(event.kind == "blend_apex" for event in driver.events)
    driver.check_limits()


def test_places_in_a_block(driver: Driver) -> None:
    """A trigger counts from the end of the segment behind it, or from its start."""
    parts = (
        SplinePart("SPL", at(450, 0), places=(Place(1, "PATH", 0.0),)),
        SplinePart("SPL", at(450, 100), places=(Place(2, "PATH", 10.0, on_start=True),)),
        SplinePart("SPL", at(450, 150), places=(Place(3, "PATH", -20.0),)),
    )
    run(driver, parts)
    passed = [driver.tool(driver.time("place", 2, key))[1] for key in (1, 2, 3)]
    assert [0.0, 10.0, 130.0] == pytest.approx(passed, abs=1e-3)


def test_stopping_at_a_place(driver: Driver) -> None:
    """The last chance for STOP WHEN PATH comes when a brake still ends just there [SPL-06]."""
    driver.move("PTP", START)
    driver.play()
    stop = (Place(1, "PATH", -10.0),)
    parts = (SplinePart("SPL", at(450, 0), stop_places=stop), SplinePart("SPL", at(450, 100)))
    driver.move("SPLINE", parts=parts, velocity=0.3)
    while driver.now == 0 or driver.events[-1].kind != "place":
        event = driver.arm.take()
        driver.events.append(event)
        driver.now = event.time
    driver.arm.brake(driver.now, False)
    driver.play()
    assert -10.0 == pytest.approx(driver.tool(driver.now)[1], abs=2e-3)


# ------------------------------------------------------------------------------------------- ranges


def line(*ranges: tuple[int, SplineRange], ends: tuple[float, ...] = (-50, 0, 100, 150)) -> Any:
    """A straight block, with ranges before segments, or behind the last."""
    parts = [
        SplinePart("SLIN", at(450, end), ranges=tuple(r for place, r in ranges if place == number))
        for number, end in enumerate(ends)
    ]
    behind = tuple(r for place, r in ranges if place == len(ends))
    return {"parts": tuple(parts), "ranges": behind}


def test_constant_speed(driver: Driver) -> None:
    """In its range the speed is the programmed one, all along [SPL-05]."""
    start = SplineRange("CONST_VEL", "START", 0.0, True)
    end = SplineRange("CONST_VEL", "END", 20.0, True)
    block = line((1, start), (3, end))
    driver.move("PTP", START)
    driver.play()
    driver.move("SPLINE", velocity=0.2, **block)
    begin = driver.now
    driver.play()
    times = range(begin, driver.now, 4000)
    inside = [time for time in times if -50.0 <= driver.tool(time)[1] <= 120.0]
    assert np.allclose([driver.arm.speed(time) for time in inside], 0.2, rtol=1e-9)


@pytest.mark.parametrize(
    ("parts", "values", "number"),
    [
        (line((0, SplineRange("CONST_VEL", "START", 0.0, True))), {"velocity": 0.2}, 3216),
        (line((1, SplineRange("CONST_VEL", "START", 0.0, True))), {"velocity": 0.2}, 3217),
        (
            line((1, SplineRange("CONST_VEL", "START", 0.0, True))),
            {"velocity": 0.4, "acceleration": 0.5},
            3216,
        ),
        (
            line(
                (1, SplineRange("CONST_VEL", "START", 0.0, True)),
                (2, SplineRange("CONST_VEL", "END", 0.0, False)),
                ends=(-50, 100, 0),
            ),
            {"velocity": 0.1},
            3215,
        ),
    ],
)
def test_speeds_that_cannot_be_kept(
    driver: Driver, parts: dict[str, Any], values: dict[str, Any], number: int
) -> None:
    """Each reason why a speed cannot be constant has its message [SPL-05]."""
    driver.move("PTP", START)
    with pytest.raises(Fault) as caught:
        driver.move("SPLINE", speed_type="#VAR_ALL", **values, **parts)
    assert number == caught.value.number


def test_durations(driver: Driver) -> None:
    """The parts of a TIME_BLOCK take their shares of its duration [SPL-10]."""
    ranges = (
        (1, SplineRange("TIME_BLOCK", "START", None, False)),
        (2, SplineRange("TIME_BLOCK", "PART", 30.0, False)),
        (4, SplineRange("TIME_BLOCK", "PART", 70.0, False)),
        (4, SplineRange("TIME_BLOCK", "END", 4.0, False)),
    )
    run(driver, **line(*ranges))
    ends = {leg.section.part: leg.ends for leg in driver.arm.path() if leg.section.number == 2}
    assert (1.2, 2.8) == pytest.approx((ends[1] - ends[0], ends[3] - ends[1]), rel=1e-5)


def test_both_kinds_of_range(driver: Driver) -> None:
    """CONST_VEL and TIME_BLOCK exclude each other in a block [SPL-10]."""
    ranges = (
        (1, SplineRange("TIME_BLOCK", "START", None, False)),
        (2, SplineRange("CONST_VEL", "START", 0.0, False)),
    )
    with pytest.raises(Fault, match="exclude each other"):
        run(driver, **line(*ranges))


@pytest.mark.parametrize(
    ("kind", "part", "number"), [("SPLINE", "SPTP", 2359), ("PTP_SPLINE", "SLIN", 2380)]
)
def test_segments_of_the_other_type(driver: Driver, kind: str, part: str, number: int) -> None:
    """A block has segments of its own type only [SPL-04]."""
    with pytest.raises(Fault) as caught:
        run(driver, (SplinePart(part, at(450, 0)),), kind=kind)
    assert number == caught.value.number
