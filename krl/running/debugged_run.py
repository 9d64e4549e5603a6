"""A run under a debugger."""

from collections import Counter
from collections.abc import Callable

from interp.controller.state.trace import TraceEvent
from interp.debugging.debugger import Debugger
from interp.executors import Prepared
from interp.program.load import CheckedProgram
from interp.session import RunResult, RunSetup, run_program

# How often a repeated message is always shown; a loop may repeat it ten thousand times.
_EACH = 10


def debugged_run(
    program: CheckedProgram, setup: RunSetup, debugger: Debugger, on_message: Callable[[str], None]
) -> RunResult | None:
    """Return the result of the run; ``None`` if the debugger's client ended it.

    ``on_message`` gets each message of the program with its line, and only once if stepping back
    runs it again. Of a repeated message it gets the first ten, the 100th, the 1,000th and so on.
    """
    prepared = Prepared(program, setup.routine, [setup.submit], is_kept=True)
    counts: Counter[str] = Counter()

    def take(event: TraceEvent) -> None:
        if event.kind == "message" and not debugger.is_repeating:
            text = ": ".join(filter(None, (event.place, str(event.fields.get("text")))))
            counts[text] += 1
            count = counts[text]
            if count <= _EACH:
                on_message(text)
            elif count == 10 ** (len(str(count)) - 1):
                on_message(f"{text} ({count:,} times)")

    return debugger.run(lambda: run_program(prepared, setup, take=take, debugger=debugger))
