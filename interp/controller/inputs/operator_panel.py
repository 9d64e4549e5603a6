"""The operator: START, STOP and CONFIRM, and what waits for them."""

from __future__ import annotations

from typing import Final

from interp.controller.motion.arm_control import ArmControl
from interp.controller.state.messages import Messages
from interp.controller.state.state import ControllerState
from interp.controller.state.tasks import Task

#: The kind of messages that stop the arm until they are acknowledged.
_STOPPING: Final = "acknowledgement"


class OperatorPanel:
    """Buttons and dialogues; ``tasks`` are the programs that START sets going again."""

    def __init__(self, state: ControllerState, arm: ArmControl, tasks: list[Task]) -> None:
        self._state = state
        self._messages: Messages = state.messages
        self._arm = arm
        self._tasks = tasks
        self._is_stopped = False

    def shown(self, _number: int, kind: str) -> None:
        """A message is shown: one that has to be acknowledged stops the arm."""
        if kind == _STOPPING:
            self._arm.halt()

    def press(self, button: str, number: int | None = None) -> None:
        """Press START, STOP or CONFIRM; ``number`` is the one message that CONFIRM is for."""
        match button:
            case "CONFIRM":
                was_waiting = bool(self._messages.unacknowledged)
                self._messages.acknowledge(number)
                if was_waiting:
                    self.free_arm()
            case "STOP" if (
                not self._is_stopped and self._state.program_states["robot"] == "P_ACTIVE"
            ):
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
        """Whether a program must wait: it was stopped, or a message is to be acknowledged."""
        return task.name == "robot" and (self._is_stopped or bool(self._messages.unacknowledged))

    def free_arm(self) -> None:
        """The arm continues, unless the operator has stopped it or must acknowledge a message."""
        if not self._is_stopped and not self._messages.unacknowledged:
            self._arm.end_halt()
