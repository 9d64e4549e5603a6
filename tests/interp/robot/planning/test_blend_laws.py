"""The laws of blends, on programs drawn by seed (`make blends`: on thousands of others)."""

from __future__ import annotations

import os

import numpy as np
import pytest
from hypothesis import Phase, assume, example, given, settings
from hypothesis import strategies as st

pytest.importorskip("scipy")
pytest.importorskip("ruckig")

from interp.values.faults import Fault
from tests.interp.robot.planning.blend_programs import (
    draw,
    exact,
    longest,
    programmed_share,
    straight,
    travel,
)

SEEDS = st.integers(0, 10_000_000)
FEW = settings(
    max_examples=int(os.environ.get("KRL_BLENDS_PROGRAMS", "8")),
    phases=[Phase.explicit, Phase.generate],
)
_DIFFERENCES = 1e-3  # what differences of samples miss of derivatives


@FEW
@given(seed=SEEDS)
def test_no_program_is_slower_for_its_blends(seed: int) -> None:
    """With exact stops in the place of blends it takes as long or longer."""
    program = draw(seed)
    try:
        blended, stopped = travel(program)[0], travel(exact(program))[0]
    except Fault:
        assume(False)
    assert blended.seconds <= stopped.seconds * (1.0 + _DIFFERENCES)


@FEW
@given(seed=SEEDS)
@example(seed=999028)  # the axes allow other speeds and accelerations on its two halves
def test_points_on_a_straight_way_cost_nothing(seed: int) -> None:
    """A line or a PTP takes as long with points on it that are blended."""
    try:
        whole, parts = (travel(row)[0].seconds for row in straight(seed))
    except Fault:
        assume(False)
    assert parts <= whole * 1.00001


@FEW
@given(seed=SEEDS, ahead=st.integers(1, 5))
@example(seed=1795902126, ahead=5)  # is known far enough ahead, so it costs nothing
@example(seed=1795902112, ahead=3)  # is not, so it takes half as long again
def test_points_on_a_straight_way_cost_what_is_not_known(seed: int, ahead: int) -> None:
    """The arm is slower only where it could not stop within the motions that it knows."""
    whole, parts = straight(seed)
    try:
        travelled, (_, line) = travel(parts, ahead=ahead)[0], travel(whole)
    except Fault:
        assume(False)
    assert travelled.seconds <= longest(line, parts, ahead) * 1.00001


@FEW
@given(seed=SEEDS)
@example(seed=300049)  # the jerk is too great for a fiftieth of a blend
def test_no_axis_exceeds_speed_acceleration_or_jerk(seed: int) -> None:
    """At every millisecond, by differences of the axes themselves."""
    try:
        blended, _ = travel(draw(seed))
    except Fault:
        assume(False)
    assert max(blended.speed, blended.acceleration, blended.jerk) <= 1.0 + _DIFFERENCES


@FEW
@given(seed=SEEDS, override=st.floats(1.0, 99.0))
def test_the_path_does_not_depend_on_the_override(seed: int, override: float) -> None:
    """Each section is the same curve at any override, and nothing is faster than it allows."""
    try:
        program = draw(seed)
        _, fast = travel(program)
        _, slow = travel(program, override)
    except Fault:
        assume(False)
    u = np.linspace(0.0, 1.0, 9)
    curves = [
        {leg.section.key: leg.section.curve.axes(u) for leg in arm.path()} for arm in (fast, slow)
    ]
    assert curves[0].keys() == curves[1].keys()
    for key, axes in curves[0].items():
        assert np.array_equal(axes, curves[1][key])
    assert programmed_share(program, slow) <= override / 100.0 * (1.0 + _DIFFERENCES)
