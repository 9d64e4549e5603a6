"""Spline blocks: through their points, smooth where they can be, the same at any speed."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from interp.port.requests import SplineRange
from interp.robot.arm import Approximation, Place, SplinePart
from interp.robot.path.pose_path import Arc, StraightLine
from interp.robot.path.spline import FreeSegment
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
    assert kinds == [FreeSegment, FreeSegment, StraightLine, FreeSegment, Arc, FreeSegment]


def test_tangent_and_curvature_go_on(driver: Driver) -> None:
    """From segment to segment direction, curvature and speed of the path go on unbroken."""
    sections = run(driver, MIXED)
    step = 1e-4
    for one, other in pairwise(sections):
        before, behind = one.curve.pose_path, other.curve.pose_path
        assert before is not None
        assert behind is not None
        assert before.length / behind.length == pytest.approx(other.junction.gear)
        first = before.tangents(np.array([1 - 2 * step, 1 - step, 1.0])) / before.length
        second = behind.tangents(np.array([0.0, step, 2 * step])) / behind.length
        assert np.allclose(first[2], second[0], atol=1e-9)
        bend = (1.5 * first[2] - 2 * first[1] + 0.5 * first[0]) / (step * before.length)
        onward = (-1.5 * second[0] + 2 * second[1] - 0.5 * second[2]) / (step * behind.length)
        assert np.allclose(bend, onward, atol=1e-6)
        assert np.allclose(before.at(np.ones(1))[1], behind.at(np.zeros(1))[1], atol=1e-9)


def test_external_axes_pass_their_points_smoothly(driver: Driver) -> None:
    """External axes are a spline of their own over the same path."""
    sections = run(
        driver, tuple(SplinePart("SPL", at(450, y, E1=e)) for y, e in ((0, 90), (90, 60)))
    )
    rates = [
        section.curve.rates(np.array([u])) for section, u in zip(sections, (1.0, 0.0), strict=True)
    ]
    gear = sections[1].junction.gear
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
        assert np.allclose(first, second * other.junction.gear)
        assert np.allclose(bend, onward * other.junction.gear**2)


@pytest.mark.parametrize("kind", ["SPLINE", "PTP_SPLINE"])
def test_swinging_beyond_a_software_limit(driver: Driver, kind: str) -> None:
    """A spline whose points are within the limits, but not all between them, is 1211 [MOT-15]."""
    places = ((500.0, 1900.0), (530.0, 1995.0), (600.0, 100.0))
    segment = "SPL" if kind == "SPLINE" else "SPTP"
    parts = tuple(SplinePart(segment, {"X": x, "E1": e}) for x, e in places)
    with pytest.raises(Fault, match=r"software limit switch: E1 at 2\d\d\d") as caught:
        run(driver, parts, kind=kind)
    assert 1211 == caught.value.number


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
