"""Interrupts and actions of triggers: when they are entered, BRAKE and RESUME [INT-01 ff.].

Their routines may do everything that other routines do [INT-16], except what is rejected here.
"""

from __future__ import annotations

from typing import Final

from interp.controller.interrupts.levels import Levels
from interp.controller.motion.advance_run import AdvanceRun
from interp.controller.motion.arm_control import ArmControl
from interp.controller.motion.motion_queue import MotionQueue
from interp.controller.motion.positions import Positions
from interp.controller.state.messages import message_fault, own_fault
from interp.controller.state.state import ControllerState
from interp.controller.state.tasks import ALWAYS, Answer, Blocked, Level, Task
from interp.port.requests import (
    BrakeArm,
    DeclareInterrupt,
    Request,
    Resume,
    SetTrigger,
    SwitchInterrupt,
)
from interp.robot.api.commands import CallCommand
from support.lazy_dataclass import dataclass

#: The priority of PRIO=-1, for which the system may pick any of 40 to 80 [TRG-06].
_SYSTEM: Final = 40


@dataclass(slots=True, eq=False)
class InterruptUnit:
    """Evaluates the conditions of interrupts, and enters the actions of interrupts and triggers."""

    _state: ControllerState
    _arm: ArmControl
    _positions: Positions
    _queue: MotionQueue
    _advance: AdvanceRun
    _levels: Levels

    # --------------------------------------------------------------- declaration and events

    def declare(self, task: Task, request: DeclareInterrupt) -> None:
        """Execute INTERRUPT DECL, also of a submit program [SUB-10]. Raises `Fault`."""
        task.interrupts.declare(request)

    def switch(self, task: Task, request: SwitchInterrupt) -> None:
        """Execute INTERRUPT ON, OFF, ENABLE or DISABLE. Raises `Fault`."""
        read = self._state.variables.read
        task.interrupts.switch(request.action, request.number, lambda code: task.holds(code, read))

    def watch(self, task: Task) -> None:
        """Evaluate the conditions of all interrupts at a tick. Raises `Fault`."""
        if not task.interrupts.is_watched:
            return
        read = self._state.variables.read
        running = sum(level.interrupt is not None for level in task.levels)
        come = task.interrupts.watch(lambda code: task.holds(code, read), running)
        if come and task.name == "robot":
            self._positions.keep("INT")

    def dispatch(self, task: Task) -> None:
        """Enter what is pending, if its priority is higher than that of what runs [INT-05]."""
        interrupt = task.interrupts.next()
        call = min(self._queue.fired, key=_priority, default=None) if task.name == "robot" else None
        if call is not None and (interrupt is None or _priority(call) <= interrupt.number):
            self._enter_call(task, call, _priority(call))
        elif interrupt is not None and interrupt.number < task.priority:
            interrupt.has_come = False
            self._levels.enter(
                task,
                "interrupt",
                interrupt.number,
                interrupt.at,
                interrupt.action,
                interrupt=interrupt,
            )

    def _enter_call(self, task: Task, command: CallCommand, priority: int) -> None:
        if priority < task.priority:
            self._queue.fired.remove(command)
            trigger = _trigger(command)
            self._levels.enter(task, "trigger", priority, trigger.at, trigger.action, call=command)

    # ---------------------------------------------------------------------- BRAKE and RESUME

    def brake(self, task: Task, request: BrakeArm) -> Answer:
        """Execute BRAKE: the routine continues when the arm is at rest [INT-09]. Raises `Fault`."""
        level = task.level
        if level is None or level.kind != "interrupt" or task.name == "submit":
            raise own_fault("brake_place")
        self._state.trace.record(task.name, "brake", request.at, mode=request.mode)
        if self._arm.is_moving:
            level.has_braked = True
            self._arm.brake(is_hard=request.mode is not None)
            return Blocked(request, lambda: self._arm.is_standing, lambda: self._braked(level))
        self._positions.keep("RET")
        return None

    def _braked(self, level: Level) -> None:
        self._positions.keep("RET")
        level.braked_at = self._positions.actual().axes

    def resume(self, task: Task, request: Resume) -> Answer:
        """Execute RESUME: return to the declaring level, after its call [INT-10, INT-11].

        The arm first finishes the motions of the interrupt routine itself (unconfirmed). Raises
        `Fault`.
        """
        level = task.level
        if level is None or level.interrupt is None:
            raise own_fault("resume_place")
        if level.interrupt.is_global:
            raise message_fault(72)
        target = level.interrupt.depth
        if level.depth <= target:
            raise own_fault("resume_level")
        if not level.motions:
            return self._resume(task, request, target)
        self._advance.stop(task, request)
        return Blocked(
            request, lambda: not level.motions, lambda: self._resume(task, request, target)
        )

    def _resume(self, task: Task, request: Request, target: int) -> Answer:
        self._state.trace.record(task.name, "resume", request.at, depth=target)
        while task.level is not None and task.level.depth >= target:
            self._levels.pop(task)
        task.interrupts.forget(target + 1)
        task.executor.unwind(target)
        task.triggers.clear()
        if task.name == "submit":
            return None
        self._arm.discard()
        self._queue.fired.clear()
        return Blocked(
            request,
            lambda: self._arm.is_standing,
            lambda: None,
            is_open=False,  # the executor has left its routine, so other interrupts may be entered
        )


def _trigger(command: CallCommand) -> SetTrigger:
    assert isinstance(command.what, SetTrigger), "made by the motion queue"
    return command.what


def _priority(command: CallCommand) -> int:
    """Return the priority of a trigger's action; an assignment has none and always runs."""
    priority = _trigger(command).priority
    return ALWAYS if priority is None else _SYSTEM if priority == -1 else priority
