"""The files of a project that a program on the command line can see, read."""

from collections.abc import Iterator, Sequence
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, NamedTuple

from krl.errors import InputError, as_input_errors
from krl.running.folder_contents import ArchiveFolders, DiskFolders
from krl.running.project_folders import (
    PARTS,
    files_near,
    in_archive,
    is_project,
    project_root,
    root_around,
)

if TYPE_CHECKING:
    from grammar.syntax.source import Source
    from support.files.discovery import Found

#: Of a larger project only the files that the program refers to are read: 16 MB take some 20 s.
_MOST_FILES, _MOST_BYTES = 20_000, 1 << 24
_MOST_SHOWN = 5


def read_sources(file: Path) -> "tuple[list[Source], str, list[str]]":
    """Return the files of a file's project, its own path among them, and what was left out.

    The files are those below `project_root` that `grammar.semantics.link` puts into the file's
    project. Files that cannot be read are left out, except the requested one.
    """
    from grammar.syntax.source import Source
    from support.files.discovery import Skipped, read_source

    archive, inner = in_archive(file)
    files = _files_on_disk(file) if archive is None else _files_in_archive(file, archive, inner)
    main = _shown(files.asked, files.root)
    whole = chosen = _of_one_project(files.found, files.root, main)
    is_large = len(whole) > _MOST_FILES or sum(one.size for one in whole) > _MOST_BYTES
    if files.are_mixed or is_large:
        chosen = _named_from(files.asked, whole)
    sources: list[Source] = []
    left: list[str] = []
    if len(chosen) < len(whole):
        unnamed = f"{len(whole) - len(chosen):,} of {len(whole):,} files"
        left.append(f"{unnamed} that the program does not name")
    for one in chosen:
        read = read_source(one)
        if not isinstance(read, Skipped):
            sources.append(Source(read.text, _shown(one, files.root)))
        elif one is files.asked:
            raise InputError(f"{one.path}: {read.reason}")
        else:
            left.append(f"{one.path}: {read.reason}")
    return sources, main, left


class _Files(NamedTuple):
    """The files below the root of a project, and the one that was asked for.

    If they ``are_mixed``, the root is no project as a whole.
    """

    root: Path
    asked: "Found"
    found: "list[Found]"
    are_mixed: bool


def _files_on_disk(file: Path) -> _Files:
    if not file.is_file() and not file.is_dir():
        raise InputError(f"{file}: no such file")
    if file.is_dir() or file.suffix.lower() == ".zip":
        raise InputError(f"{file}: holds {_programs_in(file)}")
    root = project_root(file)
    are_mixed = not is_project(root)
    roots = DiskFolders().below(root) or files_near(root) if are_mixed else [root]
    found = [one for one in _discovered(roots) if one.member is None]
    asked = _named(file, found, root, file.resolve().relative_to(root).as_posix())
    return _Files(root, asked, found, are_mixed)


def _files_in_archive(file: Path, archive: Path, inner: str) -> _Files:
    found = _discovered([archive])
    asked = _named(file, found, archive, inner)
    paths = {one: PurePosixPath(_shown(one, archive)) for one in found}
    folders = ArchiveFolders({path: one for one, path in paths.items()})
    inside = root_around(paths[asked].parent, folders)
    inner_files = [one for one, path in paths.items() if path.is_relative_to(inside)]
    return _Files(archive / inside, asked, inner_files, are_mixed=False)


def _discovered(roots: Sequence[Path]) -> "list[Found]":
    from support.files.discovery import Found, IngestError, discover

    with as_input_errors(IngestError):
        return [one for one in discover(roots) if isinstance(one, Found)]


def _named(file: Path, found: "Sequence[Found]", root: Path, path: str) -> "Found":
    """Return the file at a path below the root; raises `InputError` if it was not found."""
    from support.files.discovery import printable

    wanted = PurePosixPath(printable(path))
    for one in found:
        if PurePosixPath(_shown(one, root)) == wanted:
            return one
    raise InputError(f"{file}: no KRL program")


def sources_below(roots: Sequence[Path]) -> "Iterator[tuple[str, Source]]":
    """Yield the readable files below folders and in archives, each with its origin.

    Raises `InputError` if there is no root, or one cannot be read.
    """
    from grammar.syntax.source import Source
    from support.files.discovery import IngestError, source_files

    if not roots:
        raise InputError("there is no corpus/ here: name files, folders or .zip archives")
    with as_input_errors(IngestError):
        for one in source_files(roots):
            yield one.found.origin, Source(one.text, one.path)


def _named_from(asked: "Found", found: "Sequence[Found]") -> "list[Found]":
    """Return the files to which a file refers, directly or not, with system data and submit."""
    from grammar.semantics.link import words_of
    from support.files.discovery import SourceFile, read_source

    by_name: dict[str, list[Found]] = {}
    todo = [asked]
    folder = PurePosixPath(asked.path).parent
    for one in found:
        path = PurePosixPath(one.path)
        by_name.setdefault(path.stem.upper(), []).append(one)
        if path.name.startswith("$") or path.suffix.lower() == ".sub":
            todo += [one] if path.parent == folder or _is_in_drive(one.path) else []
    todo += by_name.pop(PurePosixPath(asked.path).stem.upper())
    named: dict[Found, None] = {}
    while todo:
        one = todo.pop()
        if one not in named:
            named[one] = None
            read = read_source(one)
            words = words_of(read.text) if isinstance(read, SourceFile) else frozenset[str]()
            todo += [other for name in words & by_name.keys() for other in by_name.pop(name)]
    return [one for one in found if one in named]


def _programs_in(place: Path) -> str:
    """Return the programs in a folder or archive as text, those in Program folders first."""
    programs = sorted(
        (one.path for one in _discovered([place]) if one.path.lower().endswith(".src")),
        key=lambda path: ("/program/" not in path.lower(), path),
    )
    if not programs:
        return "no program"
    more = f" and {len(programs) - _MOST_SHOWN} more" if len(programs) > _MOST_SHOWN else ""
    return f"programs: name one of {', '.join(programs[:_MOST_SHOWN])}{more}"


def _of_one_project(found: "Sequence[Found]", root: Path, main: str) -> "list[Found]":
    """Return the files in the same project as ``main``, judged by their paths."""
    from grammar.semantics.link import File, link

    by_path = {_shown(one, root): one for one in found}
    for project in link([File(path, None) for path in by_path]).projects:
        paths = [module.path for module in project.modules]
        if main in paths:
            if project.is_controller:
                return [by_path[path] for path in paths]
            is_inside = _is_in_drive(main)
            return [by_path[path] for path in paths if _is_in_drive(path) == is_inside]
    return []


def _is_in_drive(path: str) -> bool:
    """Return whether a file lies in R1 or STEU; files beside these are another project."""
    return not PARTS.isdisjoint(path.upper().split("/")[:-1])


def _shown(found: "Found", root: Path) -> str:
    """Return the path of a file below the root of its project, without control characters.

    It does not depend on where the project lies.
    """
    from support.files.discovery import printable

    if found.member is not None:
        return found.path.removeprefix(f"{printable(root.as_posix())}/")
    return printable(found.file.relative_to(root).as_posix())
