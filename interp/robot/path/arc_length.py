"""The arc length of a curve, and the parameter at which a length is reached."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from interp.robot.kinematics.kinematics import Array

#: Nodes and weights of Gauss-Legendre quadrature on [0, 1], exact for polynomials of degree 9.
_NODES, _WEIGHTS = np.stack(np.polynomial.legendre.leggauss(5)) / 2.0 + [[0.5], [0.0]]
_KNOTS = np.linspace(0.0, 1.0, 33)
_EXACT = 1e-12  # of u


class ArcLength:
    """The arc length of a curve up to any parameter, computed from its tangents."""

    def __init__(self, tangents: Callable[[Array], Array]) -> None:
        self._tangents = tangents
        steps = self._between(_KNOTS[:-1], _KNOTS[1:])
        self._sums = np.concatenate(([0.0], np.cumsum(steps)))

    @property
    def length(self) -> float:
        """The whole length in mm."""
        return float(self._sums[-1])

    def at(self, u: Array) -> Array:
        """Return the lengths ``(n,)`` from 0 to u."""
        place = np.searchsorted(_KNOTS[1:-1], u, side="right")
        lengths: Array = self._sums[place] + self._between(_KNOTS[place], u)
        return lengths

    def parameters(self, lengths: Array) -> Array:
        """Return the parameters in [0, 1] at which lengths are reached."""
        wanted = np.clip(lengths, 0.0, self.length)
        low, high = np.zeros_like(wanted), np.ones_like(wanted)
        u = np.interp(wanted, self._sums, _KNOTS)
        for _ in range(8):
            missing = wanted - self.at(u)
            low, high = np.where(missing >= 0.0, u, low), np.where(missing <= 0.0, u, high)
            slope = np.linalg.norm(self._tangents(u), axis=1)
            step = np.divide(missing, slope, out=np.zeros_like(u), where=slope > 0.0)
            before, u = u, np.clip(u + step, low, high)
            if np.abs(u - before).max() < _EXACT:
                break
        return u

    def _between(self, start: Array, end: Array) -> Array:
        width = end - start
        nodes = start[:, None] + width[:, None] * _NODES
        speeds = np.linalg.norm(self._tangents(nodes.reshape(-1)), axis=1)
        integrals: Array = (speeds.reshape(nodes.shape) @ _WEIGHTS) * width
        return integrals
