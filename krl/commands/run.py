"""`krl run`: a program on the controller, with an arm that moves."""

import json
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from datetime import UTC, datetime
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TextIO

import typer

from krl.errors import FINDINGS, FINE, InputError, one_line
from krl.extras import ARM, expected_extras
from krl.output_files import check_files
from krl.program_loading import load_program
from krl.progress import progress_bar
from krl.project_settings import settings_of
from krl.robot_options import robot_options
from support.files.atomic_write import atomic_path

if TYPE_CHECKING:
    from interp.controller.trace import TraceEvent
    from interp.program.load import CheckedProgram
    from interp.session import RunResult, RunSetup

__all__ = ["run"]

_MOST_TOLD = 3
_AUTO = "auto"
#: Virtual seconds that a run lasts at most, without and with automatic inputs.
_SECONDS, _AUTO_SECONDS = 3600.0, 600.0


class Executor(StrEnum):
    """Who executes the program."""

    TREE = "tree"
    VM = "vm"
    NATIVE = "native"


class Robot(StrEnum):
    """What moves."""

    NONE = "none"
    KINEMATIC = "kinematic"
    MUJOCO = "mujoco"


class Motion(StrEnum):
    """How motions are planned."""

    LOOKAHEAD = "lookahead"
    BATCH = "batch"


class Level(StrEnum):
    """What the trace tells."""

    WORLD = "world"
    FULL = "full"


def run(
    file: Annotated[
        Path,
        typer.Argument(
            metavar="FILE", help="The program; archive.zip/path/name.src in an archive."
        ),
    ],
    routine: Annotated[
        str | None, typer.Option(metavar="NAME", help="Where to begin; default: its first routine.")
    ] = None,
    executor: Annotated[
        Executor | None, typer.Option(help="Default: native, or vm where that was not built.")
    ] = None,
    robot: Annotated[Robot, typer.Option(help="What moves.")] = Robot.NONE,
    profile: Annotated[
        str | None,
        typer.Option(
            metavar="NAME",
            help="The controller: kss8, kss5, or a .toml file. Default: that of krl.toml, or kss8.",
        ),
    ] = None,
    io_script: Annotated[
        Path | None,
        typer.Option(
            "--io",
            metavar="SCRIPT",
            help="What inputs do, and when; auto fulfils waits and presses START and CONFIRM. "
            "Default: auto in a terminal, else nothing.",
        ),
    ] = None,
    submit: Annotated[
        str | None,
        typer.Option(
            metavar="NAME",
            help="A routine of the project for the submit; with --io auto its SPS by default.",
        ),
    ] = None,
    trace: Annotated[
        Path | None, typer.Option(metavar="FILE.jsonl", help="Write the trace here.")
    ] = None,
    trace_level: Annotated[
        Level, typer.Option(help="full tells every line and assignment too.")
    ] = Level.WORLD,
    path: Annotated[
        Path | None,
        typer.Option(metavar="FILE.parquet", help="Write set-points here; .csv goes too."),
    ] = None,
    html: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Write the page of the run here.")
    ] = None,
    video: Annotated[
        Path | None, typer.Option(metavar="FILE.gif", help="Film the MuJoCo arm; .webp goes too.")
    ] = None,
    machine: Annotated[
        Path | None,
        typer.Option(metavar="$machine.dat", help="Another arm than the project's."),
    ] = None,
    urdf: Annotated[
        Path | None, typer.Option(metavar="FILE", help="An arm of your own, as URDF.")
    ] = None,
    mjcf: Annotated[
        Path | None, typer.Option(metavar="FILE", help="An arm of your own, as MJCF.")
    ] = None,
    scene: Annotated[
        Path | None,
        typer.Option(metavar="FILE.toml", help="What stands around the arm; contacts are told."),
    ] = None,
    observations: Annotated[
        Path | None,
        typer.Option(metavar="FILE.jsonl", help="Write contacts and excessive torques here."),
    ] = None,
    motion: Annotated[
        Motion,
        typer.Option(help="Plan motions as they come, or as the paper did in batches."),
    ] = Motion.LOOKAHEAD,
    max_time: Annotated[
        float | None,
        typer.Option(
            "--max-time",
            "--until",
            min=0.0,
            metavar="S",
            help="Stop after so much virtual time; default: 3600, with --io auto 600.",
        ),
    ] = None,
    strict: Annotated[
        bool,
        typer.Option(
            "--strict",
            help="Run nothing while the checker finds an error; nothing stands in.",
        ),
    ] = False,
) -> int:
    """Run a program: advance run, motions, interrupts, triggers, submit, on a virtual clock.

    The same program gives the same trace on every executor and robot. Exit status 0 when it ran to
    its end or to a HALT, 1 after a fault, where its time or budget was used up, where a motion was
    skipped, where the arm touched something or could not bear a torque. What the project lacks,
    a routine behind an inline form for instance, stands in and is listed; motions that cannot
    be planned for want of it are skipped.
    """
    with _expected_errors():
        from interp.controller.automatic_inputs import OPERATOR
        from interp.controller.input_script import Script
        from interp.controller.profile import Profile
        from interp.session import RunSetup, available, submit_of

        chosen = executor.value if executor is not None else available()[-1]
        is_auto = str(io_script) == _AUTO or (io_script is None and sys.stdout.isatty())
        if is_auto:
            script = Script.read(OPERATOR, _AUTO)
        else:
            script = (
                Script() if io_script is None else Script.read(_text(io_script), str(io_script))
            )
        if is_auto and io_script is None:
            typer.echo("inputs: automatic (--io auto), as nothing was said of them", err=True)
        _check_targets(trace, path, html, video, robot)
        check_files(observations)
        own = robot_options(machine, urdf, mjcf, scene, has_robot=robot is not Robot.NONE)
        program, left = load_program(file, strict=strict, stands_in=not strict)
        if is_auto and submit is None:
            submit = submit_of(program)
        is_watched = trace is not None or html is not None
        setup = RunSetup(
            executor=chosen,
            robot=robot.value,
            profile=Profile.load(profile or _agreed_profile(file)),
            script=script,
            routine=routine,
            submit=submit,
            is_full=is_watched and trace_level is Level.FULL,
            is_told=is_watched,
            motion=motion.value,
            until=round((max_time or (_AUTO_SECONDS if is_auto else _SECONDS)) * 1e6),
            is_tolerant=not strict,
            machine=own.machine,
            robot_file=own.file,
            scene=own.scene,
        )
        for why in left[:_MOST_TOLD]:
            typer.echo(one_line(f"left out: {why}"), err=True)
        if len(left) > _MOST_TOLD:
            typer.echo(f"left out: {len(left) - _MOST_TOLD} more files of the project", err=True)
        done = _performed(program, setup, trace)
        _write(done, program, setup, path, html, video)
        if observations is not None:
            _write_observations(done, observations)
    for line in _notes(done, program, setup):
        typer.echo(one_line(line), err=True)
    typer.echo(one_line(f"{program.main.module.path}: {done.outcome}"))
    if html is not None:
        typer.echo(one_line(f"page: {html}"))
    is_fine = done.outcome.ending in ("end", "halt") and not done.controller.skipped_motions
    is_fine &= all(seen.is_estimate for seen in done.observations)
    return FINE if is_fine else FINDINGS


