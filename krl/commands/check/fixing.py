"""`krl check --fix`: applies the fixes that are certain, or shows them as a diff."""

import difflib
from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from krl.errors import say, shown
from support.files.atomic_write import write_atomic

if TYPE_CHECKING:
    from grammar.diagnostics.diagnostic import Diagnostic
    from support.files.discovery import FoundFile


def fix_files(
    paths: Sequence[Path],
    checked: "Iterable[Diagnostic]",
    is_wanted: "Callable[[Diagnostic], bool]",
    leaves_out: "Callable[[FoundFile], bool]",
    *,
    is_shown: bool,
) -> bool:
    """Fix the files below some paths, or show the differences; return whether there were any.

    ``checked`` are the findings of these files. Encoding, line ends and all other lines stay as
    they are. Archives are not changed.
    """
    from grammar.check.project.repair import repair
    from grammar.syntax.source import Source
    from support.files.discovery import FoundFile, Skipped, discover, read_source

    by_path: dict[str, list[Diagnostic]] = defaultdict(list)
    for one in checked:
        if one.fix is not None and one.fix.is_edit:
            by_path[one.path].append(one)
    is_changed = False
    for found in discover(paths):
        if not isinstance(found, FoundFile) or leaves_out(found):
            continue
        file = read_source(found)
        if isinstance(file, Skipped):
            continue
        done = repair(Source(file.text, file.path), is_wanted, by_path[found.path])
        if not done.mended:
            continue
        is_changed = True
        if is_shown:
            _show(found.path, file.text, done.text)
            continue
        if found.member is not None:
            say(f"{found.path}: not mended: it is in an archive", err=True)
            continue
        write_atomic(found.file, file.decoded.replaced(file.data, done.text))
        for one in done.mended:
            place = f"{one.path}:{one.region.line}:{one.region.column}"
            say(f"{place}: mended {one.code}: {one.message}", err=True)
    return is_changed


def _show(path: str, before: str, after: str) -> None:
    lines = difflib.unified_diff(
        before.splitlines(keepends=True), after.splitlines(keepends=True), path, path
    )
    for line in lines:
        typer.echo(shown(line.rstrip("\r\n")))
