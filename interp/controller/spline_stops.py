"""STOP WHEN PATH: a spline block stops as long as a condition is TRUE [SPL-06]."""

from __future__ import annotations

from interp.controller.inputs.operator_panel import OperatorPanel
from interp.controller.motion.arm_control import ArmControl
from interp.controller.motion.motion_queue import MotionQueue
from interp.controller.state.state import ControllerState
from interp.controller.state.tasks import Task
from interp.port.requests import SplineStop
from support.lazy_dataclass import dataclass


@dataclass(slots=True, eq=False)
class SplineStops:
    """Stops the arm at a STOP WHEN PATH place, or after it if that can no longer be reached."""

    _state: ControllerState
    _arm: ArmControl
    _queue: MotionQueue
    _panel: OperatorPanel
    _stopped_at: tuple[Task, SplineStop] | None = None

    @property
    def is_waiting(self) -> bool:
        """Whether the arm waits for a condition to become FALSE."""
        return self._stopped_at is not None

    def watch(self) -> None:
        """Evaluate the condition of the next place passed, or of the one where the arm stopped."""
        read = self._state.variables.read
        if self._stopped_at is None and self._queue.passed_stops:
            task, stop, is_late = self._queue.passed_stops.pop(0)
            if task.holds(stop.condition, read):
                self._stopped_at = task, stop
                if is_late:
                    self._state.messages.post_number(task.at, 3230)
                self._arm.halt()
        elif self._stopped_at is not None and self._state.clock.is_tick:
            task, stop = self._stopped_at
            if not task.holds(stop.condition, read):
                self._stopped_at = None
                self._panel.free_arm()
