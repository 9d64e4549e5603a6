"""What interrupts a program: interrupt routines, actions of triggers, cyclic signals and flags.

Everything is entered at a request of the executor that is not answered yet, and only the top level
runs. When it ends the request below is asked again, and what it waited for goes on.
"""

from __future__ import annotations

from typing import Any, Final

from interp.controller.interrupts import Interrupt
from interp.controller.messages import message_fault, own_fault
from interp.controller.motion_queue import Call, Moving
from interp.controller.tasks import ALWAYS, Blocked, Level, LevelKind, Task
from interp.controller.world import Setup
from interp.port.requests import (
    BrakeArm,
    Code,
    DeclareInterrupt,
    End,
    Request,
    Resume,
    SetCyclicFlag,
    SwitchInterrupt,
    SwitchSignal,
    Value,
)
from interp.robot.api.commands import CallCommand
from interp.robot.api.control_core import ControlCore
from interp.values.faults import Fault

__all__ = ["Entering"]

#: Priorities that the system gives out, for PRIO=-1 [TRG-06].
_SYSTEM: Final = range(40, 81)
_SIGNAL_LIMITS: Final = {
    "ANIN": ("analog_inputs", 1543),
    "ANOUT": ("analog_outputs", None),
    "DIGIN": ("digital_inputs", None),
}


