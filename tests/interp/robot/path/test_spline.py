"""Spline blocks: through their points, smooth where they can be, the same at any speed."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from interp.robot.arm import SplinePart
from interp.robot.path.pose_path import OrientedPath
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


def test_tangent_and_curvature_go_on(driver: Driver) -> None:
    """From segment to segment direction, curvature and speed of the path go on unbroken."""
    sections = run(driver, MIXED)
    step = 1e-4
    for one, other in pairwise(sections):
        before, behind = one.curve.pose_path, other.curve.pose_path
        assert isinstance(before, OrientedPath)
        assert isinstance(behind, OrientedPath)
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
