"""A cubic spline through evenly spaced points that is fast to create and to evaluate.

The coefficients of a cubic spline are linear in its points. The matrix of this map is computed once
for each number of points; a spline then costs one matrix product.
"""

from __future__ import annotations

from functools import cached_property, lru_cache
from typing import TYPE_CHECKING

import numpy as np

from interp.robot.kinematics.kinematics import Array

if TYPE_CHECKING:
    from scipy.interpolate import PPoly

#: The number of points above which the matrix would need too much memory.
_MAPPED = 129


class UniformSpline:
    """A cubic spline on [0, 1] through points ``(n, columns)``, with its derivatives."""

    def __init__(self, points: Array) -> None:
        from scipy.interpolate import CubicSpline, PPoly

        grid = np.linspace(0.0, 1.0, len(points))
        if len(points) <= _MAPPED:
            cubics = (_map(len(points)) @ points).reshape(4, -1, points.shape[1])
            self._values = PPoly.construct_fast(cubics, grid)
        else:
            self._values = CubicSpline(grid, points)

    def at(self, u: Array) -> Array:
        """Return values ``(n, columns)``."""
        values: Array = self._values(u)
        return values

    def rates(self, u: Array) -> tuple[Array, Array, Array]:
        """Return first to third derivatives; the third is interpolated linearly between points."""
        return self._values(u, 1), self._values(u, 2), self._thirds(u)

    @cached_property
    def _thirds(self) -> PPoly:
        """The third derivative, from those of the cubics on either side of each point.

        The not-a-knot condition makes the two cubics at each end one, whose third derivative is
        that at the point between them.
        """
        from scipy.interpolate import PPoly

        between = 6.0 * self._values.c[0]
        ends = between[[1, -2]] - (between[[2, -3]] - between[[1, -2]]) / 1.5
        thirds = np.concatenate((ends[:1], (between[:-1] + between[1:]) / 2.0, ends[1:]))
        slopes = np.diff(thirds, axis=0) * len(between)
        return PPoly.construct_fast(np.stack((slopes, thirds[:-1])), self._values.x)


@lru_cache(maxsize=8)
def _map(count: int) -> Array:
    """Return the matrix from points to coefficients, ``(4 (count - 1), count)``."""
    from scipy.interpolate import CubicSpline

    coefficients = CubicSpline(np.linspace(0.0, 1.0, count), np.eye(count)).c
    mapped: Array = coefficients.reshape(-1, count)
    return mapped
