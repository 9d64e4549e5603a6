"""A client's requests and what they do: a session of the Debug Adapter Protocol.

Requests are read on one thread. The program runs on another one, which waits where it has stopped
until a request lets it go on; only meanwhile is it looked into.
"""

import contextlib
import io
import re
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from queue import SimpleQueue
from threading import Event, Thread
from typing import Any, Final, get_args, get_type_hints

from interp.controller.trace import TaskName
from interp.debugging.client import (
    Back,
    Breakpoint,
    Command,
    Go,
    Quit,
    Select,
    StepCommand,
    Stop,
    Watch,
    Way,
)
from interp.debugging.conditions import parsed
from interp.debugging.debugger import Debugger
from interp.debugging.hits import is_hit
from interp.debugging.value_text import value_text
from interp.program.load import CheckedProgram
from interp.session import RunResult, RunSetup
from interp.values.faults import RuntimeFailure
from krl.debug_adapter.arguments import Arguments, Refused
from krl.debug_adapter.connection import Connection, Json
from krl.debug_adapter.files import ProgramFiles
from krl.debug_adapter.variables import Variables
from krl.debugged_run import debugged_run
from krl.errors import InputError, one_line
from krl.run_notes import run_notes
from krl.run_options import RunOptions, expected_errors, prepared_run

__all__ = ["Adapter"]

_CAPABILITIES: Final[Json] = {
    "supportsConfigurationDoneRequest": True,
    "supportsConditionalBreakpoints": True,
    "supportsHitConditionalBreakpoints": True,
    "supportsLogPoints": True,
    "supportsDataBreakpoints": True,
    "supportsBreakpointLocationsRequest": True,
    "supportsEvaluateForHovers": True,
    "supportsSetVariable": True,
    "supportsSetExpression": True,
    "supportsStepBack": True,
    "supportsGotoTargetsRequest": True,
    "supportsRestartRequest": True,
    "supportsTerminateRequest": True,
    "supportsExceptionInfoRequest": True,
    "supportsDelayedStackTraceLoading": True,
    "exceptionBreakpointFilters": [
        {"filter": "faults", "label": "Faults that the program does not handle", "default": True}
    ],
}
_REASONS: Final = {
    "watch": "data breakpoint",
    "fault": "exception",
    "selected": "goto",
    "back": "step",
    "refused": "step",
    "ended": "pause",
}
#: Arguments of launch by the fields of the options: what each is called there, and its type.
_OPTIONS: Final[Mapping[str, tuple[str, type[Any]]]] = {
    name: (re.sub("_(.)", lambda found: found[1].upper(), name), next(iter(get_args(kind)), kind))
    for name, kind in get_type_hints(RunOptions).items()
}
_TASKS: Final[tuple[TaskName, ...]] = ("robot", "submit")
#: The thread that shows where the arm is, which is the main run.
_ARM: Final = 3
#: Frames are numbered by thread and place.
_FRAMES: Final = 10_000


