"""`krl nightly`: all measurements in one dated folder, and what changed since the last run."""

import os
import re
import shutil
import sqlite3
import sys
import tempfile
import time
from collections import deque
from collections.abc import Iterator, Mapping
from contextlib import closing, contextmanager, suppress
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from krl.errors import FINDINGS, FINE, InputError, as_input_errors, one_line
from krl.extras import ARM, need
from krl.terminal.output_files import check_files, write_json

if TYPE_CHECKING:
    from reports.nightly.nightly_failures import Failure

_DEFAULT_OUT = Path("reports", "out", "nightly")
_DEFAULT_HISTORY = Path("reports", "history.jsonl")
#: Programs that the fuzzer runs in a run of one hour; proportional for other durations.
_PROGRAMS = 12_000
#: Escape sequences that move the cursor and colour text on a terminal.
_CONTROL = re.compile(r"\x1b\[[0-9;?]*[A-Za-z]")
_TAIL = 4_000
#: The most failed cases of a step that are run once more.
_MOST_AGAIN = 50


@dataclass(frozen=True, slots=True)
class _Step:
    """A command; ``share`` is the largest part of the total time that it may take.

    ``again`` are the options that run its failed cases once more.
    """

    name: str
    arguments: tuple[str, ...]
    share: float
    page: str = ""
    again: tuple[str, ...] = ()


def nightly(
    paths: Annotated[
        list[Path] | None,
        typer.Argument(metavar="[PATH]...", help="Files and folders to survey; default: corpus/."),
    ] = None,
    out: Annotated[
        Path, typer.Option(metavar="DIR", help="Parent of the dated folder.")
    ] = _DEFAULT_OUT,
    history: Annotated[
        Path, typer.Option(metavar="FILE", help="The history; one line is appended.")
    ] = _DEFAULT_HISTORY,
    minutes: Annotated[float, typer.Option(min=1, metavar="N", help="Time limit of the run.")] = 60,
    memory: Annotated[
        int,
        typer.Option(min=100, metavar="MB", help="Memory limit of each process, on Linux."),
    ] = 8_000,
    date: Annotated[
        str | None, typer.Option(metavar="DATE", help="The name of the run; default: today.")
    ] = None,
    only: Annotated[
        list[str] | None, typer.Option(metavar="STEP", help="Only this step; repeatable.")
    ] = None,
) -> int:
    """Run survey, growth, conformance, fuzzing and benches, and report what changed.

    An interrupted run continues where it stopped: steps that have a record are not repeated. A step
    or case that fails is tried once more. DIR/DATE/summary.md is a summary for an issue or an
    e-mail, DIR/index.html leads to the last run. Pages of the last 30 runs are kept, records for a
    year, cached results of the last run only. On a terminal each step shows its progress. Exit
    status 1 if a step or a case fails, cases of the last run have vanished, a law is broken,
    executors diverge, or a bench is far worse than before: a share by 0.1, or a ratio by a factor
    of 2; also if no time was left for a step.
    """
    name = date or f"{datetime.now(UTC):%Y-%m-%d}"
    if not name.replace("-", "").replace(".", "").isalnum():
        raise InputError(f"--date: {name!r} cannot be the name of a folder")
    if not only:
        need(*ARM)
    folder = out / name
    steps = [one for one in _steps(paths or [Path("corpus")], folder, minutes) if _is_in(one, only)]
    if not steps:
        raise InputError(f"there is no step {', '.join(only or ())}")
    _check_history(history)
    with _alone(out):
        return _run(steps, folder, history, minutes, memory * 1_000_000)


def _check_history(history: Path) -> None:
    """Raise `InputError` if the history cannot be read or replaced."""
    check_files(history)
    with as_input_errors(OSError):
        if history.exists():
            history.open("rb").close()
        history.parent.mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=history.parent).close()


@contextmanager
def _alone(out: Path) -> Iterator[None]:
    """Raise `InputError` if another nightly run is at work in a folder.

    The lock is one of SQLite, which every system releases when the process ends, however it ends.
    """
    file = out / "nightly.lock"
    with as_input_errors(OSError):
        out.mkdir(parents=True, exist_ok=True)
    with closing(sqlite3.connect(file, timeout=0, isolation_level=None)) as lock:
        try:
            lock.execute(f"PRAGMA user_version = {os.getpid()}")
            lock.execute("BEGIN IMMEDIATE")
        except sqlite3.Error as error:
            with suppress(sqlite3.Error):
                (process,) = lock.execute("PRAGMA user_version").fetchone()
                raise InputError(f"{file}: process {process} is a nightly run there") from None
            raise InputError(f"{file}: {error}") from None
        yield


