"""Cyclic flags and cyclic signals, evaluated in every interpolation cycle."""

from __future__ import annotations

from contextlib import suppress
from typing import Final

from interp.controller.interrupts.levels import Levels
from interp.controller.motion.advance_run import AdvanceRun
from interp.controller.state.messages import message_fault, own_fault
from interp.controller.state.state import ControllerState
from interp.controller.state.tasks import ALWAYS, Answer, Task
from interp.port.requests import CodeHandle, SetCyclicFlag, SwitchSignal
from interp.values.faults import Fault

#: For each keyword, the profile entry that limits the number of cyclic signals, and its message.
_SIGNAL_LIMITS: Final = {
    "ANIN": ("analog_inputs", 1543),
    "ANOUT": ("analog_outputs", None),
    "DIGIN": ("digital_inputs", None),
}


class CyclicEvaluation:
    """The conditions of cyclic flags, and the cyclic signals that are ON."""

    def __init__(self, state: ControllerState, advance: AdvanceRun, levels: Levels) -> None:
        self._state = state
        self._advance = advance
        self._levels = levels
        self._flags: dict[int, tuple[Task, CodeHandle]] = {}

    def set_flag(self, task: Task, request: SetCyclicFlag) -> None:
        """Assign a condition to $CYCFLAG[n], evaluated now and in every cycle [IOT-12].

        Raises `Fault`.
        """
        variables, number = self._state.variables, request.number
        variables.read(("$CYCFLAG", number))  # faults if there is no such flag
        is_new = number not in self._flags
        if is_new and len(self._flags) >= self._state.profile.most["cyclic_flags"]:
            raise message_fault(2940)
        value = task.holds(request.condition, variables.read)
        self._flags[number] = task, request.condition
        variables.put(("$CYCFLAG", number), value)

    def refresh_flags(self) -> None:
        """Evaluate all cyclic flags at a tick, in the order of their numbers.

        If a condition can no longer be evaluated because its routine has ended, the flag keeps its
        value (unconfirmed; the checker rejects such conditions [IOT-11]).
        """
        for number, (task, condition) in sorted(self._flags.items()):
            with suppress(Fault):
                value = task.holds(condition, self._state.variables.read)
                self._state.put(("$CYCFLAG", number), value)

    @property
    def has_flags(self) -> bool:
        """Whether there are flags to evaluate in every cycle."""
        return bool(self._flags)

    def switch_signal(self, task: Task, request: SwitchSignal) -> Answer:
        """Switch a signal ON or OFF: ANIN, ANOUT, DIGIN. Raises `Fault`."""
        return self._advance.when_reached(task, request, lambda: self._switch(task, request))

    def _switch(self, task: Task, request: SwitchSignal) -> None:
        if not request.is_on:
            task.signals.pop(request.name, None)
            return
        size, number = _SIGNAL_LIMITS[request.keyword]
        others = [one for one in task.signals.values() if one.keyword == request.keyword]
        if request.name not in task.signals and len(others) >= self._state.profile.most[size]:
            raise own_fault("cyclic_signal") if number is None else message_fault(number)
        task.signals[request.name] = request

    def enter_signal(self, task: Task, request: SwitchSignal) -> None:
        """Enter the code that computes a cyclic signal once."""
        assert request.cycle is not None, "it is ON"
        self._levels.enter(task, "cycle", ALWAYS, request.at, request.cycle, signal=request)
