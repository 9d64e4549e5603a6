"""Quiet time: stretches in which every tick is like the previous one, so that the clock may jump.

A waiting program evaluates its condition in every cycle, and so do interrupts. If a tick has
changed nothing, and has read nothing that changes with time alone, the next tick will be the same,
until the arm, a script or a timed wait does something. None of this appears in a trace.

Loops and submit programs keep running meanwhile, and their slices end anywhere in the loop. If at a
tick all programs are in the same state as at an earlier tick, and nothing has changed in between,
the time in between is a period that repeats. Whole periods are skipped at once, and their
statements are counted as begun. The period is found with Brent's algorithm for cycle detection.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from interp.controller.inputs.automatic_inputs import AutomaticInputs
from interp.controller.motion.motion_queue import MotionQueue
from interp.controller.requests.waits import IDLE_AFTER
from interp.controller.state.state import ControllerState
from interp.controller.state.tasks import Blocked, Task
from interp.port.requests import Poll, Read, Request, Slice, StopAdvance, Wait, Write

#: Requests that leave nothing in a trace, apart from the effects of their writes.
_REPEATABLE: Final = (Read, Write, StopAdvance, Slice, Poll)
#: The largest number of comparisons with one mark, so that a state that never recurs costs little.
_LOOKS: Final = 1024


@dataclass(frozen=True, slots=True)
class _Mark:
    """The state of all programs at a tick, and how many statements each had begun."""

    time: int
    places: tuple[object, ...]
    begun: tuple[int, ...]


@dataclass(slots=True)
class QuietTime:
    """Detects quiet time. ``_acts`` counts the requests that are not `_REPEATABLE`."""

    state: ControllerState
    queue: MotionQueue
    automatic: AutomaticInputs
    _acts: int = 0
    _before: tuple[int | None, ...] | None = None
    _mark: _Mark | None = None
    _reach: int = 0
    _begun: int | None = None
    _since: int = -1

    def asked(self, request: Request) -> None:
        """Note a request."""
        self._acts += not isinstance(request, _REPEATABLE)

    def begin_tick(self, robot: Task) -> None:
        """Begin a tick; the second call in a tick, after an interruption of the run, is ignored."""
        if self._since == self.state.clock.now:
            return
        self._since, self._begun = self.state.clock.now, _begun(robot)
        counts = self._counts()
        if self._before != counts or self.state.variables.activity.has_read_changing:
            self._mark = None
        self._before = counts
        self.state.variables.activity.has_read_changing = False

    def end(self, tasks: Sequence[Task], now: int, limit: int, needs_ticks: bool) -> int:
        """Return the time in µs up to which all ticks are like the previous one, or ``now``.

        None is skipped of a controller that ``needs_ticks``.
        """
        clock, state = self.state.clock, self.state
        is_quiet = (
            now < limit
            and clock.is_tick
            and not needs_ticks
            and self._before == self._counts()
            and not state.variables.activity.has_read_changing
            and self.queue.next_time() is None
        )
        if not is_quiet:
            return now
        times = [limit, state.actions.next_time(), self.automatic.wake]
        times += (task.blocked.wake for task in tasks if task.blocked and _is_timed(task))
        end = min(time for time in times if time is not None)
        robot, *others = tasks  # the others have longer slices
        is_same = _begun(robot) == self._begun is not None  # no condition has called a function
        if _waits(robot, Wait, *[Poll][:is_same]) and all(_waits(task, Wait) for task in others):
            return max(now, end - end % clock.cycle)
        if any(task.blocked and task.blocked.wake != now for task in tasks if not _is_timed(task)):
            return now  # a slice would begin too soon after the stretch
        return now + self._skipped([task for task in tasks if not task.is_over], end - now)

    def _skipped(self, tasks: Sequence[Task], most: int) -> int:
        """Return the time in µs to skip: whole periods after which the state is the same as now."""
        now, cycle = self.state.clock.now, self.state.clock.cycle
        mark = self._mark
        if mark is not None and (now - mark.time) % max(self._reach // _LOOKS, cycle):
            return 0
        found = [self._place(task) for task in tasks]
        executors = [one.recurrent for one in tasks if one.recurrent is not None]
        if None in found or len(executors) < len(tasks):
            self._mark = None
            return 0
        phase = now % (cycle * self.state.profile.submit_every)
        places = (phase, self.state.actions.next_time(), *found)
        begun = tuple(executor.begun for executor in executors)
        if mark is None or mark.places != places:  # Brent: each mark is kept twice as long
            if mark is None:
                self._reach = cycle
            if mark is None or now - mark.time >= self._reach:
                self._mark, self._reach = _Mark(now, places, begun), 2 * self._reach
            return 0
        period = now - mark.time
        sizes = [new - old for new, old in zip(begun, mark.begun, strict=True)]
        rounds = [most // period]
        rounds += (one.spare // size for one, size in zip(executors, sizes, strict=True) if size)
        count = max(min(rounds), 0)
        for task, executor, size in zip(tasks, executors, sizes, strict=True):
            executor.skip(count * size)
            if not _is_timed(task):
                task.busy_at += count * period
        self._mark = _Mark(now + count * period, places, tuple(one.begun for one in executors))
        return count * period

    def _place(self, task: Task) -> tuple[object, ...] | None:
        """Return the state on which the future of a program depends, with times relative to now.

        Return ``None`` if it is unknown: a level on top of the program may end, and a debugged
        executor shows every statement.
        """
        blocked, now = task.blocked, self.state.clock.now
        is_waiting = blocked is not None and isinstance(blocked.request, (*_REPEATABLE, Wait))
        if not is_waiting or blocked is None or task.levels or task.signals or task.is_halted:
            return None
        state = None if task.recurrent is None else task.recurrent.recurrence_state()
        if state is None:
            return None
        place = (state, repr(blocked.request), task.exempt_line)
        if _is_timed(task):
            return place
        wake = None if blocked.wake is None else blocked.wake - now
        return *place, wake, task.spent, min(now - task.busy_at, IDLE_AFTER)

    def _counts(self) -> tuple[int | None, ...]:
        state = self.state
        return (
            state.trace.count,
            state.variables.activity.changes,
            self.queue.next_time(),
            self._acts,
        )


def _begun(task: Task) -> int | None:
    """Return how many statements have begun, or ``None`` if the executor does not count them."""
    return None if task.counting is None else task.counting.begun


def _is_timed(task: Task) -> bool:
    return task.blocked is not None and _is_one_of(task.blocked, Wait)


def _waits(task: Task, *kinds: type[Request]) -> bool:
    """Return whether a program has ended, or only waits with one of these requests."""
    blocked = task.blocked
    return task.is_over or (
        blocked is not None and not task.signals and _is_one_of(blocked, *kinds)
    )


def _is_one_of(blocked: Blocked, *kinds: type[Request]) -> bool:
    return isinstance(blocked.request, kinds) and not blocked.is_postponed