class Entering(Moving):
    """A controller that interrupts programs."""

    def __init__(self, core: ControlCore, setup: Setup) -> None:
        super().__init__(core, setup)
        self._cyclic_flags: dict[int, tuple[Task, Code]] = {}

    # ---------------------------------------------------------------------- levels

    def enter(self, task: Task, level: Level, code: Code) -> None:
        """Push a level; its code runs when the task runs next."""
        task.executor.enter(code)
        task.levels.append(level)
        task.blocked, task.reply = None, None

    def _level(self, task: Task, kind: LevelKind, priority: int, at: Any, **more: Any) -> Level:
        base: Value | None = self.variables.read(("$BASE",)) if kind == "interrupt" else None
        return Level(kind, priority, at, task.executor.depth, task.blocked, base, **more)

    def leave(self, task: Task) -> Any:
        """The code of the top level has ended: what is to be waited for, then the level below."""
        level = task.levels[-1]
        if not level.has_braked or not level.has_moved:
            return self._left(task)
        end = End(level.at)
        return Blocked(
            end, lambda: not level.motions, lambda: self._go_back(task, end), is_open=False
        )

    def _go_back(self, task: Task, end: Request) -> Any:
        """The routine has moved the arm after its BRAKE: back to where the path was left."""
        level = task.levels[-1]
        if level.stand is not None and not _is_near(level.stand, self.where()[0]):
            try:
                self.load(task, self.builder.back_to(level.at, level.stand))
            except Fault as error:
                return error
        return Blocked(end, lambda: not level.motions, lambda: self._left(task), is_open=False)

    def _left(self, task: Task) -> Any:
        level = task.levels[-1]
        self._pop(task)
        if level.has_braked:
            self.core.proceed(self.clock.now)
        saved = level.saved
        if saved is None or not saved.is_open:
            return saved
        again = task.executor.advance(None)
        if again != saved.request:
            raise AssertionError(f"asked again {again}, not {saved.request}")
        return saved

    def _pop(self, task: Task) -> None:
        level = task.levels.pop()
        if task.levels and level.has_moved:  # where that one has braked, it has to go back
            task.levels[-1].has_moved = True
            task.levels[-1].motions |= level.motions
        if level.base is not None:  # [INT-13]
            self.variables.put(("$BASE",), level.base)
        if level.kind != "cycle" and level.priority != ALWAYS:
            self.trace.tell(task.name, "interrupt_leave", level.at, priority=level.priority)
        if level.call is not None:
            self.core.complete(self.clock.now, level.call)

    # ---------------------------------------------------------------------- interrupts

    def declare(self, task: Task, request: DeclareInterrupt) -> None:
        """INTERRUPT DECL. Raises `Fault`."""
        task.interrupts.declare(request)

    def switch_interrupt(self, task: Task, request: SwitchInterrupt) -> None:
        """INTERRUPT ON, OFF, ENABLE, DISABLE. Raises `Fault`."""
        task.interrupts.switch(request.action, request.number, lambda code: self.holds(task, code))

    def holds(self, task: Task, code: Code) -> bool:
        """A condition as it is now. Raises `Fault`."""
        return task.executor.evaluate(code, self.variables.read) is True

    def watch(self, task: Task) -> None:
        """A tick: look at all conditions. Raises `Fault`."""
        if not task.interrupts.is_watched:
            return
        running = sum(level.interrupt is not None for level in task.levels)
        come = task.interrupts.watch(lambda code: self.holds(task, code), running)
        if come and task.name == "robot":
            self.positions.keep("INT")

    def dispatch(self, task: Task) -> None:
        """Enter what has come and has a higher priority than what runs [INT-05]."""
        interrupt = task.interrupts.next()
        call = self._first_call() if task.name == "robot" else None
        if call is not None:
            priority = self._priority(call)
            if interrupt is None or priority <= interrupt.number:
                if priority < task.priority:
                    self._enter_call(task, call, priority)
                return
        if interrupt is not None and interrupt.number < task.priority:
            self._enter_interrupt(task, interrupt)

    def _enter_interrupt(self, task: Task, interrupt: Interrupt) -> None:
        interrupt.has_come = False
        at = interrupt.at
        level = self._level(task, "interrupt", interrupt.number, at, interrupt=interrupt)
        self.trace.tell(task.name, "interrupt_enter", at, priority=interrupt.number)
        self.enter(task, level, interrupt.action)

    def _first_call(self) -> CallCommand | None:
        return min(self.fired, key=self._priority, default=None)

    def _priority(self, command: CallCommand) -> int:
        """The priority of a trigger's call; that of PRIO=-1 is chosen when it is entered."""
        assert isinstance(command.what, Call), "made by `Moving`"
        priority = command.what.trigger.priority
        return ALWAYS if priority is None else _SYSTEM[0] if priority == -1 else priority

    def _enter_call(self, task: Task, command: CallCommand, priority: int) -> None:
        assert isinstance(command.what, Call), "made by `Moving`"
        self.fired.remove(command)
        trigger = command.what.trigger
        if trigger.priority == -1:
            taken = {level.priority for level in task.levels}
            free = [one for one in _SYSTEM if one not in taken and one < task.priority]
            if not free:
                raise message_fault(1615)
            priority = free[-1] if task.levels else free[0]
        level = self._level(task, "trigger", priority, trigger.at, call=command)
        if priority != ALWAYS:
            self.trace.tell(task.name, "interrupt_enter", trigger.at, priority=priority)
        self.enter(task, level, command.what.action)

    # ---------------------------------------------------------------------- BRAKE and RESUME

    def brake(self, task: Task, request: BrakeArm) -> Any:
        """BRAKE: the routine goes on when the arm stands [INT-09]. Raises `Fault`."""
        level = task.level
        if level is None or level.kind != "interrupt" or task.name == "submit":
            raise own_fault("brake_place")
        self.trace.tell(task.name, "brake", request.at, mode=request.mode)
        if self.moves:
            level.has_braked = True
            self.has_stopped = False
            self.core.brake(self.clock.now, is_hard=request.mode is not None)
            return Blocked(request, lambda: self._stands, lambda: self._keep_stand(level))
        self.positions.keep("RET")
        return None

    @property
    def _stands(self) -> bool:
        return self.has_stopped or self.core.next_time() is None

    def _keep_stand(self, level: Level) -> None:
        self.positions.keep("RET")
        level.stand = self.where()[0]

    def resume(self, task: Task, request: Resume) -> Any:
        """RESUME: back to the declaring level, behind its call [INT-10, INT-11]. Raises `Fault`.

        Motions of the routine itself are travelled first (unconfirmed).
        """
        level = task.level
        if level is None or level.interrupt is None:
            raise own_fault("resume_place")
        if level.interrupt.is_global:
            raise message_fault(72)
        target = level.interrupt.depth
        if level.depth <= target:
            raise own_fault("resume_level")
        self.core.release(self.clock.now)
        if not level.motions:
            return self._resume(task, request, target)
        self.trace.tell(task.name, "advance_stop", request.at)
        self.hold_up()
        return Blocked(
            request, lambda: not level.motions, lambda: self._resume(task, request, target)
        )

    def _resume(self, task: Task, request: Resume, target: int) -> Any:
        self.trace.tell(task.name, "resume", request.at, depth=target)
        while task.levels and task.levels[-1].depth >= target:
            self._pop(task)
        task.interrupts.forget(target + 1)
        task.executor.unwind(target)
        task.triggers.clear()
        if task.name == "submit":
            return None
        is_moving = self.moves
        self.has_stopped = False
        self.core.discard(self.clock.now)
        self.fired.clear()
        return Blocked(request, lambda: not is_moving or self._stands, lambda: None)

    # ---------------------------------------------------------------------- what is cyclic

    def set_cyclic_flag(self, task: Task, request: SetCyclicFlag) -> None:
        """$CYCFLAG[n] gets a condition, which is looked at now and in every cycle [IOT-12]."""
        self.variables.read(("$CYCFLAG", request.number))  # whether there is such a flag
        is_new = request.number not in self._cyclic_flags
        if is_new and len(self._cyclic_flags) >= self.profile.most["cyclic_flags"]:
            raise message_fault(2940)
        value = self.holds(task, request.condition)
        self._cyclic_flags[request.number] = task, request.condition
        self.variables.put(("$CYCFLAG", request.number), value)

    def refresh_flags(self) -> None:
        """A tick: cyclic flags in the order of their numbers.

        A condition that cannot be evaluated any more (its routine has ended) leaves its flag as it
        is (unconfirmed; the checker refuses such conditions [IOT-11]).
        """
        for number, (task, condition) in sorted(self._cyclic_flags.items()):
            try:
                value = self.holds(task, condition)
            except Fault:
                continue
            self.variables.put(("$CYCFLAG", number), value)
            self.player.changed("$CYCFLAG")

    @property
    def has_cyclic_flags(self) -> bool:
        """Whether flags have to be looked at in every cycle."""
        return bool(self._cyclic_flags)

    def switch_signal(self, task: Task, request: SwitchSignal) -> None:
        """ANIN, ANOUT, DIGIN ON or OFF. Raises `Fault`."""
        if not request.is_on:
            task.signals.pop(request.name, None)
            return
        size, number = _SIGNAL_LIMITS[request.keyword]
        others = [one for one in task.signals.values() if one.keyword == request.keyword]
        if request.name not in task.signals and len(others) >= self.profile.most[size]:
            raise own_fault("cyclic_signal") if number is None else message_fault(number)
        task.signals[request.name] = request

    def enter_signal(self, task: Task, request: SwitchSignal) -> None:
        """Compute a cyclic signal once."""
        assert request.cycle is not None, "it is ON"
        level = self._level(task, "cycle", ALWAYS, request.at, signal=request)
        self.enter(task, level, request.cycle)


def _is_near(left: tuple[float, ...], right: tuple[float, ...]) -> bool:
    return all(abs(one - other) < 1e-6 for one, other in zip(left, right, strict=True))
