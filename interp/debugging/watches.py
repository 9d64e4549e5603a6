"""The watches of a debugger: expressions whose changes stop the program."""

from __future__ import annotations

from dataclasses import dataclass

from interp.controller.state.trace import TaskName
from interp.debugging.client import Stop, Watch
from interp.debugging.conditions import parsed, root_of
from interp.debugging.executor import DebuggedExecutor
from interp.debugging.inspection import Inspection
from interp.port.requests import Value
from interp.values.faults import RuntimeFailure


@dataclass(slots=True)
class _Watched:
    """A watch with its last value, and where it applies.

    ``home`` is the data list variable that the watch is about, as in
    `interp.port.inspection.InspectedValue`.
    ``place`` is (program, height of the stack, routine) if it is about data of a routine.
    ``is_known`` is set once the watch has been evaluated in this run.
    """

    watch: Watch
    home: str
    place: tuple[TaskName, int, str] | None
    value: Value | None
    is_known: bool = True

    def applies(self, executor: DebuggedExecutor) -> bool:
        """Return whether the name of the watch refers here to the variable that is watched."""
        if self.place is not None:
            if self.place[:2] != (executor.task, executor.height):
                return False
            return self.place[2] == executor.inside.frames()[0].name
        if not self.home:
            return True
        root = root_of(parsed(self.watch.text))
        seen = None if root is None else executor.inside.look(root)
        return seen is not None and seen.home == self.home


class Watches:
    """The watches that are set, evaluated by an `Inspection`."""

    def __init__(self, inspection: Inspection) -> None:
        self._inspection = inspection
        self._watched: list[_Watched] = []

    def begin(self) -> None:
        """A run begins, in which no watch has been evaluated."""
        for one in self._watched:
            one.is_known = False

    @property
    def all(self) -> tuple[Watch, ...]:
        """The watches that are set."""
        return tuple(one.watch for one in self._watched)

    def add(self, text: str, task: TaskName = "robot", frame: int = 0) -> Watch:
        """Add a watch on an expression; raise `LinkError` if the text is not an expression."""
        root = root_of(parsed(text))
        seen = self._inspection.seen(root, task, frame) if root is not None else None
        place = None
        if seen is not None and not seen.home:
            name = self._inspection.frames(task)[frame].name
            place = (task, self._inspection.height(task) - frame, name)
        home = "" if seen is None else seen.home
        watch = Watch(text)
        self._watched.append(_Watched(watch, home, place, self._value(text, task, frame)))
        return watch

    def remove(self, watch: Watch) -> None:
        """Remove a watch."""
        self._watched = [one for one in self._watched if one.watch != watch]

    def change(self, executor: DebuggedExecutor) -> Stop | None:
        """Return the stop of the first watch that changed.

        A watch that is unknown here, or has no value, has not changed.
        """
        found: Stop | None = None
        for one in self._watched:
            if not one.applies(executor):
                continue
            is_known, one.is_known = one.is_known, True
            before, now = one.value, self._value(one.watch.text, executor.task, 0)
            if now is None or not _differ(before, now):
                continue
            one.value = now
            if found is None and is_known:
                found = Stop("watch", executor.task, executor.at, one.watch, before, now)
        return found

    def _value(self, text: str, task: TaskName, frame: int) -> Value | None:
        try:
            return self._inspection.value(text, task, frame)
        except RuntimeFailure:
            return None


def _differ(one: Value | None, other: Value | None) -> bool:
    return type(one) is not type(other) or one != other