def _run(steps: list[_Step], folder: Path, history: Path, minutes: float, memory: int) -> int:
    """Perform the steps of a run and report; return the exit status."""
    from reports.nightly.history import last_times, read_history
    from reports.nightly.step_status import has_ended, incomplete

    with as_input_errors(OSError):
        folder.mkdir(exist_ok=True)
    times = last_times(one for one in read_history(history) if one.get("date") != folder.name)
    made: dict[str, Any] = {}
    went: dict[str, dict[str, Any]] = dict(_record(folder, "steps") or {})
    try:
        for step, how, seconds in _performed(steps, folder, minutes, memory, times):
            before = went.pop(step.name, None)
            if seconds or not isinstance(before, dict) or not has_ended(how):
                page = step.page if (folder / step.page).is_file() else ""
                before = {"status": how, "seconds": round(seconds, 1), "page": page}
            went[step.name] = before
            write_json(went, folder / "steps.json")
            record = _record(folder, step.name)
            if record is not None:
                made[step.name] = record
        failed = _reported(made, went, folder, history)
    except Exception as error:
        _write_breakdown(f"failed: {type(error).__name__}: {error}", went, folder)
        raise
    return FINDINGS if failed or incomplete(went) else FINE


def _reported(
    made: dict[str, Any], went: dict[str, dict[str, Any]], folder: Path, history: Path
) -> "list[Failure]":
    """Write history, record, pages and summary of a run, and print changes; return the failures."""
    from reports.conformance.claims_page import write_claims_page
    from reports.nightly.history import (
        append_run,
        changes,
        damage,
        known_before,
        nightly_record,
        read_history,
    )
    from reports.nightly.nightly_failures import failures
    from reports.nightly.nightly_page import write_nightly_page
    from reports.nightly.nightly_store import bound_store, write_entry_page
    from reports.nightly.nightly_summary import nightly_summary
    from reports.nightly.step_status import incomplete
    from support.files.atomic_write import write_atomic

    out, name = folder.parent, folder.name
    runs = [one for one in read_history(history) if one.get("date") != name]
    last = known_before(runs)
    failed = [*_broken_off(folder), *failures(made, went, last)]
    run = {**nightly_record(name, made, went), "failures": failed}
    compared = "" if last is None else str(last["of"].get("conform", ""))
    before = _record(out / compared, "conform") if compared else None
    reported = damage(history, last)
    if last is not None or not reported:
        reported += changes(last, run, before, made.get("conform"))
    append_run(history, run)
    write_json({**run, "changes": reported}, folder / "nightly.json")
    write_claims_page(made, folder / "claims")
    pages = {"claims": {"status": "ok", "seconds": 0.0, "page": "claims/index.html"}}
    run = {**run, "steps": {**run["steps"], **pages}}
    page = write_nightly_page({**run, "changes": reported, "history": [*runs, run]}, folder)
    write_entry_page(out, name, datetime.now(UTC))
    bound_store(folder)
    write_atomic(folder / "summary.md", nightly_summary({**run, "changes": reported}))
    for one in failed:
        typer.echo(one_line(f"failed: {one['what']}"))
    if left := incomplete(went):
        typer.echo(one_line(left))
    for line in reported or ["nothing changed since the last nightly run"]:
        typer.echo(one_line(line))
    typer.echo(one_line(f"page: {page}"))
    return failed


def _broken_off(folder: Path) -> "Iterator[Failure]":
    """Yield a failure for the previous run if it did not write its record."""
    from reports.nightly.nightly_failures import OF_THE_RUN, Failure

    earlier = [one for one in folder.parent.iterdir() if one.is_dir() and one.name < folder.name]
    if earlier and not (last := max(earlier)).joinpath("nightly.json").exists():
        yield Failure(what=f"{OF_THE_RUN}of {last.name} did not finish", page="", command="")


