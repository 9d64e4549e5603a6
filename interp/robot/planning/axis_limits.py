"""The limits of the axes of an arm: speed, acceleration, jerk, and torques [MOT-05, MOT-06]."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from interp.robot.arm import Load
from interp.robot.kinematics.kinematics import Array
from interp.robot.kinematics.machine_data import AxisDynamics, AxisKind, MachineData
from interp.robot.planning.torque_limits import TorqueLimits

#: The dynamics of an axis without machine data: assumed, similar to those of other arms.
_ROTARY, _LINEAR = AxisDynamics.ramped(180.0), AxisDynamics.ramped(1000.0)


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
        are_equal = all(map(np.array_equal, self._rates, other._rates))
        return are_equal and self.torques == other.torques

    def carrying(self, loads: Mapping[str, Load]) -> AxisLimits:
        """Return the limits of the arm with these loads."""
        return replace(self, torques=self.torques and self.torques.carrying(loads))

    def scaled(self, *percents: Sequence[float]) -> AxisLimits:
        """Return limits of speed, acceleration and jerk scaled by percentages.

        One outside 0 to 100 counts as 100 [MOT-02].
        """
        return self._changed(np.multiply, [_shares(one[: len(self.velocity)]) for one in percents])

    def merged(self, other: AxisLimits, choose: Callable[[Array, Array], Array]) -> AxisLimits:
        """Return the lower or the higher limit for each axis; torques are those of the first."""
        return self._changed(choose, other._rates)

    def _changed(
        self, change: Callable[[Array, Array], Array], others: Sequence[Array]
    ) -> AxisLimits:
        velocity, acceleration, jerk = map(change, self._rates, others)
        return AxisLimits(velocity, acceleration, jerk, self.torques)

    @property
    def _rates(self) -> tuple[Array, Array, Array]:
        return self.velocity, self.acceleration, self.jerk


def axis_limits(machine: MachineData, torques: TorqueLimits | None = None) -> AxisLimits:
    """Return the limits in the machine data [MOT-05, MOT-06], with those of its torques."""
    assumed = {AxisKind.LINEAR: _LINEAR}
    known = [axis.dynamics or assumed.get(axis.kind, _ROTARY) for axis in machine.every_axis]
    rates = np.array([(one.velocity, one.acceleration, one.jerk) for one in known])
    velocity, acceleration, jerk = rates.T
    return AxisLimits(velocity, acceleration, jerk, torques)


def _shares(percents: Sequence[float]) -> Array:
    return np.array([one / 100.0 if 0.0 < one <= 100.0 else 1.0 for one in percents])
