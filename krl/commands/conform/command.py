"""`krl conform`: runs the conformance cases on any executors and robots."""

from collections.abc import Iterable
from contextlib import nullcontext
from pathlib import Path
from typing import Annotated

import typer

from krl.commands.conform.case_runs import chosen_cases, drawn_pairs, list_cases, run_and_report
from krl.commands.conform.exchange import compare_parsers, export_cases, import_recording
from krl.commands.conform.metamorphic import check_laws
from krl.commands.conform.planted_fault import planted
from krl.commands.conform.results import Outputs
from krl.errors import FINDINGS, FINE, InputError, say
from krl.extras import expected_extras, need
from krl.terminal.options import JobsOption, JsonOption, scheduler_option
from krl.terminal.output_files import check_files


def conform(
    select: Annotated[list[str] | None, typer.Argument(metavar="[SELECT...]")] = None,
    executor: Annotated[list[str] | None, typer.Option(metavar="NAME")] = None,
    robot: Annotated[list[str] | None, typer.Option(metavar="NAME")] = None,
    json_file: JsonOption = None,
    junit: Path | None = None,
    html: Annotated[Path | None, typer.Option(metavar="DIR")] = None,
    strict: bool = False,
    lint: bool = False,
    metamorphic: Annotated[int | None, typer.Option(min=1)] = None,
    fault: Annotated[str | None, typer.Option(metavar="WORDS")] = None,
    parser: Annotated[list[str] | None, typer.Option(metavar="NAME=WHAT")] = None,
    seed: int = 1,
    list_: bool = False,
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

    Options:
        select: Suites, cases (suite/name), rules (TRG-04), topics (TRG), phases, paths, corners
            (corner, corner:zero); default: all. Or: import FILE, export FILE.zip [SELECT...],
            compare [SELECT...], pairs.
        executor: tree, vm, native or compiled; repeatable; default: all but compiled.
        robot: none, kinematic or mujoco; repeatable.
        junit: Write JUnit XML to FILE.
        html: Write the page to this folder.
        strict: Unconfirmed cases count as failed: show expected and seen, exit status 1.
        lint: Only check whether the cases are well formed.
        metamorphic: Change N cases and generated programs in ways that must not change the result.
        fault: Plant a fault with these words in its name, or the change of a line
            (interp/values/texts.py:108), and see which cases notice it.
        parser: compare: another parser, as an ANTLR grammar (FILE.g4) or a command that exits with
            0 for a file it accepts; repeatable.
        seed: pairs: seed of the programs.
        list_: List the cases; run nothing.
    """
    words, outputs = select or [], Outputs(json_file, junit, html)
    check_files(json_file, junit)
    if junit is not None:
        need("junitparser")
    if scheduler is not None:
        need("distributed")
    with expected_extras():  # here or on workers
        if lint:
            return _lint(words)
        bad = ("fail", "unconfirmed") if strict else ("fail",)
        if words[:1] == ["compare"]:
            return compare_parsers(words[1:], parser or [], outputs)
        if parser:
            raise InputError("--parser belongs to krl conform compare")
        if metamorphic is not None:
            return check_laws(chosen_cases(words), metamorphic, json_file, jobs, scheduler)
        if words[:1] == ["import"]:
            return import_recording(words[1:], outputs, bad)
        if words[:1] == ["export"]:
            return export_cases(words[1:], jobs, scheduler)
        cases = drawn_pairs(seed) if words == ["pairs"] else chosen_cases(words)
        if list_:
            return list_cases(cases, json_file)
        if fault is not None and (scheduler is not None or jobs not in (None, 1)):
            raise InputError(
                "--fault is planted into this process: leave --jobs and --scheduler out"
            )
        with nullcontext("") if fault is None else planted(fault) as name:
            if name:
                say(f"planted: {name}")
            more = {"selection": words, "fault": name}
            at_once = jobs if fault is None else 1
            given = (cases, executor, robot, outputs, at_once, scheduler)
            return run_and_report(*given, bad=bad, more=more)


def _lint(words: Iterable[str]) -> int:
    from conformance.linter.case_lint import lint
    from conformance.suite.case import CASES

    folders = [Path(word) for word in words] or [CASES]
    for folder in folders:
        if not folder.is_dir():
            raise InputError(f"{folder}: no such folder of cases")
    found = [fault for folder in folders for fault in lint(folder)]
    for fault in found:
        say(str(fault))
    typer.echo(f"{len(found)} faults" if found else "the cases are well formed", err=True)
    return FINDINGS if found else FINE
