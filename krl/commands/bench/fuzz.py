"""`krl bench fuzz`: how many planted faults `krl fuzz` finds."""

from typing import Annotated

import typer
from rich.console import Console

from krl.errors import FINE
from krl.options import JobsOption, JsonOption, all_cores
from krl.output_files import check_files, write_json
from krl.progress import progress_bar


def fuzz(
    json_file: JsonOption = None,
    programs: Annotated[
        int, typer.Option(min=1, metavar="N", help="Each mutant meets so many programs at most.")
    ] = 1_000,
    seed: Annotated[int, typer.Option(metavar="N", help="Chooses the programs.")] = 1,
    jobs: JobsOption = None,
) -> int:
    """Plant faults into the machine in Python, one at a time, and see whether programs find them.

    The faults are made from the table of instructions: operands exchanged, results a little off,
    jumps that go the wrong way, faults that are not raised.
    """
    from conformance.differential.fault_catalogue import mutants
    from conformance.differential.fault_detection import examine_mutants, record_of

    check_files(json_file)
    with progress_bar("examining mutants", len(mutants())) as bar:
        verdicts = examine_mutants(programs, seed, all_cores(jobs), bar)
    record = record_of(verdicts, programs, seed)
    write_json(record, json_file, indent=1)
    console = Console(highlight=False)
    console.print(
        f"{record['caught']:,} of {record['mutants']:,} planted faults found "
        f"({record['share']:.1%}; aim 95 %), half of them within {record['median_runs']} runs",
        soft_wrap=True,
    )
    for one in record["missed"]:
        console.print(f"Not found: {one}", markup=False, soft_wrap=True)
    return FINE
