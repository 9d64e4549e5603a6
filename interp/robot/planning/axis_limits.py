"""The limits of the axes of an arm: speed, acceleration, jerk, and torques [MOT-05, MOT-06]."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from interp.robot.arm import Load
from interp.robot.kinematics.kinematics import Array
from interp.robot.kinematics.machine_data import Axis, AxisDynamics, AxisKind, MachineData
from interp.robot.planning.torque_limits import TorqueLimits

_ROTARY, _LINEAR = AxisDynamics.ramped(180.0), AxisDynamics.ramped(1000.0)
"""The dynamics of an axis without machine data: assumed, similar to those of other arms."""


@dataclass(frozen=True, slots=True, eq=False)
class AxisLimits:
    """Speed, acceleration and jerk of all axes, each ``(axes,)``, in deg or mm and seconds.

    ``torques`` are the limits of an arm whose masses are known.
    """

    velocity: Array
    acceleration: Array
    jerk: Array
    torques: TorqueLimits | None = None

    def equals(self, other: AxisLimits) -> bool:
        """Return whether all limits are equal."""
        names = ("velocity", "acceleration", "jerk")
        are_equal = all(np.array_equal(getattr(self, n), getattr(other, n)) for n in names)
        return are_equal and self.torques == other.torques

    def carrying(self, loads: Mapping[str, Load]) -> AxisLimits:
        """Return the limits of the arm with these loads."""
        if self.torques is None:
            return self
        return replace(self, torques=self.torques.carrying(loads))

    def scaled(
        self, velocity: Sequence[float], acceleration: Sequence[float], jerk: Sequence[float]
    ) -> AxisLimits:
        """Return limits scaled by percentages; one outside 0 to 100 counts as 100 [MOT-02]."""
        count = len(self.velocity)
        return AxisLimits(
            self.velocity * _shares(velocity[:count]),
            self.acceleration * _shares(acceleration[:count]),
            self.jerk * _shares(jerk[:count]),
            self.torques,
        )

    def merged(self, other: AxisLimits, choose: Callable[[Array, Array], Array]) -> AxisLimits:
        """Return the lower or the higher limit for each axis; torques are those of the first."""
        return AxisLimits(
            choose(self.velocity, other.velocity),
            choose(self.acceleration, other.acceleration),
            choose(self.jerk, other.jerk),
            self.torques,
        )


def axis_limits(machine: MachineData, torques: TorqueLimits | None = None) -> AxisLimits:
    """Return the limits in the machine data [MOT-05, MOT-06], with those of its torques."""
    known = [_dynamics(axis) for axis in machine.every_axis]
    return AxisLimits(
        np.array([one.velocity for one in known]),
        np.array([one.acceleration for one in known]),
        np.array([one.jerk for one in known]),
        torques,
    )


def _dynamics(axis: Axis) -> AxisDynamics:
    if axis.dynamics is not None:
        return axis.dynamics
    return _LINEAR if axis.kind is AxisKind.LINEAR else _ROTARY


def _shares(percents: Sequence[float]) -> Array:
    return np.array([one / 100.0 if 0.0 < one <= 100.0 else 1.0 for one in percents])
