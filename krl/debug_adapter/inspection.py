"""Inspecting a stopped program: threads, frames, variables, expressions, sources."""

from krl.debug_adapter.arguments import Arguments, Refused
from krl.debug_adapter.connection import Json
from krl.debug_adapter.debuggee import ARM, FRAMES, TASKS, Debuggee


class Inspection:
    """Handles requests about a program; all except threads and sources need a stop."""

    def __init__(self, program: Debuggee) -> None:
        self._program = program

    def on_threads(self, _arguments: Arguments) -> Json:
        """Return the tasks, and the main run, as threads."""
        tasks = self._program.tasks or ("robot",)
        found = [{"id": TASKS.index(one) + 1, "name": one} for one in tasks]
        return {"threads": [*found, {"id": ARM, "name": "arm (main run)"}]}

    def on_stack_trace(self, arguments: Arguments) -> Json:
        """Return the call stack, the innermost frame first; for the arm, the current motion."""
        self._program.wait_for_stop()
        files = self._program.files
        thread = arguments.get("threadId", int, 1)
        if thread == ARM:
            running = self._program.debugger.arm.running
            every = [] if running is None else [("motion under way", running)]
        else:
            frames = self._program.debugger.frames(self._program.task(arguments))
            every = [(one.name, one.at) for one in frames]
        first = arguments.get("startFrame", int, 0)
        levels = arguments.get("levels", int, 0) or len(every)
        shown = list(enumerate(every))[first : first + levels]
        return {
            "stackFrames": [
                {
                    "id": thread * FRAMES + number,
                    "name": name,
                    "line": self._program.line_for(at.line),
                    "column": self._program.first_line,
                    "source": files.source(at.file),
                }
                for number, (name, at) in shown
            ],
            "totalFrames": len(every),
        }

    def on_scopes(self, arguments: Arguments) -> Json:
        """Return the groups of variables of a frame."""
        self._program.wait_for_stop()
        return {"scopes": self._program.variables.scopes(*self._program.frame(arguments))}

    def on_variables(self, arguments: Arguments) -> Json:
        """Return the variables of a group, or the parts of a variable."""
        self._program.wait_for_stop()
        reference = arguments.get("variablesReference", int, 0)
        start, count = arguments.get("start", int, 0), arguments.get("count", int, 0)
        return {
            "variables": self._program.variables.children(reference, max(0, start), max(0, count))
        }

    def on_set_variable(self, arguments: Arguments) -> Json:
        """Assign a value to a variable."""
        self._program.wait_for_stop()
        found = self._program.variables.assign(
            arguments.get("variablesReference", int, 0),
            arguments.text("name") or "",
            arguments.text("value") or "",
        )
        return {"value": found.pop("result"), **found}

    def on_set_expression(self, arguments: Arguments) -> Json:
        """Assign a value to the variable that an expression names."""
        self._program.wait_for_stop()
        text, (task, frame) = arguments.text("expression") or "", self._program.frame(arguments)
        self._program.debugger.assign(text, arguments.text("value") or "", task, frame)
        found = self._program.variables.shown(text, task, frame)
        return {"value": found.pop("result"), **found}

    def on_evaluate(self, arguments: Arguments) -> Json:
        """Return the value of an expression; in the console ``NAME = VALUE`` assigns."""
        self._program.wait_for_stop()
        text, (task, frame) = arguments.text("expression") or "", self._program.frame(arguments)
        name, sign, value = text.partition("=")
        is_assignment = (
            sign and value and value[0] != "=" and not name.rstrip().endswith(("<", ">"))
        )
        if is_assignment and arguments.text("context") == "repl":
            self._program.debugger.assign(name.strip(), value.strip(), task, frame)
            text = name.strip()
        return self._program.variables.shown(text, task, frame)

    def on_source(self, arguments: Arguments) -> Json:
        """Return the text of a file in an archive, or of a stand-in."""
        number = arguments.get("sourceReference", int, 0)
        number = arguments.inner("source").get("sourceReference", int, number)
        text = self._program.files.text(number)
        if text is None:
            raise Refused("there is no such file")
        return {"content": text}
