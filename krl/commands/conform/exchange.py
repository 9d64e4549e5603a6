"""`krl conform export`, `import` and `compare`: cases and results of third parties."""

import time
from collections.abc import Collection, Sequence
from importlib import metadata
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from krl.commands.conform.case_runs import TERMINATED, chosen_cases, run_on
from krl.commands.conform.results import Outputs, print_summary
from krl.errors import FINDINGS, FINE, InputError, as_input_errors, say
from krl.extras import ARM, need
from krl.terminal.output_files import check_files
from krl.terminal.progress import progress_bar
from krl.terminal.text_table import print_figures

if TYPE_CHECKING:
    from conformance.evaluation.case_result import CaseResult


def export_cases(words: Sequence[str], jobs: int | None, scheduler: str | None) -> int:
    """Write the cases, their expectations, and the results of the tree interpreter."""
    from conformance.exchange.export import write_export

    if not words or not words[0].endswith(".zip"):
        raise InputError("krl conform export takes the name of an archive, FILE.zip")
    path = Path(words[0])
    check_files(path)
    need(*ARM)
    cases = chosen_cases(words[1:])
    results, _ = run_on(cases, ["tree"], ["kinematic"], jobs, scheduler)
    if len(results) < len(cases):
        return TERMINATED
    try:
        write_export(path, results, metadata.version("krl-workbench"))
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror}") from error
    say(f"{path}: {len(results)} cases, their expectations, a reference result")
    return FINDINGS if any(one.verdict == "fail" for one in results) else FINE


def compare_parsers(words: Sequence[str], wanted: Sequence[str], outputs: Outputs) -> int:
    """Print for each suite how many cases each parser accepts or rejects correctly."""
    from conformance.exchange.parser_comparison import OWN, ParserError, compared, parsers

    if not wanted:
        raise InputError("krl conform compare takes --parser NAME=WHAT, once or several times")
    cases = chosen_cases(words)
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
    suites = dict.fromkeys(one.case.suite for one in results)
    rows = [(suite, [one for one in results if one.case.suite == suite]) for suite in suites]
    kinds = (("to be read", False), ("to be refused", True), ("all", None))
    for kind, wanted in kinds:
        chosen = [one for one in results if wanted in (None, one.case.expects_syntax_error)]
        rows.append((kind, chosen))
    print_figures(
        ("cases", "number", *names),
        [
            (
                name,
                f"{len(own):,}",
                *(f"{_passed(own, place):,}" for place in range(len(names))),
            )
            for name, own in rows
        ],
    )


def _passed(results: "Sequence[CaseResult]", place: int) -> int:
    """Return how many cases the parser at a place passes."""
    return sum(one.results[place].verdict == "pass" for one in results)


def import_recording(words: Sequence[str], outputs: Outputs, bad: Collection[str]) -> int:
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
        say(text, err=True)
    if not results:
        raise InputError(f"{words[0]}: none of its cases can be evaluated")
    seconds = time.perf_counter() - begun
    robots = sorted({result.robot for one in results for result in one.results})
    there = {one.case.name for one in results}
    left = [case.name for case in cases if case.phase == "run" and case.name not in there]
    more = {"recording": recording.controller, "not_recorded": left}
    outputs.write(results, [recording.controller], robots, seconds, more)
    say(f"recorded on {recording.controller}")
    for answer in answers(results):
        rest = f"against it: {', '.join(answer.against)}" if answer.against else "none against it"
        typer.echo(f"{answer.rule}: {answer.met} cases as we read it, {rest}")
    print_summary(results, seconds, bad)
    return FINDINGS if wrong or any(one.verdict in bad for one in results) else FINE
