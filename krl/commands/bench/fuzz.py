"""`krl bench fuzz`: how many mutants of the machine `krl fuzz` finds."""

import os
from typing import Annotated

import typer
from rich.console import Console

from krl.errors import FINE, InputError
from krl.terminal.options import JobsOption, JsonOption, all_cores
from krl.terminal.output_files import check_files, write_json
from krl.terminal.progress import progress_bar


def fuzz(
    json_file: JsonOption = None,
    programs: Annotated[int, typer.Option(min=1)] = 200,
    mutants: Annotated[int, typer.Option(min=1)] = 200,
    seed: int = 1,
    jobs: JobsOption = None,
) -> int:
    """Mutation testing of the fuzzer: change the machine in Python, and see if programs detect it.

    The changes are drawn at random, like those of `krl bench conform`. Some of them cannot be
    detected by any program.

    Options:
        programs: At most N programs for each mutant.
        mutants: Number of mutants.
        seed: Seed of mutants and programs.
    """
    from conformance.sensitivity.fuzzed_mutants import examine_mutants, record_of

    check_files(json_file)
    if not hasattr(os, "fork"):
        raise InputError("mutants need a system that can end a computation (POSIX signals)")
    with progress_bar("examining mutants", mutants) as bar:
        verdicts = examine_mutants(mutants, programs, seed, all_cores(jobs), bar)
    record = record_of(verdicts, programs, seed)
    write_json(record, json_file, indent=1)
    console = Console(highlight=False)
    for one in record["verdicts"]:
        if one["program"] is None:
            text = f"Not found: {one['file']}:{one['line']}: {one['was']} becomes {one['now']}"
            console.print(text, markup=False, soft_wrap=True)
    text = f"{record['found']:,} of {record['mutants']:,} mutants found ({record['share']:.1%})"
    if record["found"]:
        text += f", half of them within {record['median_runs']} programs"
    console.print(text, soft_wrap=True)
    return FINE
