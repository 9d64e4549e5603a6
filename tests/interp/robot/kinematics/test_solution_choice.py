"""Which way is taken to a target: by Status and Turn, by where the arm stands, by its limits."""

import math
from collections.abc import Callable

import numpy as np
import pytest

from interp.robot.kinematics.kinematics import Array, Kinematics
from interp.robot.kinematics.solution_choice import (
    Singularity,
    TargetStatus,
    follow,
    ptp_target,
    singularities,
    solve,
    turn_of,
)
from interp.values.poses import Pose

MakeArm = Callable[..., Kinematics]

HOME = (0.0, -90.0, 90.0, 0.0, 0.0, 0.0)
AXES = (20.0, -80.0, 100.0, 30.0, 40.0, -50.0)


def flange(arm: Kinematics, axes: tuple[float, ...]) -> Pose:
    return Pose.from_matrix(arm.forward(axes).tolist())


def test_status_and_turn_of_axes_select_these_axes(arm: Kinematics) -> None:
    """Wherever an arm stands, Status and Turn of its axes lead back to them [POS-12]."""
    machine_axes = arm.machine.axes
    lower = [axis.lower for axis in machine_axes]
    upper = [axis.upper for axis in machine_axes]
    many = np.random.default_rng(11).uniform(lower, upper, (500, 6))
    statuses = arm.status(many).tolist()
    for axes, status in zip(many.tolist(), statuses, strict=True):
        found = solve(arm, flange(arm, axes), status=status, turn=turn_of(axes))
        assert axes == pytest.approx(found.axes, abs=1e-5)
        assert (status, turn_of(axes)) == (found.status, found.turn)


@pytest.mark.parametrize("status", range(8))
def test_a_status_selects_its_way(make_arm: MakeArm, status: int) -> None:
    """Each of the eight ways has a Status of its own, and the Status finds it."""
    arm = make_arm(*(f"$SOFT{sign}_END[{i}]={limit}" for i in range(1, 7) for sign, limit in WIDE))
    target = flange(arm, (20, -100, 110, 30, 40, -50))
    found = solve(arm, target, status=status)
    assert status == found.status
    assert np.allclose(target.rows, flange(arm, found.axes).rows, rtol=0, atol=1e-8)


WIDE = (("N", -180.0), ("P", 180.0))


@pytest.mark.parametrize("noise", [0.0, 1e-12, -1e-12])
def test_half_a_turn_is_positive(arm: Kinematics, noise: float) -> None:
    """Half a turn either way is as short, and rounding has no say in it."""
    target = flange(arm, (*AXES[:5], 180.0 + noise))
    assert 180 == pytest.approx(solve(arm, target, status=2).axes[5])


def test_turn_has_a_bit_for_each_negative_axis() -> None:
    """Bit 0 is for axis 1; zero is not negative, nor what rounding makes of it [POS-07]."""
    assert 0b010011 == turn_of([-1, -2, 3, 4, -5, 6])
    assert 0 == turn_of([0.0, -0.0, -1e-9, 0.0, 0.0, 0.0])


def test_the_leading_axis_counts(make_arm: MakeArm) -> None:
    """Of two ways that one is best whose leading axis takes less time, whatever the degrees."""
    start = (20.0, -80.0, 100.0, -110.0, 0.0, -60.0)
    chosen = []
    for slow in (4, 6):
        rates = [f"$VEL_AXIS_MA[{i}]={6000.0 if i != slow else 60.0}" for i in range(1, 7)]
        arm = make_arm(*rates, *(f"$RAT_MOT_AX[{i}]={{N 100,D 1}}" for i in range(1, 7)))
        best = TargetStatus.BEST
        target = flange(arm, (20.0, -80.0, 100.0, 30.0, 100.0, -50.0))
        chosen.append(solve(arm, target, start=start, preference=best).axes[3])
    assert chosen[0] < -140
    assert 30 == pytest.approx(chosen[1])


@pytest.mark.parametrize(
    ("axes", "expected"),
    [
        (HOME, (Singularity.WRIST,)),
        ((0.0, -90.0, 90.0, 0.0, 0.01812, 0.0), (Singularity.WRIST,)),
        ((0.0, -90.0, 90.0, 0.0, 0.01813, 0.0), ()),
        (AXES, ()),
    ],
)
def test_the_wrist_singularity(
    arm: Kinematics, axes: tuple[float, ...], expected: tuple[Singularity, ...]
) -> None:
    """Up to 0.01812 degrees of A5 the wrist counts as straight [POS-08]."""
    assert expected == singularities(arm, axes)


@pytest.mark.parametrize(("keep", "a4", "a6"), [(0, 0.0, 80.0), (1, 25.0, 55.0)])
@pytest.mark.parametrize("a5", [0.0, 0.01])
def test_a_target_with_a_straight_wrist(
    make_arm: MakeArm, keep: int, a4: float, a6: float, a5: float
) -> None:
    """Axis 4 goes to 0 or stays, axis 6 makes up for it, and the pose is met nearly [POS-08]."""
    arm = make_arm(f"$SINGUL_POS[3]={keep}")
    target = flange(arm, (10, -80, 100, 30, a5, 50))
    found = ptp_target(arm, target, (0, -90, 90, 25, 60, 0), status=2)
    assert (a4, a6) == pytest.approx((found.axes[3], found.axes[5]))
    assert (Singularity.WRIST,) == found.singularities
    missed = np.abs(np.array(target.rows) - flange(arm, found.axes).rows)[:, :3].max()
    assert missed <= math.radians(a5) + 1e-12


@pytest.mark.parametrize("bit", [0, 4])
def test_a_straight_wrist_has_either_status(arm: Kinematics, bit: int) -> None:
    """With A5 = 0 bit 2 of the Status says nothing, and the point can be reached with both."""
    assert HOME == pytest.approx(solve(arm, flange(arm, HOME), status=2 | bit).axes, abs=1e-9)


def path(arm: Kinematics, first: tuple[float, ...], last: tuple[float, ...], count: int) -> Array:
    """Poses along a way through axis space, and nothing said of the axes."""
    return arm.forward(np.linspace(first, last, count))


def test_a_path_keeps_its_way(arm: Kinematics) -> None:
    """Axes along a path go on from where they start, beyond half a turn as well [POS-01]."""
    first, last = (20.0, -80.0, 100.0, 30.0, 40.0, 150.0), (60.0, -70.0, 90.0, 80.0, 60.0, 330.0)
    expected = np.linspace(first, last, 200)
    assert np.allclose(expected, follow(arm, arm.forward(expected), first), rtol=0, atol=1e-7)
    assert (0, 6) == follow(arm, np.empty((0, 4, 4)), first).shape
