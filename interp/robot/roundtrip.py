"""From axes to pose, Status and Turn, and back: does an arm return to where it stood [POS-12]?"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from interp.robot.kinematics.solver import Arm
from interp.robot.kinematics.targets import solve_many, turn_of

__all__ = ["RoundTrips", "round_trips"]

_EXACT = 1e-6  # degrees
_AT_ONCE = 1_000


@dataclass(frozen=True, slots=True)
class RoundTrips:
    """Of so many positions, how many came back exactly, and by how many degrees the worst did not.

    Exactly: the same Status, the same Turn, and every axis to a millionth of a degree.
    """

    count: int
    exact: int
    worst: float


def round_trips(arm: Arm, count: int, seed: int = 2026) -> RoundTrips:
    """Try positions that lie anywhere within the software limits."""
    lower = [axis.lower for axis in arm.machine.axes]
    upper = [axis.upper for axis in arm.machine.axes]
    random = np.random.default_rng(seed)
    exact, worst = 0, 0.0
    for first in range(0, count, _AT_ONCE):
        axes = random.uniform(lower, upper, (min(_AT_ONCE, count - first), len(lower)))
        statuses = arm.status(axes).tolist()
        turns = [turn_of(each) for each in axes.tolist()]
        found = solve_many(arm, arm.forward(axes), statuses, turns)
        off = np.abs(np.array([each.axes for each in found]) - axes).max(axis=1)
        worst = max(worst, float(off.max()))
        exact += sum(
            (each.status, each.turn) == (status, turn) and difference < _EXACT
            for each, status, turn, difference in zip(found, statuses, turns, off, strict=True)
        )
    return RoundTrips(count, exact, worst)