def _notes(done: "RunResult", program: "CheckedProgram", setup: "RunSetup") -> Iterator[str]:
    """What stood in, which motions were skipped, and what a program that never ends waited for."""
    from interp.standins.completion import summary

    starts = [program.start(name) for name in (setup.routine, setup.submit) if name is not None]
    used = program.used_stand_ins(*(starts or [program.start()]))
    if used:
        yield f"stood in: {summary(used)}"
    if done.machine_note and (used or not done.machine_note.startswith("no machine data")):
        yield f"stood in: {done.machine_note}"
    skipped = done.controller.skipped_motions
    for at, error in skipped[:_MOST_TOLD]:
        yield f"motion skipped: {at.file}:{at.line}: {error}"
    if len(skipped) > _MOST_TOLD:
        yield f"motion skipped: {len(skipped) - _MOST_TOLD} more"
    yield from _seen(done)
    for line in dict.fromkeys(done.controller.unfulfilled) if done.outcome.ending == "time" else ():
        yield f"waited for: {line}"


def _seen(done: "RunResult") -> Iterator[str]:
    """What was touched, and torques that are too great; estimates in one line."""
    certain = [seen for seen in done.observations if not seen.is_estimate]
    for seen in certain[:_MOST_TOLD]:
        yield f"{seen.kind}: {seen}"
    if len(certain) > _MOST_TOLD:
        yield f"seen: {len(certain) - _MOST_TOLD} more"
    estimates = [seen for seen in done.observations if seen.is_estimate]
    if estimates:
        worst = max(estimates, key=lambda seen: seen.value / seen.limit)
        more = f"; {len(estimates) - 1} more" if len(estimates) > 1 else ""
        yield f"torque, by masses that are assumed: {worst}{more}"
    if done.torque_note:
        yield f"left out: {done.torque_note}"


@contextmanager
def _expected_errors() -> Iterator[None]:
    """Turn what the rooms raise about input into what the door prints."""
    from interp.robot.simulation.scene import SceneError
    from interp.values.faults import RuntimeFailure

    try:
        with expected_extras(*ARM):
            yield
    except (RuntimeFailure, SceneError) as error:
        raise InputError(str(error)) from error


