"""Who follows the planned path: a robot, through `interp.robot.simulation.tracking`, or nobody."""

from __future__ import annotations

from typing import Protocol

from interp.robot.arm import Arm, Motion


class Follower(Protocol):
    """Receives the set-points of the path behind the clock; raises `RobotFault` if it cannot."""

    def begun(self, time: int, motion: Motion) -> None:
        """Note that a motion begins: its frames and loads are in force from now on."""
        ...

    def advance(self, now: int) -> None:
        """Follow the path up to the last set-point that is due at ``now``."""
        ...

    def settle(self, now: int) -> None:
        """Follow the path up to ``now``."""
        ...

    def next_time(self, now: int) -> int | None:
        """Return when `advance` must be called next, in µs; ``None`` if the arm stands."""
        ...

    def measured(self, now: int) -> tuple[float, ...]:
        """Return the axes measured at ``now``."""
        ...


class Nobody:
    """The arm is where it is planned to be."""

    def __init__(self, arm: Arm) -> None:
        self._arm = arm

    def begun(self, time: int, motion: Motion) -> None:
        """See `Follower`."""

    def advance(self, now: int) -> None:
        """See `Follower`."""

    def settle(self, now: int) -> None:
        """See `Follower`."""

    def next_time(self, _now: int) -> int | None:
        """See `Follower`."""
        return None

    def measured(self, now: int) -> tuple[float, ...]:
        """See `Follower`."""
        return self._arm.position(now).axes
