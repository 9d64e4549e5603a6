"""`krl conform [SELECT...]`: which cases are run, on which executors and robots."""

import signal
import time
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

import typer

from krl.commands.conform.results import Outputs, print_summary
from krl.errors import FINDINGS, FINE, InputError, as_input_errors, say, shown
from krl.extras import ARM, need
from krl.terminal.output_files import write_json
from krl.terminal.progress import progress_bar
from support.parallel.termination import on_termination

if TYPE_CHECKING:
    from conformance.evaluation.case_result import CaseResult
    from conformance.suite.case import Case

#: The exit status of a run that was terminated, as in shells.
TERMINATED = 128 + signal.SIGTERM


def run_and_report(
    cases: "Sequence[Case]",
    executor: list[str] | None,
    robot: list[str] | None,
    outputs: Outputs,
    jobs: int | None,
    scheduler: str | None,
    *,
    bad: Collection[str],
    more: Mapping[str, object],
) -> int:
    """Run cases and report; a verdict of ``bad`` makes the exit status 1.

    ``more`` are further fields of the record.
    """
    need(*ARM)
    executors = _chosen(executor, "executor")
    robots = _chosen(robot, "robot")
    begun = time.perf_counter()
    results, running = run_on(cases, executors, robots, jobs, scheduler)
    seconds = time.perf_counter() - begun
    left = [case.name for case in cases[len(results) :]]
    outputs.write(
        results, executors, robots, seconds, {**more, "not_run": left, "running": running}
    )
    print_summary(results, seconds, bad)
    if left:
        while_ = f" while running {', '.join(running)}" if running else ""
        say(f"terminated{while_}: {len(left):,} cases are not done", err=True)
        return TERMINATED
    return FINDINGS if any(one.verdict in bad for one in results) else FINE


def list_cases(cases: "Sequence[Case]", json_file: Path | None) -> int:
    """Print the cases; the record has what a recording on a controller needs."""
    for case in cases:
        typer.echo(shown(f"{case.name:42} {','.join(case.rules):22} {case.title}"))
    expected = sum(len(case.expectations) for case in cases)
    typer.echo(f"krl: {len(cases)} cases with {expected:,} expectations", err=True)
    if json_file is not None:
        verdicts = [
            {
                "case": case.name,
                "digest": case.digest,
                "phase": case.phase,
                "rules": list(case.rules),
                "title": case.title,
                "io": list(case.io),
                "files": [source.path for source in case.sources],
            }
            for case in cases
        ]
        write_json({"cases": verdicts}, json_file)
    return FINE


def chosen_cases(words: Sequence[str]) -> "list[Case]":
    """Return the cases that words select."""
    from conformance.suite.case import CASES, CaseError, find_cases, read_case, selected

    outside = [Path(word) for word in words if Path(word).exists()]
    with as_input_errors(CaseError):
        cases = find_cases()
        for path in outside:
            if CASES.resolve() not in (path.resolve(), *path.resolve().parents):
                cases += find_cases(path) if path.is_dir() else [read_case(path, path.parent)]
        return selected(cases, words)


def drawn_pairs(seed: int) -> "list[Case]":
    """Return cases that combine features in pairs."""
    from conformance.suite.interactions import drawn

    return drawn(seed)


def _chosen(wanted: list[str] | None, what: str) -> list[str]:
    from conformance.evaluation.execution import Setup, missing
    from interp.executors import COMPILED, EXECUTORS
    from interp.robot.simulation.factory import ROBOTS

    known: tuple[str, ...] = EXECUTORS if what == "executor" else ROBOTS
    if not wanted:
        setups = [Setup(n, "none") if what == "executor" else Setup("tree", n) for n in known]
        there = [name for name, setup in zip(known, setups, strict=True) if not missing(setup)]
        return there if what == "executor" else there[:2]
    if what == "executor":
        known = (*known, COMPILED)
    for name in wanted:
        if name not in known:
            raise InputError(f"{name}: the {what} must be one of {', '.join(known)}")
    return list(dict.fromkeys(wanted))


def run_on(
    cases: "Sequence[Case]",
    executors: Sequence[str],
    robots: Sequence[str],
    jobs: int | None,
    scheduler: str | None,
) -> "tuple[list[CaseResult], list[str]]":
    """Return the results of cases, and, if this process was terminated, what was running."""
    from conformance.evaluation.verdicts import KnownFailures
    from conformance.runner import Stopped, run_cases

    def stop(_signal: int, _frame: object) -> NoReturn:
        signal.signal(signal.SIGTERM, signal.SIG_IGN)  # once is enough
        raise Stopped

    try:
        known = KnownFailures.load()
    except (OSError, ValueError) as error:
        raise InputError(f"the list of known failures cannot be read: {error}") from error
    running: list[str] = []
    with progress_bar("running cases", len(cases)) as bar, on_termination(stop):
        given = (known, jobs, bar, scheduler, running.extend)
        return run_cases(cases, executors, robots, *given), running
