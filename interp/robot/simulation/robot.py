"""The interface of a robot that follows set-points, and the two robots without masses."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

from interp.robot.arm import Load, Samples
from interp.values.faults import Fault

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt


class RobotFault(Fault):
    """The robot cannot continue: it has lost its set-points, or one of them is NaN.

    ``time`` is the time in µs. The arm has to stop; the robot itself stands still from then on.
    """

    def __init__(self, slug: str, text: str, time: int) -> None:
        super().__init__(slug, text)
        self.time = time


@dataclass(frozen=True, slots=True)
class Measured:
    """Measured axes in degrees or mm, and torques in Nm or N, both (n, axes)."""

    axes: npt.NDArray[np.float64]
    torques: npt.NDArray[np.float64]


class Robot(Protocol):
    """A robot that follows set-points."""

    @property
    def step(self) -> int:
        """The time in µs between set-points that the robot needs; 0 if it needs none."""
        ...

    @property
    def chunk(self) -> int:
        """The time in µs of set-points to send at once; a fault is not detected earlier."""
        ...

    def stand(self, axes: Sequence[float]) -> None:
        """Place the robot at axes, robot axes first, in degrees (mm if linear)."""
        ...

    def carry(self, loads: Mapping[str, Load]) -> None:
        """Set the loads that the robot carries from now on, by the names in `Settings.loads`."""
        ...

    def follow(self, samples: Samples) -> Measured | None:
        """Follow set-points that are ``step`` apart and continue the previous ones.

        Return ``None`` if nothing is measured; the set-points then count as measured. Raises
        `RobotFault`.
        """
        ...


class NoRobot:
    """No robot: only the plan is computed, for programs whose control flow is all that matters."""

    step = 0
    chunk = 1_000_000

    def stand(self, axes: Sequence[float]) -> None:
        """Do nothing."""

    def carry(self, loads: Mapping[str, Load]) -> None:
        """Do nothing."""

    def follow(self, samples: Samples) -> None:
        """Do nothing."""


class KinematicRobot:
    """A robot that is always at its set-point; ``cycle`` is the interpolation cycle in µs."""

    chunk = 1_000_000

    def __init__(self, cycle: int) -> None:
        self.step = cycle

    def stand(self, axes: Sequence[float]) -> None:
        """Do nothing: this robot has no state."""

    def carry(self, loads: Mapping[str, Load]) -> None:
        """Do nothing: this robot has no masses."""

    def follow(self, samples: Samples) -> None:
        """Check the set-points; raise `RobotFault` if one is infinite or NaN."""
        check_samples(samples)


def check_samples(samples: Samples) -> None:
    """Raise `RobotFault` at the first set-point that is infinite or NaN."""
    import numpy as np

    sound = np.isfinite(samples.axes).all(axis=1)
    if not sound.all():
        raise RobotFault(
            "set_point", "a set-point is no number", int(samples.times[int(np.argmin(sound))])
        )
