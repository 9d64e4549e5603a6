"""Levels on top of a program: interrupt routines, actions of triggers, cyclic signals.

After a routine that has used BRAKE, the arm moves back to its path and continues there.

A level is entered while a request of the executor is unanswered, and only the top level runs. When
it ends, the request below is made again, and the program continues to wait for what it waited for.
"""

from __future__ import annotations

from interp.controller.motion.arm_control import ArmControl
from interp.controller.motion.motion_queue import MotionQueue
from interp.controller.motion.positions import Positions
from interp.controller.state.declared_interrupts import Interrupt
from interp.controller.state.state import ControllerState
from interp.controller.state.tasks import ALWAYS, Answer, Blocked, Level, LevelKind, Task
from interp.port.requests import At, CodeHandle, End, SwitchSignal
from interp.robot.api.commands import CallCommand
from support.lazy_dataclass import dataclass


@dataclass(slots=True, eq=False)
class Levels:
    """Pushes and pops the levels of programs."""

    _state: ControllerState
    _arm: ArmControl
    _positions: Positions
    _queue: MotionQueue

    def enter(
        self,
        task: Task,
        kind: LevelKind,
        priority: int,
        at: At,
        code: CodeHandle,
        *,
        interrupt: Interrupt | None = None,
        call: CallCommand | None = None,
        signal: SwitchSignal | None = None,
    ) -> None:
        """Push a level; its code runs when the task runs next."""
        assert task.blocked is not None, "only a program that waits is interrupted"
        base = self._state.variables.read(("$BASE",)) if kind == "interrupt" else None
        level = Level(
            kind, priority, at, task.executor.depth, task.blocked, base, interrupt, call, signal
        )
        if priority != ALWAYS:
            self._state.trace.record(task.name, "interrupt_enter", at, priority=priority)
        task.executor.enter(code)
        task.levels.append(level)
        task.at, task.blocked, task.reply = at, None, None

    def leave(self, task: Task, level: Level) -> Answer:
        """End the top level; return what to wait for before the level below continues."""
        if not level.has_braked or not level.has_moved:
            return self._finish(task, level)
        return Blocked(
            End(level.at),
            lambda: not level.motions,
            lambda: self._return_to_path(task, level),
            is_open=False,
        )

    def _return_to_path(self, task: Task, level: Level) -> Answer:
        """Move back to where BRAKE stopped the arm, if the routine has moved it away from there."""
        here = self._positions.actual().axes
        if level.braked_at is not None and not _is_near(level.braked_at, here):
            self._queue.plan_return(task, level.at, level.braked_at)
        return Blocked(
            End(level.at),
            lambda: not level.motions,
            lambda: self._finish(task, level),
            is_open=False,
        )

    def _finish(self, task: Task, level: Level) -> Answer:
        self.pop(task)
        if level.has_braked:
            self._arm.proceed()
        saved = level.saved
        task.at = saved.request.at
        if not saved.is_open:
            return saved
        again = task.executor.advance(None)
        if again != saved.request:
            raise AssertionError(f"the request after a level is {again}, not {saved.request}")
        return saved

    def pop(self, task: Task) -> None:
        """Remove the top level, and restore what it has changed only for itself."""
        level = task.levels.pop()
        below = task.level
        if below is not None and level.has_moved:  # one that has braked must return the arm
            below.has_moved = True
            below.motions |= level.motions
        if level.base is not None:  # [INT-13]
            self._state.variables.put(("$BASE",), level.base)
        if level.priority != ALWAYS:
            self._state.trace.record(
                task.name, "interrupt_leave", level.at, priority=level.priority
            )
        if level.call is not None:
            self._arm.core.complete(self._state.clock.now, level.call)


def _is_near(left: tuple[float, ...], right: tuple[float, ...]) -> bool:
    return all(abs(one - other) < 1e-6 for one, other in zip(left, right, strict=True))
