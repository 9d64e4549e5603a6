"""The advance run: what waits until the main run has come to where the program is [ADV-04 ff.].

Statements and accesses that stop the advance run wait until the arm stands [ADV-04 to ADV-07],
unless a CONTINUE exempts their line [ADV-08]. What then happens happens in the main run; what does
not stop it happens while the arm is still on its way [ADV-09, ADV-13], also with $ADVANCE=0, where
what a controller does is not known [CON-09].
"""

from __future__ import annotations

from collections.abc import Callable

from interp.controller.motion.motion_queue import MotionQueue
from interp.controller.state.state import ControllerState
from interp.controller.state.tasks import Answer, Blocked, Task
from interp.port.requests import Continue, Request, StopAdvance
from interp.values.faults import Fault


class AdvanceRun:
    """Synchronises programs with the motion queue."""

    def __init__(self, state: ControllerState, queue: MotionQueue) -> None:
        self._state = state
        self._queue = queue

    def when_reached(self, task: Task, request: Request, then: Callable[[], Answer]) -> Answer:
        """Do something once the program's own motions have ended.

        A submit program, a line that CONTINUE exempts and a program without pending motions do not
        wait.
        """
        if task.name == "submit" or task.exempt_line is not None:
            return then()
        self._queue.release()
        if not self._queue.own_pending(task):
            return then()
        self.stop(task, request)

        def finish() -> Answer:
            self._state.trace.origin = task.name, request.at
            try:
                return then()
            except Fault as error:
                return error

        return Blocked(request, lambda: not self._queue.own_pending(task), finish)

    def stop(self, task: Task, request: Request) -> None:
        """Record that a request stops the advance run."""
        self._state.trace.record(task.name, "advance_stop", request.at)
        self._queue.stop_advance()

    def stop_here(self, task: Task, request: StopAdvance) -> Answer:
        """An access that only stops the advance run [ADV-05, ADV-06]."""
        return self.when_reached(task, request, lambda: None)

    def exempt(self, task: Task, request: Continue) -> Answer:
        """CONTINUE: the next line does not stop the advance run [ADV-08]."""
        task.exempt_line = request.at.file, request.at.line + 1
        return None