class Adapter:
    """Serves one client, with what the command line says where its launch says nothing."""

    def __init__(self, connection: Connection, file: Path | None, options: RunOptions) -> None:
        self._connection = connection
        self._file = file
        self._options = options
        self._stops_on_entry = self._stops_at_end = False
        self._commands: SimpleQueue[Command] = SimpleQueue()
        self._stopped = Event()
        self._is_leaving = self._is_restarting = False
        self._thread: Thread | None = None
        self._breakpoints: dict[str, list[Breakpoint]] = {}
        self._watches: dict[str, Watch] = {}
        self._is_stopping_at_faults = True
        self._lines_first_1 = True
        self._files: ProgramFiles | None = None
        self._program: CheckedProgram
        self._setup: RunSetup
        self._debugger: Debugger
        self._variables: Variables
        self._stop: Stop

    def serve(self) -> None:
        """Answer requests until the client has gone."""
        try:
            for request in self._connection.requests():
                self._answer(request)
                if request["command"] == "disconnect":
                    break
        except InputError as error:
            self._connection.event("output", category="stderr", output=f"{error}\n")
        finally:
            self._leave()

    def _answer(self, request: Json) -> None:
        handle = _HANDLERS.get(request["command"])
        arguments = request.get("arguments")
        try:
            if handle is None:
                raise Refused(f"{request['command']} is not supported")
            body = handle(self, Arguments(arguments if isinstance(arguments, dict) else {}))
        except (Refused, RuntimeFailure, InputError, IndexError) as error:
            self._connection.respond(request, None, one_line(str(error)))
            return
        then = body.pop("then", None)
        self._connection.respond(request, body)
        if then is not None:
            then()

    # ----------------------------------------------------------------------- the session

    def _load(self) -> None:
        """Read the program, anew after a restart; what has to be said of it is an output."""
        said = io.StringIO()
        try:
            with contextlib.redirect_stderr(said), expected_errors():
                assert self._file is not None
                found = prepared_run(self._file, self._options, is_terminal=False)
                self._program, self._setup = found
                self._program.start(self._setup.routine)
        finally:
            self._output(said.getvalue(), "console")
        self._files = ProgramFiles(self._file, self._program)

    def _begin(self) -> None:
        self._thread = Thread(target=self._run, daemon=True)
        self._thread.start()

    def _run(self) -> None:
        """Run the program, as often as it is restarted, and report its end."""
        status = 2
        try:
            done = self._ran()
            while self._is_restarting:
                self._is_restarting = False
                self._load()
                done = self._ran()
            if done is not None:
                status = int(done.outcome.ending not in ("end", "halt"))
                for line in run_notes(done, self._program, self._setup):
                    self._output(line + "\n", "console")
                self._output(f"{self._program.main.module.path}: {done.outcome}\n", "console")
            else:
                status = 0
        except InputError as error:
            self._output(f"{error}\n", "stderr")
        except Exception as error:  # a defect of ours, which the client is told
            self._output(f"a defect in krl itself, {type(error).__name__}: {error}\n", "stderr")
        finally:
            with contextlib.suppress(OSError, ValueError):  # the client may have gone
                self._connection.event("exited", exitCode=status)
                self._connection.event("terminated")

    def _ran(self) -> RunResult | None:
        debugger = self._debugger = Debugger(self._program, self._client, self._log)
        self._watches.clear()
        self._put_breakpoints()
        debugger.stops_at_faults = self._is_stopping_at_faults
        with expected_errors():
            return debugged_run(
                self._program,
                self._setup,
                debugger,
                lambda text: self._output(f"{text}\n", "console"),
            )

    def _client(self, debugger: Debugger, stop: Stop) -> Command:
        """Wait for what the client wants, on the thread of the program."""
        if self._is_leaving or self._is_restarting:
            return Quit()
        if (stop.reason == "entry" and not self._stops_on_entry) or (
            stop.reason == "ended" and not self._stops_at_end
        ):
            return Go()
        self._stop, self._variables = stop, Variables(debugger)
        self._stopped.set()
        body: Json = {"reason": _REASONS.get(stop.reason, stop.reason), "allThreadsStopped": True}
        body["threadId"] = _TASKS.index(stop.task) + 1
        if stop.watch is not None:
            change = f"{value_text(stop.before)} -> {value_text(stop.now)}"
            body["description"] = body["text"] = f"{stop.watch.text}: {change}"
        elif stop.text:
            body["description"] = body["text"] = stop.text
        if stop.reason == "refused":
            self._output(f"{stop.text}\n", "important")
        self._connection.event("stopped", **body)
        return self._commands.get()

    def _go(self, command: Command) -> Json:
        """Let the program go on, once the client has its answer."""
        self._wait_for_stop()

        def then() -> None:
            self._stopped.clear()
            self._commands.put(command)

        return {"allThreadsContinued": True, "then": then}

    def _wait_for_stop(self) -> None:
        if not self._stopped.is_set():
            raise Refused("the program runs")

    def _end(self) -> None:
        """Leave the run, wherever it is."""
        if self._stopped.is_set():
            self._stopped.clear()
            self._commands.put(Quit())
        elif self._thread is not None:
            self._debugger.pause()

    def _leave(self) -> None:
        self._is_leaving = True
        self._end()
        if self._thread is not None:
            self._thread.join(1.0)

    def _log(self, text: str) -> None:
        self._output(f"{text}\n", "stdout")

    def _output(self, text: str, category: str) -> None:
        if text:
            self._connection.event("output", category=category, output=text)

    # ----------------------------------------------------------------------- setting up

    def initialize(self, arguments: Arguments) -> Json:
        """What this adapter can do."""
        self._lines_first_1 = arguments.get("linesStartAt1", bool, True)
        return dict(_CAPABILITIES)

    def launch(self, arguments: Arguments) -> Json:
        """Read the program; it begins with configurationDone."""
        if self._thread is not None:
            raise Refused("a program has been launched already")
        program = arguments.path("program") or self._file
        if program is None:
            raise Refused("launch names no program")
        given = {name: arguments.of(kind, key) for name, (key, kind) in _OPTIONS.items()}
        said = {name: value for name, value in given.items() if value is not None}
        self._file, self._options = program, replace(self._options, **said)
        self._stops_on_entry = arguments.get("stopOnEntry", bool, False)
        self._stops_at_end = arguments.get("stopAtEnd", bool, False)
        self._load()
        self._debugger = Debugger(self._program, self._client, self._log)
        return {"then": lambda: self._connection.event("initialized")}

    def configuration_done(self, _arguments: Arguments) -> Json:
        """Begin."""
        if self._files is None or self._thread is not None:
            raise Refused("there is no program to begin")
        return {"then": self._begin}

    def restart(self, _arguments: Arguments) -> Json:
        """Read the files again and begin anew."""
        if self._thread is None or not self._thread.is_alive():
            raise Refused("no program runs")
        self._is_restarting = True
        return {"then": self._end}

    def terminate(self, _arguments: Arguments) -> Json:
        """End the program."""
        self._is_leaving = True
        return {"then": self._end}

    def disconnect(self, _arguments: Arguments) -> Json:
        """End all."""
        return {}

    # ----------------------------------------------------------------------- breakpoints

    def set_breakpoints(self, arguments: Arguments) -> Json:
        """Those of one file, in place of all it had; each at the next line with a statement."""
        source = arguments.inner("source")
        file = self._launched().named(source.text("path") or source.text("name") or "")
        lines = self._debugger.lines(file)
        found: list[Json] = []
        made: list[Breakpoint] = []
        for one in arguments.all("breakpoints"):
            wanted = self._line_of(one.get("line", int, 0))
            line = next((line for line in lines if line >= wanted), None)
            text = "no statement begins here" if line is None else self._wrong(one)
            if line is None or text:
                found.append({"verified": False, "message": text})
                continue
            made.append(
                Breakpoint(
                    file,
                    line,
                    one.text("condition"),
                    one.text("hitCondition"),
                    one.text("logMessage"),
                )
            )
            found.append({"verified": True, "line": self._line_for(line)})
        self._breakpoints[file] = made
        self._put_breakpoints()
        return {"breakpoints": found}

    @staticmethod
    def _wrong(one: Arguments) -> str:
        """Why a breakpoint cannot be; empty where it can."""
        try:
            condition, hits = one.text("condition"), one.text("hitCondition")
            if condition:
                parsed(condition)
            is_hit(hits, 1)
        except RuntimeFailure as error:
            return str(error)
        return ""

    def _put_breakpoints(self) -> None:
        every = [one for found in self._breakpoints.values() for one in found]
        self._debugger.set_breakpoints(every)

    def breakpoint_locations(self, arguments: Arguments) -> Json:
        """The lines of a range at which a program can stop."""
        file = self._launched().named(arguments.inner("source").text("path") or "")
        first = self._line_of(arguments.get("line", int, 0))
        last = self._line_of(arguments.get("endLine", int, arguments.get("line", int, 0)))
        lines = self._debugger.lines(file)
        there = [self._line_for(line) for line in lines if first <= line <= last]
        return {"breakpoints": [{"line": line} for line in there]}

    def set_exception_breakpoints(self, arguments: Arguments) -> Json:
        """Whether to stop at faults."""
        filters = arguments.values.get("filters")
        self._is_stopping_at_faults = isinstance(filters, list) and "faults" in filters
        if self._files is not None:
            self._debugger.stops_at_faults = self._is_stopping_at_faults
        return {}

    def exception_info(self, _arguments: Arguments) -> Json:
        """The fault that the program has stopped at."""
        self._wait_for_stop()
        return {
            "exceptionId": "fault",
            "description": self._stop.text,
            "breakMode": "unhandled" if self._stop.reason == "fault" else "never",
        }

    def data_breakpoint_info(self, arguments: Arguments) -> Json:
        """How a variable can be watched."""
        self._wait_for_stop()
        reference = arguments.get("variablesReference", int, 0)
        text = arguments.text("name") or ""
        task, frame = self._frame(arguments)
        if reference:
            text, task, frame = self._variables.path(reference, text)
        parsed(text)
        return {
            "dataId": f"{task} {frame} {text}",
            "description": text,
            "accessTypes": ["write"],
            "canPersist": False,
        }

    def set_data_breakpoints(self, arguments: Arguments) -> Json:
        """All there are; those that are set already stay as they are."""
        self._wait_for_stop()
        wanted = [one.text("dataId") or "" for one in arguments.all("breakpoints")]
        for name in [one for one in self._watches if one not in wanted]:
            self._debugger.forget(self._watches.pop(name))
        found: list[Json] = []
        for name in wanted:
            found.append({"verified": True})
            if name in self._watches:
                continue
            task, frame, text = (*name.split(" ", 2), "", "")[:3]
            if task not in _TASKS or not frame.isdigit():
                found[-1] = {"verified": False, "message": "there is no such variable"}
                continue
            self._watches[name] = self._debugger.watch(text, task, int(frame))
        return {"breakpoints": found}

    # ----------------------------------------------------------------------- going

    def go_on(self, _arguments: Arguments) -> Json:
        """Go on to the next stop."""
        return self._go(Go())

    def reverse(self, _arguments: Arguments) -> Json:
        """Go back to where it would have stopped last."""
        return self._go(Back("go"))

    def step_back(self, arguments: Arguments) -> Json:
        """Go back by a statement."""
        return self._go(Back("over", self._task(arguments)))

    def step_motion_back(self, arguments: Arguments) -> Json:
        """Go back to before the motion that has ended last."""
        return self._go(Back("motion", self._task(arguments)))

    def pause(self, _arguments: Arguments) -> Json:
        """Stop at the next statement."""
        self._launched()
        self._debugger.pause()
        return {}

    def goto_targets(self, arguments: Arguments) -> Json:
        """The statement of a line, which `goto` may name."""
        file = self._launched().named(arguments.inner("source").text("path") or "")
        line = self._line_of(arguments.get("line", int, 0))
        if line not in self._debugger.lines(file):
            return {"targets": []}
        shown = self._line_for(line)
        return {"targets": [{"id": line, "label": f"line {shown}", "line": shown}]}

    def goto(self, arguments: Arguments) -> Json:
        """Go on at a line of the routine, without executing what lies between."""
        return self._go(Select(arguments.get("targetId", int, 0)))

    # ----------------------------------------------------------------------- looking

    def threads(self, _arguments: Arguments) -> Json:
        """The programs, and the main run."""
        tasks = () if self._files is None else self._debugger.tasks
        found = [{"id": _TASKS.index(one) + 1, "name": one} for one in tasks or ("robot",)]
        return {"threads": [*found, {"id": _ARM, "name": "arm (main run)"}]}

    def stack_trace(self, arguments: Arguments) -> Json:
        """What is open, the innermost first; of the arm, the motion it is in."""
        self._wait_for_stop()
        files = self._launched()
        thread = arguments.get("threadId", int, 1)
        if thread == _ARM:
            running = self._debugger.arm.running
            every = [] if running is None else [("motion under way", running)]
        else:
            frames = self._debugger.frames(self._task(arguments))
            every = [(one.name, one.at) for one in frames]
        first = arguments.get("startFrame", int, 0)
        levels = arguments.get("levels", int, 0) or len(every)
        shown = list(enumerate(every))[first : first + levels]
        return {
            "stackFrames": [
                {
                    "id": thread * _FRAMES + number,
                    "name": name,
                    "line": self._line_for(at.line),
                    "column": 1 if self._lines_first_1 else 0,
                    "source": files.source(at.file),
                }
                for number, (name, at) in shown
            ],
            "totalFrames": len(every),
        }

    def scopes(self, arguments: Arguments) -> Json:
        """Groups of variables of a frame."""
        self._wait_for_stop()
        return {"scopes": self._variables.scopes(*self._frame(arguments))}

    def variables(self, arguments: Arguments) -> Json:
        """The variables of a group, or the parts of one."""
        self._wait_for_stop()
        reference = arguments.get("variablesReference", int, 0)
        start, count = arguments.get("start", int, 0), arguments.get("count", int, 0)
        return {"variables": self._variables.children(reference, max(0, start), max(0, count))}

    def set_variable(self, arguments: Arguments) -> Json:
        """Give a variable a value."""
        self._wait_for_stop()
        found = self._variables.assign(
            arguments.get("variablesReference", int, 0),
            arguments.text("name") or "",
            arguments.text("value") or "",
        )
        return {"value": found.pop("result"), **found}

    def set_expression(self, arguments: Arguments) -> Json:
        """Give what an expression names a value."""
        self._wait_for_stop()
        text, (task, frame) = arguments.text("expression") or "", self._frame(arguments)
        self._debugger.assign(text, arguments.text("value") or "", task, frame)
        found = self._variables.shown(text, task, frame)
        return {"value": found.pop("result"), **found}

    def evaluate(self, arguments: Arguments) -> Json:
        """The value of an expression; in the console ``NAME = VALUE`` assigns."""
        self._wait_for_stop()
        text, (task, frame) = arguments.text("expression") or "", self._frame(arguments)
        name, sign, value = text.partition("=")
        is_assignment = (
            sign and value and value[0] != "=" and not name.rstrip().endswith(("<", ">"))
        )
        if is_assignment and arguments.text("context") == "repl":
            self._debugger.assign(name.strip(), value.strip(), task, frame)
            text = name.strip()
        return self._variables.shown(text, task, frame)

    def source(self, arguments: Arguments) -> Json:
        """The text of a file that lies in an archive, or stands in for one that is missing."""
        number = arguments.get("sourceReference", int, 0)
        number = arguments.inner("source").get("sourceReference", int, number)
        text = self._launched().text(number)
        if text is None:
            raise Refused("there is no such file")
        return {"content": text}

    # ----------------------------------------------------------------------- places

    def _launched(self) -> ProgramFiles:
        if self._files is None:
            raise Refused("no program has been launched")
        return self._files

    def _task(self, arguments: Arguments) -> TaskName:
        number = arguments.get("threadId", int, 1)
        tasks = self._debugger.tasks
        return _TASKS[number - 1] if number in (1, 2) and _TASKS[number - 1] in tasks else "robot"

    def _frame(self, arguments: Arguments) -> tuple[TaskName, int]:
        """The frame that is meant, by default the one on top of what has stopped."""
        number = arguments.get("frameId", int, 0)
        if not number:
            return self._stop.task, 0
        thread, frame = divmod(number, _FRAMES)
        if thread == _ARM:
            return "robot", 0
        task = _TASKS[thread - 1] if thread in (1, 2) else "robot"
        if task not in self._debugger.tasks or frame >= len(self._debugger.frames(task)):
            raise Refused("there is no such frame")
        return task, frame

    def _line_of(self, line: int) -> int:
        return line if self._lines_first_1 else line + 1

    def _line_for(self, line: int) -> int:
        return line if self._lines_first_1 else line - 1


