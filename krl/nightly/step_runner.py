"""Performs the steps of a nightly run, one after another, within limits of time and memory."""

import os
import re
import shutil
import sys
import time
from collections import deque
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import typer

from krl.errors import FINDINGS, FINE, one_line
from krl.nightly.steps import Step
from reports.nightly.nightly_failures import AGAIN, failed_cases
from reports.nightly.step_status import CUT_OFF, FAILED, FLAKY, NOT_RUN, has_ended
from reports.rendering.record_fields import count, texts
from support.files.untrusted import json_of, read_bytes
from support.parallel.limited_process import run_limited

#: Escape sequences that move the cursor and colour text on a terminal.
_CONTROL = re.compile(r"\x1b\[[0-9;?]*[A-Za-z]")
_TAIL = 4_000
#: The most failed cases of a step that are run once more.
_MOST_AGAIN = 50


def performed(
    steps: list[Step],
    folder: Path,
    minutes: float,
    memory: int,
    times: Mapping[str, tuple[float, str]],
) -> Iterator[tuple[Step, str, float]]:
    """Yield each step with its status (`reports.nightly.step_status`) and the seconds it took.

    A step that is done already takes no time. One that failed is tried once more, and is flaky if
    it succeeds then. Failed cases are repeated in a step of their own. ``times`` are those of the
    steps in earlier runs (`reports.nightly.history.last_times`): a step that would not end in the
    time that is left is not begun, and one that is cut off before it ended then lacked the time.
    """
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
        record = step_record(folder, step.name)
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
        if cases := failed_cases(step.name, step_record(folder, step.name) or {})[:_MOST_AGAIN]:
            again = ("conform", *cases, *step.again)
            left_to_do.appendleft((number, Step(step.name + AGAIN, again, step.share / 2)))


def _attempt(step: Step, target: Path, most: float, memory: int) -> str:
    """Perform a step, which writes its record to ``target``; return its status in one line."""
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
    record = step_record(target.parent, target.stem) or {}
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


def step_record(folder: Path, name: str) -> dict[str, Any] | None:
    """Return the record of a step; ``None`` if it is missing or cannot be read."""
    try:
        record = json_of(read_bytes(folder / f"{name}.json").decode("utf-8"))
    except (OSError, ValueError):
        return None
    return record if isinstance(record, dict) else None
