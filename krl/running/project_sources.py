"""The files of a project that a program on the command line can see, read."""

from collections.abc import Iterator, Sequence
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING

from krl.errors import InputError
from krl.running.project_folders import project_root

if TYPE_CHECKING:
    from grammar.syntax.source import Source
    from support.files.discovery import FoundFile

#: Of a larger project only the files that the program refers to are read: 16 MB take some 20 s.
_MOST_FILES, _MOST_BYTES = 20_000, 1 << 24
_MOST_SHOWN = 5


def read_sources(file: Path) -> "tuple[list[Source], str, list[str]]":
    """Return the files of a file's project, its own path among them, and what was left out.

    Paths begin at the root of the project, wherever it lies. Files that cannot be read are left
    out, except the requested one.
    """
    from grammar.semantics.project_grouping import projects_of
    from grammar.syntax.source import Source
    from support.files.discovery import Skipped, archive_around, read_source

    if file.is_dir() or (file.suffix.lower() == ".zip" and file.is_file()):
        raise InputError(f"{file}: holds {_programs_in(file)}")
    if archive_around(file) is None and not file.is_file():
        raise InputError(f"{file}: no such file")
    found = _discovered(project_root(file))
    asked = _named(file, found)
    projects = projects_of(found)
    root, is_controller, whole = next(one for one in projects if asked in one[2])

    def shown(one: "FoundFile") -> str:
        return one.path.removeprefix(f"{root}/") if root else one.path

    is_large = len(whole) > _MOST_FILES or sum(one.size for one in whole) > _MOST_BYTES
    chosen = _named_from(asked, whole, is_controller=is_controller) if is_large else whole
    sources: list[Source] = []
    left: list[str] = []
    if len(chosen) < len(whole):
        unnamed = f"{len(whole) - len(chosen):,} of {len(whole):,} files"
        left.append(f"{unnamed} that the program does not name")
    for one in chosen:
        read = read_source(one)
        if not isinstance(read, Skipped):
            sources.append(Source(read.text, shown(one)))
        elif one is asked:
            raise InputError(f"{file}: {read.reason}")
        else:
            left.append(f"{shown(one)}: {read.reason}")
    return sources, shown(asked), left


def _discovered(root: Path) -> "list[FoundFile]":
    """Return the files below a folder or in an archive; raises `InputError` if there are none."""
    from support.files.discovery import FoundFile, discover

    return [one for one in discover([root]) if isinstance(one, FoundFile)]


def _named(file: Path, found: "Sequence[FoundFile]") -> "FoundFile":
    """Return the file at a path; raises `InputError` if it was not found.

    In an archive the letter case counts only if files differ in nothing else, as on a controller.
    """
    from support.files.discovery import printable

    if file.is_file():
        place = file.resolve()
        one = next((one for one in found if one.member is None and one.file == place), None)
        where = ""
    else:
        path = printable(file.as_posix())
        folded = PurePosixPath(path.casefold())
        inside = (one for one in found if one.member)
        same = [one for one in inside if PurePosixPath(one.path.casefold()) == folded]
        one = max(same, key=lambda one: one.path == path, default=None)
        where = " of this name in the archive"
    if one is None:
        raise InputError(f"{file}: no KRL program{where}")
    return one


def sources_below(roots: Sequence[Path]) -> "Iterator[tuple[str, Source]]":
    """Yield the readable files below folders and in archives, each with its origin.

    Raises `InputError` if a root cannot be read.
    """
    from grammar.syntax.source import Source
    from support.files.discovery import source_files

    for one in source_files(roots):
        yield one.found.origin, Source(one.text, one.path)


def _named_from(
    asked: "FoundFile", found: "Sequence[FoundFile]", *, is_controller: bool
) -> "list[FoundFile]":
    """Return the files to which a file refers, directly or not, with system data and submit."""
    from grammar.syntax.source import names_in_text
    from support.files.discovery import SourceFile, read_source

    by_name: dict[str, list[FoundFile]] = {}
    todo = [asked]
    folder = PurePosixPath(asked.path).parent
    for one in found:
        path = PurePosixPath(one.path)
        by_name.setdefault(path.stem.upper(), []).append(one)
        if path.name.startswith("$") or path.suffix.lower() == ".sub":
            todo += [one] if is_controller or path.parent == folder else []
    todo += by_name.pop(PurePosixPath(asked.path).stem.upper())
    named: dict[FoundFile, None] = {}
    while todo:
        one = todo.pop()
        if one not in named:
            named[one] = None
            read = read_source(one)
            words = names_in_text(read.text) if isinstance(read, SourceFile) else frozenset[str]()
            todo += [other for name in words & by_name.keys() for other in by_name.pop(name)]
    return [one for one in found if one in named]


def _programs_in(place: Path) -> str:
    """Return the programs in a folder or archive as text, those in Program folders first."""
    programs = sorted(
        (one.path for one in _discovered(place) if one.path.lower().endswith(".src")),
        key=lambda path: ("/program/" not in path.lower(), path),
    )
    if not programs:
        return "no program"
    more = f" and {len(programs) - _MOST_SHOWN} more" if len(programs) > _MOST_SHOWN else ""
    return f"programs: name one of {', '.join(programs[:_MOST_SHOWN])}{more}"
