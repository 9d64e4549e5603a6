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
    """The robot cannot continue: it has touched something, or was sent where nothing can be.

    ``time`` is when, in µs. The arm has to stop; the robot itself stands from then on.
    """

    def __init__(self, slug: str, text: str, time: int) -> None:
        super().__init__(slug, text)
        self.time = time


@dataclass(frozen=True, slots=True)
class Measured:
    """Where a robot was, in degrees or mm, and with which torques, in Nm or N: (n, axes)."""

    axes: npt.NDArray[np.float64]
    torques: npt.NDArray[np.float64]


class Robot(Protocol):
    """Follows set-points."""

    @property
    def step(self) -> int:
        """µs from one set-point to the next that it needs; 0 where it needs none."""
        ...

    @property
    def chunk(self) -> int:
        """µs of set-points that it should be sent at once; a fault shows no earlier."""
        ...

    def stand(self, axes: Sequence[float]) -> None:
        """It stands at axes, robot axes first, in degrees (mm for linear ones)."""
        ...

    def carry(self, loads: Mapping[str, Load]) -> None:
        """From now on it carries these loads, by the names that `Settings.loads` has."""
        ...

    def follow(self, samples: Samples) -> Measured | None:
        """Follow set-points that are ``step`` apart and continue where the last ones ended.

        ``None`` where nothing is measured and the set-points stand for it. Raises `RobotFault`.
        """
        ...


class NoRobot:
    """No robot: only the plan passes, for programs whose control flow is all that counts."""

    step = 0
    chunk = 1_000_000

    def stand(self, axes: Sequence[float]) -> None:
        """Nothing stands."""

    def carry(self, loads: Mapping[str, Load]) -> None:
        """Nothing is carried."""

    def follow(self, samples: Samples) -> None:
        """Nothing follows."""


class KinematicRobot:
    """Is always at its set-point; ``cycle`` is the interpolation cycle in µs."""

    chunk = 1_000_000

    def __init__(self, cycle: int) -> None:
        self.step = cycle

    def stand(self, axes: Sequence[float]) -> None:
        """It has no state of its own."""

    def carry(self, loads: Mapping[str, Load]) -> None:
        """It has no masses."""

    def follow(self, samples: Samples) -> None:
        """Look at the set-points. Raises `RobotFault` where one is no number."""
        check_samples(samples)


def check_samples(samples: Samples) -> None:
    """Raise `RobotFault` at the first set-point that is no number."""
    import numpy as np

    sound = np.isfinite(samples.axes).all(axis=1)
    if not sound.all():
        raise RobotFault(
            "set_point", "a set-point is no number", int(samples.times[int(np.argmin(sound))])
        )