_Handler = Callable[[Adapter, Arguments], Json]


def _stepping(way: Way) -> _Handler:
    def step(adapter: Adapter, arguments: Arguments) -> Json:
        return adapter._go(StepCommand(way, adapter._task(arguments)))

    return step


_HANDLERS: Final[Mapping[str, _Handler]] = {
    "initialize": Adapter.initialize,
    "launch": Adapter.launch,
    "configurationDone": Adapter.configuration_done,
    "restart": Adapter.restart,
    "terminate": Adapter.terminate,
    "disconnect": Adapter.disconnect,
    "setBreakpoints": Adapter.set_breakpoints,
    "breakpointLocations": Adapter.breakpoint_locations,
    "setExceptionBreakpoints": Adapter.set_exception_breakpoints,
    "exceptionInfo": Adapter.exception_info,
    "dataBreakpointInfo": Adapter.data_breakpoint_info,
    "setDataBreakpoints": Adapter.set_data_breakpoints,
    "continue": Adapter.go_on,
    "reverseContinue": Adapter.reverse,
    "next": _stepping("over"),
    "stepIn": _stepping("into"),
    "stepOut": _stepping("out"),
    "stepMotion": _stepping("motion"),
    "stepBack": Adapter.step_back,
    "stepMotionBack": Adapter.step_motion_back,
    "pause": Adapter.pause,
    "gotoTargets": Adapter.goto_targets,
    "goto": Adapter.goto,
    "threads": Adapter.threads,
    "stackTrace": Adapter.stack_trace,
    "scopes": Adapter.scopes,
    "variables": Adapter.variables,
    "setVariable": Adapter.set_variable,
    "setExpression": Adapter.set_expression,
    "evaluate": Adapter.evaluate,
    "source": Adapter.source,
}
