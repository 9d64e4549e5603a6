"""`krl run`: a program on the controller, with an arm that moves."""

import json
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from datetime import UTC, datetime
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, BinaryIO

import typer

from krl.errors import FINDINGS, FINE, InputError, as_input_errors, say
from krl.running.run_notes import NOTED, refused, run_notes
from krl.running.run_options import (
    FileArgument,
    Robot,
    RunOptions,
    expected_errors,
    prepared_run,
)
from krl.terminal.output_files import check_files
from krl.terminal.progress import progress_bar
from support.files.atomic_write import atomic_path
from support.parallel.termination import on_termination

if TYPE_CHECKING:
    from interp.controller.state.trace import TraceEvent
    from interp.program.load import CheckedProgram
    from interp.session import RunResult, RunSetup


class Level(StrEnum):
    """The amount of detail in a trace."""

    WORLD = "world"
    FULL = "full"


def run(
    file: FileArgument,
    *,
    options: RunOptions,
    trace: Annotated[Path | None, typer.Option(metavar="FILE.jsonl")] = None,
    trace_level: Level = Level.WORLD,
    max_trace: Annotated[int, typer.Option(metavar="MB", min=1)] = 1000,
    path: Annotated[Path | None, typer.Option(metavar="FILE.parquet")] = None,
    html: Path | None = None,
    video: Annotated[Path | None, typer.Option(metavar="FILE.mp4")] = None,
    png: Annotated[Path | None, typer.Option(metavar="FILE.png")] = None,
    observations: Annotated[Path | None, typer.Option(metavar="FILE.jsonl")] = None,
) -> int:
    """Run a program: advance run, motions, interrupts, triggers, submit, on a virtual clock.

    The same program gives the same trace on every executor and robot. Exit status 0 if it ran to
    its end or to a HALT; 1 after a fault, if the time or statement limit was reached, if a line
    could not be read or failed and was skipped, or if the arm collided or exceeded a torque.
    Stand-ins replace what the project lacks, such as a routine behind an inline form, and are
    listed; statements that still fail, mostly motions, are skipped and listed.

    Options:
        trace: Write the trace to FILE.
        trace_level: full also records every line and assignment.
        max_trace: End the trace at this size; the run goes on.
        path: Write set-points; also .csv.
        html: Write the page of the run.
        video: Film the MuJoCo arm; also .gif and .webp.
        png: Write a picture of the MuJoCo arm and its path.
        observations: Write contacts and excessive torques here.
    """
    needed = ["numpy"] * (html is not None) + ["PIL"] * (video is not None or png is not None)
    needed += ["imageio_ffmpeg"] * (video is not None and video.suffix.lower() == ".mp4")
    with expected_errors(options.robot, *needed):
        check_files(trace, path, html, video, png, observations)
        _check_targets(path, video, png, options.robot)
        is_watched = trace is not None or html is not None
        program, setup = prepared_run(
            file,
            options,
            is_terminal=sys.stdout.isatty(),
            is_full=is_watched and trace_level is Level.FULL,
            is_traced=is_watched,
        )
        is_shown = html is not None or video is not None or png is not None
        done = _performed(program, setup, trace, max_trace * 1_000_000, keeps_all=is_shown)
        if path is not None and done.path is not None:
            _write_path(done.path.columns(), path)
        if html is not None:
            from reports.programs.run_page import write_run_page

            write_run_page(_record(done, program, setup), html)
        if video is not None or png is not None:
            from krl.running.run_pictures import write_run_film, write_run_picture

            if video is not None:
                write_run_film(video, done, program, setup)
            if png is not None:
                write_run_picture(png, done, setup)
        if observations is not None:
            _write_observations(done, observations)
    for line in run_notes(done, program, setup):
        say(line, err=True)
    say(f"{program.main.module.path}: {done.outcome}")
    if html is not None:
        say(f"page: {html}")
    is_fine = done.outcome.ending in ("end", "halt") and not done.controller.skipped
    is_fine &= next(refused(done), None) is None
    is_fine &= all(seen.is_estimate for seen in done.observations)
    reached = program.reached(*program.starts(setup.routine, setup.submit))
    is_fine &= all(unit.module.path not in program.damaged for unit in reached)
    return FINE if is_fine else FINDINGS


