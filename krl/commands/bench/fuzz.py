"""`krl bench fuzz`: how many mutants of the machine `krl fuzz` finds."""

import os
from typing import Annotated

import typer

from krl.commands.bench.bench_command import Record, bench
from krl.errors import InputError, say
from krl.terminal.options import JobsOption, JsonOption, all_cores
from krl.terminal.progress import progress_bar


def _print(record: Record) -> None:
    for one in record["verdicts"]:
        if one["program"] is None:
            say(f"Not found: {one['file']}:{one['line']}: {one['was']} becomes {one['now']}")
    text = f"{record['found']:,} of {record['mutants']:,} mutants found ({record['share']:.1%})"
    if record["found"]:
        text += f", half of them within {record['median_runs']} programs"
    say(text)


@bench(_print)
def fuzz(
    _json_file: JsonOption = None,
    programs: Annotated[int, typer.Option(min=1)] = 200,
    mutants: Annotated[int, typer.Option(min=1)] = 200,
    seed: int = 1,
    jobs: JobsOption = None,
) -> Record:
    """Mutation testing of the fuzzer: change the machine in Python, and see if programs detect it.

    The changes are drawn at random, like those of `krl bench conform`. Some of them cannot be
    detected by any program.

    Options:
        programs: At most N programs for each mutant.
        mutants: Number of mutants.
        seed: Seed of mutants and programs.
    """
    from conformance.sensitivity.fuzzed_mutants import examine_mutants, record_of

    if not hasattr(os, "fork"):
        raise InputError("mutants need a system that can end a computation (POSIX signals)")
    with progress_bar("examining mutants", mutants) as bar:
        verdicts = examine_mutants(mutants, programs, seed, all_cores(jobs), bar)
    return record_of(verdicts, programs, seed)
