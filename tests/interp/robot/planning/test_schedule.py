"""Speeds at the seams of stretches, and what lies between them."""

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from interp.robot.path.speed_profile import SpeedProfile
from interp.robot.planning.junctions import AT_REST, JoinedStretch, Junction, PathState
from interp.robot.planning.limits import Stretch
from interp.robot.planning.ramps import Bounds
from interp.robot.planning.schedule import brakings, schedule


def joined(
    gear: float, start: float, end: float, velocity: float, even: float = 0.0
) -> JoinedStretch:
    """A stretch with a speed of its own, per unit of u; a blend where it has an even one."""
    normal, hard = Bounds(velocity, 2.0, 20.0), Bounds(velocity, 4.0, 80.0)
    constant = replace(hard, velocity=even) if even else None
    hard = hard if constant is None else normal
    stretch = Stretch(start, end, 1000.0, velocity, normal, hard, constant)
    return JoinedStretch(stretch, Junction(gear))


def seams(steps: list[JoinedStretch], profiles: list[SpeedProfile]) -> list[float]:
    """The speeds in which the steps end, per unit of u."""
    return [p.final / step.stretch.size for step, p in zip(steps, profiles, strict=True)]


def laid(
    steps: list[JoinedStretch], state: PathState = AT_REST, override: float = 1.0
) -> list[SpeedProfile]:
    """The profiles of a schedule that can be."""
    found = schedule(steps, state, override)
    assert found is not None
    return found.profiles


def test_too_late_to_brake() -> None:
    """What would be overrun is passed as slow as can be, and the schedule says so."""
    steps = [joined(0.0, 0.0, 0.5, 1.0), joined(1.0, 0.5, 1.0, 0.1)]
    state = PathState(0.45, 1.0, 0.0)
    found = schedule(steps, state, 1.0)
    assert found is not None
    assert found.over > 0.0
    assert seams(steps, laid(steps, state))[0] > 0.5


def test_a_blend_is_braked_in_before_a_stop_is_overrun() -> None:
    """Where the one under way is too short to brake in, the next is not passed at one speed."""
    steps = [
        joined(0.0, 0.0, 1.0, 1.0, even=1.0),
        joined(1.0, 0.0, 1.0, 1.0, even=1.0),
        joined(1.0, 0.0, 0.01, 1.0),
        joined(0.0, 0.0, 1.0, 1.0),
    ]
    first, second, last, _ = seams(steps, laid(steps, PathState(0.95, 1.0, 0.0)))
    assert second < 0.5 < first
    assert 0.0 == pytest.approx(last, abs=1e-6)


def test_an_acceleration_that_cannot_be_taken_back() -> None:
    """Too near to the end of a stretch nothing can be changed any more."""
    assert schedule([joined(0.0, 0.0, 1.0, 1.0)], PathState(0.9999, 0.5, 2.0), 1.0) is None


@given(
    lengths=st.lists(st.floats(1e-4, 0.5), min_size=1, max_size=8),
    data=st.data(),
    override=st.floats(0.01, 1.0),
)
def test_any_row_of_stretches(lengths: list[float], data: st.DataObject, override: float) -> None:
    """Whatever the stretches, each is entered as the one before was left, and the last at rest."""
    ends = [0.0]
    for length in lengths:
        ends.append(ends[-1] + length)
    speeds = [data.draw(st.floats(0.01, 3.0)) for _ in lengths]
    steps = [
        joined(1.0, start, end, speed)
        for start, end, speed in zip(ends, ends[1:], speeds, strict=False)
    ]
    before = 0.0
    profiles = laid(steps, override=override)
    for step, profile, length in zip(steps, profiles, lengths, strict=True):
        assert before == pytest.approx(profile.knots[0][2], abs=1e-6)
        assert length * 1000.0 == pytest.approx(profile.length, rel=1e-6, abs=1e-6)
        most = step.stretch.normal.velocity * override * 1000.0
        assert max(profile.final, *(knot[2] for knot in profile.knots)) <= most * (1 + 1e-5) + 1e-6
        before = profile.final
    assert 0.0 == pytest.approx(before, abs=1e-4)


def test_the_hardest_ramp_is_the_shortest() -> None:
    """BRAKE F stops sooner than BRAKE [INT-09]."""
    steps = [joined(0.0, 0.0, 1.0, 1.0)]
    lengths = []
    for is_hard in (False, True):
        found = next(brakings(steps, PathState(0.0, 1.0, 0.0), is_hard=is_hard))
        lengths.append(found.profiles[0].length)
    assert lengths[1] < 0.6 * lengths[0]