def _text(file: Path) -> str:
    from support.files.untrusted import read_text

    if file.is_dir():
        raise InputError(f"{file}: a folder, not a file")
    try:
        return read_text(file, "utf-8-sig")
    except UnicodeDecodeError:
        raise InputError(f"{file}: not a text in UTF-8") from None


def _agreed_profile(file: Path) -> str:
    """The profile that the settings of a project name, or the one of today's controllers."""
    agreed = settings_of([file])
    return (agreed and agreed.profile) or "kss8"


def _check_targets(
    trace: Path | None, path: Path | None, html: Path | None, video: Path | None, robot: Robot
) -> None:
    """Say now what would only fail after the run."""
    check_files(trace, path, html, video)
    if path is not None and path.suffix.lower() not in (".parquet", ".csv"):
        raise InputError(f"--path: {path} ends neither in .parquet nor in .csv")
    if path is not None and robot is Robot.NONE:
        raise InputError(
            "--path: the robot none takes no set-points; say --robot kinematic or mujoco"
        )
    if video is not None:
        from interp.robot.simulation.video import VideoError, check

        if robot is not Robot.MUJOCO:
            raise InputError("--video: only the MuJoCo arm can be filmed; say --robot mujoco")
        try:
            check(video)
        except VideoError as error:
            raise InputError(str(error)) from error


def _performed(program: "CheckedProgram", setup: "RunSetup", trace: Path | None) -> "RunResult":
    """Run it with a progress bar, writing the trace as it comes."""
    from interp.session import run_program

    with progress_bar("running, virtual seconds", None) as bar, _tracing(trace) as stream:
        kept: list[TraceEvent] = []
        told = 0

        def take(event: "TraceEvent") -> None:
            kept.append(event)
            if stream is not None:
                stream.write(event.line() + "\n")

        def on_time(now: int) -> None:
            nonlocal told
            bar(now // 1_000_000 - told)
            told = now // 1_000_000

        done = run_program(program, setup, take=take, on_time=on_time)
        return replace(done, events=kept)


@contextmanager
def _tracing(file: Path | None) -> Iterator[TextIO | None]:
    """The trace, written beside its place and moved there when it is whole."""
    if file is None:
        yield None
        return
    with atomic_path(file) as part, part.open("w", encoding="utf-8", newline="\n") as stream:
        yield stream


def _write(
    done: "RunResult",
    program: "CheckedProgram",
    setup: "RunSetup",
    path: Path | None,
    html: Path | None,
    video: Path | None,
) -> None:
    if path is not None and done.path is not None:
        _write_path(done.path.columns(), path)
    if html is not None:
        from reports.run_page import write_run_page

        write_run_page(_record(done, program, setup), html)
    if video is not None and done.path is not None:
        _film(done, setup, video)


def _write_observations(done: "RunResult", target: Path) -> None:
    """One observation a line, in the order in which they began."""
    lines = (json.dumps(one.record()) + "\n" for one in done.observations)
    with atomic_path(target) as part:
        part.write_text("".join(lines), encoding="utf-8", newline="\n")


def _film(done: "RunResult", setup: "RunSetup", target: Path) -> None:
    from interp.robot.simulation.cell import Cell
    from interp.robot.simulation.scene import Scene
    from interp.robot.simulation.video import VideoError, frame_count, write_video

    assert done.path is not None
    cell = Cell(done.machine, setup.scene or Scene(), setup.robot_file)
    shown = done.path.axes if done.path.axes_measured is None else done.path.axes_measured
    try:
        filming = progress_bar("filming", frame_count(done.path.times))
        with filming as bar, atomic_path(target) as part:
            write_video(part, cell, done.path.times, shown, on_frame=bar)
    except VideoError as error:
        raise InputError(str(error)) from error


def _write_path(columns: Mapping[str, Any], target: Path) -> None:
    """A table with a row each interpolation cycle."""
    import pandas as pd

    table = pd.DataFrame(dict(columns))
    with atomic_path(target) as part:
        if target.suffix.lower() == ".csv":
            table.to_csv(part, index=False, lineterminator="\n")
        else:
            table.to_parquet(part, index=False)


def _record(done: "RunResult", program: "CheckedProgram", setup: "RunSetup") -> dict[str, Any]:
    """What the page of a run is made of; see `reports.run_page.write_run_page`."""
    from importlib import metadata

    from interp.run_record import record_of

    return {
        **record_of(done, program, setup),
        "version": metadata.version("krl-workbench"),
        "generated": datetime.now(UTC).isoformat(timespec="seconds"),
    }
