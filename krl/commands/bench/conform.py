"""`krl bench conform`: how many planted faults the cases find, and how fast they run."""

from collections.abc import Mapping
from typing import Annotated, Any

import typer
from rich.console import Console

from krl.errors import FINE, InputError, as_input_errors
from krl.extras import ARM, expected_extras
from krl.options import JobsOption, JsonOption, all_cores
from krl.output_files import check_files, write_json
from krl.progress import progress_bar
from krl.text_table import figures

__all__ = ["conform"]


def conform(
    json_file: JsonOption = None,
    group: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME", help="Only faults of this group; may be repeated."),
    ] = None,
    jobs: JobsOption = None,
) -> int:
    """Plant faults into the controller, the arm and the machine in Python; see which cases notice.

    A fault is found by a case that passes without it and not with it. Cases a second are those of
    all cases, with the tree interpreter and no robot, in one process.
    """
    check_files(json_file)
    with expected_extras(*ARM):
        from conformance.sensitivity import measure, speed_of
        from conformance.sensitivity.trial import all_faults
        from conformance.suite.case import CaseError, find_cases
    groups = list(dict.fromkeys(one.group for one in all_faults()))
    for name in group or ():
        if name not in groups:
            raise InputError(f"--group {name}: the groups are {', '.join(groups)}")
    faults = [one for one in all_faults() if not group or one.group in group]
    with as_input_errors(CaseError):
        cases = find_cases()
    with progress_bar("timing cases", len(cases)) as bar:
        speed = speed_of(cases, bar)
    with progress_bar("planting faults", len(faults)) as bar:
        found = measure(faults, cases, all_cores(jobs), bar)
    record = {"bench": "conform", **found, **speed}
    write_json(record, json_file)
    _print(record)
    return FINE


def _print(record: Mapping[str, Any]) -> None:
    console = Console(highlight=False)
    table = figures(("faults in", "planted", "found", "by a failure", "share"))
    every = {"group": "all", **record}
    for row in (*record["groups"], every):
        counts = (row["mutants"], row["killed"], row["failing"])
        table.add_row(row["group"], *(f"{one:,}" for one in counts), f"{row['share']:.1%}")
    console.print(table)
    console.print(
        f"{record['cases_per_s']:,.1f} cases a second ({record['cases']:,} cases, "
        f"{record['executor']}, robot {record['robot']}); aim {record['aim']:.0%} of faults found",
        soft_wrap=True,
    )
    for one in record["survivors"]:
        console.print(f"Not found: {one['group']}: {one['fault']}", markup=False, soft_wrap=True)
