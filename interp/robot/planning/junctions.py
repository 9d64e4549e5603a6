"""Junctions of a path: how the motion on one curve continues on the next.

Each curve has a parameter u of its own, so speed and acceleration change their unit from one to the
next, although the arm moves on without a jump.
"""

from __future__ import annotations

from dataclasses import dataclass

from interp.robot.planning.limits import Stretch


@dataclass(frozen=True, slots=True)
class PathState:
    """A parameter u, with speed and acceleration in units of u."""

    u: float
    speed: float
    acceleration: float


@dataclass(frozen=True, slots=True)
class Junction:
    """The start of a curve relative to the end of the one before.

    The speed du/dt is ``gear`` times the one before; the acceleration is ``gear`` times the one
    before plus ``bend`` times the square of the speed before. With a gear of 0 the arm stops.
    """

    gear: float
    bend: float = 0.0

    def then(self, following: Junction) -> Junction:
        """Return the junction past a curve of no length between this junction and the next."""
        bend = following.gear * self.bend + following.bend * self.gear**2
        return Junction(self.gear * following.gear, bend)

    def passed(self, state: PathState, start: float) -> PathState:
        """Return the state at the ``start`` of the curve, given that at the end of the last."""
        acceleration = self.gear * state.acceleration + self.bend * state.speed**2
        return PathState(start, state.speed * self.gear, acceleration)


@dataclass(frozen=True, slots=True)
class JoinedStretch:
    """A stretch, and the junction at its start."""

    stretch: Stretch
    junction: Junction


AT_REST = PathState(0.0, 0.0, 0.0)
STOP = Junction(0.0)
SAME_CURVE = Junction(1.0)
