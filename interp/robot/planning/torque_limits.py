"""Limits of the torques of an arm whose masses are known, as bounds on the speed along a curve.

For u(t) along a curve q(u) the torque of an axis is ``a·ü + b·u̇² + c``: a is what inertia resists,
b is the effect of curvature, centrifugal and Coriolis forces, c that of gravity. If ``|b|·v² +
|a|·w`` is below what gravity leaves of every axis's torque, every profile with speeds up to v and
accelerations up to w respects the limits. Friction is not included.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Protocol

import numpy as np

from interp.robot.arm import Load
from interp.robot.kinematics.kinematics import Array
from interp.robot.path.axis_path import AxisPath

#: Share of a torque that is used, because it is computed at samples only.
_MARGIN = 0.95
#: Share of what gravity leaves that constant speed may take; the rest is for changing it.
_FAST = 0.5
#: Share of a torque that counts as free although gravity takes it: the arm moves, if slowly, and
#: whoever simulates it reports that it cannot.
_LEFT = 0.1
_FEWEST, _MOST = 33, 129  # samples of a curve


class Dynamics(Protocol):
    """The masses of an arm."""

    def torques(
        self, axes: Array, speeds: Array, accelerations: Array, loads: Mapping[str, Load]
    ) -> Array:
        """Return torques ``(n, axes)`` in Nm or N; arguments likewise, in deg or mm, and s."""
        ...


@dataclass(frozen=True, slots=True)
class TorqueLimits:
    """The largest torques of the axes, in Nm or N, for an arm that carries ``loads``."""

    dynamics: Dynamics
    largest: tuple[float, ...]
    loads: Mapping[str, Load] = field(default_factory=dict)

    def carrying(self, loads: Mapping[str, Load]) -> TorqueLimits:
        """Return the limits of the arm with these loads."""
        return self if loads == self.loads else replace(self, loads=loads)

    def along(self, curve: AxisPath) -> TorqueMargin:
        """Return what the torques leave for moving along a curve."""
        u = curve.grid
        if not _FEWEST <= len(u) <= _MOST:
            u = np.linspace(0.0, 1.0, min(max(len(u), _FEWEST), _MOST))
        axes = curve.axes(u)
        first, second, _ = curve.rates(u)
        rest = np.zeros_like(axes)
        held, steady, pushed = (
            self.dynamics.torques(axes, *rates, self.loads)
            for rates in ((rest, rest), (first, second), (rest, first))
        )
        largest = np.full(axes.shape[1], np.inf)
        largest[: len(self.largest)] = self.largest
        margin = np.maximum(_MARGIN * largest - np.abs(held), _LEFT * largest)
        return TorqueMargin(u, margin, np.abs(steady - held), np.abs(pushed - held))


@dataclass(frozen=True, slots=True, eq=False)
class TorqueMargin:
    """Samples along a curve: what gravity leaves, and what speed and acceleration along u take.

    ``u`` is ``(n,)``, the others are ``(n, axes)``: ``margin`` in Nm or N, ``steady`` by the square
    of du/dt, and ``pushed`` by d²u/dt².
    """

    u: Array
    margin: Array
    steady: Array
    pushed: Array

    def between(self, start: float, end: float) -> TorqueMargin:
        """Return the samples of a part of the curve, and the next one on either side."""
        low = max(int(np.searchsorted(self.u, start, side="right")) - 1, 0)
        part = slice(low, int(np.searchsorted(self.u, end)) + 1)
        return TorqueMargin(self.u[part], self.margin[part], self.steady[part], self.pushed[part])

    @property
    def fastest(self) -> float:
        """The largest speed that leaves enough for changing it, in u per second."""
        return float(np.sqrt((_FAST * self.margin / np.maximum(self.steady, 1e-12)).min()))

    def left(self, speed: float) -> float:
        """Return the largest acceleration at speeds up to this one, in u per second squared."""
        free = self.margin - self.steady * speed**2
        return float((free / np.maximum(self.pushed, 1e-12)).min())
