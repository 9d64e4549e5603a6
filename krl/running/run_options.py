"""Options of commands that run programs, and the set-up made from them."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from krl.errors import InputError, as_input_errors, say
from krl.extras import ARM, expected_extras
from krl.project_settings import settings_of
from krl.running.arm_files import read_arm
from krl.running.program_loading import load_program

if TYPE_CHECKING:
    from interp.program.load import CheckedProgram
    from interp.session import RunSetup

_AUTO = "auto"
_MOST_LISTED = 3
#: Default limit of virtual seconds, without and with automatic inputs.
_SECONDS, _AUTO_SECONDS = 3600.0, 600.0
#: With automatic inputs, seconds without motion after which the program is taken to wait for ever.
_AUTO_PATIENCE = 20.0
#: Statements after which a program counts as endless: the same for all machines, so that their
#: traces are equal. A loop ends within some 5 s of the slowest and of the tree interpreter.
_STATEMENTS, _TREE_STATEMENTS = 4_000_000, 150_000
#: The same limit for functions in the tree interpreter, where a statement takes longer.
_TREE_FUNCTIONS = 2_000_000


class Executor(StrEnum):
    """The executor of the program."""

    TREE = "tree"
    VM = "vm"
    NATIVE = "native"
    COMPILED = "compiled"


class Robot(StrEnum):
    """The arm that moves."""

    NONE = "none"
    KINEMATIC = "kinematic"
    MUJOCO = "mujoco"


class Motion(StrEnum):
    """The planning strategy."""

    LOOKAHEAD = "lookahead"
    BATCH = "batch"


FileArgument = Annotated[
    Path,
    typer.Argument(metavar="FILE", help="The program; archive.zip/path/name.src in an archive."),
]
ExecutorOption = Annotated[
    Executor | None, typer.Option(help="Default: native, or vm if native is not built.")
]


@dataclass(frozen=True, slots=True)
class RunOptions:
    """The options of a run, from the command line or a client.

    A command with a parameter of this type has an option for each field.

    Options:
        routine: Where to start; default: the first routine.
        robot: The arm that moves.
        profile: The controller: kss8, kss5, or a .toml file. Default: that of krl.toml, or kss8.
        io: Sets inputs at given times; auto fulfils waits and presses START and CONFIRM. Default:
            auto in a terminal, else nothing.
        submit: The submit program, a routine of the project; with --io auto its SPS by default.
        machine: Use this arm, not the project's.
        urdf: An arm of your own, as URDF.
        mjcf: An arm of your own, as MJCF.
        scene: Objects around the arm; contacts are reported.
        motion: Plan motions as they arrive, or in batches.
        max_time: Stop after S seconds of virtual time; default: 3600, with --io auto 600, or once
            the arm has stood still for 20.
        statements: Statements each program may execute before it counts as endless; default:
            4000000, with the executor tree 150000.
        strict: Do not run if the checker finds an error, and use no stand-ins.
    """

    routine: Annotated[str | None, typer.Option(metavar="NAME")] = None
    executor: ExecutorOption = None
    robot: Robot = Robot.NONE
    profile: Annotated[str | None, typer.Option(metavar="NAME")] = None
    io: Annotated[Path | None, typer.Option(metavar="SCRIPT")] = None
    submit: Annotated[str | None, typer.Option(metavar="NAME")] = None
    machine: Annotated[Path | None, typer.Option(metavar="$machine.dat")] = None
    urdf: Path | None = None
    mjcf: Path | None = None
    scene: Annotated[Path | None, typer.Option(metavar="FILE.toml")] = None
    motion: Motion = Motion.LOOKAHEAD
    max_time: Annotated[
        float | None, typer.Option("--max-time", "--until", min=0.0, metavar="S")
    ] = None
    statements: Annotated[int | None, typer.Option(min=1, max=2**31 - 1)] = None
    strict: bool = False


def prepared_run(
    file: Path,
    options: RunOptions,
    *,
    is_terminal: bool,
    is_full: bool = False,
    is_traced: bool = False,
) -> "tuple[CheckedProgram, RunSetup]":
    """Return the program and its set-up; print on stderr what was left out or assumed.

    In a terminal inputs are automatic by default. ``is_full`` and ``is_traced`` are those of the
    set-up. Raises `InputError`, and exceptions that `expected_errors` turns into it.
    """
    from interp.controller.inputs.automatic_inputs import OPERATOR
    from interp.controller.inputs.input_script import Script
    from interp.controller.state.profile import Profile
    from interp.executors import available
    from interp.program.load import Limits
    from interp.session import RunSetup

    chosen = options.io
    is_auto = str(chosen) == _AUTO or (chosen is None and is_terminal)
    if is_auto:
        script = Script.read(OPERATOR, _AUTO)
    else:
        script = Script() if chosen is None else Script.read(_text(chosen), str(chosen))
    if is_auto and chosen is None:
        typer.echo("inputs: automatic (--io auto is the default in a terminal)", err=True)
    own = read_arm(
        *(options.machine, options.urdf, options.mjcf, options.scene),
        has_robot=options.robot is not Robot.NONE,
    )
    program, left = load_program(
        file, strict=options.strict, stands_in=not options.strict, routine=options.routine
    )
    submit = program.submit_name() if is_auto and options.submit is None else options.submit
    seconds, patience = options.max_time, _SECONDS
    if seconds is None:
        seconds, patience = (_AUTO_SECONDS, _AUTO_PATIENCE) if is_auto else (_SECONDS, _SECONDS)
    profile = Profile.load(options.profile or _agreed_profile(file))
    executor = options.executor.value if options.executor is not None else available()[-1]
    is_tree = executor == "tree"
    most = options.statements or (_TREE_STATEMENTS if is_tree else _STATEMENTS)
    functions = options.statements or (_TREE_FUNCTIONS if is_tree else _STATEMENTS)
    setup = RunSetup(
        executor=executor,
        robot=options.robot.value,
        profile=profile,
        script=script,
        routine=options.routine,
        submit=submit,
        is_full=is_full,
        is_traced=is_traced,
        motion=options.motion.value,
        until=round(seconds * 1e6),
        patience=round(patience * 1e6),
        limits=Limits(statements=most, functions=functions, per_slice=profile.statements),
        is_tolerant=not options.strict,
        skips_failures=not options.strict,
        machine=own.machine,
        robot_file=own.file,
        scene=own.scene,
    )
    if len(left) > _MOST_LISTED:  # what this run can reach comes first
        reached = program.reached(*program.starts(options.routine, submit))
        paths = {unit.module.path for unit in reached}
        left = sorted(left, key=lambda why: why.partition(":")[0] not in paths)
    for why in left[:_MOST_LISTED]:
        say(f"left out: {why}", err=True)
    if len(left) > _MOST_LISTED:
        typer.echo(f"left out: {len(left) - _MOST_LISTED} more in the project", err=True)
    return program, setup


@contextmanager
def expected_errors(robot: Robot, *needed: str) -> Iterator[None]:
    """Raise exceptions of the packages below about input as `InputError`.

    Also if a package is missing that the arm needs, or one of ``needed``: these are imported late
    but checked at once.
    """
    from interp.robot.simulation.scene import SceneError
    from interp.values.faults import RuntimeFailure

    arm = () if robot is Robot.NONE else ARM
    with as_input_errors(RuntimeFailure, SceneError), expected_extras(*arm, *needed):
        yield


def _text(file: Path) -> str:
    from support.files.untrusted import read_text

    if file.is_dir():
        raise InputError(f"{file}: a folder, not a file")
    try:
        return read_text(file, "utf-8-sig")
    except UnicodeDecodeError:
        raise InputError(f"{file}: not a text in UTF-8") from None


def _agreed_profile(file: Path) -> str:
    """Return the profile in the project's settings, or that of current controllers."""
    agreed = settings_of([file])
    return (agreed and agreed.profile) or "kss8"
