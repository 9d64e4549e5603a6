"""`krl bench programs`: which main programs of controllers' backups run to their end."""

from collections.abc import Mapping
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich import box
from rich.console import Console
from rich.table import Table

from krl.errors import FINDINGS, FINE, one_line, say
from krl.running.project_sources import sources_below
from krl.running.run_options import ExecutorOption, Robot
from krl.terminal.options import (
    JobsOption,
    JsonOption,
    ProgramsArgument,
    all_cores,
    programs_or_ours,
)
from krl.terminal.output_files import check_files, write_json
from krl.terminal.progress import progress_bar

if TYPE_CHECKING:
    from grammar.syntax.source import Source
    from interp.bench.program_survey import Origin, SurveyedOrigin

_RESULTS = {
    "end": "to its end",
    "halt": "to a HALT",
    "waits": "waits for ever",
    "goes on": "never ends",
    "moves": "still moves",
    "fault": "a fault",
    "unlinked": "needs what no file has",
    "refused": "cannot begin",
    "budget": "out of statements",
    "cpu": "out of CPU time",
    "crash": "a defect of ours",
}

#: The most lines with different faults that are printed for an origin; the record has all.
_MOST_FAULTS = 5


class Part(StrEnum):
    """How much of a project a backup contains."""

    WHOLE = "whole"
    MODULES = "modules"
    CODE = "code"
    FILE = "file"


def _kinds(value: str) -> str:
    """Return the value of ``--damage`` if each of its kinds is valid."""
    from grammar.bench.damage import DAMAGES

    kinds = list(DAMAGES) if value == "all" else value.split(",")
    if value and not DAMAGES.keys() >= set(kinds):
        raise typer.BadParameter(f"kinds are {', '.join(DAMAGES)} and all")
    return ",".join(kinds)


def programs(
    paths: ProgramsArgument = None,
    executor: ExecutorOption = None,
    robot: Robot = Robot.NONE,
    strict: bool = False,
    max_time: Annotated[float, typer.Option(min=0.0, metavar="S")] = 600.0,
    max_cpu: Annotated[float, typer.Option(min=0.0, metavar="S")] = 30.0,
    jobs: JobsOption = None,
    cache: Annotated[Path | None, typer.Option(metavar="DIR")] = None,
    json_file: JsonOption = None,
    part: Part = Part.WHOLE,
    damage: Annotated[str, typer.Option(metavar="KIND,…", callback=_kinds)] = "",
    sample: Annotated[float, typer.Option(min=0, max=1, metavar="SHARE")] = 1.0,
    seed: int = 1,
) -> int:
    """Run the main programs of backups with their own machine, tools, bases and points.

    The submit program runs too; START after a HALT and acknowledgements are simulated. Inputs that
    a WAIT FOR needs arrive after 1 s. A program counts as waiting once
    its arm has stood still for 20 s. Stand-ins replace what a backup lacks, as in `krl run`. Each
    origin is shown as soon as its programs have run. Exit status 1 after a defect of the workbench.

    Options:
        robot: The arm that moves.
        strict: Use no stand-ins for what a backup lacks.
        max_time: Virtual time for each program.
        max_cpu: CPU time for each program.
        cache: Reuse results of unchanged programs from here.
        part: How much of a backup to use: all, its users' modules, no data lists, or each .src
            alone.
        damage: Run all once more with three of ten files damaged: files (lost), lists (data lists
            lost), cut, lines (lost), names (misspelt), characters (exchanged), latin (wrong
            encoding), or all of these.
        sample: Run this share of the programs, at random.
        seed: Seed of programs and damage.
    """
    from interp.bench.program_survey import RandomSample, RunBounds, damaged, remaining, survey
    from interp.bench.program_survey_record import survey_record
    from interp.executors import available

    check_files(json_file)
    bounds = RunBounds(
        executor=executor.value if executor is not None else available()[-1],
        robot=robot.value,
        until=round(max_time * 1e6),
        cpu=max_cpu,
        stands_in=not strict,
        sample=RandomSample(sample, seed),
    )
    whole = _origins(programs_or_ours(paths))
    left = remaining(whole, part.value)
    kinds = ["", *damage.split(",")] if damage else [""]
    origins = list(damaged(left, kinds, seed))
    console = Console(highlight=False)
    finished: dict[Origin, SurveyedOrigin] = {}
    expected = 0

    def record() -> dict[str, Any]:
        """Return the record of what has run, in the order of the origins."""
        done = [finished[one] for one in origins if one in finished]
        return survey_record(done, bounds, part.value, seed)

    with progress_bar("running programs") as bar:

        def on_found(count: int) -> None:
            """More programs are known of."""
            nonlocal expected
            expected += count
            bar.expect(expected)

        for done in survey(
            origins, bounds, jobs=all_cores(jobs), cache=cache, on_found=on_found, on_done=bar
        ):
            finished[done.origin] = done
            write_json(record(), json_file, indent=1)
            _print_origin(console, done)
    write_json(last := record(), json_file, indent=1)
    _print_summary(last)
    return FINDINGS if "crash" in last["results"] else FINE


