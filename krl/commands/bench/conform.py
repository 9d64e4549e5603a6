"""`krl bench conform`: how many mutants and planted faults cases find, and how fast they run."""

import time
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.console import Console

from krl.errors import FINE, InputError, as_input_errors, say
from krl.extras import ARM, expected_extras
from krl.running.run_options import Executor
from krl.terminal.options import JobsOption, JsonOption, all_cores
from krl.terminal.output_files import check_files, write_json
from krl.terminal.progress import progress_bar
from krl.terminal.text_table import print_figures

_SEED = 1


def conform(
    json_file: JsonOption = None,
    mutants: Annotated[int, typer.Option(min=0)] = 100,
    seed: Annotated[list[int] | None, typer.Option(metavar="N")] = None,
    package: Annotated[list[str] | None, typer.Option(metavar="NAME")] = None,
    most: Annotated[int, typer.Option("--most-cases", min=1)] = 1000,
    survivors: Path | None = None,
    group: Annotated[list[str] | None, typer.Option(metavar="NAME")] = None,
    executor: Executor = Executor.TREE,
    removed: bool = False,
    jobs: JobsOption = None,
    cache: Annotated[Path | None, typer.Option(metavar="DIR")] = None,
) -> int:
    """Mutation testing of the cases: change the semantics in one place, and see if a case fails.

    Mutants are drawn at random from the code of values, tree interpreter, controller and robot:
    comparisons, arithmetic, connectives, conditions, constants, omitted statements. Planted faults
    are those that no such change makes. The cases per second are those of all cases, with the tree
    interpreter and no robot, in one process.

    Options:
        mutants: Number of mutants for each seed.
        seed: Seed of the mutants; repeatable; default: 1.
        package: Only mutants of this package; repeatable.
        most: Try at most N of the cases that run a mutant's lines and may fail.
        survivors: Write mutants that no case detects, as TSV.
        group: Only planted faults of this group, or 'none'; repeatable.
        executor: Executor that runs the cases for planted faults.
        removed: Instead remove from each case the feature its title names; list cases that still
            pass.
        cache: Cache results here; an interrupted run continues.
    """
    check_files(json_file, survivors)
    with expected_extras(*ARM):
        from conformance.evaluation.execution import Setup, missing
        from conformance.sensitivity.bench_record import mutants_record, planted_record, speed_of
        from conformance.sensitivity.detection import (
            detect_faults,
            is_possible,
            kept_detections,
            reaches_of,
        )
        from conformance.sensitivity.mutants import drawn
        from conformance.sensitivity.mutated_code import OF_CASES
        from conformance.sensitivity.planted_faults import FAULTS
        from conformance.suite.case import CaseError, find_cases
    if removed:
        return _removals(json_file, all_cores(jobs))
    groups = list(dict.fromkeys(one.group for one in FAULTS))
    for name in group or ():
        if name not in (*groups, "none"):
            raise InputError(f"--group {name}: the groups are {', '.join(groups)}, none")
    for name in package or ():
        if name not in OF_CASES:
            raise InputError(f"--package {name}: the packages are {', '.join(OF_CASES)}")
    if lacking := missing(Setup(executor.value, "none")):
        raise InputError(f"--executor {executor.value}: {lacking}")
    faults = [one for one in FAULTS if not group or one.group in group]
    with as_input_errors(CaseError):
        cases = find_cases()
    seeds = seed or [_SEED]
    packages = [one for one in OF_CASES if not package or one in package]
    wanted = {one: drawn(one, mutants, packages) for one in dict.fromkeys(seeds)}
    every = tuple(dict.fromkeys(mutant for found in wanted.values() for mutant in found))
    record: dict[str, Any] = {"bench": "conform"}
    if (every or faults) and not is_possible():
        raise InputError(
            "faults need a system that can copy a process (fork): use --mutants 0 --group none"
        )
    began = time.perf_counter()
    with kept_detections(cache) as store:
        running = [case for case in cases if case.phase == "run"] if every or faults else []
        with progress_bar("which lines cases run", len(running)) as bar:
            reaches = reaches_of(running, all_cores(jobs), bar, store)
        with progress_bar("trying mutants", len(every)) as bar:
            detections = detect_faults(every, reaches, all_cores(jobs), most, bar, store)
        with progress_bar("planting faults", len(faults)) as bar:
            planted = detect_faults(
                faults, reaches, all_cores(jobs), most, bar, store, executor.value
            )
    record |= planted_record(planted, executor.value)
    record["seconds"] = round(time.perf_counter() - began, 3)
    with progress_bar("timing cases", len(cases)) as bar:
        record |= speed_of(cases, bar)
    by_mutant = dict(zip(every, detections, strict=True))
    if every:
        record["drawn"] = mutants_record(
            {one: [by_mutant[mutant] for mutant in found] for one, found in wanted.items()}
        )
    write_json(record, json_file)
    if survivors is not None:
        survivors.write_text(_rows(record.get("drawn", {})), encoding="utf-8", newline="\n")
    if every:
        _print_mutants(record["drawn"])
    _print(record)
    return FINE


