"""Outputs that the control core switches at their exact time, and the report of their changes.

The core runs ahead of the controller, by the time of one `ControlCore.run_until`. So the changes
that an output command makes are stored until the controller handles the event of that command.
"""

from __future__ import annotations

from collections import deque

from interp.controller.state.signals import Change, Signals
from interp.controller.state.variables import Variables
from interp.port.requests import Path, Value


class OutputSwitch:
    """Switches outputs for a control core."""

    def __init__(self, variables: Variables, signals: Signals) -> None:
        self._variables = variables
        self._signals = signals
        self._changes: deque[list[Change]] = deque()

    def switch(self, path: Path, value: Value, _time: int) -> None:
        """Write a system variable at this time, which the clock shows. Raises `Fault`."""
        with self._signals.deferred() as changes:
            self._variables.write(path, value)
        self._changes.append(changes)

    def next_changes(self) -> list[Change]:
        """Remove and return the changes of the earliest output command that was not handled yet."""
        return self._changes.popleft()
