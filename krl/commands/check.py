"""`krl check`: what the controller would complain about, and more, before anything is uploaded."""

import json
import os
import re
import sys
from collections.abc import Iterable, Iterator, Mapping
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.console import Console
from rich.text import Text

from krl.errors import FINDINGS, FINE, InputError, as_input_errors, one_line
from krl.options import JobsOption
from krl.output_files import check_files
from krl.progress import progress_bar
from support.files.atomic_write import write_atomic

if TYPE_CHECKING:
    from grammar.check.batch import CheckReport
    from grammar.diagnostics.diagnostic import Diagnostic
    from grammar.diagnostics.suppression import Selection

__all__ = ["check"]

_SKIPPED_SHOWN = 5
_STYLES = {"error": "bold red", "warning": "bold yellow", "note": "bold cyan"}
_NOT_ASCII = re.compile(r"[^\n\x20-\x7e]")
#: Findings that are no faults: why the robot stops.
_STOPS = ("KRL601", "KRL602", "KRL603", "KRL604")


class Format(StrEnum):
    """How findings are written."""

    TEXT = "text"
    JSON = "json"
    SARIF = "sarif"


def check(
    paths: Annotated[
        list[Path],
        typer.Argument(metavar="PATH...", help="Files, folders, .zip archives of controllers."),
    ],
    format_: Annotated[
        Format, typer.Option("--format", help="How to write the findings.")
    ] = Format.TEXT,
    syntax_only: Annotated[
        bool, typer.Option("--syntax-only", help="Only see whether the files can be read.")
    ] = False,
    select: Annotated[
        list[str] | None,
        typer.Option(metavar="CODES", help="Only these codes, or those that begin so: KSS,KRL2."),
    ] = None,
    ignore: Annotated[
        list[str] | None, typer.Option(metavar="CODES", help="Not these codes.")
    ] = None,
    stops: Annotated[
        bool,
        typer.Option(
            "--stops", help="Also report what stops the advance run and which blends are lost."
        ),
    ] = False,
    complete: Annotated[
        bool,
        typer.Option("--complete", help="No file is missing: what nothing declares is an error."),
    ] = False,
    out: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Write the findings here.")
    ] = None,
    jobs: JobsOption = None,
    cache: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="Where to keep findings; default: the user's cache."),
    ] = None,
    no_cache: Annotated[
        bool, typer.Option("--no-cache", help="Keep nothing, and use nothing that was kept.")
    ] = False,
) -> int:
    """Check programs: syntax, names, types, control flow, and what is not allowed where.

    Exit status 1 where there are errors or warnings; notes alone leave it 0. A comment
    '; krl: ignore[CODE]' silences its line, '; krl: ignore-file[CODE]' its file.
    """
    from grammar.check.batch import CheckOptions, check_paths
    from grammar.diagnostics.suppression import Selection
    from krl.program_loading import project_paths
    from support.files.discovery import IngestError

    check_files(out)
    with as_input_errors(ValueError):
        selection = Selection.of(select or (), ignore or ())
    options = CheckOptions(syntax_only, stops or _asks_for_stops(selection), complete)
    folder = None if no_cache else _usable(cache, _users_cache())
    with as_input_errors(IngestError), progress_bar("checking") as bar:
        found = check_paths(
            paths,
            options,
            around=[one for path in paths for one in project_paths(path)],
            jobs=jobs,
            cache=folder,
            on_found=bar.expect,
            on_done=bar,
        )
    if not found.files:
        first = found.skipped[0]
        raise InputError(f"{first.path}: {first.reason}")
    kept = [one for one in found.diagnostics if selection.keeps(one.code)]
    _write(kept, found, format_, out)
    _sum_up(kept, found)
    return FINDINGS if any(one.severity != "note" for one in kept) else FINE


def _asks_for_stops(selection: "Selection") -> bool:
    """Whether those notes are among what was selected by name."""
    return bool(selection.select) and any(map(selection.keeps, _STOPS))


# -- the cache -------------------------------------------------------------------------------------


