"""`krl bench scale`: what large corpora cost, in time and memory."""

import math
import os
import tempfile
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any, Final

import typer

from krl.errors import BAD_INPUT, FINE, InputError, as_input_errors, run, say
from krl.terminal.options import JsonOption, ProgramsArgument, programs_or_ours
from krl.terminal.output_files import check_files, write_json
from krl.terminal.progress import progress_bar
from krl.terminal.text_table import print_figures
from support.measure.isolated import call_isolated
from support.measure.speed import MB, machine

_LARGEST: Final = 2_000
#: What is measured.
_COMMANDS: Final = {
    "recover": "recover --jobs 1 --no-start --out {out} {corpus}",
    "check": "check --jobs 1 --no-cache {corpus}",
}


def scale(
    paths: ProgramsArgument = None,
    json_file: JsonOption = None,
    sizes: Annotated[str, typer.Option(metavar="MB,…")] = "10,20,40",
    command: Annotated[list[str] | None, typer.Option(metavar="NAME")] = None,
    seed: int = 1,
) -> int:
    """Measure CPU time and memory of recover and check on corpora of growing size.

    A corpus is written to a temporary folder: copies of the programs, with other names and numbers
    and some routines left out, and a tenth random programs. One process on one core at a time.

    Options:
        sizes: Sizes of the corpora, such as 20,80 or 40,1000.
        command: Only recover, or only check; repeatable.
        seed: Seed of the corpora.
    """
    check_files(json_file)
    wanted = _sizes(sizes)
    commands = command or list(_COMMANDS)
    for name in commands:
        if name not in _COMMANDS:
            raise InputError(f"--command {name}: not one of {', '.join(_COMMANDS)}")
    roots = programs_or_ours(paths)
    record: dict[str, Any] = {"bench": "scale", **machine(), "seed": seed, "rows": []}
    with progress_bar("measuring", len(wanted) * len(commands)) as advance:
        for size in wanted:
            with tempfile.TemporaryDirectory() as folder:
                corpus, out = Path(folder, "corpus"), Path(folder, "out")
                call_isolated(_write, roots, corpus, round(size * MB), seed)
                files = [file.stat().st_size for file in corpus.rglob("*") if file.is_file()]
                given = {"files": len(files), "bytes": sum(files)}
                out.mkdir()
                for name in commands:
                    row = {"command": name, **given, **_measured(name, corpus, out)}
                    record["rows"].append(row)
                    record |= _growth(record["rows"])
                    write_json(record, json_file, indent=1)
                    advance()
    _print(record)
    return FINE


def _sizes(given: str) -> list[float]:
    """Return the sizes in MB from a list with commas, in ascending order."""
    try:
        sizes = sorted(float(size) for size in given.split(","))
    except ValueError:
        sizes = [0]
    if not all(0 < size <= _LARGEST for size in sizes):
        raise InputError(f"--sizes {given}: not a list of MB, each above 0 and up to {_LARGEST:,}")
    return sizes


def _write(roots: Sequence[Path], corpus: Path, size: int, seed: int) -> None:
    from recovery.bench.copies import write_corpus

    with as_input_errors(ValueError):
        write_corpus(roots, corpus, size, seed)


def _measured(name: str, corpus: Path, out: Path) -> dict[str, Any]:
    """Return the figures of a command on the corpus; ``page_bytes`` only if it writes a page."""
    words = [word.format(corpus=corpus, out=out) for word in _COMMANDS[name].split()]
    status, seconds, peak = call_isolated(_run, words)
    if status == BAD_INPUT:
        raise InputError(f"krl {' '.join(words)}: ended with status {status}")
    page = out / "index.html"
    size = page.stat().st_size if "{out}" in _COMMANDS[name] else None
    return {"seconds": seconds, "peak_bytes": peak, "page_bytes": size}


def _run(words: list[str]) -> tuple[int, float, int]:
    """Return exit status, CPU seconds and peak memory in bytes of a command, in this process."""
    from krl.commands.app import app
    from support.measure.peak_memory import peak_memory

    with Path(os.devnull).open("w") as nowhere:
        for stream in (1, 2):
            os.dup2(nowhere.fileno(), stream)
        status = run(app(*words), words)
    return status, time.process_time(), peak_memory() or 0


def _growth(rows: Sequence[Mapping[str, Any]]) -> dict[str, float]:
    """Return how CPU time and memory of each command grow from the first size to the last."""
    found = {}
    for name in _COMMANDS:
        of_one = [row for row in rows if row["command"] == name]
        if of_one and of_one[-1]["bytes"] > of_one[0]["bytes"]:
            size, seconds, peak = (
                of_one[-1][key] / of_one[0][key] for key in ("bytes", "seconds", "peak_bytes")
            )
            found[f"{name}_exponent"] = math.log(seconds) / math.log(size)
            found[f"{name}_memory_growth"] = peak
    return found


def _print(record: Mapping[str, Any]) -> None:
    print_figures(
        ("command", "files", "MB", "CPU s", "s/MB", "peak memory", "page"),
        [
            (
                row["command"],
                f"{row['files']:,}",
                f"{row['bytes'] / MB:,.0f}",
                f"{row['seconds']:,.1f}",
                f"{row['seconds'] * MB / row['bytes']:.2f}",
                f"{row['peak_bytes'] / MB:,.0f} MB",
                "–" if row["page_bytes"] is None else f"{row['page_bytes'] / MB:,.1f} MB",
            )
            for row in record["rows"]
        ],
    )
    for name in _COMMANDS:
        if f"{name}_exponent" in record:
            say(
                f"{name}: exponent of CPU time over size {record[f'{name}_exponent']:.2f}, last to "
                f"first memory {record[f'{name}_memory_growth']:.2f}"
            )
