"""A debugger for all programs of a run: it stops, steps, inspects, changes and steps back.

The debugger runs a function that it is given, and calls its client where a program stops; nothing
continues until the client has returned. To go back, it repeats the run and stops earlier
(`interp.debugging.history`).
"""

from __future__ import annotations

from array import array
from bisect import bisect_right
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, Final, Protocol, TypeVar

from grammar.semantics.types import UNKNOWN, Type
from interp.controller.controller import ArmState
from interp.controller.state.tasks import LevelKind
from interp.controller.state.trace import TaskName
from interp.debugging.client import (
    Back,
    Breakpoint,
    Command,
    Go,
    Quit,
    Restart,
    Select,
    StepCommand,
    Stop,
    Watch,
)
from interp.debugging.conditions import evaluated, guard_of, parsed, place_of, root_of
from interp.debugging.executor import DebuggedExecutor
from interp.debugging.history import START, Assigned, Fits, History, Selected
from interp.debugging.hits import is_hit
from interp.debugging.names import Names, names_in, signal_in, signals_of
from interp.debugging.selection import reason_against
from interp.debugging.value_text import value_text
from interp.port.inspection import Breaks, Guard, Seen, StackFrame
from interp.port.requests import Fail, Path, Value
from interp.program.load import CheckedProgram
from interp.program.statement_paths import routine_at, statement_lines
from interp.values.faults import LinkError, RuntimeFailure
from interp.values.values import converted

#: Called where a program stops; may inspect and change the run through the debugger.
Client = Callable[["Debugger", Stop], Command]
_T = TypeVar("_T")
_NOWHERE: Final[Breaks] = {}


class World(Protocol):
    """What a debugger needs of the controller (`interp.controller.controller.Controller`)."""

    @property
    def arm(self) -> ArmState:
        """The state of the arm."""

    def look(self, path: Path) -> Value:
        """Return the value of a system variable."""

    def assign(self, path: Path, value: Value) -> None:
        """Assign a value to a system variable."""

    def type_of(self, path: Path) -> Type:
        """Return the type of a system variable or of a part of it."""

    def levels(self, task: TaskName) -> list[tuple[LevelKind, int]]:
        """Return the actions that run on top of a program, each as (kind, priority)."""


@dataclass(slots=True)
class _Watched:
    """A watch with its last value, and where it applies.

    ``home`` is the data list variable that the watch is about, as in `interp.port.inspection.Seen`.
    ``place`` is (program, height of the stack, routine) if it is about data of a routine.
    ``is_known`` is set once the watch has been evaluated in this run.
    """

    watch: Watch
    home: str
    place: tuple[TaskName, int, str] | None
    value: Value | None = None
    is_known: bool = False


@dataclass(frozen=True, slots=True)
class _Stepping:
    """A step in progress: its kind, and program, stack height and ended motions at its start."""

    way: str
    task: TaskName
    height: int
    ended: int

    def is_over(self, executor: DebuggedExecutor, ended: int) -> bool:
        """Return whether the step ends before the statement that a program is about to begin."""
        if executor.task != self.task:
            return False
        if self.way == "motion":
            return ended > self.ended
        return self.way == "into" or executor.height < self.height + (self.way == "over")


class _RunAgain(Exception):
    """Leaves a run because another one is to begin."""


class _SessionEnded(Exception):
    """Leaves a run because the session ends."""


