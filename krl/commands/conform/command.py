"""`krl conform`: runs the conformance cases on any executors and robots."""

import signal
import time
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NoReturn

import typer
from rich.console import Console

from krl.errors import FINDINGS, FINE, InputError, as_input_errors, one_line, shown
from krl.extras import ARM, expected_extras, need
from krl.terminal.options import JobsOption, JsonOption, scheduler_option
from krl.terminal.output_files import check_files, write_json
from krl.terminal.progress import progress_bar
from krl.terminal.text_table import figures
from support.parallel.termination import on_termination

if TYPE_CHECKING:
    from conformance.evaluation.case_result import CaseResult
    from conformance.suite.case import Case

_SHOWN = 20
#: The exit status of a run that was terminated, as in shells.
_TERMINATED = 128 + signal.SIGTERM


def conform(
    select: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="[SELECT...]",
            help="Suites, cases (suite/name), rules (TRG-04), topics (TRG), phases, paths, "
            "corners (corner, corner:zero); default: all. Or: import FILE, "
            "export FILE.zip [SELECT...], compare [SELECT...], pairs.",
        ),
    ] = None,
    executor: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME",
            help="tree, vm, native or compiled; repeatable; default: all but compiled.",
        ),
    ] = None,
    robot: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME", help="none, kinematic or mujoco; repeatable."),
    ] = None,
    json_file: JsonOption = None,
    junit: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Write JUnit XML to FILE.")
    ] = None,
    html: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Write the page to this folder.")
    ] = None,
    strict: Annotated[
        bool,
        typer.Option(
            "--strict",
            help="Unconfirmed cases count as failed: show expected and seen, exit status 1.",
        ),
    ] = False,
    lint: Annotated[
        bool, typer.Option("--lint", help="Only check whether the cases are well formed.")
    ] = False,
    metamorphic: Annotated[
        int | None,
        typer.Option(
            min=1,
            metavar="N",
            help="Change N cases and generated programs in ways that must not change the result.",
        ),
    ] = None,
    fault: Annotated[
        str | None,
        typer.Option(
            metavar="WORDS",
            help="Plant a fault with these words in its name, or the change of a line "
            "(interp/values/texts.py:108), and see which cases notice it.",
        ),
    ] = None,
    parser: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME=WHAT",
            help="compare: another parser, as an ANTLR grammar (FILE.g4) or a command that exits "
            "with 0 for a file it accepts; repeatable.",
        ),
    ] = None,
    seed: Annotated[int, typer.Option(metavar="N", help="pairs: seed of the programs.")] = 1,
    list_: Annotated[bool, typer.Option("--list", help="List the cases; run nothing.")] = False,
    jobs: JobsOption = None,
    scheduler: Annotated[str | None, scheduler_option("run the cases")] = None,
) -> int:
    """Run conformance cases, and compare results with expectations and between executors.

    Exit status 1 if a case fails. A run that is terminated (SIGTERM) records what it has. 'krl
    conform import FILE' evaluates a recording that was made on a controller; conformance/CASES.md
    says how to make one. 'krl conform export FILE.zip' writes the cases, their expectations as
    JSON, and a reference result, for other executors. 'krl conform compare --parser NAME=WHAT'
    counts the cases that other parsers accept or reject correctly. 'krl conform pairs --seed N'
    runs programs that combine features of motions, interrupts, triggers and outputs in pairs; the
    executors must agree and no law may be broken.
    """
    words, outputs = select or [], _Outputs(json_file, junit, html)
    check_files(json_file, junit)
    if junit is not None:
        need("junitparser")
    if scheduler is not None:
        need("distributed")
    with _expected_errors():
        if lint:
            return _lint(words)
        if words[:1] == ["compare"]:
            return _compare(words[1:], parser or [], outputs)
        if parser:
            raise InputError("--parser belongs to krl conform compare")
        if metamorphic is not None:
            from krl.commands.conform.metamorphic import check_laws

            return check_laws(_cases(words), metamorphic, json_file, jobs, scheduler)
        if fault is None or list_ or words[:1] in (["import"], ["export"]):
            given = (words, executor, robot, outputs, jobs, scheduler)
            return _conform(*given, list_=list_, strict=strict, seed=seed)
        from krl.commands.conform.planted_fault import planted

        if scheduler is not None or jobs not in (None, 1):
            raise InputError(
                "--fault is planted into this process: leave --jobs and --scheduler out"
            )
        with planted(fault) as name:
            typer.echo(one_line(f"planted: {name}"))
            return _conform(words, executor, robot, outputs, 1, None, strict=strict, fault=name)


