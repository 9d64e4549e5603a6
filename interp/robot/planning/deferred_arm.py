"""An arm that is planned from its first motion on: most that a program computes needs none.

The planner and NumPy take longer to load than a short program to run.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    from interp.robot.arm import ArmEvent, Motion, Position, Samples
    from interp.robot.planning.planned_arm import PlannedArm


class DeferredArm:
    """An `interp.robot.arm.Arm` that stands; ``make`` gives the one that does all else."""

    def __init__(self, make: Callable[[], PlannedArm]) -> None:
        self._make = make
        self._is_made = False
        #: The override in force and since when, for an arm that is not made yet.
        self._override: tuple[int, float] | None = None

    @cached_property
    def _arm(self) -> PlannedArm:
        arm = self._make()
        if self._override is not None:
            arm.override(*self._override)
        self._is_made = True
        return arm

    def plan(self, now: int, motion: Motion) -> tuple[int, ...]:
        """See `interp.robot.arm.Arm.plan`, here and below."""
        return self._arm.plan(now, motion)

    def mark(self) -> object:
        """Return a mark for `rewind`."""
        return self._arm.mark()

    def rewind(self, mark: object) -> None:
        """Undo plans."""
        self._arm.rewind(mark)

    def next_event(self) -> ArmEvent | None:
        """``None`` as long as there was no motion."""
        return self._arm.next_event() if self._is_made else None

    def take(self) -> ArmEvent:
        """`next_event`, which has happened."""
        return self._arm.take()

    def pending(self) -> int:
        """0 as long as there was no motion."""
        return self._arm.pending() if self._is_made else 0

    def target(self) -> Position:
        """See `interp.robot.planning.planned_arm.PlannedArm.target`."""
        return self._arm.target()

    def position(self, time: int) -> Position:
        """Return the set-point."""
        return self._arm.position(time)

    def speed(self, time: int) -> float:
        """Return the speed of the tool."""
        return self._arm.speed(time)

    def distances(self, time: int) -> tuple[float, float]:
        """Travelled and left of the running motion."""
        return self._arm.distances(time)

    def sample(self, times: npt.NDArray[np.int64]) -> Samples:
        """Set-points."""
        return self._arm.sample(times)

    def forget(self, time: int) -> None:
        """Forget the path before a time."""
        if self._is_made:
            self._arm.forget(time)

    def override(self, now: int, percent: float) -> None:
        """$OV_PRO changes."""
        if self._is_made:
            self._arm.override(now, percent)
        else:
            self._override = now, percent

    def brake(self, now: int, is_hard: bool) -> None:
        """Stop on the path."""
        self._arm.brake(now, is_hard)

    def proceed(self, now: int) -> None:
        """Continue."""
        self._arm.proceed(now)

    def discard(self, now: int) -> None:
        """Forget what is ahead."""
        self._arm.discard(now)