def _check_targets(path: Path | None, video: Path | None, png: Path | None, robot: Robot) -> None:
    """Raise `InputError` now for an output that would fail after the run."""
    if path is not None and path.suffix.lower() not in (".parquet", ".csv"):
        raise InputError(f"--path: {path} ends neither in .parquet nor in .csv")
    if path is not None and robot is Robot.NONE:
        raise InputError(
            "--path: the robot none takes no set-points; say --robot kinematic or mujoco"
        )
    if video is None and png is None:
        return
    from interp.robot.simulation.video import SUFFIXES, VideoError, check

    for option, target, suffixes in (("--video", video, SUFFIXES), ("--png", png, (".png",))):
        if target is None:
            continue
        if robot is not Robot.MUJOCO:
            raise InputError(f"{option}: only the MuJoCo arm can be filmed; say --robot mujoco")
        with as_input_errors(VideoError):
            check(target, suffixes)


def _performed(
    program: "CheckedProgram", setup: "RunSetup", trace: Path | None, most: int, *, keeps_all: bool
) -> "RunResult":
    """Run a program with a progress bar and write the trace meanwhile; return the result.

    The trace has at most ``most`` bytes. Without ``keeps_all`` the result has only the events that
    the notes of a run look at: those of a long run are larger than memory.
    """
    from interp.executors import Prepared
    from interp.session import run_program

    prepared = Prepared(program, setup.routine, [setup.submit], is_kept=True)
    with progress_bar("running, virtual seconds", None) as bar, _tracing(trace, most) as writer:
        kept: list[TraceEvent] = []
        shown = 0

        def take(event: "TraceEvent") -> None:
            if keeps_all or event.kind in NOTED:
                kept.append(event)
            if writer is not None:
                writer.write(event)

        def on_time(now: int) -> None:
            nonlocal shown
            bar(now // 1_000_000 - shown)
            shown = now // 1_000_000

        done = run_program(prepared, setup, take=take, on_time=on_time)
    for note in prepared.notes:
        say(note, err=True)
    if writer is not None and writer.ended is not None:
        at = f"{writer.ended / 1e6:g} s, at {most // 1_000_000:,} MB"
        typer.echo(f"trace: it ends at {at}; --max-trace allows more", err=True)
    return replace(done, events=kept)


class _TraceWriter:
    """Writes events as lines of at most ``left`` bytes in all.

    ``ended`` is the time of the first event that is not written, in µs.
    """

    def __init__(self, stream: BinaryIO, left: int) -> None:
        self._stream = stream
        self._left = left
        self.ended: int | None = None

    def write(self, event: "TraceEvent") -> None:
        """Write an event, unless the trace has ended."""
        if self.ended is not None:
            return
        line = f"{event.line()}\n".encode()
        self._left -= len(line)
        if self._left < 0:
            self.ended = event.time
        else:
            self._stream.write(line)


@contextmanager
def _tracing(file: Path | None, most: int) -> Iterator[_TraceWriter | None]:
    """Yield what writes the trace, to a temporary file that is moved to its path at the end.

    A process that receives SIGINT or SIGTERM keeps what is traced so far, and reports it.
    """
    if file is None:
        yield None
        return
    with on_termination(lambda number, _: sys.exit(128 + number)):
        ended: KeyboardInterrupt | SystemExit | None = None
        with atomic_path(file) as part, part.open("wb") as stream:
            try:
                yield _TraceWriter(stream, most)
            except (KeyboardInterrupt, SystemExit) as error:
                ended = error
        if ended is not None:
            say(f"trace: {file} ends where the run was interrupted", err=True)
            raise ended


def _write_observations(done: "RunResult", target: Path) -> None:
    """Write one observation per line, in the order of their starts."""
    lines = (json.dumps(one.record()) + "\n" for one in done.observations)
    with atomic_path(target) as part:
        part.write_text("".join(lines), encoding="utf-8", newline="\n")


def _write_path(columns: Mapping[str, Any], target: Path) -> None:
    """Write a table with a row for each interpolation cycle."""
    import pandas as pd

    table = pd.DataFrame(dict(columns))
    with atomic_path(target) as part:
        if target.suffix.lower() == ".csv":
            table.to_csv(part, index=False, lineterminator="\n")
        else:
            table.to_parquet(part, index=False)


def _record(done: "RunResult", program: "CheckedProgram", setup: "RunSetup") -> dict[str, Any]:
    """Return the record for the page of a run; see `reports.programs.run_page.write_run_page`."""
    from importlib import metadata

    from interp.run_record import record_of

    return {
        **record_of(done, program, setup),
        "version": metadata.version("krl-workbench"),
        "generated": datetime.now(UTC).isoformat(timespec="seconds"),
    }