@dataclass(frozen=True, slots=True)
class _Outputs:
    """The files that are asked for."""

    json_file: Path | None
    junit: Path | None
    html: Path | None

    def write(
        self,
        results: "Sequence[CaseResult]",
        executors: Sequence[str],
        robots: Sequence[str],
        seconds: float,
        more: Mapping[str, object],
    ) -> None:
        """Write them; ``more`` are further fields of the record, if not empty.

        The record is written last, because it says that the run is complete.
        """
        from conformance.records.conform_record import record_of

        version = metadata.version("krl-workbench")
        if self.json_file is not None or self.html is not None:
            record = record_of(results, executors, robots, version=version, seconds=seconds)
            record |= {name: value for name, value in more.items() if value}
            if self.html is not None:
                from reports.conformance.conform_page import write_conformance_page

                typer.echo(one_line(f"page: {write_conformance_page(record, self.html)}"))
            write_json(record, self.json_file)
        if self.junit is not None:
            from conformance.records.junit import write_junit

            write_junit(results, self.junit)


@contextmanager
def _expected_errors() -> Iterator[None]:
    """Turn missing packages, here or on workers, and unusable workers into `InputError`."""
    from support.parallel.workers import WorkersError

    with as_input_errors(WorkersError), expected_extras():
        yield


def _conform(
    words: list[str],
    executor: list[str] | None,
    robot: list[str] | None,
    outputs: _Outputs,
    jobs: int | None,
    scheduler: str | None,
    *,
    strict: bool,
    list_: bool = False,
    seed: int = 1,
    fault: str = "",
) -> int:
    bad = ("fail", "unconfirmed") if strict else ("fail",)
    if words[:1] == ["import"]:
        return _import(words[1:], outputs, bad)
    if words[:1] == ["export"]:
        return _export(words[1:], jobs, scheduler)
    if words == ["pairs"]:
        from conformance.suite.interactions import drawn

        cases = drawn(seed)
    else:
        cases = _cases(words)
    if list_:
        return _list(cases, outputs.json_file)
    need(*ARM)
    executors = _chosen(executor, "executor")
    robots = _chosen(robot, "robot")
    begun = time.perf_counter()
    results, running = _run(cases, executors, robots, jobs, scheduler)
    seconds = time.perf_counter() - begun
    left = [case.name for case in cases[len(results) :]]
    more = {"selection": words, "fault": fault, "not_run": left, "running": running}
    outputs.write(results, executors, robots, seconds, more)
    _print_summary(results, seconds, bad)
    if left:
        while_ = f" while running {', '.join(running)}" if running else ""
        typer.echo(one_line(f"terminated{while_}: {len(left):,} cases are not done"), err=True)
        return _TERMINATED
    return FINDINGS if any(one.verdict in bad for one in results) else FINE


def _list(cases: "Sequence[Case]", json_file: Path | None) -> int:
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


def _cases(words: Sequence[str]) -> "list[Case]":
    from conformance.suite.case import CASES, CaseError, find_cases, read_case, selected

    outside = [Path(word) for word in words if Path(word).exists()]
    with as_input_errors(CaseError):
        cases = find_cases()
        for path in outside:
            if CASES.resolve() not in (path.resolve(), *path.resolve().parents):
                cases += find_cases(path) if path.is_dir() else [read_case(path, path.parent)]
        return selected(cases, words)


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


def _run(
    cases: "Sequence[Case]",
    executors: Sequence[str],
    robots: Sequence[str],
    jobs: int | None,
    scheduler: str | None,
) -> "tuple[list[CaseResult], list[str]]":
    """Return the results of the cases, and, if this process was terminated, what was running."""
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


def _print_summary(
    results: "Sequence[CaseResult]", seconds: float, bad: Collection[str] = ("fail",)
) -> None:
    """Print the cases with one of the ``bad`` verdicts, then the figures."""
    from conformance.evaluation.verdicts import VERDICTS
    from conformance.suite.rule_coverage import coverage
    from reports.rendering.number_format import counted

    failed = [one for one in results if one.verdict in bad]
    for one in failed[:_SHOWN]:
        _print_failure(one, bad)
    if len(failed) > _SHOWN:
        typer.echo(f"… and {counted(len(failed) - _SHOWN, 'more case')} failed")
    runs = [result for one in results for result in one.results]
    totals = {verdict: sum(r.verdict == verdict for r in runs) for verdict in VERDICTS}
    verdicts = ", ".join(f"{count:,} {verdict}" for verdict, count in totals.items() if count)
    rate = len(runs) / seconds if seconds else 0.0
    covered, hard = coverage(one.case for one in results).count(hard=True)
    negative = sum(one.case.is_negative for one in results)
    cases, done = counted(len(results), "case"), counted(len(runs), "run")
    typer.echo(f"{cases} ({negative:,} negative), {done}: {verdicts}")
    typer.echo(f"rules that may fail: {covered} of {hard} have a case; {rate:.1f} runs a second")


def _print_failure(one: "CaseResult", bad: Collection[str]) -> None:
    """Print on which setups a case failed and why; equal failures share a line."""
    typer.echo(shown(f"{one.case.name}: {one.case.title} [{', '.join(one.case.rules)}]"))
    failed = [result for result in one.results if result.verdict in bad]
    for reason in dict.fromkeys(result.reason for result in failed):
        alike = [result for result in failed if result.reason == reason]
        names = ", ".join(f"{result.executor}/{result.robot}" for result in alike)
        typer.echo(f"  {one_line(f'{names}: {reason}')}")
        found = next((result.divergence for result in alike if result.divergence), None)
        if found is not None:
            line = one.case.line(found.file, found.line)
            typer.echo(shown(f"    {found.file}:{found.line}: {line}"))
            for side in (found.left, found.right):
                values = ", ".join(f"{name}={value}" for name, value in side.variables.items())
                typer.echo(f"    {one_line(f'{side.name}: ' + (values or 'no variables yet'))}")


