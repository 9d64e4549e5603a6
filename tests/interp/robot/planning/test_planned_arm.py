"""Single motions to a nanometre and a microsecond; the cases state what each instruction does."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from interp.robot.arm import Approximation, Place
from interp.robot.kinematics.placement import IpoMode, Placement
from interp.robot.planning.planned_arm import PlannedArm
from interp.values.faults import Fault
from interp.values.poses import Pose
from tests.interp.robot.conftest import speeds

if TYPE_CHECKING:
    from tests.interp.robot.conftest import Driver

POINT = {"X": 500.0, "Y": 100.0, "Z": 600.0, "A": 0.0, "B": 160.0, "C": 0.0}


def flanges(driver: Driver, start: int, end: int) -> tuple[Any, Any]:
    """Positions and rotations of the flange at a hundred times."""
    axes = driver.arm.sample(np.linspace(start, end, 100).astype(np.int64)).axes
    poses = PlannedArm(driver.machine, axes[0])._tracks.arm.forward(axes[:, :6])
    return poses[:, :3, 3], poses[:, :3, :3]


# ---------------------------------------------------------------------------------------------- PTP


def test_ptp_is_synchronous(driver: Driver) -> None:
    """All axes start and stop together, and at any time have gone the same share [MOT-01]."""
    driver.move("PTP", {"A1": 40.0, "A2": -80.0, "E1": 300.0})
    driver.play()
    samples = driver.samples()
    start, end = samples.axes[0], samples.axes[-1]
    assert (40.0, -80.0, 300.0) == pytest.approx((end[0], end[1], end[6]))
    moving = end != start
    shares = (samples.axes - start)[:, moving] / (end - start)[moving]
    assert np.allclose(shares, shares[:, :1], atol=1e-12)
    driver.check_limits()


def test_ptp_is_as_fast_as_the_leading_axis(driver: Driver) -> None:
    """Full speed of the leading axis, plus half of its ramps, is the time of a PTP."""
    driver.move("PTP", {"A1": 160.0})
    driver.play()
    speed, acceleration = 360.0, 360.0 / 0.3
    jerk = acceleration / 0.06
    wanted = 160.0 / speed + speed / acceleration + acceleration / jerk
    assert wanted == pytest.approx(driver.now * 1e-6, rel=1e-6)
    assert 360.0 == pytest.approx(np.abs(speeds(driver.samples().axes)[:, 0]).max())


# ---------------------------------------------------------------------------------------- LIN, CIRC


def test_lin_keeps_to_its_line(driver: Driver) -> None:
    """The tool runs on the line between its ends, and turns evenly, to a nanometre and less."""
    driver.move("PTP", POINT)
    driver.play()
    begin = driver.now
    driver.move("LIN", {"X": 400.0, "Y": -150.0, "Z": 700.0, "A": 40.0}, velocity=0.4)
    driver.play()
    places, turned = flanges(driver, begin, driver.now)
    way = places[-1] - places[0]
    share = (places - places[0]) @ way / (way @ way)
    assert np.allclose(places[0] + share[:, None] * way, places, atol=1e-9)
    assert (np.diff(share) >= 0).all()
    assert Rotation.from_matrix(turned[0].T @ turned[-1]).magnitude() > 0.1
    tool = turned[:, :, 0]
    swivel = np.arccos(np.clip(tool @ tool[0], -1, 1))
    assert np.allclose(swivel, share * swivel[-1], atol=1e-7)
    driver.check_limits()


@pytest.mark.parametrize("angle", [None, 100.0, 400.0, -60.0])
def test_circ_keeps_to_its_circle(driver: Driver, angle: float | None) -> None:
    """The tool stays on the circle through the three points, as far round as told [MOT-13]."""
    driver.move("PTP", {**POINT, "Y": 0.0, "X": 450.0})
    driver.play()
    begin = driver.now
    driver.move(
        "CIRC", {"X": 550.0, "Y": 0.0}, auxiliary={"X": 500.0, "Y": 50.0}, angle=angle, velocity=0.2
    )
    driver.play()
    places, _ = flanges(driver, begin, driver.now)
    centre = np.array([500.0, 0.0, 600.0])
    assert np.allclose(np.linalg.norm(places - centre, axis=1), 50.0, atol=1e-9)
    assert np.allclose(places[:, 2], 600.0, atol=1e-9)
    out = places - centre
    turned = np.unwrap(np.arctan2(out[:, 1], -out[:, 0]))
    assert math.radians(180.0 if angle is None else angle) == pytest.approx(turned[-1])
    driver.check_limits()


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
    """Back at a mark the arm is as it was, events and all."""
    driver.move("PTP", {"A1": 40.0}, criteria=("C_PTP",))
    mark = driver.arm.mark()
    before, event = driver.arm.sample(np.arange(0, 10**6, 10**4)).axes, driver.arm.next_event()
    driver.move("PTP", {"A2": -60.0})
    driver.arm.rewind(mark)
    assert np.array_equal(before, driver.arm.sample(np.arange(0, 10**6, 10**4)).axes)
    assert (event, 1) == (driver.arm.next_event(), driver.arm.pending())


# ------------------------------------------------------------------------------------------- faults


@pytest.mark.parametrize(
    ("kind", "target", "others", "number"),
    [
        ("PTP", {"X": 3000.0}, {}, 1366),
        ("LIN", {"X": 3000.0}, {}, 1366),
        ("PTP", {"A3": 200.0}, {}, 1447),
        ("PTP", {"E1": 9999.0}, {}, 1447),
        ("LIN", {"X": math.nan}, {}, 1422),
        ("PTP", {"A1": math.inf}, {}, 1422),
        ("LIN", {"Y": 0.0}, {"velocity": 0.0}, 1422),
        ("LIN", {"Y": 0.0}, {"velocity": math.nan}, 1422),
        ("LIN", {"Y": 0.0}, {"orientation": "#IGNORE"}, 3094),
        ("LIN", {"Y": 0.0}, {"approximation": Approximation(cdis=math.nan)}, 1422),
        ("PTP", {"A1": 0.0}, {"axis_velocity": (math.nan,) * 12}, 1422),
        ("LIN", {"Y": 0.0}, {"places": (Place(9, "PATH", math.nan),)}, 1422),
        ("CIRC", {}, {"auxiliary": {"X": 510.0}}, 1456),
        ("CIRC", {"Y": 0.0}, {"auxiliary": {}}, 1457),
        ("CIRC", {"Y": 0.0}, {"auxiliary": {"Y": 0.0}}, 1458),
        ("CIRC", {"Y": 0.0}, {"auxiliary": {"Y": 50.0}}, 1506),
        ("SPL", {}, {}, None),
    ],
)
def test_what_cannot_be_done(
    driver: Driver, kind: str, target: dict[str, float], others: dict[str, Any], number: int | None
) -> None:
    """A motion that cannot be is refused with its message, and the arm stays as it is."""
    driver.move("PTP", POINT)
    before = driver.arm.path()
    with pytest.raises(Fault) as caught:
        driver.move(kind, target, **others)
    assert number == caught.value.number
    assert before == driver.arm.path()
    assert 1 == driver.arm.pending()


@pytest.mark.parametrize(
    ("speed_type", "is_reduced", "is_allowed"),
    [
        ("#CONSTANT", False, False),
        ("#CONSTANT", True, False),
        ("#VAR_T1", False, False),
        ("#VAR_T1", True, True),
        ("#VAR_ALL", False, True),
        ("#VAR_ALL_MODEL", False, True),
    ],
)
def test_near_a_straight_wrist(
    driver: Driver, speed_type: str, is_reduced: bool, is_allowed: bool
) -> None:
    """Where an axis cannot follow, the speed drops, or it is message 1102 [MOT-08]."""
    driver.move("PTP", {"A4": 0.0, "A5": 1.0})
    driver.play()
    settings = {"speed_type": speed_type, "is_reduced": is_reduced, "velocity": 0.25}
    x, y, z = driver.tool(driver.now)
    if is_allowed:
        driver.move("LIN", {"X": x, "Y": y + 100.0, "Z": z}, **settings)
        driver.play()
        driver.check_limits()
    else:
        with pytest.raises(Fault) as caught:
            driver.move("LIN", {"X": x, "Y": y + 100.0, "Z": z}, **settings)
        assert 1102 == caught.value.number


def test_through_a_straight_wrist(driver: Driver) -> None:
    """A path on which an axis would have to jump is refused at any speed."""
    driver.move("PTP", {"A4": 0.0, "A5": 0.0})
    driver.play()
    with pytest.raises(Fault) as caught:
        driver.move("LIN", {"Y": 100.0}, speed_type="#VAR_ALL")
    assert 1102 == caught.value.number
