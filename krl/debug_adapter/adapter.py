"""The Debug Adapter Protocol: capabilities, start and stepping.

Other requests are answered in `krl.debug_adapter.inspection` and `krl.debug_adapter.breakpoints`.
A request ``gotoTargets`` is answered by the method ``on_goto_targets`` of one of the three, which
returns the body of the response. A function under the key ``then`` is removed from it, and called
after the response was sent.
"""

import re
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any, Final, get_args, get_type_hints

from interp.controller.state.trace import TaskName
from interp.debugging.client import Back, Command, Go, Select, StepCommand
from interp.values.faults import RuntimeFailure
from krl.debug_adapter.arguments import Arguments, Refused
from krl.debug_adapter.breakpoints import Breakpoints
from krl.debug_adapter.connection import Connection, Json
from krl.debug_adapter.debuggee import Debuggee
from krl.debug_adapter.inspection import Inspection
from krl.errors import InputError, one_line
from krl.running.run_options import RunOptions

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
#: For each field of the options, the name and type of the argument of ``launch``.
_OPTIONS: Final[Mapping[str, tuple[str, type[Any]]]] = {
    name: (re.sub("_(.)", lambda found: found[1].upper(), name), next(iter(get_args(kind)), kind))
    for name, kind in get_type_hints(RunOptions).items()
}


#: The command that each request to go on gives to the debugger, from the task that it names.
_GOING: Final[Mapping[str, Callable[[TaskName], Command]]] = {
    "continue": lambda _task: Go(),
    "reverseContinue": lambda _task: Back("go"),
    "next": partial(StepCommand, "over"),
    "stepIn": partial(StepCommand, "into"),
    "stepOut": partial(StepCommand, "out"),
    "stepMotion": partial(StepCommand, "motion"),
    "stepBack": partial(Back, "over"),
    "stepMotionBack": partial(Back, "motion"),
}


class Adapter:
    """Serves one client; options of the command line are defaults for its launch request."""

    def __init__(self, connection: Connection, file: Path | None, options: RunOptions) -> None:
        self._connection = connection
        self._file = file
        self._options = options
        self._program = Debuggee(connection)
        self._breakpoints = Breakpoints(self._program)
        self._targets: list[tuple[int, str]] = []
        self._parts = (self, self._breakpoints, Inspection(self._program))

    def serve(self) -> None:
        """Answer requests until the client disconnects."""
        try:
            for request in self._connection.requests():
                self._answer(request)
                if request["command"] == "disconnect":
                    break
        except InputError as error:
            self._connection.event("output", category="stderr", output=f"{error}\n")
        finally:
            self._program.leave()

    def _answer(self, request: Json) -> None:
        name, given = request["command"], request.get("arguments")
        arguments = Arguments(given if isinstance(given, dict) else {})
        method = "on_" + re.sub("[A-Z]", lambda found: f"_{found[0].lower()}", name)
        answers = (getattr(part, method, None) for part in self._parts)
        try:
            if name in _GOING:
                body = self._program.go(_GOING[name](self._program.task(arguments)))
            elif answer := next(filter(None, answers), None):
                body = answer(arguments)
            else:
                raise Refused(f"{name} is not supported")
        except (Refused, RuntimeFailure, InputError, IndexError) as error:
            self._connection.respond(request, None, one_line(str(error)))
            return
        then = body.pop("then", None)
        self._connection.respond(request, body)
        if then is not None:
            then()

    # ------------------------------------------------------------------------------- the session

    def on_initialize(self, arguments: Arguments) -> Json:
        """Return the capabilities of this adapter."""
        self._program.first_line = int(arguments.get("linesStartAt1", bool, True))
        return dict(_CAPABILITIES)

    def on_launch(self, arguments: Arguments) -> Json:
        """Load the program; it starts with configurationDone."""
        if self._program.has_begun:
            raise Refused("a program has been launched already")
        program = arguments.path("program") or self._file
        if program is None:
            raise Refused("launch names no program")
        given = {name: arguments.of(kind, key) for name, (key, kind) in _OPTIONS.items()}
        said = {name: value for name, value in given.items() if value is not None}
        self._file, self._options = program, replace(self._options, **said)
        self._program.stops_on_entry = arguments.get("stopOnEntry", bool, False)
        self._program.stops_at_end = arguments.get("stopAtEnd", bool, False)
        self._program.load(self._file, self._options)
        return {"then": lambda: self._connection.event("initialized")}

    def on_configuration_done(self, _arguments: Arguments) -> Json:
        """Start the program."""
        if not self._program.is_loaded or self._program.has_begun:
            raise Refused("there is no program to begin")
        return {"then": lambda: self._program.begin(self._breakpoints.install)}

    def on_restart(self, _arguments: Arguments) -> Json:
        """Read the files again and restart the program."""
        self._program.restart()
        return {"then": self._program.end}

    def on_disconnect(self, _arguments: Arguments) -> Json:
        """End the session, which is done after the response."""
        return {}

    def on_terminate(self, _arguments: Arguments) -> Json:
        """End the program."""
        return {"then": self._program.terminate}

    # ------------------------------------------------------------------------------- going

    def on_pause(self, _arguments: Arguments) -> Json:
        """Stop at the next statement."""
        self._program.pause()
        return {}

    def on_goto_targets(self, arguments: Arguments) -> Json:
        """Return the statement on a line as a target for `goto`."""
        file = self._program.files.named(arguments.inner("source").text("path") or "")
        line = self._program.line_of(arguments.get("line", int, 0))
        if line not in self._program.debugger.breakpoints.lines(file):
            return {"targets": []}
        shown = self._program.line_for(line)
        self._targets.append((line, file))
        return {"targets": [{"id": len(self._targets), "label": f"line {shown}", "line": shown}]}

    def on_goto(self, arguments: Arguments) -> Json:
        """Continue at a line of the routine without executing the lines between."""
        number = arguments.get("targetId", int, 0)
        if not 0 < number <= len(self._targets):
            raise Refused("there is no such target")
        line, file = self._targets[number - 1]
        return self._program.go(Select(line, file, self._program.task(arguments)))
