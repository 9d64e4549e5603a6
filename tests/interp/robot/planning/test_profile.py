"""Profiles of one degree of freedom: bounds, ends, and the way back from position to time."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from interp.robot.path.speed_profile import SpeedProfile, profile_of
from interp.robot.planning.profile import travel
from interp.robot.planning.ramps import Bounds, ramp

BOUNDS = Bounds(1000.0, 2000.0, 20000.0)
speeds = st.floats(0.0, 1000.0)


def check(profile: SpeedProfile, bounds: Bounds) -> None:
    """Speed, acceleration and jerk stay within their bounds, and position grows."""
    times = np.linspace(0.0, profile.duration, 500)
    position, speed, acceleration = np.array([profile.state(time) for time in times]).T
    assert speed.max() <= bounds.velocity * (1 + 1e-9)
    assert np.abs(acceleration).max() <= bounds.acceleration * (1 + 1e-9)
    assert max(abs(knot[4]) for knot in profile.knots) <= bounds.jerk * (1 + 1e-9)
    assert (np.diff(position) >= -1e-9).all()


@given(length=st.floats(1e-3, 5000.0), start=speeds, end=speeds)
def test_between_speeds(length: float, start: float, end: float) -> None:
    """Where the ramp between two speeds fits, the way ends where and as it should."""
    assume(ramp(start, end, BOUNDS).length <= length)
    profile = travel(length, start, 0.0, end, BOUNDS)
    check(profile, BOUNDS)
    position, speed, acceleration = profile.state(profile.duration)
    assert length == pytest.approx(position, rel=1e-9, abs=1e-7)
    assert end == pytest.approx(speed, rel=1e-5, abs=1e-5)
    assert 0.0 == pytest.approx(acceleration, abs=1e-3)


@given(speed=speeds, acceleration=st.floats(-2000.0, 2000.0), target=speeds)
def test_a_ramp_is_what_the_profile_does(speed: float, acceleration: float, target: float) -> None:
    """The length and time of a change of speed, worked out on paper, are those of Ruckig."""
    assume(speed + acceleration * abs(acceleration) / 40000.0 >= 0.0)
    wide = Bounds(1e6, BOUNDS.acceleration, BOUNDS.jerk)
    change = ramp(speed, target, BOUNDS, acceleration)
    profile = travel(change.length, speed, acceleration, target, wide)
    assert change.duration == pytest.approx(profile.duration, rel=1e-5, abs=1e-7)


def test_a_ramp_to_zero_is_a_stop() -> None:
    """A stop ends at rest."""
    profile = ramp(800.0, 0.0, BOUNDS, 500.0)
    check(profile, BOUNDS)
    assert 0.0 == pytest.approx(profile.final, abs=1e-9)


@given(share=st.floats(0.0, 1.0))
def test_back_from_position_to_time(share: float) -> None:
    """At the time of a position the profile has that position."""
    profile = travel(700.0, 100.0, 0.0, 300.0, BOUNDS)
    time = profile.time_at(700.0 * share)
    assert 700.0 * share == pytest.approx(profile.state(time)[0], abs=1e-8)


def test_the_time_of_a_position_is_exact() -> None:
    """The time of a position is exact to rounding."""
    profile = profile_of(500.0, ((1.25, 0.0, 0.0),))
    assert 500.0 == pytest.approx(profile.state(profile.time_at(500.0))[0], abs=1e-12)


def test_a_position_beyond_the_end() -> None:
    """What is never reached has the time of the end."""
    profile = travel(700.0, 0.0, 0.0, 0.0, BOUNDS)
    assert profile.duration == profile.time_at(701.0)


def test_one_time_or_many() -> None:
    """A single time gives what it gives among others."""
    profile = travel(700.0, 50.0, 0.0, 0.0, BOUNDS)
    times = np.array([-1.0, 0.0, 0.1, profile.duration / 2, profile.duration, math.inf])
    single = [profile.state(time)[0] for time in times.tolist()]
    assert np.allclose(profile.at(times)[0], single, rtol=1e-12)


@given(
    start=st.sampled_from([0.0, 0.3, 1.0]),
    end=st.sampled_from([0.0, 0.6, 1.0]),
    exponent=st.floats(-8.0, 0.0),
    scale=st.floats(-3.0, 4.0),
)
def test_lengths_that_are_just_enough(
    start: float, end: float, exponent: float, scale: float
) -> None:
    """A little more than a change of speed takes is travelled within the bounds, at any scale."""
    unit = 10.0**scale
    bounds = Bounds(unit, 7.0 * unit, 60.0 * unit)
    least = max(ramp(start * unit, end * unit, bounds).length, 0.01 * unit)
    length = least * (1.0 + 10.0**exponent)
    profile = travel(length, start * unit, 0.0, end * unit, bounds)
    wide = Bounds(unit * (1 + 1e-6), 7.0 * unit * (1 + 1e-6), 60.0 * unit * (1 + 1e-6))
    check(profile, wide)
    assert length == pytest.approx(profile.length, rel=1e-9)
    assert end * unit == pytest.approx(profile.final, rel=1e-6, abs=1e-6 * unit)
