"""Stretches of time in which every tick is like the one before, so that the clock may jump.

A program that waits looks at its condition in every cycle, and so do interrupts. Where a tick has
changed nothing, and has read nothing that time alone changes, the next one will be like it, until
the arm, a script or a wait with an end does something. Nothing of that is seen in a trace.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from interp.controller.automatic_inputs import AutomaticInputs
from interp.controller.motion_queue import MotionQueue
from interp.controller.state import ControllerState
from interp.controller.tasks import Task
from interp.port.requests import Poll, Request, Wait


@dataclass(slots=True)
class QuietTime:
    """Finds such stretches."""

    state: ControllerState
    queue: MotionQueue
    automatic: AutomaticInputs
    _before: tuple[int, int, int] | None = None

    def begin_tick(self) -> None:
        """A tick begins: what changes from here on is its doing."""
        self._before = self._counts()
        self.state.variables.has_read_changing = False

    def end(self, tasks: Sequence[Task], now: int, limit: int) -> int:
        """The time up to which all ticks are like the one that is over; ``now`` where none is."""
        clock, state = self.state.clock, self.state
        is_quiet = (
            clock.is_tick
            and self._before == self._counts()
            and not state.variables.has_read_changing
            and self.queue.next_time() is None
            and _waits(tasks[0], Poll, Wait)
            and all(_waits(task, Wait) for task in tasks[1:])  # which have longer slices
        )
        if not is_quiet:
            return now
        times = [limit, state.actions.next_time(), self.automatic.wake]
        times += (task.blocked.wake for task in tasks if task.blocked and _is_timed(task))
        end = min(time for time in times if time is not None)
        return end - end % clock.cycle

    def _counts(self) -> tuple[int, int, int]:
        state = self.state
        return state.trace.count, state.variables.writes, self.queue.count


def _is_timed(task: Task) -> bool:
    return task.blocked is not None and isinstance(task.blocked.request, Wait)


def _waits(task: Task, *kinds: type[Request]) -> bool:
    """Whether a program is over, or only waits: for a time, or for a condition."""
    blocked = task.blocked
    return task.is_over or (
        blocked is not None and not task.signals and isinstance(blocked.request, kinds)
    )
