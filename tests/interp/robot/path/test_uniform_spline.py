"""Splines through evenly spaced points."""

import numpy as np
import pytest

from interp.robot.path.uniform_spline import UniformSpline


@pytest.mark.parametrize("count", [33, 257])
def test_a_smooth_function(count: int) -> None:
    """Between the points, values and derivatives are those of the function, as far as can be."""
    grid = np.linspace(0.0, 1.0, count)
    table = UniformSpline(np.stack((np.sin(3 * grid), np.exp(grid)), axis=1))
    u = np.linspace(0.0, 1.0, 1001)
    first, second, third = table.rates(u)
    assert np.allclose(table.at(u), np.stack((np.sin(3 * u), np.exp(u)), axis=1), atol=1e-6)
    assert np.allclose(first, np.stack((3 * np.cos(3 * u), np.exp(u)), axis=1), atol=2e-4)
    assert np.allclose(second, np.stack((-9 * np.sin(3 * u), np.exp(u)), axis=1), atol=3e-2)
    assert np.allclose(third, np.stack((-27 * np.cos(3 * u), np.exp(u)), axis=1), atol=0.6)


def test_through_its_points() -> None:
    """The points themselves are met."""
    points = np.random.default_rng(4).normal(size=(65, 6))
    assert np.allclose(UniformSpline(points).at(np.linspace(0.0, 1.0, 65)), points)
