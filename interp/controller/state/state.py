"""The state that the parts of a controller share: clock, trace, variables, signals, messages."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Final

from interp.controller.state.clock import ActionQueue, Clock
from interp.controller.state.messages import Messages
from interp.controller.state.profile import Profile
from interp.controller.state.signals import Signals
from interp.controller.state.timers import Timers
from interp.controller.state.trace import TaskName, Trace
from interp.controller.state.variables import Variables
from interp.port.requests import At, Path, Value
from interp.robot.kinematics.machine_data import MachineData
from interp.values.json_form import to_json
from interp.values.values import EnumValue

#: The kind of trace event for each array of signals.
_SIGNAL_KINDS: Final = {"$IN": "in", "$ANIN": "in", "$OUT": "out", "$ANOUT": "anout"}


class ControllerState:
    """The state of a controller, apart from programs and motions.

    ``values`` are the initial values that data lists give to system variables. ``observers`` are
    called with each variable that a program or something outside has changed, and with its value as
    given. ``program_states`` are the words of $PRO_STATE by task.
    """

    def __init__(
        self,
        profile: Profile,
        trace: Trace,
        machine: MachineData,
        values: Mapping[str, Value],
    ) -> None:
        self.profile = profile
        self.trace = trace
        self.machine = machine
        self.clock = Clock(profile.cycle)
        self.actions = ActionQueue()
        self.messages = Messages(trace)
        self.variables = Variables(profile, values)
        self.signals = Signals(profile, self.clock, self.later, self.signal_changed)
        self.variables.connect(["$IN", "$OUT", "$ANIN", "$ANOUT"], self.signals)
        self.timers = Timers(self.clock, profile.sizes["timers"])
        self.variables.connect(["$TIMER", "$TIMER_STOP", "$TIMER_FLAG"], self.timers)
        self.observers: list[Callable[[Path, Value], None]] = []
        self.program_states: dict[TaskName, str] = {"robot": "P_ACTIVE", "submit": "P_FREE"}
        #: Statements that failed and were skipped, each with the reason of its first failure.
        self.skipped: dict[tuple[str, int], Exception] = {}

    @property
    def mode(self) -> str:
        """The word of $MODE_OP."""
        value = self.variables.read(("$MODE_OP",))
        return value.name.upper() if isinstance(value, EnumValue) else "AUT"

    def skip(self, task: TaskName, at: At, error: Exception) -> None:
        """Note that a failed statement is skipped, with a message the first time."""
        if (at.file, at.line) not in self.skipped:
            self.skipped[at.file, at.line] = error
            number = getattr(error, "number", None) or 0
            self.messages.post(task, at, number, f"skipped: {error}", "notification")

    # ------------------------------------------------------------------------------ changes

    def put(self, path: Path, value: Value) -> None:
        """Write a system variable for a program; raise `Fault`."""
        self.variables.write(path, value)
        self.changed(path, value)

    def assign(self, path: Path, value: Value) -> None:
        """Assign a value to a variable from outside the program; raise `Fault`."""
        with self.trace.attributed("robot", None):
            if path[0] in _SIGNAL_KINDS:
                self.signals.put(path, value)
            else:
                self.variables.put(path, value)
                self.changed(path, value)

    def put_at(self, task: TaskName, at: At | None, path: Path, value: Value) -> None:
        """Write a system variable on behalf of a line that requested it earlier."""
        with self.trace.attributed(task, at):
            self.put(path, value)

    def changed(self, path: Path, value: Value) -> None:
        """Notify the observers of a change, unless the variable is a signal."""
        if path[0] not in _SIGNAL_KINDS:
            self._notify(path, value)

    def signal_changed(self, name: str, place: int, value: Value) -> None:
        """Record a change of a signal in the trace, and notify the observers."""
        self.variables.activity.changes += 1
        self.trace.record_change(
            _SIGNAL_KINDS[name], signal=name, number=place, value=to_json(value)
        )
        self._notify((name, place), value)

    def _notify(self, path: Path, value: Value) -> None:
        for observer in self.observers:
            observer(path, value)

    def later(self, time: int, action: Callable[[], None]) -> None:
        """Schedule an action at a time in µs, on behalf of the line that is executed now."""
        origin = self.trace.origin

        def act() -> None:
            with self.trace.attributed(*origin):
                action()

        self.actions.add(time, act)
