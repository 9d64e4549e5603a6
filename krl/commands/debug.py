"""`krl debug`: a program under a debugger, at a prompt or behind an editor."""

import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING, Annotated

import typer

from krl.errors import FINDINGS, FINE, InputError, say
from krl.running.run_options import RunOptions, expected_errors, prepared_run

if TYPE_CHECKING:
    from interp.debugging.debugger import Debugger
    from krl.running.debug_prompt import Prompt


def debug(
    file: Annotated[Path | None, typer.Argument(metavar="[FILE]")] = None,
    *,
    options: RunOptions,
    dap: bool = False,
    port: Annotated[int | None, typer.Option(min=0, max=65535)] = None,
) -> int:
    """Run a program under a debugger: breakpoints, steps forwards and back, variables, the arm.

    Commands are read from a prompt, or from standard input if it is not a terminal; `help` lists
    them. Exit status 1 if the run ended with a fault or a command from a file was wrong. See
    docs/debugging.md.

    Options:
        file: The program; with --dap the client can name it.
        dap: Serve an editor: the Debug Adapter Protocol over stdio.
        port: With --dap: use this port of 127.0.0.1; 0 picks one.
    """
    if dap:
        from krl.debug_adapter.server import serve

        serve(file, options, port)
        return FINE
    if port is not None:
        raise InputError("--port: only with --dap")
    if file is None:
        raise InputError("name a program: krl debug FILE")
    return _at_prompt(file, options)


def _at_prompt(file: Path, options: RunOptions) -> int:
    with expected_errors(options.robot):
        from interp.debugging.debugger import Debugger
        from krl.running.debug_prompt import Prompt
        from krl.running.debugged_run import debugged_run
        from krl.running.run_notes import run_notes

        is_terminal = sys.stdin.isatty() and sys.stdout.isatty()
        program, setup = prepared_run(file, options, is_terminal=is_terminal)
        prompt = Prompt(program, is_terminal=is_terminal)
        debugger = Debugger(program, prompt.stopped, say)
        with _pausing(debugger, prompt):
            done = debugged_run(program, setup, debugger, lambda text: say(f"message: {text}"))
        if done is None:
            return FINDINGS if prompt.has_failed else FINE
        for line in run_notes(done, program, setup):
            say(line, err=True)
    is_fine = done.outcome.ending in ("end", "halt") and not prompt.has_failed
    return FINE if is_fine else FINDINGS


@contextmanager
def _pausing(debugger: "Debugger", prompt: "Prompt") -> Iterator[None]:
    """Let Ctrl-C pause the program; at the prompt, or when pressed again, it ends everything."""

    def pause(_number: int, _frame: FrameType | None) -> None:
        if not prompt.is_running:
            raise KeyboardInterrupt
        prompt.is_running = False
        debugger.pause()

    before = signal.signal(signal.SIGINT, pause)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
