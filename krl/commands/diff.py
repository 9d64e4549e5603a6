"""`krl diff`: compares two backups by routines, points and data."""

import json
from collections.abc import Iterable, Iterator, Mapping
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from krl.errors import FINDINGS, FINE, InputError, shown
from krl.terminal.output_files import check_files, write_json

if TYPE_CHECKING:
    from grammar.syntax.source import Source

Record = Mapping[str, Any]

_LONGEST = 160
_NOWHERE = "/dev/null"  # git passes this path for a missing file


class Format(StrEnum):
    """The format in which differences are written."""

    TEXT = "text"
    JSON = "json"


def diff(
    old: Annotated[Path, typer.Argument(metavar="OLD")],
    new: Annotated[Path | None, typer.Argument(metavar="[NEW]")] = None,
    format_: Format = Format.TEXT,
    json_file: Annotated[Path | None, typer.Option("--json")] = None,
    html: Annotated[Path | None, typer.Option(metavar="DIR")] = None,
    textconv: bool = False,
) -> int:
    """Compare two versions of programs: routines, then taught points and data.

    Headers, comments, folds, layout and letter case are ignored. Exit status 1 if there are
    differences.

    Options:
        old: A file, folder or .zip archive.
        new: The newer version.
        format_: How to write the differences.
        json_file: Also write the record to FILE.
        html: Write a page to this folder, or to FILE.html.
        textconv: Print OLD without comments and layout, for git.
    """
    from grammar.comparison.backups import compare

    check_files(json_file)
    if textconv:
        if new is not None:
            raise InputError("--textconv takes one file")
        typer.echo("\n".join(_plain(_sources(old))))
        return FINE
    if new is None:
        raise InputError("name two files, folders or archives: OLD and NEW")
    sources = _sources(old), _sources(new)
    if not any(sources):
        raise InputError(f"{old}, {new}: no KRL in either")
    record = {"old": old.as_posix(), "new": new.as_posix(), **compare(*sources)}
    write_json(record, json_file, 1)
    if html is not None:
        from reports.programs.diff_page import write_diff_page

        typer.echo(f"page: {write_diff_page(record, html)}", err=True)
    if format_ is Format.JSON:
        typer.echo(json.dumps(record, indent=1))
    else:
        for line in _text(record):
            typer.echo(shown(line))
    files = record["files"]
    changes = (files["added"], files["removed"], files["moved"])
    is_changed = any(
        (*changes, record["names"], record["routines"], record["points"], record["data"])
    )
    return FINDINGS if is_changed else FINE


def _sources(root: Path) -> "list[Source]":
    """Return the programs below a root, with paths relative to it."""
    from grammar.syntax.source import Source
    from support.files.discovery import Skipped, discover, read_source

    if root.as_posix() == _NOWHERE:
        return []
    read = [*map(read_source, discover([root]))]
    found = []
    for one in read:
        if isinstance(one, Skipped):
            typer.echo(shown(f"left out {one.path}: {one.reason}"), err=True)
            continue
        path = one.path.removeprefix(root.as_posix()).lstrip("/") or root.name
        found.append(Source(one.text, path))
    return found


def _plain(sources: "Iterable[Source]") -> Iterator[str]:
    """Yield the statements of files, one per line, as git compares them."""
    from grammar.comparison.content import content_of

    for source in sources:
        content = content_of(source)
        for routine in content.routines:
            if routine.name:
                yield shown(" ".join(routine.head.text.split()))
            yield from (shown(" ".join(line.text.split())) for line in routine.body)
        for datum in content.data.values():
            yield shown(f"{datum.type} {datum.name} = {datum.text}".strip())


# -- text ------------------------------------------------------------------------------------------


def _text(record: Record) -> Iterator[str]:
    tables = (("points", record["points"]), ("data", record["data"]))
    sections = [
        _files(record),
        *map(_routine, record["routines"]),
        *((f"{title}:", *map(_datum, rows)) for title, rows in tables if rows),
    ]
    for lines in filter(None, map(tuple, sections)):
        yield from (*lines, "")
    yield _summary(record)


def _files(record: Record) -> Iterator[str]:
    from reports.programs.diff_view import moves

    files = record["files"]
    for kind in ("added", "removed"):
        yield from (f"file {kind}: {path}" for path in files[kind])
    for number, old, new in moves(files):
        what = f"{number:,} files" if number > 1 else "file"
        yield f"{what} moved: {old} -> {new}"
    yield from (f"name changed throughout: {one['old']} -> {one['new']}" for one in record["names"])


def _routine(one: Record) -> Iterator[str]:
    from reports.programs.diff_view import routine_name, routine_words

    yield f"{one['file']}:{one['line']}: {routine_name(one)} {routine_words(one)}"
    for hunk in one["hunks"]:
        yield f"  line {hunk['old_line']}, now {hunk['new_line']}"
        for side, mark in (("old", "-"), ("new", "+")):
            yield from (f"  {mark} {text}" for text in hunk[side])


def _datum(one: Record) -> str:
    from reports.programs.diff_view import point_words

    said = point_words(one)
    if len(said) > _LONGEST:
        said = f"{said[: _LONGEST - 1]}…"
    return f"  {one['file']}:{one['line']}: {one['name']} {said}"


def _summary(record: Record) -> str:
    from reports.rendering.number_format import counted

    files = record["files"]
    nouns = {"names": "name", "routines": "routine", "points": "point", "data": "other item"}
    found = [counted(len(record[key]), noun) for key, noun in nouns.items() if record[key]]
    said = [
        f"{counted(len(files[key]), 'file')} {key}"
        for key in ("added", "removed", "moved")
        if files[key]
    ]
    if found or not said:
        said.append(f"{', '.join(found) or 'nothing'} changed")
    if files["noise"]:
        said.append(f"{files['noise']:,} differ in comments and layout only")
    return f"{files['old']:,} and {files['new']:,} files: {'; '.join(said)}"
