"""Options and arguments that several commands share, and what they mean if nothing is named."""

import os
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from krl.errors import InputError

if TYPE_CHECKING:
    from recovery.negatives.negatives import Negative

#: More processes would need more open files than most systems allow.
_MOST_JOBS = 256
#: The file for a command's record; `output_files.check_files` checks it in advance.
JsonOption = Annotated[
    Path | None, typer.Option("--json", metavar="FILE", help="Write the record to FILE.")
]
#: The same for commands that write the record into a folder anyway.
JsonTooOption = Annotated[
    Path | None, typer.Option("--json", metavar="FILE", help="Also write the record to FILE.")
]
JobsOption = Annotated[
    int | None,
    typer.Option(min=1, max=_MOST_JOBS, metavar="N", help="Processes; default: one per core."),
]
#: The same for commands that do little work in this process.
JobsOrOneOption = Annotated[
    int | None,
    typer.Option(
        min=1,
        max=_MOST_JOBS,
        metavar="N",
        help="Processes; default: one per core, or one for little input.",
    ),
]
#: The programs that a bench measures; see `programs_or_ours`.
ProgramsArgument = Annotated[
    list[Path] | None,
    typer.Argument(
        metavar="[PATH]...", help="Files, folders, .zip archives; default: the programs in corpus/."
    ),
]

#: The files that are surveyed; see `corpus_or_ours`.
CorpusArgument = Annotated[
    list[Path] | None,
    typer.Argument(
        metavar="[PATH]...", help="Files, folders, .zip archives of controllers; default: corpus/."
    ),
]

_CORPUS = Path("corpus")
_NEGATIVES = Path("corpus", "negatives")
_OURS = (Path("corpus", "programs"), Path("corpus", "open"))


def scheduler_option(work: str) -> Any:
    """Return the option for a Dask cluster whose workers do this work."""
    help_text = f"A trusted Dask cluster (it can run code here) whose workers {work}."
    return typer.Option(metavar="ADDRESS", help=help_text)


def all_cores(jobs: int | None) -> int:
    """Return the requested number of processes; the default is one for each core."""
    return jobs or os.cpu_count() or 1


def programs_or_ours(paths: list[Path] | None) -> list[Path]:
    """Return the named paths, or the programs of the corpus in the working folder.

    Raises `InputError` if nothing is named and there is no corpus.
    """
    return paths or _there(_OURS)


def corpus_or_ours(paths: list[Path] | None) -> list[Path]:
    """Return the named paths, or the whole corpus in the working folder.

    Raises `InputError` if nothing is named and there is no corpus.
    """
    return paths or _there([_CORPUS])


def _there(folders: Iterable[Path]) -> list[Path]:
    roots = [folder for folder in folders if folder.is_dir()]
    if not roots:
        raise InputError("there is no corpus/ here: name files, folders or .zip archives")
    return roots


def negatives_or_ours(folder: Path | None = None) -> "tuple[Negative, ...]":
    """Return the negatives below a folder; by default those of a checkout, if there is one.

    Raises `recovery.negatives.negatives.NegativeError`.
    """
    from recovery.negatives.negatives import load

    return load(folder or _NEGATIVES) if folder or _NEGATIVES.is_dir() else ()
