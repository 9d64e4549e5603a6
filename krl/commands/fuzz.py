"""`krl fuzz`: random programs on several executors, whose traces must be equal."""

import time
from typing import TYPE_CHECKING, Annotated

import typer
from rich.console import Console

from krl.errors import FINDINGS, FINE, InputError, as_input_errors, say
from krl.extras import need
from krl.terminal.options import JobsOption, JsonOption, all_cores, scheduler_option
from krl.terminal.output_files import check_files, write_json
from krl.terminal.progress import progress_bar

if TYPE_CHECKING:
    from conformance.differential.campaign import Finding, Findings

_SHOWN = 5


def fuzz(
    programs: Annotated[int, typer.Option(min=1)] = 1_000,
    seed: int = 1,
    minutes: Annotated[float | None, typer.Option(min=0.1)] = None,
    executor: Annotated[list[str] | None, typer.Option(metavar="NAME")] = None,
    json_file: JsonOption = None,
    jobs: JobsOption = None,
    scheduler: Annotated[str | None, scheduler_option("run the programs")] = None,
) -> int:
    """Generate random programs, run each on all executors, and compare every request and event.

    Replies, interrupts, triggers and faults are random too; all of it follows from the seed. A
    program on which two executors diverge is reduced as far as possible; exit status 1 if there is
    one. A program reaches a rule of KRL if it executes everything that all conformance cases of
    this rule, or of a clause of it, have in common.

    Options:
        programs: Number of programs.
        seed: Seed of the programs.
        minutes: Start no more programs after N minutes.
        executor: tree, vm, native or compiled; repeatable; the first is the reference; default: all
            but compiled.
    """
    from conformance.differential.campaign import fuzz as run
    from conformance.differential.campaign import record_of
    from conformance.differential.construct_coverage import needs
    from conformance.suite.case import CaseError, find_cases
    from support.parallel.ordered_map import check_scheduler

    check_files(json_file)
    if scheduler is not None:
        need("distributed")
    names = _chosen(executor or [])
    with as_input_errors(CaseError):
        check_scheduler(scheduler)
        rules = needs(find_cases())
    begun = time.perf_counter()
    with progress_bar("running programs", programs) as bar:
        found = run(programs, seed, names, all_cores(jobs), bar, scheduler, rules, minutes)
    record = record_of(found, time.perf_counter() - begun)
    write_json(record, json_file, indent=1)
    _print_summary(found, record["seconds"])
    return FINDINGS if found.findings else FINE


def _chosen(wanted: list[str]) -> list[str]:
    """Return executors by name, each once; all available ones by default."""
    from conformance.differential.runs import EXECUTORS
    from interp.executors import available, is_available

    there = available()
    for name in wanted:
        if name not in EXECUTORS:
            raise InputError(f"{name}: the executor must be one of {', '.join(EXECUTORS)}")
        if not is_available(name):
            raise InputError(f"{name}: this executor is not available here")
    names = list(dict.fromkeys(wanted or there))
    if len(names) < 2:
        raise InputError("name two executors at least to compare")
    return names


def _print_summary(found: "Findings", seconds: float) -> None:
    from conformance.differential.construct_coverage import missing

    console = Console(highlight=False)
    ends = ", ".join(f"{count:,} with {word}" for word, count in sorted(found.ends.items()))
    say(
        f"{found.programs:,} programs on {', '.join(found.executors)} in {seconds:,.1f} s, "
        f"{found.facts:,} requests and events; ended: {ends}"
    )
    for kind, names in missing(found.counts).items():
        say(f"Never executed, {kind}: {', '.join(names)}")
    never = [rule for rule in found.rules if not found.counts["rule", rule]]
    say(
        f"Reached {len(found.rules) - len(never)} of {len(found.rules)} rules and clauses that have"
        f" cases with something of their own; never: {', '.join(never) or 'none'}"
    )
    count = len(found.findings)
    if not count:
        console.print("No difference.")
        return
    console.print(f"[bold red]{count:,} difference{'s' if count > 1 else ''}[/]")
    for one in found.findings[:_SHOWN]:
        _show(console, one, found.executors[0])
    if count > _SHOWN:
        others = ", ".join(str(one.number) for one in found.findings[_SHOWN : _SHOWN + 20])
        console.print(f"Others: programs {others}{' …' if count > _SHOWN + 20 else ''}")


def _show(console: Console, finding: "Finding", reference: str) -> None:
    difference = finding.difference
    size = "" if finding.statements is None else f", reduced to {finding.statements} statements"
    console.print(f"\n[bold]Program {finding.number}[/]{size}", soft_wrap=True)
    console.print(f"{reference}: {difference.expected_text}", markup=False, soft_wrap=True)
    console.print(f"{difference.executor}: {difference.actual_text}", markup=False, soft_wrap=True)
    for path, text in finding.files:
        console.print(f"{path}:", markup=False)
        for number, row in enumerate(text.rstrip().split("\n"), start=1):
            console.print(f"{number:4} {row}", markup=False, soft_wrap=True)
