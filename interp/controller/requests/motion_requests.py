"""The handlers of motion requests: how far the program may run ahead of the arm [ADV-01 ff.]."""

from __future__ import annotations

from interp.controller.motion.motion_queue import MotionQueue
from interp.controller.state.messages import own_fault
from interp.controller.state.state import ControllerState
from interp.controller.state.tasks import Answer, Blocked, Task
from interp.port.requests import At, Move, MoveEmily, MoveSpline, SetTrigger
from interp.values.faults import Fault


class MotionRequests:
    """Answers requests for motions; the motion queue itself answers those for triggers."""

    def __init__(self, state: ControllerState, queue: MotionQueue) -> None:
        self._state = state
        self._queue = queue

    def move(self, task: Task, request: Move | MoveSpline) -> Answer:
        """Plan a motion; the program continues once it is at most $ADVANCE motions ahead.

        With $ADVANCE=3, the program waits after the third planned motion while the arm executes
        another one. With $ADVANCE=0 it waits for the end of each motion [ADV-01, ADV-02, INT-12].
        """
        if task.name == "submit":
            raise own_fault("submit_motion")
        is_first, triggers = self._queue.is_unused, task.triggers
        try:
            self._queue.plan(task, request)
        except Fault as error:
            if not self._replaces(task, request, triggers, error):
                return self._skip(task, request.at, error)
        if is_first and self._state.profile.runs_coincidence:
            return self._coincide(task, request)
        advance = self._state.variables.read(("$ADVANCE",))
        assert isinstance(advance, int)
        if not advance:
            self._queue.stop_advance()
        return Blocked(request, lambda: self._queue.own_pending(task) <= advance, lambda: None)

    def _replaces(
        self, task: Task, request: Move | MoveSpline, triggers: list[SetTrigger], error: Fault
    ) -> bool:
        """Try a PTP to the end of a motion that cannot be planned, and return whether it works.

        This way the next motions begin where they should, although the posture of the arm is not
        that of the program.
        """
        profile = self._state.profile
        if not (profile.is_tolerant and profile.brings_arm) or isinstance(request, MoveSpline):
            return False
        task.triggers = triggers
        try:
            self._queue.plan(task, request, is_replaced=True)
        except Fault:
            return False
        instead = Fault(error.slug, f"{error}, PTP instead", number=error.number, rules=error.rules)
        self._state.skip(task.name, request.at, instead)
        return True

    def _coincide(self, task: Task, request: Move | MoveSpline) -> Blocked:
        """Execute the block coincidence run: the program waits for its end [ADV-14]."""
        self._queue.is_coincidence_run = True
        messages = self._state.messages
        messages.post_number(request.at, 309, "state")
        self._queue.stop_advance()

        def reached() -> None:
            self._queue.is_coincidence_run = False
            messages.post_number(request.at, 1350)

        return Blocked(request, lambda: not self._queue.own_pending(task), reached)

    def move_emily(self, task: Task, request: MoveEmily) -> Answer:
        """Skip the motion, which is not simulated, or raise `Fault`."""
        return self._skip(task, request.at, own_fault("motion_kind"))

    def _skip(self, task: Task, at: At, error: Fault) -> Answer:
        """Continue without a motion if the profile is tolerant, else raise ``error``.

        If the same motion is skipped again, end the slice: time passes in a loop in which all
        motions fail.
        """
        if not self._state.profile.is_tolerant:
            raise error
        if (at.file, at.line) in self._state.skipped:
            task.spent = self._state.profile.requests
        self._state.skip(task.name, at, error)
        return None
