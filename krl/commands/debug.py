"""`krl debug`: a program under a debugger, at a prompt or behind an editor."""

import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING, Annotated

import typer

from krl.errors import FINDINGS, FINE, InputError, one_line
from krl.run_options import (
    ExecutorOption,
    IoOption,
    MachineOption,
    MaxTimeOption,
    MjcfOption,
    Motion,
    MotionOption,
    ProfileOption,
    Robot,
    RobotOption,
    RoutineOption,
    RunOptions,
    SceneOption,
    StrictOption,
    SubmitOption,
    UrdfOption,
    expected_errors,
    prepared_run,
)

if TYPE_CHECKING:
    from interp.controller.trace import TraceEvent
    from interp.debugging.debugger import Debugger
    from interp.session import RunResult
    from krl.debug_prompt import Prompt

__all__ = ["debug"]


def debug(
    file: Annotated[
        Path | None,
        typer.Argument(metavar="[FILE]", help="The program; with --dap the client may name it."),
    ] = None,
    routine: RoutineOption = None,
    executor: ExecutorOption = None,
    robot: RobotOption = Robot.NONE,
    profile: ProfileOption = None,
    io_script: IoOption = None,
    submit: SubmitOption = None,
    machine: MachineOption = None,
    urdf: UrdfOption = None,
    mjcf: MjcfOption = None,
    scene: SceneOption = None,
    motion: MotionOption = Motion.LOOKAHEAD,
    max_time: MaxTimeOption = None,
    strict: StrictOption = False,
    dap: Annotated[
        bool,
        typer.Option("--dap", help="Serve an editor: the Debug Adapter Protocol over stdio."),
    ] = False,
    port: Annotated[
        int | None,
        typer.Option(
            min=0, max=65535, metavar="N", help="With --dap: on this port of 127.0.0.1; 0 picks."
        ),
    ] = None,
) -> int:
    """Run a program under a debugger: breakpoints, steps forwards and back, variables, the arm.

    Commands come from a prompt or, where it is no terminal, from standard input; `help` lists them.
    Exit status 1 where the run has ended by a fault, or a command from a file was wrong.
    docs/debugging.md says more.
    """
    options = RunOptions(
        file=file or Path(),
        routine=routine,
        executor=executor,
        robot=robot,
        profile=profile,
        io_script=io_script,
        submit=submit,
        machine=machine,
        urdf=urdf,
        mjcf=mjcf,
        scene=scene,
        motion=motion,
        max_time=max_time,
        strict=strict,
    )
    if dap:
        from krl.debug_adapter.server import serve

        serve(options, port)
        return FINE
    if port is not None:
        raise InputError("--port: only with --dap")
    if file is None:
        raise InputError("name a program: krl debug FILE")
    return _at_prompt(options)


def _at_prompt(options: RunOptions) -> int:
    with expected_errors():
        from interp.debugging.debugger import Debugger
        from interp.executors import Prepared
        from interp.session import run_program
        from krl.debug_prompt import Prompt
        from krl.run_notes import run_notes

        is_terminal = sys.stdin.isatty() and sys.stdout.isatty()
        program, setup = prepared_run(options, is_terminal=is_terminal)
        prompt = Prompt(program, is_terminal=is_terminal)
        debugger = Debugger(program, prompt.stopped, lambda text: typer.echo(one_line(text)))
        prepared = Prepared(program, setup.routine)

        def begin() -> "RunResult":
            def take(event: "TraceEvent") -> None:
                if event.kind == "message" and not debugger.is_repeating:
                    typer.echo(one_line(f"message: {event.fields.get('text')}"))

            return run_program(prepared, setup, take=take, debugger=debugger)

        with _pausing(debugger, prompt):
            done = debugger.run(begin)
        if done is None:
            return FINDINGS if prompt.has_failed else FINE
        for line in run_notes(done, program, setup):
            typer.echo(one_line(line), err=True)
    is_fine = done.outcome.ending in ("end", "halt") and not prompt.has_failed
    return FINE if is_fine else FINDINGS


@contextmanager
def _pausing(debugger: "Debugger", prompt: "Prompt") -> Iterator[None]:
    """Ctrl-C stops the program at its next statement; at the prompt, and once more, it ends all."""

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
