"""Options of commands: how they are declared, those that several commands share, their defaults.

A command declares an option by a parameter with its type, and describes it in the section
``Options:`` of its docstring. A parameter whose type is a dataclass stands for an option of each
field, described in the docstring of that class. `typer.Option` is only needed for more: limits,
another name; `typer.Argument` makes an argument of a parameter.
"""

import inspect
import os
import re
from collections.abc import Callable, Iterable, Mapping
from copy import copy
from dataclasses import is_dataclass
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, get_args

import typer

from krl.errors import InputError

if TYPE_CHECKING:
    from recovery.negatives.negatives import Negative

_DESCRIBED = re.compile(r"^    (\w+): (.*(?:\n     +.*)*)", re.MULTILINE)
#: What help calls the value of an option that does not say it itself, by a part of its type.
_METAVARS: Mapping[Any, str] = {int: "N", float: "N", Path: "FILE"}

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


class Commands(typer.Typer):
    """A group of commands that describe their options in their docstrings."""

    def command(self, name: str | None = None, **more: Any) -> Callable[..., Any]:
        """Return a decorator that adds a command."""

        def add(command: Callable[..., Any]) -> Callable[..., Any]:
            """Add a command, and return it as it is."""
            super(Commands, self).command(name, **more)(_with_options(command))
            return command

        return add


def _descriptions(documented: object) -> tuple[str, Mapping[str, str]]:
    """Return a docstring without its section ``Options:``, and what that says of each option."""
    text, _, listed = (inspect.getdoc(documented) or "").partition("\n\nOptions:\n")
    return text, {name: " ".join(said.split()) for name, said in _DESCRIBED.findall(listed)}


def _as_option(name: str, annotation: Any, said: str | None) -> Any:
    """Return the annotation of a parameter as typer needs it for an option with this help."""
    kind, *given = get_args(annotation) if hasattr(annotation, "__metadata__") else (annotation,)
    info = copy(given[0]) if given else typer.Option()
    info.help = said or info.help
    if isinstance(info, typer.models.OptionInfo):
        if info.default is ...:  # where typer keeps the first name; a bool gets no second one
            info.default = f"--{name.rstrip('_').replace('_', '-')}"
        parts = (kind, *get_args(kind))
        info.metavar = info.metavar or next(filter(None, map(_METAVARS.get, parts)), None)
    return Annotated[kind, info]


def _is_group(annotation: Any) -> bool:
    """Return whether a parameter with this annotation stands for several options."""
    return is_dataclass(annotation)


def _options_of(one: inspect.Parameter, said: Mapping[str, str]) -> list[inspect.Parameter]:
    """Return the parameters that typer needs for a parameter of a command: options with help."""
    kind: Any = one.annotation
    parameters = [one]
    if _is_group(kind):
        _, said = _descriptions(kind)
        parameters = [*inspect.signature(kind, eval_str=True).parameters.values()]
    return [
        each.replace(
            kind=one.kind, annotation=_as_option(each.name, each.annotation, said.get(each.name))
        )
        for each in parameters
    ]


def _with_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Return a command whose parameters are options, with the help that its docstring gives."""
    text, said = _descriptions(command)
    own = inspect.signature(command, eval_str=True)
    made_of = [(one, _options_of(one, said)) for one in own.parameters.values()]

    @wraps(command)
    def called(*words: Any, **given: Any) -> Any:
        for one, options in made_of:
            if _is_group(one.annotation):
                values = {each.name: given.pop(each.name) for each in options}
                given[one.name] = one.annotation(**values)
        return command(*words, **given)

    called.__doc__ = text
    parameters = [each for _, options in made_of for each in options]
    vars(called)["__signature__"] = own.replace(parameters=parameters)
    return called
