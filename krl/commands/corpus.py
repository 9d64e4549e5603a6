"""`krl corpus`: the programs that the survey reads, which are ours, public or synthetic."""

import re
import shutil
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from krl.errors import FINDINGS, FINE, InputError, as_input_errors, say
from krl.terminal.options import Commands
from krl.terminal.text_table import print_columns
from reports.rendering.number_format import counted

if TYPE_CHECKING:
    from recovery.corpus.public import PublicSource

#: In the working folder: the corpus is data of a checkout and does not travel with the package.
CORPUS = Path("corpus")

_SYNTHETIC = Path("reports", "out", "synth")
_UNITS = {"": 1, "k": 1_000, "m": 1_000_000, "g": 1_000_000_000}

app = Commands(help="List the programs of the corpus, fetch the public ones, make others.")


@app.command("list")
def show() -> int:
    """List our own programs and the public repositories, and which files are here."""
    from recovery.corpus.public import absent

    sources = _sources()
    typer.echo(f"Own programs in {CORPUS / 'programs'}")
    cells = list(_own_cells(CORPUS / "programs"))
    own = ((name, counted(files, "file"), _kilobytes(size)) for name, files, size in cells)
    _print_rows(own)
    typer.echo("\nPublic repositories, which belong to their authors")
    rows = []
    for source in sources:
        missing = len(absent(source, CORPUS / "open"))
        here = f"{len(source.files) - missing} here" if missing else "all here"
        count = counted(len(source.files), "file")
        rows.append((*_heading(source), source.generation, count, _kilobytes(source.size), here))
    _print_rows(rows)
    return FINE


@app.command("fetch")
def fetch(
    mirror: Annotated[Path | None, typer.Option(metavar="DIR")] = None,
    out: Annotated[Path, typer.Option(metavar="DIR")] = CORPUS / "open",
) -> int:
    """Fetch the KRL files of the public repositories, each verified by its checksum.

    The files belong to other people. Exit status 1 if a file could not be fetched.

    Options:
        mirror: Use git mirrors of the repositories in this folder (OWNER/NAME, OWNER__NAME or
            OWNER+NAME), not the network.
        out: Where to write, one folder per repository.
    """
    from krl.terminal.progress import progress_bar
    from recovery.corpus import public

    sources = _sources()
    if shutil.which("git") is None:
        raise InputError("fetching needs git, and there is none on the PATH")
    if mirror is not None and not mirror.is_dir():
        raise InputError(f"{mirror}: no such folder of mirrors")
    if out.exists() and not out.is_dir():
        raise InputError(f"{out}: not a folder")
    typer.echo(
        "These files belong to their authors, under the licence named here. Where none is stated,\n"
        "all rights are theirs: read and measure the files, and do not pass them on."
    )
    wanted = sum(len(source.files) for source in sources)
    with progress_bar("fetching", wanted) as advance:
        results = [public.fetch(source, out, mirror, advance) for source in sources]
    rows = []
    for result in results:
        share = f"{result.written + result.kept} of {counted(len(result.source.files), 'file')}"
        rows.append((*_heading(result.source), share))
    _print_rows(rows)
    problems = [problem for result in results for problem in result.problems]
    for problem in problems:
        say(f"missing: {problem}", err=True)
    written = sum(result.written for result in results)
    had = written + sum(result.kept for result in results)
    say(f"{had} of {wanted} files in {out}, {written} of them new")
    return FINDINGS if problems else FINE


@app.command("synth")
def synth(
    paths: Annotated[list[Path] | None, typer.Argument(metavar="[PATH]...")] = None,
    size: Annotated[str, typer.Option(metavar="BYTES")] = "1MB",
    seed: int = 1,
    out: Annotated[Path | None, typer.Option(metavar="DIR")] = None,
) -> int:
    """Write programs in whole cells, for tests of scale.

    Copies of the programs, with other names and numbers and some routines left out, and a tenth
    random programs; where there is no corpus/ and none is named, all are random. The same programs,
    size and seed give the same files everywhere. They are not evidence for a grammar.

    Options:
        paths: Programs to copy: files, folders, .zip archives; default: corpus/programs.
        size: Total size: 500000, 300kB, 10MB, 1.5GB.
        seed: Seed of the programs.
        out: Where to write; default: a folder in reports/out/synth.
    """
    from krl.terminal.progress import progress_bar
    from recovery.bench.copies import write_corpus

    wanted = _bytes(size)
    folder = out or _SYNTHETIC / f"{wanted}-{seed}"
    if folder.exists() and not folder.is_dir():
        raise InputError(f"{folder}: not a folder")
    ours = CORPUS / "programs"
    roots = paths or ([ours] if ours.is_dir() else [])
    with progress_bar("writing", wanted) as advance, as_input_errors(ValueError):
        written = write_corpus(roots, folder, wanted, seed, advance)
    files, cells = counted(written.files, "file"), counted(written.cells, "cell")
    say(f"{written.bytes:,} bytes in {files} of {cells} in {folder}")
    others = sum(path.is_file() for path in folder.rglob("*")) - written.files
    if others:
        beside = counted(others, "file")
        say(f"{folder} has {beside} beside them, from before", err=True)
    return FINE


def _bytes(text: str) -> int:
    """Return the number of bytes of a size such as ``10 MB``; kB is 1,000."""
    found = re.fullmatch(r"([0-9]+(?:\.[0-9]+)?) ?([kmg]?)b?", text.strip(), re.IGNORECASE)
    size = int(float(found[1]) * _UNITS[found[2].lower()]) if found else 0
    if size < 1:
        raise InputError(f"--size {text}: not a number of bytes such as 500000, 300kB or 10MB")
    return size


def _sources() -> "tuple[PublicSource, ...]":
    from recovery.corpus.public import SourceListError, read_sources

    if not CORPUS.is_dir():
        raise InputError(f"no {CORPUS} folder here: run this in a checkout of the workbench")
    with as_input_errors(SourceListError):
        return read_sources(CORPUS)


def _own_cells(programs: Path) -> Iterator[tuple[str, int, int]]:
    """Yield name, number of files and bytes of each cell, which is a folder or an archive."""
    for cell in sorted(programs.iterdir()) if programs.is_dir() else ():
        files = [path for path in cell.rglob("*") if path.is_file()] if cell.is_dir() else [cell]
        yield cell.name, len(files), sum(path.stat().st_size for path in files)


def _heading(source: "PublicSource") -> tuple[str, str]:
    licence = "no licence stated" if source.licence == "none" else source.licence
    return source.repository, licence


def _kilobytes(size: int) -> str:
    return f"{size / 1000:,.0f} kB"


def _print_rows(rows: Iterable[Sequence[str]]) -> None:
    print_columns(*([*rows] or [("none",)]))
