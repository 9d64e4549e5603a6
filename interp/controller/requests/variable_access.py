"""The handlers of variable access: advance stops, the limits of ANOUT, and $ERR."""

from __future__ import annotations

from interp.controller.inputs.automatic_inputs import AutomaticInputs
from interp.controller.motion.advance_run import AdvanceRun
from interp.controller.motion.motion_queue import MotionQueue
from interp.controller.state.clock import microseconds
from interp.controller.state.error_variable import ErrorVariable
from interp.controller.state.state import ControllerState
from interp.controller.state.tasks import Answer, Task
from interp.port.requests import EmptyError, Read, SwitchSignal, Write
from interp.values.faults import fault
from support.lazy_dataclass import dataclass


@dataclass(slots=True, eq=False)
class VariableAccess:
    """Answers requests to read and to write system variables."""

    _state: ControllerState
    _queue: MotionQueue
    _advance: AdvanceRun
    _automatic: AutomaticInputs
    _errors: ErrorVariable

    def read(self, task: Task, request: Read) -> Answer:
        """Return the value of a variable. Raises `Fault`."""
        path, variables = request.path, self._state.variables
        self._automatic.was_read(task.name, path, request.at)
        if path[0] == "$ERR":
            self._errors.show(task)
        if variables.stops(str(path[0]), is_write=False):
            return self._advance.when_reached(task, request, lambda: variables.read(path))
        return variables.read(path)

    def write(self, task: Task, request: Write) -> Answer:
        """Assign a value to a variable. Raises `Fault`."""
        path, name = request.path, str(request.path[0])
        if name == "$OUT_C":
            self._queue.output_in_main_run(task, request.at, path, request.value)
            return None
        if name == "$ERR":
            self._errors.write(task, request)
            return None
        if name == "$ADVANCE" and task.levels:  # [INT-13]
            raise fault("read_only")
        if name == "$ANOUT" and task.level is not None and task.level.signal is not None:
            self._put_cyclic(request, task.level.signal)
            return None
        if self._state.variables.stops(name, is_write=True):
            return self._advance.when_reached(
                task, request, lambda: self._state.put(path, request.value)
            )
        self._state.put(path, request.value)
        return None

    def _put_cyclic(self, request: Write, signal: SwitchSignal) -> None:
        """ANOUT ON: assign the value within its limits, after its delay in seconds [IOT-09]."""
        state, value = self._state, request.value
        if signal.minimum is not None:
            value = max(value, signal.minimum)
        if signal.maximum is not None:
            value = min(value, signal.maximum)
        if signal.delay is None or signal.delay <= 0.0:
            state.put(request.path, value)  # a negative delay cannot be simulated (unconfirmed)
            return
        at = state.clock.now + microseconds(signal.delay)
        state.later(at, lambda: state.put(request.path, value))

    def empty_error(self, task: Task, _request: EmptyError) -> Answer:
        """Empty $ERR."""
        self._errors.empty(task)
        return None
