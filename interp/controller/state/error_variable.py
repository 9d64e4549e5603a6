"""The variable $ERR: the error that ON_ERROR_PROCEED caught, for each level of calls [FCT-12]."""

from __future__ import annotations

from typing import Any

from interp.controller.state.declared_interrupts import module_name
from interp.controller.state.state import ControllerState
from interp.controller.state.tasks import Task
from interp.controller.state.trace import TaskName
from interp.port.requests import Write
from interp.values.predefined_values import word
from interp.values.values import ArrayValue, Value, copied, set_text

#: A program and a depth of its calls.
_Level = tuple[TaskName, int]


class ErrorVariable:
    """Keeps $ERR for each open routine; that of the routine that asked last is the variable."""

    def __init__(self, state: ControllerState) -> None:
        self._state = state
        self._none = copied(state.variables.read(("$ERR",)))
        self._shown: _Level | None = None
        self._others: dict[_Level, Value] = {}

    def show(self, task: Task) -> None:
        """Let $ERR be that of the running routine of a program."""
        level = (task.name, task.executor.depth)
        if level == self._shown:
            return
        variables = self._state.variables
        if self._shown is not None:
            self._others[self._shown] = variables.read(("$ERR",))
        variables.put(("$ERR",), self._others.pop(level, copied(self._none)))
        self._shown = level

    def forget(self, task: TaskName, depth: int) -> None:
        """Forget the error of a routine that has ended."""
        self._others.pop((task, depth), None)
        if self._shown == (task, depth):
            self._shown = None

    def empty(self, task: Task) -> None:
        """Empty $ERR: its number tells an error from none."""
        self.show(task)
        self._state.variables.put(("$ERR", "NUMBER"), 0)

    def write(self, task: Task, request: Write) -> None:
        """Assign to $ERR; with the number of an error come its place and circumstances."""
        self.show(task)
        variables = self._state.variables
        variables.put(request.path, request.value)
        if request.path != ("$ERR", "NUMBER"):
            return
        error: Any = variables.read(("$ERR",))
        level = task.level
        error.set("INT_PRIO", level.priority if level else 0)
        error.set("LINE_NR", request.at.line)
        for name, text in (("MODULE", module_name(request.at.file)), ("UP_NAME", task.routine)):
            part = error.get(name)
            assert isinstance(part, ArrayValue)
            set_text(part, text.upper())
        variables.put(("$ERR",), error)
        words = {
            "INTERPRETER": ("PROG_INT_E", "R_INT" if task.name == "robot" else "S_INT"),
            "INT_TYPE": ("INT_TYP_E", "I_INTERRUPT" if level else "I_NORMAL"),
        }
        if level is not None and level.call is not None:  # [TRG-12]; none is ever replayed
            words["TRIGGER_TYPE"] = ("TRIGGER_UP_TYPE", "TRG_REGULAR")
        for member, (type_name, name) in words.items():
            variables.put(("$ERR", member), word(type_name, name))
