"""An arm that is planned from its first motion on: most that a program computes needs none.

The planner and NumPy take longer to load than a short program to run.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from interp.robot.arm import ArmEvent, Position
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

    def __getattr__(self, name: str) -> Any:
        """Return what is not below from the other arm, which is made now."""
        return getattr(self._arm, name)

    def next_event(self) -> ArmEvent | None:
        """``None`` as long as there was no motion."""
        return self._arm.next_event() if self._is_made else None

    def pending(self) -> int:
        """0 as long as there was no motion."""
        return self._arm.pending() if self._is_made else 0

    def target(self) -> Position:
        """See `interp.robot.planning.planned_arm.PlannedArm.target`."""
        return self._arm.target()

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
