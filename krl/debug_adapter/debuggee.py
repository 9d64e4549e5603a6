"""The program being debugged: file and options, its thread, where it stops, how it continues.

Requests are read on one thread. The program runs on another one. Where it stops, that thread waits
until a request lets it continue; the program is only inspected meanwhile.
"""

import contextlib
import io
from collections.abc import Callable
from pathlib import Path
from queue import SimpleQueue
from threading import Event, Thread
from typing import Final

from interp.controller.state.trace import TaskName
from interp.debugging.client import Command, Go, Quit, Stop
from interp.debugging.debugger import Debugger
from interp.debugging.value_text import value_text
from interp.program.load import CheckedProgram
from interp.session import RunResult, RunSetup
from krl.debug_adapter.arguments import Arguments, Refused
from krl.debug_adapter.connection import Connection, Json
from krl.debug_adapter.files import ProgramFiles
from krl.debug_adapter.variables import Variables
from krl.errors import InputError
from krl.running.debugged_run import debugged_run
from krl.running.run_notes import run_notes
from krl.running.run_options import RunOptions, expected_errors, prepared_run

_REASONS: Final = {
    "watch": "data breakpoint",
    "fault": "exception",
    "selected": "goto",
    "back": "step",
    "refused": "step",
    "ended": "pause",
}
TASKS: Final[tuple[TaskName, ...]] = ("robot", "submit")
#: The number of the thread that stands for the arm (the main run).
ARM: Final = 3
#: A frame's number is that of its thread times this, plus its index.
FRAMES: Final = 10_000


