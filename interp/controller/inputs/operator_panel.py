"""The buttons START, STOP and CONFIRM: what each does, and which programs wait for them."""

from __future__ import annotations

from typing import Final

from interp.controller.motion.arm_control import ArmControl
from interp.controller.state.messages import Messages
from interp.controller.state.state import ControllerState
from interp.controller.state.tasks import Task

#: The kind of messages that stop the arm until the operator acknowledges them.
_STOPPING: Final = "acknowledgement"


class OperatorPanel:
    """The buttons and dialogues; ``tasks`` are the programs that START continues."""

    def __init__(self, state: ControllerState, arm: ArmControl, tasks: list[Task]) -> None:
        self._state = state
        self._messages: Messages = state.messages
        self._arm = arm
        self._tasks = tasks
        self._is_stopped = False

    def shown(self, _number: int, kind: str) -> None:
        """Stop the arm if a message has appeared that must be acknowledged."""
        if kind == _STOPPING:
            self._arm.halt()

    def press(self, button: str, number: int | None = None) -> None:
        """Press START, STOP or CONFIRM; with ``number``, CONFIRM acknowledges only that message."""
        match button:
            case "CONFIRM":
                was_waiting = bool(self._messages.unacknowledged)
                self._messages.acknowledge(number)
                if was_waiting:
                    self.free_arm()
            case "STOP" if self._state.program_states["robot"] == "P_ACTIVE":
                self._is_stopped = True
                self._state.program_states["robot"] = "P_STOP"
                self._arm.halt()
            case "START":
                for task in self._tasks:
                    task.is_halted = False
                self._state.program_states["robot"] = "P_ACTIVE"
                self._is_stopped = False
                self.free_arm()

    def answer(self, button: int) -> None:
        """Answer the oldest dialogue with a button, counted from 1."""
        self._messages.answer(button)

    def is_holding(self, task: Task) -> bool:
        """Return whether a program is stopped, or waits until a message is acknowledged."""
        return task.name == "robot" and (self._is_stopped or bool(self._messages.unacknowledged))

    def free_arm(self) -> None:
        """Let the arm continue, unless it is stopped or a message must be acknowledged."""
        if not self._is_stopped and not self._messages.unacknowledged:
            self._arm.end_halt()