class Debugger:
    """Debugs the runs of one program; it stops before the first statement.

    ``log`` receives the texts of log points.
    """

    def __init__(
        self, program: CheckedProgram, client: Client, log: Callable[[str], None] = print
    ) -> None:
        self.stops_at_faults = True
        self._program = program
        self._client = client
        self._log = log
        self._world: World | None = None
        self._tasks: dict[TaskName, DebuggedExecutor] = {}
        self._history = History()
        self._breakpoints: dict[int, list[Breakpoint]] = {}
        self._places: dict[tuple[str, int], Guard | None] = {}
        self._hits: dict[Breakpoint, array[int]] = {}
        self._watches: list[_Watched] = []
        self._stepping: _Stepping | None = None
        self._is_begun = self._is_selected = self._is_to_pause = self._is_ended = False

    # ----------------------------------------------------------------------- running

    def run(self, begin: Callable[[], _T]) -> _T | None:
        """Run the program as often as the client wants, and return the result of the last run.

        Return ``None`` if the client ends the session before the run has ended. ``begin`` creates
        and executes a run, each time the same one; its executors come from `around`.
        """
        while True:
            self._tasks.clear()
            self._history.begin()
            self._stepping, self._is_ended = None, False
            self._is_selected = False
            for one in self._watches:
                one.is_known = False
            try:
                result = begin()
                self._end(str(getattr(result, "outcome", "")))
            except _RunAgain:
                continue
            except _SessionEnded:
                return None
            return result

    def _end(self, text: str) -> None:
        """Report the end of a run to the client, which may continue with another run."""
        self._history.ends(self._begun_count())
        if self._history.is_searched():
            self._history.end_search()
            raise _RunAgain
        robot = self._tasks["robot"]
        self._history.arrived(robot)  # if no statement came that could be returned to
        self._is_ended = True
        self._handle_stop(robot, Stop("ended", "robot", robot.at, text=text))

    def around(self, inside: Any, per_slice: int, task: TaskName = "robot") -> DebuggedExecutor:
        """Return an executor that stops for this debugger; ``inside`` is an `Inspectable`."""
        made = self._tasks[task] = DebuggedExecutor(self, task, inside, per_slice)
        return made

    def attach(self, world: World) -> None:
        """Set the controller of the run that begins."""
        self._world = world

    def pause(self) -> None:
        """Stop before the next statement; may be called from another thread."""
        self._is_to_pause = True

    @property
    def is_repeating(self) -> bool:
        """Whether the run repeats what has happened before, so that its events are known."""
        return self._history.is_repeating

    # ----------------------------------------------------------------------- breakpoints

    def set_breakpoints(self, breakpoints: Sequence[Breakpoint]) -> None:
        """Replace all breakpoints; raise `LinkError` for invalid hits."""
        by_line: dict[int, list[Breakpoint]] = {}
        for one in breakpoints:
            is_hit(one.hits, 1)
            by_line.setdefault(one.line, []).append(one)
        self._breakpoints = by_line
        self._places = {}
        signals = signals_of(self._program)
        for unit in self._program.units.values():
            for one in breakpoints:
                place = unit.module.path, one.line
                if _is_path_of(one.file, unit.module.path):
                    is_only = place not in self._places
                    guard = guard_of(one.condition) if one.condition and is_only else None
                    is_signal = guard is not None and guard.name.upper() in signals
                    self._places[place] = None if is_signal else guard
        self._hits = {one: self._hits.get(one, array("q")) for one in breakpoints if one.hits}

    @property
    def breakpoints(self) -> list[Breakpoint]:
        """All breakpoints, by lines."""
        return [one for _, found in sorted(self._breakpoints.items()) for one in found]

    def lines(self, file: str) -> tuple[int, ...]:
        """Return the lines of a file at which a program can stop, in ascending order."""
        units = [one for one in self._program.units.values() if _is_path_of(file, one.module.path)]
        routines = [one for unit in units for one in self._program.routines_of(unit)]
        return tuple(sorted({line for one in routines for line in statement_lines(one)}))

    def watch(self, text: str, task: TaskName = "robot", frame: int = 0) -> Watch:
        """Add a watch on an expression; raise `LinkError` if the text is not an expression."""
        root = root_of(parsed(text))
        seen = self._look(task, frame, root) if root is not None else None
        frames, place = self.frames(task), None
        if seen is not None and not seen.home:
            height = self._tasks[task].height - frame
            place = (task, height, frames[frame].name)
        watched = _Watched(Watch(text), "" if seen is None else seen.home, place)
        watched.value, watched.is_known = self._value_of(task, frame, text), True
        self._watches.append(watched)
        return watched.watch

    @property
    def watches(self) -> tuple[Watch, ...]:
        """The watches that are set."""
        return tuple(one.watch for one in self._watches)

    def forget(self, watch: Watch) -> None:
        """Remove a watch."""
        self._watches = [one for one in self._watches if one.watch != watch]

    # ----------------------------------------------------------------------- looking around

    @property
    def tasks(self) -> tuple[TaskName, ...]:
        """The programs of the run: the robot's, and the submit interpreter's if there is one."""
        return tuple(self._tasks)

    @property
    def arm(self) -> ArmState:
        """The state of the arm."""
        return ArmState(0, None, 0, 0) if self._world is None else self._world.arm

    def frames(self, task: TaskName = "robot") -> tuple[StackFrame, ...]:
        """Return the call stack of a program, innermost frame first."""
        frames = self._tasks[task].inside.frames()
        levels = [] if self._world is None else self._world.levels(task)
        return tuple(_named(one, levels) for one in frames)

    def names(self, task: TaskName = "robot", frame: int = 0) -> Names:
        """Return the names of the variables that are visible in a frame."""
        return names_in(self._program, self._tasks[task].inside.frames()[frame])

    def look(self, text: str, task: TaskName = "robot", frame: int = 0) -> Value | None:
        """Return the value of a variable by its name; ``None`` if it has no value.

        Raises `LinkError` if there is no such variable.
        """
        seen = self._look(task, frame, text)
        return self.value(text, task, frame) if seen is None else seen.value

    def value(self, text: str, task: TaskName = "robot", frame: int = 0) -> Value:
        """Return the value of an expression in a frame.

        Raises `LinkError` if it is not an expression or uses an unknown name, and `Fault` as the
        program would.
        """
        return evaluated(parsed(text), *self._names_of(task, frame))

    def assign(self, text: str, value: str, task: TaskName = "robot", frame: int = 0) -> None:
        """Assign the value of an expression to a variable, system variable or input.

        Raises `LinkError`, and `Fault` for a value that the variable cannot have.
        """
        if self._is_ended:
            raise LinkError("the program has ended")
        names = self._names_of(task, frame)
        target = place_of(parsed(text), *names)
        if isinstance(target, str):
            seen = self._look(task, frame, target)
            type_ = UNKNOWN if seen is None else seen.type
        else:
            type_ = UNKNOWN if self._world is None else self._world.type_of(target)
        found = evaluated(parsed(value), *names, type_)
        if type_ != UNKNOWN and not isinstance(target, str):
            found = converted(found, type_)
        change = Assigned(task, frame, target, found)
        self._apply(change)
        self._history.change(change)

    def _apply(self, change: Assigned) -> None:
        if isinstance(change.target, str):
            self._tasks[change.task].inside.put(change.target, change.value, change.frame)
        elif self._world is None:
            raise LinkError(
                f"{change.target[0]} belongs to the controller, which is not available here"
            )
        else:
            self._world.assign(change.target, change.value)

    def _names_of(self, task: TaskName, frame: int) -> tuple[Any, Any, Any]:
        """Return the functions with which `evaluated` looks up names in a frame."""
        read = None if self._world is None else self._world.look
        place = self._tasks[task].inside.frames()[frame]
        return partial(self._look, task, frame), read, partial(signal_in, self._program, place)

    def _look(self, task: TaskName, frame: int, text: str) -> Seen | None:
        return self._tasks[task].inside.look(text, frame)

    def _value_of(self, task: TaskName, frame: int, text: str) -> Value | None:
        try:
            return self.value(text, task, frame)
        except RuntimeFailure:
            return None

    # ----------------------------------------------------------------------- what goes by

    @property
    def places(self) -> Breaks:
        """The breakpoints that the debugger wants to see, even where `unseen` allows more."""
        history = self._history
        is_idle = history.is_repeating and not history.is_looking(self._begun_count())
        return _NOWHERE if is_idle else self._places

    def unseen(self, shows_places: bool) -> int:
        """Return how many statements may begin before the debugger wants to see one.

        With ``shows_places``, statements at `places` are shown anyway and need not be counted.
        """
        history = self._history
        if not history.is_repeating:
            looks = (self._places and not shows_places) or self._watches or self._stepping
            if looks or self._is_to_pause or self._is_selected or not self._is_begun:
                return 0
        return history.unseen(self._begun_count(), shows_places)

    def begins(self, executor: DebuggedExecutor) -> int | None:
        """Decide what happens before a statement: return a line to continue at, else ``None``.

        The executor calls this for every statement that the debugger wants to see, and possibly for
        others (see `unseen`).
        """
        history = self._history
        history.comes(self._begun_count())
        if history.is_idle:
            stop = self._reason_to_stop(executor)
            return None if stop is None else self._handle_stop(executor, stop)
        line: int | None = None
        for change in history.due():
            if isinstance(change, Assigned):
                self._apply(change)
            else:
                line = change.line
        self._end_search_at(executor)
        if arrived := history.arrived(executor):
            self._is_begun = True
            for hits in self._hits.values():
                del hits[bisect_right(hits, history.here[0]) :]
            self._watch_stop(executor)  # the watches take the values of this moment
            return self._handle_stop(executor, arrived)
        if line is not None or history.is_repeating:
            return line
        stop = self._reason_to_stop(executor)
        return None if stop is None else self._handle_stop(executor, stop)

    def fails(self, executor: DebuggedExecutor, request: Fail) -> None:
        """Stop at a fault that the program does not handle."""
        self._history.comes(self._begun_count())
        self._end_search_at(None)
        if self.stops_at_faults and not self._history.is_repeating:
            stop = Stop("fault", executor.task, request.at, text=str(request.fault))
            self._handle_stop(executor, stop)

    def _end_search_at(self, executor: DebuggedExecutor | None) -> None:
        if self._history.is_searched(executor):
            self._history.end_search()
            raise _RunAgain

    def _begun_count(self) -> int:
        count = 0
        for one in self._tasks.values():
            count += one.inside.begun
        return count

    # ----------------------------------------------------------------------- why to stop

    def _reason_to_stop(self, executor: DebuggedExecutor) -> Stop | None:
        """Return why to stop here, or ``None``."""
        task, at = executor.task, executor.at
        if not self._is_begun:
            self._is_begun = True
            return Stop("entry", task, at)
        if self._is_selected:
            self._is_selected = False
            return Stop("selected", task, at)
        if self._is_to_pause:
            self._is_to_pause = False
            return Stop("pause", task, at)
        changed = self._watch_stop(executor)
        if changed is not None:
            return changed
        step = self._stepping
        if step is not None and step.is_over(executor, self._ended_motions(step.way)):
            return Stop("step", task, at)
        return self._breakpoint_stop(executor)

    def _ended_motions(self, way: str) -> int:
        return self.arm.ended if way == "motion" else 0

    def _breakpoint_stop(self, executor: DebuggedExecutor) -> Stop | None:
        """Return the stop of a breakpoint at this statement, if one applies."""
        at, task = executor.at, executor.task
        found: Stop | None = None
        for one in self._breakpoints.get(at.line, ()):
            if not _is_path_of(one.file, at.file):
                continue
            text = self._breakpoint_note(one, task)
            if text is None or not self._hit_counts(one):
                continue
            if one.log is None:
                found = found or Stop("breakpoint", task, at, text=text)
            elif not self._history.is_repeating:
                self._log(self._log_text(one.log, task))
        return found

    def _breakpoint_note(self, one: Breakpoint, task: TaskName) -> str | None:
        """Return ``None`` if the condition is FALSE, else "", or why it cannot be evaluated."""
        if one.condition is None:
            return ""
        try:
            return None if self.value(one.condition, task) is False else ""
        except RuntimeFailure as error:
            return str(error)

    def _hit_counts(self, one: Breakpoint) -> bool:
        """Return whether this hit counts; all hits are stored, so that going back undoes them."""
        if one.hits is None:
            return True
        hits, count = self._hits[one], self._history.here[0]
        if not self._history.is_repeating:
            hits.append(count)
        return is_hit(one.hits, bisect_right(hits, count))

    def _log_text(self, text: str, task: TaskName) -> str:
        """Return the text of a log point, with the values of the expressions in braces."""
        parts = text.replace("}", "{").split("{")
        for place in range(1, len(parts), 2):
            try:
                parts[place] = value_text(self.value(parts[place], task))
            except RuntimeFailure as error:
                parts[place] = f"({error})"
        return "".join(parts)

    def _watch_stop(self, executor: DebuggedExecutor) -> Stop | None:
        """Return the stop of the first watch that changed.

        A watch that is unknown here, or has no value, has not changed.
        """
        found: Stop | None = None
        for one in self._watches:
            if not self._applies(one, executor):
                continue
            is_known, one.is_known = one.is_known, True
            before, now = one.value, self._value_of(executor.task, 0, one.watch.text)
            if now is None or not _differ(before, now):
                continue
            one.value = now
            if found is None and is_known:
                found = Stop("watch", executor.task, executor.at, one.watch, before, now)
        return found

    def _applies(self, one: _Watched, executor: DebuggedExecutor) -> bool:
        """Return whether a watch applies here: its name refers to the variable that was watched."""
        if one.place is not None:
            if one.place[:2] != (executor.task, executor.height):
                return False
            return one.place[2] == executor.inside.frames()[0].name
        if not one.home:
            return True
        root = root_of(parsed(one.watch.text))
        seen = None if root is None else executor.inside.look(root)
        return seen is not None and seen.home == one.home

    # ----------------------------------------------------------------------- commands

    def _handle_stop(self, executor: DebuggedExecutor, stop: Stop) -> int | None:
        """Execute commands of the client; return a line to continue at, else ``None``.

        Raises `_RunAgain` or `_SessionEnded` to leave this run.
        """
        while True:
            self._stepping = None
            match self._client_command(stop):
                case Go():
                    return None
                case StepCommand(way=way, task=task):
                    self._stepping = self._step(way, self._tasks.get(task or stop.task, executor))
                    return None
                case Back(way=way, task=task):
                    if self._history.here > START:
                        stepped = self._tasks.get(task or stop.task, executor)
                        is_of_places = way == "go" and not self._watches
                        self._history.look_back(self._search_test(way, stepped), is_of_places)
                        raise _RunAgain
                    text = "this is the first statement"
                case Restart():
                    self._history.forget()
                    self._is_begun = False
                    for hits in self._hits.values():
                        del hits[:]
                    raise _RunAgain
                case Quit():
                    raise _SessionEnded
                case Select() as selected:
                    text = self._reason_against(selected, executor, stop)
                    if not text:
                        self._history.change(Selected(selected.line))
                        self._is_selected = True
                        return selected.line
            stop = Stop("refused", stop.task, stop.at, text=text)

    def _client_command(self, stop: Stop) -> Command:
        try:
            return self._client(self, stop)
        except RuntimeFailure as error:  # which would count as a fault of the program
            raise RuntimeError(f"the client has failed: {error}") from error

    def _step(self, way: str, executor: DebuggedExecutor) -> _Stepping:
        return _Stepping(way, executor.task, executor.height, self._ended_motions(way))

    def _search_test(self, way: str, executor: DebuggedExecutor) -> Fits:
        """Return the test for the statement to go back to."""
        if way == "go":
            return lambda one: self._watch_stop(one) or self._breakpoint_stop(one)
        step = self._step(way, executor)

        def fits(one: DebuggedExecutor) -> Stop | None:
            if way == "motion":
                is_there = one.task == step.task and self.arm.ended < step.ended
            else:
                is_there = step.is_over(one, 0)
            return Stop("back", one.task, one.at) if is_there else None

        return fits

    def _reason_against(self, selected: Select, executor: DebuggedExecutor, stop: Stop) -> str:
        """Return why a line cannot be selected; "" if it can."""
        if self._is_ended or stop.reason == "fault":
            return "the program has ended"
        if selected.task not in (None, executor.task):
            return f"the {executor.task} has stopped here: a line can be selected in it alone"
        frame = executor.inside.frames()[0]
        routine = routine_at(self._program, executor.at.file, frame.name)
        if frame.is_action:
            return "an action is no routine"
        if routine is None:
            return f"{frame.name} is not known"
        if selected.file and not _is_path_of(selected.file, executor.at.file):
            return f"{selected.file}:{selected.line} is not in {frame.name}"
        return reason_against(routine, executor.at.line, selected.line)


def _named(frame: StackFrame, levels: list[tuple[LevelKind, int]]) -> StackFrame:
    """Return a frame with its name; an action is named after its cause, the last of ``levels``."""
    if not frame.is_action or not levels:
        return frame
    kind, priority = levels.pop()
    return replace(frame, name=f"{kind} {priority or ''}".rstrip() + f" in {frame.name}")


def _is_path_of(wanted: str, file: str) -> bool:
    """Return whether ``wanted`` is the path of a file or the end of that path."""
    wanted, file = wanted.replace("\\", "/").upper(), file.upper()
    return file == wanted or file.endswith(f"/{wanted}")


def _differ(one: Value | None, other: Value | None) -> bool:
    return type(one) is not type(other) or one != other
