"""`krl bench programs`: which main programs of controllers' backups run to their end."""

import time
from collections import Counter
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich import box
from rich.console import Console
from rich.table import Table

from krl.commands.run import Executor, Robot
from krl.errors import FINDINGS, FINE, InputError, one_line
from krl.options import JsonOption, ProgramsArgument, programs_or_ours
from krl.output_files import check_files, write_json
from krl.program_loading import sources_below
from krl.progress import progress_bar

if TYPE_CHECKING:
    from grammar.syntax.source import Source
    from interp.bench.main_programs import MainProgram

__all__ = ["programs"]

_RESULTS = {
    "end": "to its end",
    "halt": "to a HALT",
    "waits": "waits for ever",
    "goes on": "never ends",
    "fault": "a fault",
    "unlinked": "needs what no file has",
    "refused": "cannot begin",
    "budget": "out of statements",
    "crash": "a defect of ours",
}

#: What a program does that has nothing left to do.
_SERVED = ("end", "halt", "waits", "goes on")


def programs(
    paths: ProgramsArgument = None,
    executor: Annotated[
        Executor | None, typer.Option(help="Default: native, or vm where that was not built.")
    ] = None,
    robot: Annotated[Robot, typer.Option(help="What moves.")] = Robot.NONE,
    scripts: Annotated[
        Path | None,
        typer.Option(
            metavar="DIR",
            help="Scripts: DIR/ARCHIVE.io for all programs of an archive, DIR/NAME.io for one.",
        ),
    ] = None,
    every: Annotated[
        bool,
        typer.Option("--every", help="Programs without machine data of their own too."),
    ] = False,
    strict: Annotated[
        bool, typer.Option("--strict", help="Nothing stands in for what a backup lacks.")
    ] = False,
    max_time: Annotated[
        float, typer.Option(min=0.0, metavar="S", help="Virtual time for each program.")
    ] = 600.0,
    json_file: JsonOption = None,
) -> int:
    """Run the main programs of backups with their own machine, tools, bases and points.

    Their submit program runs beside them; somebody goes on after a HALT and acknowledges messages.
    The inputs that a WAIT FOR waits for come after 1 s, but for those that a script sets itself. A
    program waits when its arm has stood for 20 s. What a backup lacks stands in, as in `krl run`.
    Exit status 1 after a defect of ours.
    """
    from interp.bench.main_programs import main_programs, run_main, survey_profile
    from interp.controller.input_script import ScriptError
    from interp.executors import available
    from interp.session import RunSetup

    check_files(json_file)
    origins: dict[str, list[Source]] = {}
    for origin, source in sources_below(programs_or_ours(paths)):
        origins.setdefault(origin, []).append(source)
    setup = RunSetup(
        executor=executor.value if executor is not None else available()[-1],
        robot=robot.value,
        profile=survey_profile(),
        until=round(max_time * 1e6),
        is_tolerant=not strict,
    )
    rows: list[dict[str, Any]] = []
    unread: list[dict[str, str]] = []
    with progress_bar("running programs") as bar:
        for origin, sources in origins.items():
            mains, left = main_programs(sources, stands_in=not strict)
            unread += [{"path": path, "reason": reason} for path, reason in left]
            wanted = [main for main in mains if every or main.has_machine]
            bar.expect(len(wanted))
            for main in wanted:
                before = time.perf_counter()
                try:
                    ran = run_main(main, setup, _script(scripts, origin, main))
                except ScriptError as error:
                    raise InputError(f"--scripts: {error}") from error
                wall = round(time.perf_counter() - before, 3)
                rows.append({"origin": origin, "path": main.path, **asdict(ran), "wall": wall})
                bar()
    record = {
        "bench": "programs",
        "executor": setup.executor,
        "robot": setup.robot,
        "results": dict(Counter(row["result"] for row in rows)),
        "moved": sum(row["motions"] > 0 for row in rows),
        "served": sum(row["result"] in _SERVED for row in rows),
        "programs": rows,
        "unread": unread,
    }
    write_json(record, json_file, indent=1)
    _print(record)
    return FINDINGS if "crash" in record["results"] else FINE


def _script(folder: Path | None, origin: str, main: "MainProgram") -> str:
    """What the inputs of a program do, from the files for its archive and for itself."""
    if folder is None:
        return ""
    if not folder.is_dir():
        raise InputError(f"--scripts: {folder}: no such folder")
    names = (Path(origin).name, Path(main.path).stem)
    files = [folder / f"{name}.io" for name in names]
    return "\n".join(file.read_text(encoding="utf-8") for file in files if file.is_file())


def _print(record: Mapping[str, Any]) -> None:
    console = Console(highlight=False)
    rows = record["programs"]
    console.print(
        f"{len(rows):,} main programs on the robot {record['robot']}, {record['executor']}; "
        f"{len(record['unread']):,} files that cannot be read",
        soft_wrap=True,
    )
    for origin in dict.fromkeys(row["origin"] for row in rows):
        console.print(one_line(origin), soft_wrap=True, markup=False)
        table = Table(box=box.SIMPLE_HEAD, show_edge=False, pad_edge=False)
        table.add_column("program")
        table.add_column("ran")
        table.add_column("virtual s", justify="right")
        table.add_column("motions", justify="right")
        table.add_column("skipped", justify="right")
        table.add_column("stood in", justify="right")
        table.add_column("inputs", justify="right")
        table.add_column("where and why", overflow="fold")
        for row in (row for row in rows if row["origin"] == origin):
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
    counts = record["results"]
    told = [f"{words}: {counts[name]:,}" for name, words in _RESULTS.items() if name in counts]
    console.print("; ".join(told), soft_wrap=True)
    if rows:
        moved, served = (record[name] / len(rows) for name in ("moved", "served"))
        console.print(f"{moved:.0%} executed a motion, {served:.0%} ended or serve for ever")
