"""An arm that is planned from its first motion on: most that a program computes needs none.

The planner and NumPy take longer to load than a short program to run.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import TYPE_CHECKING, Any, cast

if TYPE_CHECKING:
    from interp.robot.arm import ArmEvent, Position
    from interp.robot.planning.planned_arm import PlannedArm


def deferred_arm(make: Callable[[], PlannedArm]) -> PlannedArm:
    """Return an arm that stands, until it is asked for more than the one that ``make`` gives."""
    return cast("PlannedArm", _DeferredArm(make))


class _DeferredArm:
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
        return getattr(self._arm, name)

    def next_event(self) -> ArmEvent | None:
        return self._arm.next_event() if self._is_made else None

    def pending(self) -> int:
        return self._arm.pending() if self._is_made else 0

    def target(self) -> Position:  # the type of the arm is asked whether it has this
        return self._arm.target()

    def forget(self, time: int) -> None:
        if self._is_made:
            self._arm.forget(time)

    def override(self, now: int, percent: float) -> None:
        if self._is_made:
            self._arm.override(now, percent)
        else:
            self._override = now, percent
