"""A debugger for all programs of a run: it stops, steps, inspects, changes and steps back.

The debugger runs a function that it is given, and calls its client where a program stops; nothing
continues until the client has returned. To go back, it repeats the run and stops earlier
(`interp.debugging.history`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final, TypeVar

from grammar.syntax import ast
from interp.controller.state.trace import TaskName
from interp.debugging.breakpoints import Breakpoints, is_path_of
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
)
from interp.debugging.executor import DebuggedExecutor
from interp.debugging.history import START, Assigned, Fits, History, Selected
from interp.debugging.inspection import Inspection
from interp.debugging.value_text import value_text
from interp.debugging.watches import Watches
from interp.port.inspection import Breaks
from interp.port.requests import Fail, Skip
from interp.program.load import CheckedProgram, Routine
from interp.program.statement_paths import routine_at, way_to
from interp.values.faults import LinkError, RuntimeFailure

#: Called where a program stops; may inspect and change the run through the debugger.
Client = Callable[["Debugger", Stop], Command]
_T = TypeVar("_T")
_NOWHERE: Final[Breaks] = {}


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


class Debugger(Inspection):
    """Debugs the runs of one program.

    ``log`` receives the texts of log points. With ``stops_at_entry`` each session stops before its
    first statement.
    """

    def __init__(
        self, program: CheckedProgram, client: Client, log: Callable[[str], None] = print
    ) -> None:
        super().__init__(program)
        self.stops_at_entry = self.stops_at_faults = True
        self.breakpoints = Breakpoints(program)
        self.watches = Watches(self)
        self._client = client
        self._log = log
        self._history = History()
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
            self.watches.begin()
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

    def pause(self) -> None:
        """Stop before the next statement; may be called from another thread."""
        self._is_to_pause = True

    @property
    def is_repeating(self) -> bool:
        """Whether the run repeats what has happened before, so that its events are known."""
        return self._history.is_repeating

    def assign(self, text: str, value: str, task: TaskName = "robot", frame: int = 0) -> None:
        """Assign the value of an expression to a variable, system variable or input.

        Raises `LinkError`, and `Fault` for a value that the variable cannot have.
        """
        if self._is_ended:
            raise LinkError("the program has ended")
        change = self.assignment(text, value, task, frame)
        self.apply(change)
        self._history.change(change)

    # ----------------------------------------------------------------------- statements that begin

    @property
    def places(self) -> Breaks:
        """The breakpoints that the debugger wants to see, even where `unseen` allows more.

        The object stays the same as long as its content does.
        """
        history = self._history
        is_idle = history.is_repeating and not history.is_looking(self._begun_count())
        return _NOWHERE if is_idle else self.breakpoints.places

    def unseen(self, shows_places: bool) -> int:
        """Return how many statements may begin before the debugger wants to see one.

        With ``shows_places``, statements at `places` are shown anyway and need not be counted.
        """
        history = self._history
        if not history.is_repeating:
            places = self.breakpoints.places and not shows_places
            looks = places or self.watches.all or self._stepping
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
                self.apply(change)
            else:
                line = change.line
        self._end_search_at(executor)
        if arrived := history.arrived(executor):
            self._is_begun = True
            self.breakpoints.forget_hits(after=history.here[0])
            self.watches.change(executor)  # the watches take the values of this moment
            return self._handle_stop(executor, arrived)
        if line is not None or history.is_repeating:
            return line
        stop = self._reason_to_stop(executor)
        return None if stop is None else self._handle_stop(executor, stop)

    def fails(self, executor: DebuggedExecutor, request: Fail | Skip) -> None:
        """Stop at a fault that the program does not handle, or at a statement that is skipped."""
        self._history.comes(self._begun_count())
        is_last = isinstance(request, Fail)
        if is_last:
            self._end_search_at(None)
        if self.stops_at_faults and not self._history.is_repeating:
            text = str(request.fault) if is_last else f"{request.fault}; to continue is to skip it"
            stop = Stop("fault", executor.task, request.at, text=text)
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
            if self.stops_at_entry:
                return Stop("entry", task, at)
        if self._is_selected:
            self._is_selected = False
            return Stop("selected", task, at)
        if self._is_to_pause:
            self._is_to_pause = False
            return Stop("pause", task, at)
        changed = self.watches.change(executor)
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
        moment, is_new = self._history.here[0], not self._history.is_repeating
        found: Stop | None = None
        for one in self.breakpoints.at(at.file, at.line):
            text = self._breakpoint_note(one, task)
            if text is None or not self.breakpoints.hit_counts(one, moment, is_new=is_new):
                continue
            if one.log is None:
                found = found or Stop("breakpoint", task, at, text=text)
            elif is_new:
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

    def _log_text(self, text: str, task: TaskName) -> str:
        """Return the text of a log point, with the values of the expressions in braces."""
        parts = text.replace("}", "{").split("{")
        for place in range(1, len(parts), 2):
            try:
                parts[place] = value_text(self.value(parts[place], task))
            except RuntimeFailure as error:
                parts[place] = f"({error})"
        return "".join(parts)

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
                        is_of_places = way == "go" and not self.watches.all
                        self._history.look_back(self._search_test(way, stepped), is_of_places)
                        raise _RunAgain
                    text = "this is the first statement"
                case Restart():
                    self._history.forget()
                    self._is_begun = False
                    self.breakpoints.forget_hits()
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
            return lambda one: self.watches.change(one) or self._breakpoint_stop(one)
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
        if self._is_ended:
            return "the program has ended"
        if stop.reason == "fault":
            return "the statement has failed: go back to before it"
        if selected.task not in (None, executor.task):
            return f"the {executor.task} has stopped here: a line can be selected in it alone"
        frame = executor.inside.frames()[0]
        routine = routine_at(self._program, executor.at.file, frame.name)
        if frame.is_action:
            return "an action is no routine"
        if routine is None:
            return f"{frame.name} is not known"
        if selected.file and not is_path_of(selected.file, executor.at.file):
            return f"{selected.file}:{selected.line} is not in {frame.name}"
        return _reason_against_line(routine, executor.at.line, selected.line)


def _reason_against_line(routine: Routine, here: int, line: int) -> str:
    """Return why a program cannot continue at ``line`` when it is at ``here``; "" if it can.

    The limit of a FOR is private to it, so its body can be entered only from inside. No rule says
    what else the official implementation allows (unconfirmed).
    """
    way = way_to(routine, line)
    if not way:
        return f"no statement of {routine.name} begins in line {line}"
    open_blocks = way_to(routine, here)[:-1]
    for block in way[:-1]:
        if isinstance(block, ast.For) and block not in open_blocks:
            first = routine.unit.line(block)
            return f"line {line} is inside the FOR of line {first}, which has not begun"
    return ""