def _users_cache() -> Path | None:
    """Where programs of this user keep what can be worked out again."""
    if sys.platform == "win32":
        base = os.environ.get("LOCALAPPDATA")
        return Path(base, "krl", "cache") if base else None
    if base := os.environ.get("XDG_CACHE_HOME"):
        return Path(base, "krl")
    try:
        home = Path.home()
    except RuntimeError:  # a user without a home
        return None
    return home / "Library" / "Caches" / "krl" if sys.platform == "darwin" else home / ".cache/krl"


def _usable(wanted: Path | None, default: Path | None) -> Path | None:
    """The folder for what is kept; without a usable one nothing is, unless it was asked for."""
    folder = wanted or default
    if folder is None:
        return None
    try:
        folder.mkdir(parents=True, exist_ok=True)
        usable = os.access(folder, os.W_OK)
    except OSError:
        usable = False
    if not usable and wanted is not None:
        raise InputError(f"{wanted}: not a folder that can be written to")
    return folder if usable else None


# -- the findings ----------------------------------------------------------------------------------


def _write(
    kept: "list[Diagnostic]", found: "CheckReport", format_: Format, out: Path | None
) -> None:
    if format_ is Format.TEXT and out is None:
        _print_text(kept, found.lines)
        return
    written = "".join(f"{line}\n" for line in _written(kept, found.lines, format_))
    if out is None:
        typer.echo(written, nl=False)
        return
    write_atomic(out, written)


def _written(
    kept: "list[Diagnostic]", lines: Mapping[tuple[str, int], str], format_: Format
) -> Iterator[str]:
    from importlib import metadata

    from grammar.diagnostics.diagnostic import records
    from grammar.diagnostics.rendering import rendered
    from grammar.diagnostics.sarif import sarif

    if format_ is Format.TEXT:
        yield from rendered(kept, lambda path, number: lines.get((path, number), ""))
    elif format_ is Format.JSON:
        yield _json(records(kept))
    else:
        yield _json(sarif(kept, metadata.version("krl-workbench")))


def _json(record: Any) -> str:
    """The record as JSON that steers no terminal: what is not printable is escaped."""
    text = json.dumps(record, ensure_ascii=False, allow_nan=False, indent=1)
    return _NOT_ASCII.sub(_shown, text)


def _shown(found: re.Match[str]) -> str:
    char = found[0]
    return char if char.isprintable() else json.dumps(char)[1:-1].replace("\x7f", "\\u007f")


def _print_text(kept: "list[Diagnostic]", lines: Mapping[tuple[str, int], str]) -> None:
    """The findings on the terminal, in colours where it has any."""
    console = Console(highlight=False, markup=False, emoji=False, soft_wrap=True)
    for line in _written(kept, lines, Format.TEXT):
        if console.is_terminal:
            console.print(_coloured(line))
        else:
            typer.echo(line)


def _coloured(line: str) -> Text:
    text = Text(line)
    if not line.startswith(" "):
        for severity, style in _STYLES.items():
            text.highlight_regex(rf": {severity} [A-Z]+\d+:", style)
    elif set(line.partition("|")[2].strip()) == {"^"}:
        text.stylize("bold green", line.index("|") + 1)
    return text


def _sum_up(kept: "Iterable[Diagnostic]", found: "CheckReport") -> None:
    """What was checked and found, on one line of stderr, and what was left out."""
    from grammar.diagnostics.diagnostic import Diagnostic
    from grammar.diagnostics.rendering import summary

    told: list[Diagnostic] = list(kept)
    for skipped in found.skipped[:_SKIPPED_SHOWN]:
        typer.echo(one_line(f"skipped {skipped.path}: {skipped.reason}"), err=True)
    more = len(found.skipped) - _SKIPPED_SHOWN
    if more > 0:
        typer.echo(f"skipped {more:,} more", err=True)
    files = f"{found.files:,} file{'s' * (found.files != 1)} checked"
    unchanged = f" ({found.unchanged:,} unchanged)" if found.unchanged else ""
    typer.echo(f"{files}{unchanged}: {summary(told)}", err=True)
