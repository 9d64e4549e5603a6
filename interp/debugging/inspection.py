"""What a stopped run shows and lets change: call stacks, variables, signals and the arm."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

from grammar.semantics.types import UNKNOWN
from interp.controller.controller import ArmState, Controller
from interp.controller.state.tasks import LevelKind
from interp.controller.state.trace import TaskName
from interp.debugging.conditions import Evaluation, parsed
from interp.debugging.executor import DebuggedExecutor
from interp.debugging.history import Assigned
from interp.debugging.names import Names, names_in, signal_in
from interp.port.inspection import InspectedValue, StackFrame
from interp.port.requests import Value
from interp.program.load import CheckedProgram
from interp.values.values import converted


class Inspection:
    """The state of all programs of a run, of its controller and of its arm.

    A frame is counted from the innermost of a program. The methods that take an expression raise
    `LinkError` if it is not one or uses an unknown name, and `Fault` as the program would.
    """

    def __init__(self, program: CheckedProgram) -> None:
        self._program = program
        self._controller: Controller
        self._tasks: dict[TaskName, DebuggedExecutor] = {}

    def attach(self, controller: Controller) -> None:
        """Set the controller of the run that begins."""
        self._controller = controller

    @property
    def tasks(self) -> tuple[TaskName, ...]:
        """The programs of the run: the robot's, and the submit interpreter's if there is one."""
        return tuple(self._tasks)

    @property
    def arm(self) -> ArmState:
        """The state of the arm."""
        return self._controller.arm

    def frames(self, task: TaskName = "robot") -> tuple[StackFrame, ...]:
        """Return the call stack of a program, innermost frame first."""
        frames = self._tasks[task].inside.frames()
        levels = self._controller.levels(task)
        return tuple(_named(one, levels) for one in frames)

    def height(self, task: TaskName) -> int:
        """Return how many frames a program has."""
        return self._tasks[task].height

    def names(self, task: TaskName = "robot", frame: int = 0) -> Names:
        """Return the names of the variables that are visible in a frame."""
        return names_in(self._program, self._tasks[task].inside.frames()[frame])

    def seen(self, text: str, task: TaskName, frame: int = 0) -> InspectedValue | None:
        """Return a variable of a frame by its name; ``None`` if the program has none there."""
        return self._tasks[task].inside.look(text, frame)

    def look(self, text: str, task: TaskName = "robot", frame: int = 0) -> Value | None:
        """Return the value of a variable by its name; ``None`` if it has no value."""
        seen = self.seen(text, task, frame)
        return self.value(text, task, frame) if seen is None else seen.value

    def value(self, text: str, task: TaskName = "robot", frame: int = 0) -> Value:
        """Return the value of an expression in a frame."""
        return self._evaluation(task, frame).value(parsed(text))

    def assignment(self, text: str, value: str, task: TaskName, frame: int) -> Assigned:
        """Return the assignment of the value of an expression to a variable, also an input."""
        evaluation = self._evaluation(task, frame)
        target = evaluation.place(parsed(text))
        if isinstance(target, str):
            seen = self.seen(target, task, frame)
            type_ = UNKNOWN if seen is None else seen.type
        else:
            type_ = self._controller.type_of(target)
        found = evaluation.value(parsed(value), type_)
        if type_ != UNKNOWN and not isinstance(target, str):
            found = converted(found, type_)
        return Assigned(task, frame, target, found)

    def apply(self, change: Assigned) -> None:
        """Assign; raises `LinkError` and, for a value that the variable cannot have, `Fault`."""
        if isinstance(change.target, str):
            self._tasks[change.task].inside.put(change.target, change.value, change.frame)
        else:
            self._controller.assign(change.target, change.value)

    def _evaluation(self, task: TaskName, frame: int) -> Evaluation:
        """Return what evaluates expressions in a frame."""
        place = self._tasks[task].inside.frames()[frame]
        return Evaluation(
            lambda text: self.seen(text, task, frame),
            self._controller.look,
            partial(signal_in, self._program, place),
        )


def _named(frame: StackFrame, levels: list[tuple[LevelKind, int]]) -> StackFrame:
    """Return a frame with its name; an action is named after its cause, the last of ``levels``."""
    if not frame.is_action or not levels:
        return frame
    kind, priority = levels.pop()
    return replace(frame, name=f"{kind} {priority or ''}".rstrip() + f" in {frame.name}")