def _lint(words: Iterable[str]) -> int:
    from conformance.linter.case_lint import lint
    from conformance.suite.case import CASES

    folders = [Path(word) for word in words] or [CASES]
    for folder in folders:
        if not folder.is_dir():
            raise InputError(f"{folder}: no such folder of cases")
    found = [fault for folder in folders for fault in lint(folder)]
    for fault in found:
        typer.echo(one_line(str(fault)))
    typer.echo(f"{len(found)} faults" if found else "the cases are well formed", err=True)
    return FINDINGS if found else FINE


def _export(words: Sequence[str], jobs: int | None, scheduler: str | None) -> int:
    """Write the cases, their expectations, and the results of the tree interpreter."""
    from conformance.exchange.export import write_export

    if not words or not words[0].endswith(".zip"):
        raise InputError("krl conform export takes the name of an archive, FILE.zip")
    path = Path(words[0])
    check_files(path)
    need(*ARM)
    cases = _cases(words[1:])
    results, _ = _run(cases, ["tree"], ["kinematic"], jobs, scheduler)
    if len(results) < len(cases):
        return _TERMINATED
    try:
        write_export(path, results, metadata.version("krl-workbench"))
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror}") from error
    typer.echo(one_line(f"{path}: {len(results)} cases, their expectations, a reference result"))
    return FINDINGS if any(one.verdict == "fail" for one in results) else FINE


def _compare(words: Sequence[str], wanted: Sequence[str], outputs: _Outputs) -> int:
    """Print for each suite how many cases each parser accepts or rejects correctly."""
    from conformance.exchange.parser_comparison import OWN, ParserError, compared, parsers

    if not wanted:
        raise InputError("krl conform compare takes --parser NAME=WHAT, once or several times")
    cases = _cases(words)
    begun = time.perf_counter()
    with as_input_errors(ParserError), parsers(wanted) as found:
        with progress_bar("reading cases", len(cases)) as bar:
            results = compared(cases, found, bar)
        names = list(found)
    seconds = time.perf_counter() - begun
    outputs.write(results, names, ["none"], seconds, {"selection": list(words)})
    _print_comparison(results, names)
    own = any(one.executor == OWN and one.verdict == "fail" for r in results for one in r.results)
    return FINDINGS if own else FINE


def _print_comparison(results: "Sequence[CaseResult]", names: Sequence[str]) -> None:
    table = figures(("cases", "number", *names))
    suites = dict.fromkeys(one.case.suite for one in results)
    rows = [(suite, [one for one in results if one.case.suite == suite]) for suite in suites]
    kinds = (("to be read", False), ("to be refused", True), ("all", None))
    for kind, wanted in kinds:
        chosen = [one for one in results if wanted in (None, one.case.expects_syntax_error)]
        rows.append((kind, chosen))
    for name, own in rows:
        passed = (sum(one.results[at].verdict == "pass" for one in own) for at in range(len(names)))
        table.add_row(name, f"{len(own):,}", *(f"{one:,}" for one in passed))
    Console(highlight=False).print(table)


def _import(words: Sequence[str], outputs: _Outputs, bad: Collection[str]) -> int:
    """Evaluate a recording: its failures, and its evidence on unconfirmed rules."""
    from conformance.exchange.recording import (
        Recording,
        RecordingError,
        answers,
        evaluate_recording,
    )
    from conformance.suite.case import CaseError, find_cases

    if len(words) != 1:
        raise InputError("krl conform import takes one file")
    begun = time.perf_counter()
    with as_input_errors(RecordingError, CaseError):
        recording = Recording.read(Path(words[0]))
        cases = find_cases()
        results, wrong = evaluate_recording(recording, cases)
    for text in wrong:
        typer.echo(one_line(text), err=True)
    if not results:
        raise InputError(f"{words[0]}: none of its cases can be evaluated")
    seconds = time.perf_counter() - begun
    robots = sorted({result.robot for one in results for result in one.results})
    there = {one.case.name for one in results}
    left = [case.name for case in cases if case.phase == "run" and case.name not in there]
    more = {"recording": recording.controller, "not_recorded": left}
    outputs.write(results, [recording.controller], robots, seconds, more)
    typer.echo(one_line(f"recorded on {recording.controller}"))
    for answer in answers(results):
        rest = f"against it: {', '.join(answer.against)}" if answer.against else "none against it"
        typer.echo(f"{answer.rule}: {answer.met} cases as we read it, {rest}")
    _print_summary(results, seconds, bad)
    return FINDINGS if wrong or any(one.verdict in bad for one in results) else FINE
