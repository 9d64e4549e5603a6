"""`krl growth`: the effect of each construct of the ledger on a corpus."""

from collections.abc import Sequence
from datetime import UTC, datetime
from importlib import metadata
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich import box
from rich.console import Console
from rich.table import Table
from rich.text import Text

from krl.errors import FINE, InputError, one_line, say
from krl.terminal.options import CorpusArgument, JobsOrOneOption, JsonTooOption, corpus_or_ours
from krl.terminal.output_files import check_targets, write_json
from krl.terminal.progress import progress_bar
from krl.terminal.survey_summary import percentage
from reports.rendering.number_format import counted

if TYPE_CHECKING:
    from recovery.record.record_types import GrowthRecord, StepRecord

_DEFAULT_OUT = Path("reports", "out", "growth")
_BIGGEST = 14
_LEFT = 5


def growth(
    paths: CorpusArgument = None,
    out: Annotated[Path, typer.Option(metavar="DIR")] = _DEFAULT_OUT,
    json_file: JsonTooOption = None,
    jobs: JobsOrOneOption = None,
    constructs: Annotated[Path | None, typer.Option(metavar="DIR")] = None,
) -> int:
    """Replay the ledger over KRL source: parse rate and metrics of the grammar, step by step.

    Options:
        out: Where index.html and growth.json go.
        constructs: The ledger; default: that of the current grammar.
    """
    from grammar.notation.generate import GRAMMAR
    from recovery.growth.growth import growth as replayed
    from recovery.ledger.ledger import Ledger, preliminary_of, replay
    from reports.recovery.growth_page import write_growth_page

    roots = corpus_or_ours(paths)
    if constructs is not None and not constructs.is_dir():
        raise InputError(f"{constructs}: not a folder")
    check_targets(out, json_file)
    start = preliminary_of(GRAMMAR.with_name("preliminary.g4"))
    ledger = Ledger.read(constructs or GRAMMAR.with_name("constructs"))
    steps = replay(start, ledger.accepted)
    with progress_bar("replaying") as bar:
        record = replayed(
            roots,
            start,
            steps,
            jobs=jobs,
            cache=out / "cache",
            on_found=bar.expect,
            on_done=bar,
        )
    record["grammar"] = "grammar/KRL.g4" if constructs is None else constructs.as_posix()
    record["version"] = metadata.version("krl-workbench")
    record["generated"] = datetime.now(UTC).isoformat(timespec="seconds")
    page = write_growth_page(record, out)
    write_json(record, out / "growth.json")
    write_json(record, json_file)
    _print(record, page)
    return FINE


def _print(record: "GrowthRecord", page: Path) -> None:
    """Print the first, the last and the biggest steps, and what remains."""
    console = Console(highlight=False, markup=False, emoji=False)
    steps = record["steps"]
    first, last = steps[0], steps[-1]
    say(
        f"{counted(record['files'], 'file')}, {record['bytes'] / 1e6:.2f} MB; "
        f"{counted(len(steps) - 1, 'construct')}; "
        f"parsed {first['parsed']:,} at the start, {last['parsed']:,} at the end "
        f"({percentage(last['parsed'], last['files'])} of files, "
        f"{percentage(last['parsed_bytes'], last['bytes'])} of bytes); {record['seconds']:.1f} s"
    )
    console.print(_table(steps))
    ambiguous, look = record["ambiguous"], record["lookahead"]
    say(
        f"Of {look['decisions']} decisions {look['one']:.1f} % are taken on one token, "
        f"{look['two']:.1f} % on at most two; {ambiguous['lines']:,} of {ambiguous['of']:,} lines "
        "have two readings."
    )
    left = record["remaining_files"]
    for file in left[:_LEFT]:
        why = f"{file['kind']}: {file['reason']}" if file["kind"] else "open"
        say(f"remains: {one_line(file['path'])}: {one_line(why)}")
    if len(left) > _LEFT:
        console.print(f"… and {len(left) - _LEFT} more files remain")
    say(f"Page: {one_line(str(page))}")


def _table(steps: "Sequence[StepRecord]") -> Table:
    """Return the first step, the last one, and those that restored most files, in order."""
    biggest = sorted(steps[1:], key=lambda step: -step["restored"])[:_BIGGEST]
    shown = {0, len(steps) - 1} | {
        number for number, step in enumerate(steps) if step["restored"] and step in biggest
    }
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, expand=True)
    table.add_column("", justify="right", no_wrap=True)
    table.add_column("construct", no_wrap=True, overflow="ellipsis", ratio=3)
    table.add_column("grounds", no_wrap=True, overflow="ellipsis", ratio=2)
    for heading in ("restores", "files", "bytes", "failing lines"):
        table.add_column(heading, justify="right", no_wrap=True, min_width=len(heading))
    before = -1
    for number in sorted(shown):
        step = steps[number]
        if number > before + 1:
            table.add_row("…", *[""] * 6)
        before = number
        broken = f" −{step['broken']:,}" if step["broken"] else ""
        table.add_row(
            str(step["number"]),
            Text(one_line(step["title"])),
            ", ".join(step["grounds"]),
            f"{step['restored']:,}{broken}" if number else "",
            percentage(step["parsed"], step["files"]),
            percentage(step["parsed_bytes"], step["bytes"]),
            f"{step['failing_lines']:,}",
        )
    return table