def _write_breakdown(what: str, went: dict[str, dict[str, Any]], folder: Path) -> None:
    """Write summary, record and page of a run that ended with an exception."""
    from reports.nightly.nightly_failures import OF_THE_RUN, Failure
    from reports.nightly.nightly_page import write_nightly_page
    from reports.nightly.nightly_summary import nightly_summary
    from support.files.atomic_write import write_atomic

    own = Failure(what=OF_THE_RUN + what, page="", command="")
    run = {"date": folder.name, "steps": went, "failures": [own]}
    with suppress(Exception):  # writing may be the cause of the failure, which the caller raises
        write_atomic(folder / "summary.md", nightly_summary(run))
        write_json(run, folder / "nightly.json")
        write_nightly_page(run, folder)


def _is_in(step: _Step, only: list[str] | None) -> bool:
    return not only or step.name in only


def _steps(paths: list[Path], folder: Path, minutes: float) -> Iterator[_Step]:
    """Yield the commands of a nightly run, the most important ones first."""
    given = tuple(map(str, paths))
    seed = folder.name.replace("-", "").replace(".", "")
    seed = seed if seed.isdigit() else "1"
    programs = str(max(100, round(_PROGRAMS * minutes / 60)))
    yield _Step(
        "conform", ("conform", "--html", str(folder / "conform")), 0.25, "conform/index.html"
    )
    arm = ("--executor", "native", "--robot", "mujoco")
    motions = ("motion", "blending", "program", *arm, "--html", str(folder / "conform-arm"))
    yield _Step("conform-arm", ("conform", *motions), 0.15, "conform-arm/index.html", arm)
    yield _Step("conform-laws", ("conform", "--metamorphic", "10"), 0.1)
    within = ("--minutes", f"{0.25 * minutes:g}")  # a slow machine runs fewer
    yield _Step("fuzz", ("fuzz", "--programs", programs, *within, "--seed", seed), 0.35)
    yield _Step(
        "recover", ("recover", *given, "--out", str(folder / "recover")), 0.3, "recover/index.html"
    )
    yield _Step(
        "growth", ("growth", *given, "--out", str(folder / "growth")), 0.15, "growth/index.html"
    )
    limits = {
        "scale": ("--sizes", "4,8,16"),
        "conform": ("--mutants", str(max(10, round(minutes / 2))), "--seed", seed),
    }
    for bench in ("recover", "check", "scale", "vm", "arm", "conform"):
        arguments = ("bench", bench, *(given if bench in ("recover", "check", "scale") else ()))
        share = 0.25 if bench == "conform" else 0.15
        yield _Step(f"bench-{bench}", (*arguments, *limits.get(bench, ())), share)
    sample = str(max(4, round(minutes / 2)))
    yield _Step(
        "bench-mutation", ("bench", "mutation", "--singles", sample, "--multiple", "4"), 0.2
    )


def _performed(
    steps: list[_Step],
    folder: Path,
    minutes: float,
    memory: int,
    times: Mapping[str, tuple[float, str]],
) -> Iterator[tuple[_Step, str, float]]:
    """Yield each step with its status (`reports.nightly.step_status`) and the seconds it took.

    A step that is done already takes no time. One that failed is tried once more, and is flaky if
    it succeeds then. Failed cases are repeated in a step of their own. ``times`` are those of the
    steps in earlier runs (`reports.nightly.history.last_times`): a step that would not end in the
    time that is left is not begun, and one that is cut off before it ended then lacked the time.
    """
    from reports.nightly.nightly_failures import AGAIN, failed_cases
    from reports.nightly.step_status import CUT_OFF, FAILED, FLAKY, NOT_RUN, has_ended

    begun = time.monotonic()
    left_to_do = deque(enumerate(steps, 1))
    while left_to_do:
        number, step = left_to_do.popleft()
        began = time.monotonic()
        target = folder / f"{step.name}.json"
        share = max(60 * minutes * step.share, 1)
        left = 60 * minutes - (began - begun)
        took, when = times.get(step.name, (share / 10, ""))
        before = f"; it took {took / 60:.1f} minutes on {when}" if when else ""
        record = _record(folder, step.name)
        if target.is_file() and not (record or {}).get("not_run"):
            damaged = f"{FAILED}{target.name} there is damaged"
            yield step, damaged if record is None else "ok", 0.0
        elif left < min(took, share):
            yield step, f"{NOT_RUN}: no time left{before}", 0.0
        else:
            most = min(share, left)
            words = f"{step.name} (at most {most / 60:.3g} min, {number} of {len(steps)})"
            _say(began - begun, words)
            _recall(folder, step.name)
            how = _attempt(step, target, most, memory)
            if how.startswith(FAILED):
                second = _attempt(step, target, most, memory)
                how = f"{FLAKY}{how}; then {second}" if has_ended(second) else how
            if how.startswith(CUT_OFF) and most < max(share, took):
                how = f"{NOT_RUN} to its end: too little time, {how}{before}"
            ended = time.monotonic()
            _say(ended - begun, f"{step.name}: {how}, {(ended - began) / 60:.1f} min")
            yield step, how, ended - began
        if cases := failed_cases(step.name, _record(folder, step.name) or {})[:_MOST_AGAIN]:
            again = ("conform", *cases, *step.again)
            left_to_do.appendleft((number, _Step(step.name + AGAIN, again, step.share / 2)))


