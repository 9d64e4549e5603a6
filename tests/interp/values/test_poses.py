"""Poses: the geometric operator, and angles that give the rotation they were taken from."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from interp.values.poses import IDENTITY, Pose, sine_cosine

angles = st.one_of(
    st.floats(-400, 400),
    st.sampled_from([-90.0, 90.0]),
    st.floats(-1e-6, 1e-6).map(lambda little: 90.0 + little),
)
lengths = st.floats(-5000, 5000)
poses = st.builds(Pose.of, lengths, lengths, lengths, angles, angles, angles)


def distance(left: Pose, right: Pose) -> float:
    """The largest difference of their matrices, positions in metres."""
    rows = zip(left.rows, right.rows, strict=True)
    return max(
        abs(a - b) / (1000.0 if column == 3 else 1.0)
        for one, other in rows
        for column, (a, b) in enumerate(zip(one, other, strict=True))
    )


@pytest.mark.parametrize(("degrees", "quarter"), [(0, 0), (90, 1), (-180, 2), (270, 3), (1170, 1)])
def test_quarter_turns_are_exact(degrees: float, quarter: int) -> None:
    """Sine and cosine of multiples of 90 degrees are 0, 1 or -1, and zeros have no sign."""
    expected = ((0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0))[quarter]
    found = sine_cosine(degrees)
    assert expected == found
    assert "-0.0" not in map(str, found)


@pytest.mark.parametrize("degrees", [math.nan, math.inf, -math.inf])
def test_no_angle_has_no_sine(degrees: float) -> None:
    """What is no number stays none, and the pose says so."""
    assert all(map(math.isnan, sine_cosine(degrees)))
    assert not Pose.of(a=degrees).is_finite
    assert IDENTITY.is_finite


@given(poses)
def test_components_give_the_pose_again(pose: Pose) -> None:
    """A pose made of its own components is the same one, at and near B = 90 degrees as well."""
    again = Pose.of(*pose.components)
    assert distance(pose, again) < 5e-12
    a, b, c = pose.angles
    assert -180 < a <= 180
    assert -90 <= b <= 90
    assert -180 < c <= 180


@given(poses)
def test_the_inverse_undoes(pose: Pose) -> None:
    """A pose and its inverse make no difference, whichever comes first."""
    assert distance(IDENTITY, pose @ pose.inverse()) < 1e-12
    assert distance(IDENTITY, pose.inverse() @ pose) < 1e-12


@given(poses, poses, poses)
def test_the_operator_is_associative(first: Pose, second: Pose, third: Pose) -> None:
    """Frames that are chained may be put together from either end."""
    assert distance(first @ (second @ third), (first @ second) @ third) < 1e-11


def test_a_is_zero_where_only_the_sum_counts() -> None:
    """At B = 90 degrees A and C turn about one line, and C has all of it."""
    a, b, c = Pose.of(a=30, b=90, c=50).angles
    assert (0, 90) == (a, b)
    assert 20 == pytest.approx(c)
