"""`krl format`: lays programs out in one style and changes nothing else."""

from collections import Counter
from enum import Enum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from krl.errors import BAD_INPUT, FINDINGS, FINE, InputError, one_line, say
from support.files.atomic_write import write_atomic
from support.gc_pause import gc_paused

if TYPE_CHECKING:
    from support.files.discovery import FoundFile, Skipped


_LONGEST = 60  # characters of a token in a message


class _Outcome(Enum):
    """The outcome for a file, as counted in the last line of output."""

    RIGHT = "as it should be"
    FORMATTED = "formatted"
    WOULD_CHANGE = "would change"
    LEFT = "left alone"
    NOT_WRITTEN = "not written"
    SKIPPED = "skipped"


def format_programs(
    paths: Annotated[list[Path], typer.Argument(metavar="PATH...")],
    check: bool = False,
) -> int:
    """Format programs: indentation, spaces, keywords in upper case.

    Comments, folds, headers, line breaks, line ends, encoding and the meaning of a program do not
    change. Exit status 1 if a file has syntax errors, which is then left alone, or if one would
    change but is not written: with --check, and in archives.

    Options:
        paths: Files, folders, .zip archives of controllers; archives are only checked.
        check: Write nothing; list the files that would change.
    """
    from support.files.discovery import IngestError, discover

    counts: Counter[_Outcome] = Counter()
    try:
        for found in discover(paths):
            with gc_paused():
                counts[_format(found, check)] += 1
    except IngestError as error:
        if counts[_Outcome.SKIPPED]:  # reported before
            return BAD_INPUT
        raise InputError(str(error)) from error
    typer.echo(
        ", ".join(f"{counts[outcome]:,} {outcome.value}" for outcome in _Outcome if counts[outcome])
    )
    if counts[_Outcome.NOT_WRITTEN]:
        return BAD_INPUT
    return FINDINGS if counts[_Outcome.LEFT] or counts[_Outcome.WOULD_CHANGE] else FINE


def _format(candidate: "FoundFile | Skipped", check: bool) -> _Outcome:
    """Format one file, and print on one line what is wrong with it."""
    from grammar.syntax.formatter import FormatterDefect, formatter
    from support.files.discovery import Skipped, read_source

    file = read_source(candidate)
    if isinstance(file, Skipped):
        return _complain(file.path, f"skipped: {file.reason}", _Outcome.SKIPPED)
    found = file.found
    try:
        text = formatter().layout(file.text, found.path)
    except FormatterDefect as defect:
        return _complain(found.path, f"left alone, please report it: {defect}", _Outcome.LEFT)
    if isinstance(text, list):
        first = text[0]
        place = f"{found.path}:{first.line}:{first.column}"
        what = first.reason or f"syntax error at {_token(first.text)}"
        return _complain(place, f"left alone: {what}", _Outcome.LEFT)
    if text == file.text:
        return _Outcome.RIGHT
    if check or found.member is not None:
        typer.echo(f"would change {one_line(found.path)}")
        return _Outcome.WOULD_CHANGE
    try:
        write_atomic(found.file, file.decoded.replaced(file.data, text))
    except OSError as error:
        reason = error.strerror or type(error).__name__
        return _complain(found.path, f"not written: {reason}", _Outcome.NOT_WRITTEN)
    typer.echo(f"formatted {one_line(found.path)}")
    return _Outcome.FORMATTED


def _complain(path: str, what: str, outcome: _Outcome) -> _Outcome:
    say(f"{path}: {what}", err=True)
    return outcome


def _token(text: str) -> str:
    if not text:
        return "the end of the file"
    return text[:_LONGEST] if text.strip() else "the end of the line"