def _removals(json_file: Path | None, jobs: int) -> int:
    from conformance.sensitivity.removed_features import removals_record, try_removals
    from conformance.suite.case import CaseError, find_cases

    with as_input_errors(CaseError):
        cases = [case for case in find_cases() if case.phase == "run"]
    with progress_bar("removing features", len(cases)) as bar:
        record = removals_record(try_removals(cases, jobs, bar))
    write_json({"bench": "conform", "removed": record}, json_file)
    for one in record["unnoticed"]:
        say(f"Passes without {one['feature']}: {one['case']}")
    Console(highlight=False).print(
        f"{record['removed']:,} times a feature that its title names was removed from a case; "
        f"{len(record['unnoticed']):,} times it passed nevertheless"
    )
    return FINE


def _rows(drawn: Mapping[str, Any]) -> str:
    """Return a row for each mutant that no case detects."""
    keys = ("fate", "file", "line", "function", "was", "now", "case", "reached", "changed", "why")
    rows = [one for one in drawn.get("trials", ()) if one["fate"] not in ("red", "invalid")]
    lines = sorted({"\t".join(str(one[key]) for key in keys) for one in rows})
    return "\n".join(["\t".join(keys), *lines, ""])


def _print_mutants(drawn: Mapping[str, Any]) -> None:
    fates = ("red", "soft", "survived", "equivalent", "invalid")
    rows = []
    for one in drawn["seeds"]:
        rows.append((f"seed {one['seed']}", one))
        rows += [(f"  {row['package']}", row) for row in one["packages"]]
    if len(drawn["seeds"]) > 1:
        rows += [(row["package"], row) for row in drawn["packages"]]
    rows.append(("all", drawn))
    print_figures(
        ("mutants of", "drawn", *fates, "red"),
        [
            (name, *(f"{row[key]:,}" for key in ("mutants", *fates)), f"{row['share']:.1%}")
            for name, row in rows
        ],
        f"of {drawn['red']:,} red ones {drawn['by_profile']:,} only break laws of our simulator "
        "(docs/motion.md), which rest on no rule of KRL",
        f"of {drawn['survived']:,} that survived, {drawn['unreached']:,} are on lines that no case "
        f"runs; {drawn['unchanged']:,} change nothing that can be seen of the cases tried",
        f"{drawn['unsure']:,} that no case detects are on lines that only cases of unconfirmed "
        "rules run",
        f"aim: {drawn['aim']:.0%} of those that a case could notice red",
    )


def _print(record: Mapping[str, Any]) -> None:
    keys = ("mutants", "killed", "failing")
    print_figures(
        ("faults in", "planted", "found", "by a failure", "share"),
        [
            (row["group"], *(f"{row[key]:,}" for key in keys), f"{row['share']:.1%}")
            for row in (*record["groups"], {"group": "all", **record})
        ],
    )
    say(
        f"{record['cases_per_s']:,.1f} cases a second ({record['cases']:,} cases, "
        f"{record['executor']}, robot {record['robot']}); aim {record['aim']:.0%} of faults found"
    )
    for one in record["survivors"]:
        say(f"Not found: {one['group']}: {one['fault']}")