def _origins(paths: list[Path]) -> "list[Origin]":
    """Return the origins to survey."""
    from interp.bench.program_survey import Origin

    files: dict[str, list[Source]] = {}
    for origin, source in sources_below(paths):
        files.setdefault(origin, []).append(source)
    return [Origin(name, tuple(sources)) for name, sources in files.items()]


def _print_origin(console: Console, done: "SurveyedOrigin") -> None:
    if not done.rows:
        return
    damage = f" ({done.origin.damage})" if done.origin.damage else ""
    say(done.origin.name + damage)
    table = Table(box=box.SIMPLE_HEAD, show_edge=False, pad_edge=False)
    for heading in ("program", "ran"):
        table.add_column(heading)
    for heading in ("virtual s", "motions", "skipped", "stand-ins", "inputs"):
        table.add_column(heading, justify="right")
    table.add_column("where and why", overflow="fold")
    for row in done.rows:
        where = "" if row["result"] == "end" else f"{row['at'].rpartition('/')[2]} "
        table.add_row(
            one_line(row["path"].rpartition("/")[2]),
            _RESULTS[row["result"]],
            f"{row['seconds']:,.1f}",
            f"{row['motions']:,}",
            f"{row['skipped']:,}",
            f"{len(row['stood_in']):,}",
            f"{row['inputs']:,}",
            one_line(where + row["reason"]),
        )
    console.print(table)
    faults = list(dict.fromkeys(fault for row in done.rows for fault in row["own_faults"]))
    for fault in faults[:_MOST_FAULTS]:
        say(f"own fault: {fault}")
    if len(faults) > _MOST_FAULTS:
        console.print(f"own fault: {len(faults) - _MOST_FAULTS:,} more lines")


def _print_summary(record: Mapping[str, Any]) -> None:
    rows = record["programs"]
    say(
        f"{len(rows):,} main programs on the robot {record['robot']}, {record['executor']}; "
        f"{len(record['unread']):,} files that cannot be read"
    )
    counts = record["results"]
    counted = [f"{words}: {counts[name]:,}" for name, words in _RESULTS.items() if name in counts]
    say("; ".join(counted))
    if rows:
        moved, served = (record[name] / len(rows) for name in ("moved", "served"))
        say(
            f"{moved:.0%} executed a motion, {served:.0%} ended or serve for ever, "
            f"{record['own_faults'] / len(rows):.0%} have a fault of their own"
        )
    for one in record["damages"] if len(record["damages"]) > 1 else ():
        moved, served = (one[name] / one["programs"] for name in ("moved", "served"))
        say(
            f"{one['damage'] or 'not damaged'}: {one['programs']:,} programs, {moved:.0%} executed "
            f"a motion, {served:.0%} ended or serve for ever"
        )
