"""Breakpoints on lines, data breakpoints, and stops at faults."""

from bisect import bisect_left

from interp.debugging.breakpoints import is_hit
from interp.debugging.client import Breakpoint, Watch
from interp.debugging.conditions import parsed
from interp.debugging.debugger import Debugger
from interp.values.faults import RuntimeFailure
from krl.debug_adapter.arguments import Arguments
from krl.debug_adapter.connection import Json
from krl.debug_adapter.debuggee import TASKS, Debuggee


class Breakpoints:
    """The client's breakpoints; they persist from one run to the next."""

    def __init__(self, program: Debuggee) -> None:
        self._program = program
        self._of_files: dict[str, list[Breakpoint]] = {}
        self._watches: dict[str, Watch] = {}
        self._is_stopping_at_faults = True

    def install(self, debugger: Debugger) -> None:
        """Set the breakpoints in the debugger of a new run; data breakpoints do not persist."""
        self._watches.clear()
        debugger.breakpoints.set(self._every())
        debugger.stops_at_faults = self._is_stopping_at_faults

    def _every(self) -> list[Breakpoint]:
        return [one for found in self._of_files.values() for one in found]

    def on_set_breakpoints(self, arguments: Arguments) -> Json:
        """Replace the breakpoints of one file; each moves to the next line with a statement."""
        source = arguments.inner("source")
        file = self._program.files.named(source.text("path") or source.text("name") or "")
        lines = self._program.debugger.breakpoints.lines(file)
        found: list[Json] = []
        made: list[Breakpoint] = []
        for one in arguments.all("breakpoints"):
            wanted = self._program.line_of(one.get("line", int, 0))
            place = bisect_left(lines, wanted)
            line = lines[place] if place < len(lines) else None
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
            found.append({"verified": True, "line": self._program.line_for(line)})
        self._of_files[file] = made
        self._program.debugger.breakpoints.set(self._every())
        return {"breakpoints": found}

    @staticmethod
    def _wrong(one: Arguments) -> str:
        """Return why a breakpoint is invalid; empty if it is valid."""
        try:
            condition, hits = one.text("condition"), one.text("hitCondition")
            if condition:
                parsed(condition)
            is_hit(hits, 1)
        except RuntimeFailure as error:
            return str(error)
        return ""

    def on_breakpoint_locations(self, arguments: Arguments) -> Json:
        """Return the lines of a range at which a program can stop."""
        file = self._program.files.named(arguments.inner("source").text("path") or "")
        first = self._program.line_of(arguments.get("line", int, 0))
        last = self._program.line_of(arguments.get("endLine", int, arguments.get("line", int, 0)))
        lines = self._program.debugger.breakpoints.lines(file)
        there = [self._program.line_for(line) for line in lines if first <= line <= last]
        return {"breakpoints": [{"line": line} for line in there]}

    def on_set_exception_breakpoints(self, arguments: Arguments) -> Json:
        """Set whether to stop at faults."""
        filters = arguments.values.get("filters")
        self._is_stopping_at_faults = isinstance(filters, list) and "faults" in filters
        if self._program.is_loaded:
            self._program.debugger.stops_at_faults = self._is_stopping_at_faults
        return {}

    def on_exception_info(self, _arguments: Arguments) -> Json:
        """Return the fault at which the program has stopped."""
        self._program.wait_for_stop()
        return {
            "exceptionId": "fault",
            "description": self._program.stop.text,
            "breakMode": "unhandled" if self._program.stop.reason == "fault" else "never",
        }

    def on_data_breakpoint_info(self, arguments: Arguments) -> Json:
        """Return how a variable can be watched."""
        self._program.wait_for_stop()
        reference = arguments.get("variablesReference", int, 0)
        text = arguments.text("name") or ""
        task, frame = self._program.frame(arguments)
        if reference:
            text, task, frame = self._program.variables.path(reference, text)
        parsed(text)
        return {
            "dataId": f"{task} {frame} {text}",
            "description": text,
            "accessTypes": ["write"],
            "canPersist": False,
        }

    def on_set_data_breakpoints(self, arguments: Arguments) -> Json:
        """Replace the data breakpoints; those that are already set are kept."""
        wanted = [one.text("dataId") or "" for one in arguments.all("breakpoints")]
        if wanted or self._watches:  # VS Code says at the start that there are none
            self._program.wait_for_stop()
        for name in [one for one in self._watches if one not in wanted]:
            self._program.debugger.watches.remove(self._watches.pop(name))
        found: list[Json] = []
        for name in wanted:
            found.append({"verified": True})
            if name in self._watches:
                continue
            task, frame, text = (*name.split(" ", 2), "", "")[:3]
            if task not in TASKS or not frame.isdigit():
                found[-1] = {"verified": False, "message": "there is no such variable"}
                continue
            self._watches[name] = self._program.debugger.watches.add(text, task, int(frame))
        return {"breakpoints": found}
