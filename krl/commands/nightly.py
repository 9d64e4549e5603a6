"""`krl nightly`: everything once, into one dated folder, and what changed since the last night."""

import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated, Any

import typer

from krl.door import FINDINGS, FINE, Unusable, one_line
from krl.writing import write_json

__all__ = ["nightly"]

_DEFAULT_OUT = Path("reports", "out", "nightly")
_DEFAULT_HISTORY = Path("reports", "history.jsonl")
#: Programs that the fuzzer runs in an hour's night; other lengths have their share.
_PROGRAMS = 20_000


@dataclass(frozen=True, slots=True)
class _Step:
    """A command of the night; ``share`` of the night's length is the most that it may take."""

    name: str
    arguments: tuple[str, ...]
    share: float
    page: str = ""


def nightly(
    paths: Annotated[
        list[Path] | None,
        typer.Argument(metavar="[PATH]...", help="What is surveyed; default: corpus/."),
    ] = None,
    out: Annotated[
        Path, typer.Option(metavar="DIR", help="Where the dated folder goes.")
    ] = _DEFAULT_OUT,
    history: Annotated[
        Path, typer.Option(metavar="FILE", help="The history that gets one line more.")
    ] = _DEFAULT_HISTORY,
    minutes: Annotated[
        float, typer.Option(min=1, metavar="N", help="How long the night may be.")
    ] = 60,
    date: Annotated[
        str | None, typer.Option(metavar="DATE", help="The night's name; default: today.")
    ] = None,
    only: Annotated[
        list[str] | None, typer.Option(metavar="STEP", help="Only this step; may be repeated.")
    ] = None,
) -> int:
    """Survey, growth, conformance, fuzzing and benches; then tell what changed since last night.

    A night that was broken off goes on where it was: steps whose record is there are not done
    again. Exit status 1 where a step failed or a case did.
    """
    from reports import write_claims_page, write_night_page
    from reports.history import append_night, changes, night_of, read_nights

    name = date or f"{datetime.now(UTC):%Y-%m-%d}"
    if not name.replace("-", "").replace(".", "").isalnum():
        raise Unusable(f"--date: {name!r} is not fit for the name of a folder")
    folder = out / name
    folder.mkdir(parents=True, exist_ok=True)
    steps = [one for one in _steps(paths or [Path("corpus")], folder, minutes) if _is_in(one, only)]
    if not steps:
        raise Unusable(f"there is no step {', '.join(only or ())}")
    made: dict[str, Any] = {}
    went: dict[str, dict[str, Any]] = {}
    for step, status, seconds in _performed(steps, folder, minutes):
        went[step.name] = {"status": status, "seconds": round(seconds, 1), "page": step.page}
        record = _record(folder, step.name)
        if record is not None:
            made[step.name] = record
    nights = [one for one in read_nights(history) if one.get("date") != name]
    last = nights[-1] if nights else None
    night = night_of(name, made, went)
    before = None if last is None else _record(out / str(last.get("date", "")), "conform")
    told = changes(last, night, before, made.get("conform"))
    append_night(history, night)
    write_json({**night, "changes": told}, folder / "night.json")
    write_claims_page(made, folder / "claims")
    pages = {"claims": {"status": "ok", "seconds": 0.0, "page": "claims/index.html"}}
    night = {**night, "steps": {**night["steps"], **pages}}
    page = write_night_page({**night, "changes": told, "history": [*nights, night]}, folder)
    for line in told or ["nothing changed since the last night"]:
        typer.echo(one_line(line))
    typer.echo(one_line(f"page: {page}"))
    failed = any(one["status"] not in ("ok", "findings") for one in went.values())
    verdicts = night["conform"]["verdicts"]
    return FINDINGS if failed or verdicts.get("fail") or night["fuzz"]["divergences"] else FINE


def _is_in(step: _Step, only: list[str] | None) -> bool:
    return not only or step.name in only


def _steps(paths: list[Path], folder: Path, minutes: float) -> Iterator[_Step]:
    """The commands of a night, the most telling ones first."""
    given = tuple(map(str, paths))
    seed = folder.name.replace("-", "").replace(".", "")
    seed = seed if seed.isdigit() else "1"
    programs = str(max(100, round(_PROGRAMS * minutes / 60)))
    yield _Step(
        "conform", ("conform", "--html", str(folder / "conform")), 0.25, "conform/index.html"
    )
    arm = ("motion", "blending", "program", "--executor", "native", "--robot", "mujoco")
    yield _Step("conform-arm", ("conform", *arm), 0.15)
    yield _Step("conform-laws", ("conform", "--metamorphic", "10"), 0.1)
    yield _Step("fuzz", ("fuzz", "--programs", programs, "--seed", seed), 0.3)
    yield _Step(
        "recover", ("recover", *given, "--out", str(folder / "recover")), 0.2, "recover/index.html"
    )
    yield _Step(
        "growth", ("growth", *given, "--out", str(folder / "growth")), 0.15, "growth/index.html"
    )
    for bench in ("recover", "check", "vm", "arm", "conform"):
        arguments = ("bench", bench, *(given if bench in ("recover", "check") else ()))
        yield _Step(f"bench-{bench}", arguments, 0.15)
    sample = str(max(4, round(minutes / 2)))
    yield _Step(
        "bench-mutation", ("bench", "mutation", "--singles", sample, "--multiple", "4"), 0.2
    )


def _performed(
    steps: list[_Step], folder: Path, minutes: float
) -> Iterator[tuple[_Step, str, float]]:
    """Each step with how it went: ok, findings, failed with its last line, or cut off."""
    begun = time.monotonic()
    for step in steps:
        began = time.monotonic()
        target = folder / f"{step.name}.json"
        if target.is_file():
            is_whole = _record(folder, step.name) is not None
            yield step, "ok" if is_whole else f"failed: {target.name} there is damaged", 0.0
            continue
        typer.echo(f"{(began - begun) / 60:5.1f} min  {step.name}", err=True)
        left = 60 * minutes - (began - begun)
        most = min(60 * minutes * step.share, left)
        command = [sys.executable, "-m", "krl", *step.arguments, "--json", str(target)]
        try:
            done = subprocess.run(
                command,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.PIPE,
                text=True,
                encoding="utf-8",
                errors="replace",
                timeout=max(most, 1),
                check=False,
            )
        except subprocess.TimeoutExpired:
            yield step, f"cut off after {most / 60:.0f} minutes", time.monotonic() - began
            continue
        status = {FINE: "ok", FINDINGS: "findings"}.get(done.returncode)
        if status is None or not target.is_file():
            said = done.stderr.strip().splitlines()
            status = f"failed: {said[-1] if said else f'status {done.returncode}'}"
        yield step, one_line(status), time.monotonic() - began


def _record(folder: Path, name: str) -> dict[str, Any] | None:
    """The record of a step; ``None`` where there is none that can be read."""
    from grammar.documents import json_of, read_bytes

    try:
        record = json_of(read_bytes(folder / f"{name}.json").decode("utf-8"))
    except (OSError, ValueError):
        return None
    return record if isinstance(record, dict) else None
