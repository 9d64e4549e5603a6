"""`krl nightly`: all measurements in one dated folder, and what changed since the last run."""

import tempfile
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated

import typer

from krl.errors import InputError, as_input_errors
from krl.extras import ARM, need
from krl.terminal.output_files import check_files

_DEFAULT_OUT = Path("reports", "out", "nightly")
_DEFAULT_HISTORY = Path("reports", "history.jsonl")


def nightly(
    paths: Annotated[list[Path] | None, typer.Argument(metavar="[PATH]...")] = None,
    out: Annotated[Path, typer.Option(metavar="DIR")] = _DEFAULT_OUT,
    history: Path = _DEFAULT_HISTORY,
    minutes: Annotated[float, typer.Option(min=1)] = 60,
    memory: Annotated[int, typer.Option(min=100, metavar="MB")] = 8_000,
    date: Annotated[str | None, typer.Option(metavar="DATE")] = None,
    only: Annotated[list[str] | None, typer.Option(metavar="STEP")] = None,
) -> int:
    """Run survey, growth, conformance, fuzzing and benches, and report what changed.

    An interrupted run continues where it stopped: steps that have a record are not repeated. A step
    or case that fails is tried once more. DIR/DATE/summary.md is a summary for an issue or an
    e-mail, DIR/index.html leads to the last run. Pages of the last 30 runs are kept, records for a
    year, cached results of the last run only. On a terminal each step shows its progress. Exit
    status 1 if a step or a case fails, cases of the last run have vanished, a law is broken,
    executors diverge, or a bench is far worse than before: a share by 0.1, or a ratio by a factor
    of 2; also if no time was left for a step.

    Options:
        paths: Files and folders to survey; default: corpus/.
        out: Parent of the dated folder.
        history: The history; one line is appended.
        minutes: Time limit of the run.
        memory: Memory limit of each process, on Linux.
        date: The name of the run; default: today.
        only: Only this step; repeatable.
    """
    from krl.nightly.nightly_run import run_steps
    from krl.nightly.run_lock import alone
    from krl.nightly.steps import steps_of

    name = date or f"{datetime.now(UTC):%Y-%m-%d}"
    if not name.replace("-", "").replace(".", "").isalnum():
        raise InputError(f"--date: {name!r} cannot be the name of a folder")
    if not only:
        need(*ARM)
    folder = out / name
    every = steps_of(paths or [Path("corpus")], folder, minutes)
    steps = [one for one in every if not only or one.name in only]
    if not steps:
        raise InputError(f"there is no step {', '.join(only or ())}")
    _check_history(history)
    with alone(out):
        return run_steps(steps, folder, history, minutes, memory * 1_000_000)


def _check_history(history: Path) -> None:
    """Raise `InputError` if the history cannot be read or replaced."""
    check_files(history)
    with as_input_errors(OSError):
        if history.exists():
            history.open("rb").close()
        history.parent.mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=history.parent).close()
