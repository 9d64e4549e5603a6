"""A run under a debugger."""

from collections.abc import Callable

from interp.controller.trace import TraceEvent
from interp.debugging.debugger import Debugger
from interp.executors import Prepared
from interp.program.load import CheckedProgram
from interp.session import RunResult, RunSetup, run_program


def debugged_run(
    program: CheckedProgram, setup: RunSetup, debugger: Debugger, on_message: Callable[[str], None]
) -> RunResult | None:
    """What came of the run; ``None`` where the client of the debugger left it.

    ``on_message`` takes each message of the program once, though going back runs it again.
    """
    prepared = Prepared(program, setup.routine, is_kept=True)

    def take(event: TraceEvent) -> None:
        if event.kind == "message" and not debugger.is_repeating:
            on_message(str(event.fields.get("text")))

    return debugger.run(lambda: run_program(prepared, setup, take=take, debugger=debugger))
