"""The program that a file on the command line means: with all files of its project."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from krl.errors import InputError

if TYPE_CHECKING:
    from grammar.syntax.source import Source
    from interp.program.load import CheckedProgram
    from support.files.discovery import Found

__all__ = ["load_program", "read_sources", "sources_below"]

#: Folders that lie directly below the root of a controller's files.
_PARTS = frozenset({"R1", "STEU"})
_MOST_FILES = 20_000


def load_program(file: Path, *, strict: bool = False) -> "tuple[CheckedProgram, list[str]]":
    """The program that begins with a file, and why files of its project were left out.

    ``archive.zip/folder/name.src`` names a file in an archive. Without ``strict`` an error that the
    checker finds is no obstacle: what it is about fails when it is reached. Raises `InputError` for
    what cannot be read, and `interp.values.faults.LinkError` for what cannot be run.
    """
    from interp.program.load import load

    sources, main, left = read_sources(file)
    return load(sources, main, strict=strict), left


def sources_below(roots: Sequence[Path]) -> "Iterator[tuple[str, Source]]":
    """The files below folders and in archives that can be read, each with where it comes from.

    Raises `InputError` where there is no root, or one that cannot be looked into.
    """
    from grammar.syntax.source import Source
    from support.files.decode import decode
    from support.files.discovery import Found, IngestError, Skipped, discover, read

    if not roots:
        raise InputError("there is no corpus/ here: name files, folders or .zip archives")
    try:
        for one in discover(roots):
            data = read(one) if isinstance(one, Found) else one
            text = data.reason if isinstance(data, Skipped) else decode(data)
            if not isinstance(text, str):
                yield one.origin, Source(text.text, one.path)
    except IngestError as error:
        raise InputError(str(error)) from error


def read_sources(file: Path) -> "tuple[list[Source], str, list[str]]":
    """The files of the project of a file, the path of that file among them, and what was left out.

    A project is what one controller holds: the nearest R1 or STEU that the file lies in and what
    stands beside that, else the folder that the file lies in, without those below. Files that
    cannot be read as KRL are left out, but not the one that was asked for.
    """
    from grammar.syntax import ast
    from grammar.syntax.build import read_module
    from grammar.syntax.source import Source
    from support.files.decode import decode
    from support.files.discovery import Found, IngestError, Skipped, discover, read

    archive, inner = _in_archive(file)
    try:
        root = archive or _root_of(file)
        found = [one for one in discover([root]) if isinstance(one, Found)]
    except IngestError as error:
        raise InputError(str(error)) from error
    if archive is None and root == file.resolve().parent:  # a loose file: not what lies below
        found = [one for one in found if one.file.parent == root and one.member is None]
    sources: list[Source] = []
    left: list[str] = []
    main = ""
    for one in found[:_MOST_FILES]:
        is_main = _is_asked_for(one, file, inner)
        data = read(one)
        decoded = data.reason if isinstance(data, Skipped) else decode(data)
        if isinstance(decoded, str):
            if is_main:
                raise InputError(f"{one.path}: {decoded}")
            left.append(f"{one.path}: {decoded}")
            continue
        source = Source(decoded.text, _shown(one, root))
        syntax = read_module(source.text, source.path)
        if isinstance(syntax, ast.Module) or is_main:
            sources.append(source)
        else:
            left.append(f"{one.path}:{syntax[0].line}: it cannot be read")
        main = source.path if is_main else main
    if not main:
        raise InputError(f"{file}: no KRL program")
    return sources, main, left


def _shown(found: "Found", root: Path) -> str:
    """The path of a file below the root of its project: the same wherever the project lies.

    As people are shown it: a name may hold what no terminal, image or trace can.
    """
    from support.files.discovery import printable

    if found.member is not None:
        return found.path.removeprefix(f"{printable(root.as_posix())}/")
    return printable(found.file.relative_to(root).as_posix())


def _in_archive(file: Path) -> tuple[Path | None, str]:
    """The archive that a path leads into, and the rest of the path; none for a plain file."""
    for parent in file.parents:
        if parent.suffix.lower() == ".zip" and parent.is_file():
            return parent, file.relative_to(parent).as_posix()
    return None, ""


def _is_asked_for(found: "Found", file: Path, inner: str) -> bool:
    if found.member is not None:
        return bool(inner) and found.path.endswith("/" + inner)
    return not inner and found.file.resolve() == file.resolve()


def _root_of(file: Path) -> Path:
    """The folder that holds the project of a file: it lies below R1 or STEU there, or alone."""
    if not file.is_file():
        raise InputError(f"{file}: no such file")
    folders = file.resolve().parents
    return next((one.parent for one in folders if one.name.upper() in _PARTS), folders[0])