class Debuggee:
    """The program of one session.

    ``debugger``, ``stop`` and ``variables`` belong to the current run; the latter two are valid
    while it is stopped. ``first_line`` is the client's number of the first line of a file.
    """

    debugger: Debugger
    stop: Stop
    variables: Variables

    def __init__(self, connection: Connection) -> None:
        self._connection = connection
        self.first_line = 1
        self.stops_on_entry = self.stops_at_end = False
        self._commands: SimpleQueue[Command] = SimpleQueue()
        self._stopped = Event()
        self._is_leaving = self._is_restarting = False
        self._thread: Thread | None = None
        self._file: Path
        self._options: RunOptions
        self._files: ProgramFiles | None = None
        self._program: CheckedProgram
        self._setup: RunSetup

    # ------------------------------------------------------------------------------- its life

    @property
    def is_loaded(self) -> bool:
        """Whether a program is loaded."""
        return self._files is not None

    @property
    def has_begun(self) -> bool:
        """Whether the program has been started."""
        return self._thread is not None

    @property
    def files(self) -> ProgramFiles:
        """The files of the program; raises `Refused` before it is loaded."""
        if self._files is None:
            raise Refused("no program has been launched")
        return self._files

    @property
    def tasks(self) -> tuple[TaskName, ...]:
        """The tasks of the program; none before it is loaded."""
        return () if self._files is None else self.debugger.tasks

    def load(self, file: Path, options: RunOptions) -> None:
        """Load the program; remarks are sent as output. Raises `InputError`."""
        said = io.StringIO()
        try:
            with contextlib.redirect_stderr(said), expected_errors(options.robot):
                self._program, self._setup = prepared_run(file, options, is_terminal=False)
                self._program.start(self._setup.routine)
        finally:
            self.output(said.getvalue(), "console")
        self._files = ProgramFiles(file, self._program)
        self._file, self._options = file, options
        self.debugger = Debugger(self._program, self._client, self._log)

    def begin(self, prepare: Callable[[Debugger], None]) -> None:
        """Start the program; ``prepare`` gets the debugger of each run beforehand."""
        self._thread = Thread(target=self._run, args=(prepare,), daemon=True)
        self._thread.start()

    def restart(self) -> None:
        """Restart once the run has ended; raises `Refused` if nothing runs."""
        if self._thread is None or not self._thread.is_alive():
            raise Refused("no program runs")
        self._is_restarting = True

    def pause(self) -> None:
        """Stop at the next statement; raises `Refused` before the program is loaded."""
        if not self.is_loaded:
            raise Refused("no program has been launched")
        self.debugger.pause()

    def terminate(self) -> None:
        """End the run without a restart."""
        self._is_leaving = True
        self.end()

    def end(self) -> None:
        """End the current run."""
        if self._stopped.is_set():
            self._stopped.clear()
            self._commands.put(Quit())
        elif self._thread is not None:
            self.debugger.pause()

    def leave(self) -> None:
        """End everything, because the client has disconnected."""
        self.terminate()
        if self._thread is not None:
            self._thread.join(1.0)

    def go(self, command: Command) -> Json:
        """Return a response after which the program continues; raises `Refused` while it runs."""
        self.wait_for_stop()

        def then() -> None:
            self._stopped.clear()
            self._commands.put(command)

        return {"allThreadsContinued": True, "then": then}

    def wait_for_stop(self) -> None:
        """Raise `Refused` while the program runs, so that it is not inspected then."""
        if not self._stopped.is_set():
            raise Refused("the program runs")

    def output(self, text: str, category: str) -> None:
        """Send a text as output, unless it is empty."""
        if text:
            self._connection.event("output", category=category, output=text)

    # ------------------------------------------------------------------------------- its thread

    def _run(self, prepare: Callable[[Debugger], None]) -> None:
        """Run the program, with its restarts, and report its end."""
        status = 2
        try:
            done = self._ran(prepare)
            while self._is_restarting:
                self._is_restarting = False
                self.load(self._file, self._options)
                done = self._ran(prepare)
            if done is not None:
                status = int(done.outcome.ending not in ("end", "halt"))
                for line in run_notes(done, self._program, self._setup):
                    self.output(line + "\n", "console")
                self.output(f"{self._program.main.module.path}: {done.outcome}\n", "console")
            else:
                status = 0
        except InputError as error:
            self.output(f"{error}\n", "stderr")
        except Exception as error:  # a defect of ours, which is reported to the client
            self.output(f"a defect in krl itself, {type(error).__name__}: {error}\n", "stderr")
        finally:
            with contextlib.suppress(OSError, ValueError):  # the client may have gone
                self._connection.event("exited", exitCode=status)
                self._connection.event("terminated")

    def _ran(self, prepare: Callable[[Debugger], None]) -> RunResult | None:
        self.debugger.stops_at_entry = self.stops_on_entry
        prepare(self.debugger)
        with expected_errors(self._options.robot):
            return debugged_run(
                self._program,
                self._setup,
                self.debugger,
                lambda text: self.output(f"{text}\n", "console"),
            )

    def _client(self, debugger: Debugger, stop: Stop) -> Command:
        """Wait for the client's next command, on the thread of the program."""
        if self._is_leaving or self._is_restarting:
            return Quit()
        if stop.reason == "ended" and not self.stops_at_end:
            return Go()
        self.stop, self.variables = stop, Variables(debugger)
        self._stopped.set()
        body: Json = {"reason": _REASONS.get(stop.reason, stop.reason), "allThreadsStopped": True}
        body["threadId"] = TASKS.index(stop.task) + 1
        if stop.watch is not None:
            change = f"{value_text(stop.before)} -> {value_text(stop.now)}"
            body["description"] = body["text"] = f"{stop.watch.text}: {change}"
        elif stop.text:
            body["description"] = body["text"] = stop.text
        if stop.reason == "refused":
            self.output(f"{stop.text}\n", "important")
        self._connection.event("stopped", **body)
        return self._commands.get()

    def _log(self, text: str) -> None:
        self.output(f"{text}\n", "stdout")

    # ------------------------------------------------------------------------------- its places

    def task(self, arguments: Arguments) -> TaskName:
        """Return the task of the thread in a request; the default is the robot's."""
        number = arguments.get("threadId", int, 1)
        return (
            TASKS[number - 1] if number in (1, 2) and TASKS[number - 1] in self.tasks else "robot"
        )

    def frame(self, arguments: Arguments) -> tuple[TaskName, int]:
        """Return the frame in a request; the default is the top one of the stopped task."""
        number = arguments.get("frameId", int, 0)
        if not number:
            return self.stop.task, 0
        thread, frame = divmod(number, FRAMES)
        if thread == ARM:
            return "robot", 0
        task = TASKS[thread - 1] if thread in (1, 2) else "robot"
        if task not in self.debugger.tasks or frame >= len(self.debugger.frames(task)):
            raise Refused("there is no such frame")
        return task, frame

    def line_of(self, line: int) -> int:
        """Return the line number, from 1, for the client's number."""
        return line + 1 - self.first_line

    def line_for(self, line: int) -> int:
        """Return the client's number for a line number."""
        return line - 1 + self.first_line
