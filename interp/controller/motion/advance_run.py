"""The advance run: what must wait until the main run has reached the program [ADV-04 ff.].

Statements and accesses that stop the advance run wait until the arm is at rest [ADV-04 to ADV-07],
unless CONTINUE exempts their line [ADV-08]. Their effects then happen in the main run. All other
effects happen while the arm still moves [ADV-09, ADV-13]. This is so with $ADVANCE=0 too, where the
behaviour of a controller is unknown [CON-09].
"""

from __future__ import annotations

from collections.abc import Callable

from interp.controller.motion.motion_queue import MotionQueue
from interp.controller.state.state import ControllerState
from interp.controller.state.tasks import Answer, Blocked, Task
from interp.port.requests import Continue, Request, StopAdvance


class AdvanceRun:
    """Synchronises programs with the motion queue."""

    def __init__(self, state: ControllerState, queue: MotionQueue) -> None:
        self._state = state
        self._queue = queue

    def when_reached(self, task: Task, request: Request, then: Callable[[], Answer]) -> Answer:
        """Call ``then`` once the program's own motions have ended.

        There is nothing to wait for in a submit program, in a line that CONTINUE exempts, and if no
        motion is pending.
        """
        if task.name == "submit" or task.exempt_line is not None:
            return then()
        if not self._queue.is_ahead(task):
            return then()
        self.stop(task, request)
        return Blocked(request, lambda: not self._queue.is_ahead(task), then)

    def stop(self, task: Task, request: Request) -> None:
        """Record that a request stops the advance run."""
        self._state.trace.record(task.name, "advance_stop", request.at)
        self._queue.stop_advance()

    def stop_here(self, task: Task, request: StopAdvance) -> Answer:
        """Execute an access that only stops the advance run [ADV-05, ADV-06]."""
        return self.when_reached(task, request, lambda: None)

    def exempt(self, task: Task, request: Continue) -> Answer:
        """Execute CONTINUE: the next line does not stop the advance run [ADV-08]."""
        task.exempt_line = request.at.file, request.at.line + 1
        return None
