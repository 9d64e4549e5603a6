"""A cubic spline through evenly spaced points that is fast to create and to evaluate.

The coefficients of a cubic spline are linear in its points. The matrix of this map is computed once
for each number of points; a spline then costs one matrix product.
"""

from __future__ import annotations

from functools import cached_property, lru_cache

import numpy as np
import numpy.typing as npt

from interp.robot.kinematics.kinematics import Array

_MAPPED = 129
"""The number of points above which the matrix would need too much memory."""


class UniformSpline:
    """A cubic spline on [0, 1] through points ``(n, columns)``, with its derivatives."""

    def __init__(self, points: Array) -> None:
        self._count = len(points) - 1
        if len(points) <= _MAPPED:
            mapped = _map(len(points)) @ points
            self._coefficients = mapped.reshape(4, self._count, points.shape[1])
        else:
            from scipy.interpolate import CubicSpline

            spline = CubicSpline(np.linspace(0.0, 1.0, len(points)), points)
            self._coefficients = np.ascontiguousarray(spline.c)

    def at(self, u: Array) -> Array:
        """Return values ``(n, columns)``."""
        (c3, c2, c1, c0), dt, _ = self._local(u)
        values: Array = c0 + dt * (c1 + dt * (c2 + dt * c3))
        return values

    def rates(self, u: Array) -> tuple[Array, Array, Array]:
        """Return first to third derivatives; the third is interpolated linearly between points."""
        (c3, c2, c1, _), dt, place = self._local(u)
        share = dt * self._count
        third = self._thirds[place] * (1.0 - share) + self._thirds[place + 1] * share
        return c1 + dt * (2.0 * c2 + dt * 3.0 * c3), 2.0 * c2 + dt * 6.0 * c3, third

    @cached_property
    def _thirds(self) -> Array:
        """The third derivatives at the points, from those of the cubics on either side.

        The not-a-knot condition makes the two cubics at each end one, whose third derivative is
        that at the point between them.
        """
        between = 6.0 * self._coefficients[0]
        thirds = np.empty((self._count + 1, between.shape[1]))
        thirds[1:-1] = (between[:-1] + between[1:]) / 2.0
        thirds[0] = between[1] - (between[2] - between[1]) / 1.5
        thirds[-1] = between[-2] - (between[-3] - between[-2]) / 1.5
        return thirds

    def _local(self, u: Array) -> tuple[Array, Array, npt.NDArray[np.intp]]:
        """Return for each parameter its coefficients, and the distance and index of its point."""
        place = np.minimum((u * self._count).astype(np.intp), self._count - 1)
        return self._coefficients[:, place], (u - place / self._count)[:, None], place


@lru_cache(maxsize=8)
def _map(count: int) -> Array:
    """Return the matrix from points to coefficients, ``(4 (count - 1), count)``."""
    from scipy.interpolate import CubicSpline

    coefficients = CubicSpline(np.linspace(0.0, 1.0, count), np.eye(count)).c
    mapped: Array = coefficients.reshape(-1, count)
    return mapped