def _attempt(step: _Step, target: Path, most: float, memory: int) -> str:
    """Perform a step, which writes its record to ``target``; return its status in one line."""
    from reports.nightly.step_status import CUT_OFF, FAILED

    command = [sys.executable, "-m", "krl", *step.arguments, "--json", str(target)]
    returned, last = _watched(command, most, memory)
    if returned is None:
        return one_line(f"{CUT_OFF}after {most / 60:.3g} minutes{_how_far(target)}")
    if returned in (FINE, FINDINGS) and target.is_file():
        return "ok" if returned == FINE else "findings"
    if returned < 0:
        return f"{FAILED}killed by signal {-returned}"
    return one_line(f"{FAILED}{last or f'status {returned}'}")


def _how_far(target: Path) -> str:
    """Return which cases were done and running when a step was cut off, if its record has that."""
    from reports.rendering.record_fields import count, texts

    record = _record(target.parent, target.stem) or {}
    left, running = len(texts(record, "not_run")), ", ".join(texts(record, "running"))
    if not left:
        return ""
    total = count(record, "cases_total") + left
    return (
        f"{f', while {running} ran' if running else ''}; {left:,} of {total:,} cases are not done"
    )


def _say(seconds: float, words: str) -> None:
    typer.echo(f"{seconds / 60:5.1f} min  {words}", err=True)


def _recall(folder: Path, name: str) -> None:
    """Copy results cached by the last run to a step; they are found by digest only."""
    kept = Path(name, "cache", "results.sqlite")
    runs = sorted(folder.parent.glob(f"*/{kept.as_posix()}"), key=lambda one: one.stat().st_mtime)
    if runs and not (folder / kept).exists():
        (folder / kept).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(runs[-1], folder / kept)


def _watched(command: list[str], seconds: float, memory: int) -> tuple[int | None, str]:
    """Run a command under limits; return its status, ``None`` if cut off, and its last line.

    On a terminal its progress is shown.
    """
    from support.parallel.limited_process import run_limited

    is_seen = sys.stderr.isatty()
    size = shutil.get_terminal_size()
    terminal = {"FORCE_COLOR": "1", "COLUMNS": str(size.columns), "LINES": str(size.lines)}
    said = ""

    def hear(text: str) -> None:
        nonlocal said
        said = (said + text)[-_TAIL:]
        if is_seen:
            sys.stderr.write(text)
            sys.stderr.flush()

    environment = {**os.environ, **(terminal if is_seen else {"KRL_PROGRESS": "0"})}
    returned = run_limited(command, seconds, memory, hear, environment)
    lines = [line.strip() for line in re.split(r"[\r\n]", _CONTROL.sub("", said))]
    return returned, next((line for line in reversed(lines) if line), "")


def _record(folder: Path, name: str) -> dict[str, Any] | None:
    """Return the record of a step; ``None`` if it is missing or cannot be read."""
    from support.files.untrusted import json_of, read_bytes

    try:
        record = json_of(read_bytes(folder / f"{name}.json").decode("utf-8"))
    except (OSError, ValueError):
        return None
    return record if isinstance(record, dict) else None
