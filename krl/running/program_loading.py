"""Loading the program of a file on the command line, with all files of its project."""

import os
import re
from collections.abc import Callable, Iterator, Mapping, Sequence, Set
from itertools import chain
from pathlib import Path, PurePath, PurePosixPath
from typing import TYPE_CHECKING, NamedTuple, Protocol, TypeVar

from krl.errors import InputError, as_input_errors

if TYPE_CHECKING:
    from grammar.syntax.source import Source
    from interp.program.load import CheckedProgram
    from support.files.discovery import Found

#: Folders directly below the root of a controller's files.
_PARTS = frozenset({"R1", "STEU"})
_OF_CONTROLLERS = frozenset({*_PARTS, "SYSTEM", "MADA"})
_ENDINGS = frozenset({".src", ".dat", ".sub"})
#: Of a larger project only the files that the program refers to are read: 16 MB take some 20 s.
_MOST_FILES, _MOST_BYTES = 20_000, 1 << 24
_MOST_SHOWN = 5
#: The most files that are examined to find out whether a folder has mostly KRL.
_MOST_BELOW = 2_000
#: Also matches names in comments, which does no harm here.
_CALL = re.compile(r"\b([A-Z_]\w*)[ \t]*\(", re.IGNORECASE | re.ASCII)

_T = TypeVar("_T")
_P = TypeVar("_P", bound=PurePath)
_Folder_contra = TypeVar("_Folder_contra", bound=PurePath, contravariant=True)


def load_program(
    file: Path, *, strict: bool = False, stands_in: bool = False, routine: str | None = None
) -> "tuple[CheckedProgram, list[str]]":
    """Return the program that starts with a file, and why files of its project were left out.

    ``archive.zip/folder/name.src`` is a file in an archive. Without ``strict`` an error found by
    the checker does not prevent a run: the statement fails when it is reached. With ``stands_in``
    the project gets stand-ins for missing parts, also for the arguments of ``routine`` (default:
    the first one) if the run starts there. A program that was loaded before comes from the cache
    (`support.files.kept_values`). Raises `InputError` if it cannot be read, and
    `interp.values.faults.LinkError` if it cannot be run.
    """
    from interp.program.load import load
    from interp.program.routine_callers import with_caller

    def loaded(sources: "list[Source]", main: str, unread: list[str]) -> "CheckedProgram":
        program = load(sources, main, strict=strict, stands_in=stands_in, unread=unread)
        return with_caller(program, routine) if stands_in else program

    return _made_once(file, f"{strict} {stands_in} {routine}", loaded)


class Image(NamedTuple):
    """A program compiled from ``files`` files.

    ``refusals`` are statements that end it when reached.
    """

    data: bytes
    files: int
    codes: int
    instructions: int
    refusals: tuple[str, ...]


def compile_project(file: Path, *, strict: bool = False) -> tuple[Image, list[str]]:
    """Return the image of the program, and why files were left out; like `load_program`, cached."""

    def compiled(sources: "list[Source]", main: str, unread: list[str]) -> Image:
        from interp.bytecode.compiler import compile_program
        from interp.bytecode.verifier.verify import VerificationError, verify
        from interp.program.load import load
        from interp.values.faults import LinkError

        made = compile_program(load(sources, main, strict=strict, unread=unread))
        try:
            data = verify(made.program).image
        except VerificationError as error:
            raise LinkError(str(error)) from error
        codes = made.program.codes
        refusals = tuple(f"{one.path}:{one.line}: {one.reason}" for one in made.refusals)
        return Image(
            data, len(sources), len(codes), sum(len(code.instructions) for code in codes), refusals
        )

    return _made_once(file, f"image of files {strict}", compiled)


def _made_once(
    file: Path, how: str, make: "Callable[[list[Source], str, list[str]], _T]"
) -> "tuple[_T, list[str]]":
    """Return what ``make`` returns for the project of a file, cached, and the files left out."""
    from interp.executors import CODE
    from support.files.kept_values import kept

    sources, main, left = read_sources(file)

    def made() -> "tuple[_T, list[str]]":
        unread = left.copy()
        return make(sources, main, unread), unread

    texts = (text for one in sources for text in (one.path, one.text))
    return kept(CODE, (main, how, *left, *texts), made)


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


def read_sources(file: Path) -> "tuple[list[Source], str, list[str]]":
    """Return the files of a file's project, its own path among them, and what was left out.

    The files are those below `project_root` that `grammar.semantics.link` puts into the file's
    project. Files that cannot be read are left out, except the requested one.
    """
    from grammar.syntax.source import Source
    from support.files.discovery import (
        Found,
        IngestError,
        Skipped,
        discover,
        printable,
        read_source,
    )

    archive, inner = _in_archive(file)
    if archive is None and not file.is_file() and not file.is_dir():
        raise InputError(f"{file}: no such file")
    if archive is None and (file.is_dir() or file.suffix.lower() == ".zip"):
        raise InputError(f"{file}: holds {_programs_in(file)}")
    root = archive or project_root(file)
    is_mixed = archive is None and not _is_project(root)
    with as_input_errors(IngestError):
        roots = _Disk().below(root) or _near(root, _Disk()) if is_mixed else [root]
        found = [one for one in discover(roots) if isinstance(one, Found)]
    if archive is None:
        found = [one for one in found if one.member is None]
    paths = {one: PurePosixPath(_shown(one, root)) for one in found}
    wanted = PurePosixPath(printable(inner or file.resolve().relative_to(root).as_posix()))
    asked = next((one for one, path in paths.items() if path == wanted), None)
    if asked is None:
        raise InputError(f"{file}: no KRL program")
    if archive is not None:
        inside = _root_around(
            paths[asked].parent, _Listing({path: one for one, path in paths.items()})
        )
        root = archive / inside
        found = [one for one, path in paths.items() if path.is_relative_to(inside)]
    main = _shown(asked, root)
    found = _of_one_project(found, root, main)
    sources: list[Source] = []
    left: list[str] = []
    is_large = len(found) > _MOST_FILES or sum(one.size for one in found) > _MOST_BYTES
    if is_mixed or is_large:
        whole, found = found, _named_from(asked, found)
        unnamed = f"{len(whole) - len(found):,} of {len(whole):,} files"
        left += [f"{unnamed} that the program does not name"] * (len(found) < len(whole))
    for one in found:
        read = read_source(one)
        if isinstance(read, Skipped):
            if one is asked:
                raise InputError(f"{one.path}: {read.reason}")
            left.append(f"{one.path}: {read.reason}")
            continue
        sources.append(Source(read.text, _shown(one, root)))
    return sources, main, left


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
    from support.files.discovery import Found, IngestError, discover

    with as_input_errors(IngestError):
        paths = [one.path for one in discover([place]) if isinstance(one, Found)]
    programs = sorted(
        (path for path in paths if path.lower().endswith(".src")),
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
    return not _PARTS.isdisjoint(path.upper().split("/")[:-1])


def _shown(found: "Found", root: Path) -> str:
    """Return the path of a file below the root of its project, without control characters.

    It does not depend on where the project lies.
    """
    from support.files.discovery import printable

    if found.member is not None:
        return found.path.removeprefix(f"{printable(root.as_posix())}/")
    return printable(found.file.relative_to(root).as_posix())


def _in_archive(file: Path) -> tuple[Path | None, str]:
    """Return the archive in a path and the rest of the path; ``None`` for a plain file."""
    for parent in file.parents:
        if parent.suffix.lower() == ".zip" and parent.is_file():
            return parent, file.relative_to(parent).as_posix()
    return None, ""


def project_root(path: Path) -> Path:
    """Return the folder of the project to which a file or folder belongs.

    It is the folder around R1 or STEU, or around a drive with another name (`is_drive`). Without
    such a layout the folder itself is the project; but if it lies in a folder of KRL, such as
    Program, that is. A folder with a few programs among many other files is no project: a program
    then has the files to which it refers (`read_sources`).
    """
    path = path.resolve()
    return _root_around(path if path.is_dir() else path.parent, _Disk())


class _Folders(Protocol[_Folder_contra]):
    """The content of folders, on disk or in an archive."""

    def folders_in(self, folder: _Folder_contra) -> list[str]: ...

    def is_of_krl(self, folder: _Folder_contra) -> bool: ...

    def below(self, folder: _Folder_contra) -> Sequence[PurePath]: ...

    def calls(self, file: PurePath) -> Set[str]: ...


def _root_around(folder: _P, folders: _Folders[_P]) -> _P:
    from support.files.discovery import is_drive

    for one in (folder, *folder.parents):
        if one.name.upper() in _PARTS:
            return one.parent
        names = folders.folders_in(one)
        if is_drive(names):
            beside = map(str.upper, folders.folders_in(one.parent))
            return one.parent if "STEU" in beside else one
        if _PARTS & set(map(str.upper, names)) and one.name.upper() == "KRC":
            return one
    while folder != folder.parent and folders.is_of_krl(folder.parent):
        folder = folder.parent
    return _calling(folder, folders)


def _calling(folder: _P, folders: _Folders[_P]) -> _P:
    """Return the folder around it that also holds what its programs call and do not have.

    One that holds mostly files of the same names is a copy, or another controller.
    """
    own = folders.below(folder)
    names = {path.stem.upper() for path in own}
    called: Set[str] | None = None
    found = folder
    for outer in folder.parents:
        every = folders.below(outer)
        more = [path for path in every if found not in path.parents]
        others = {path.stem.upper() for path in more}
        is_copy = more and 2 * len(others & names) >= min(len(others), len(names))
        if is_copy or not every or any(_is_of_controller(one.relative_to(outer)) for one in more):
            break
        if not others - names:
            continue
        if called is None:
            called = {name for path in own for name in folders.calls(path)}
        if called & (others - names):
            found, names = outer, names | others
    return found


def _is_of_controller(path: PurePath) -> bool:
    """Return whether a file lies in a folder that every controller has."""
    return not _OF_CONTROLLERS.isdisjoint(part.upper() for part in path.parts[:-1])


def _is_controller(root: Path) -> bool:
    from support.files.discovery import is_drive

    names = _Disk().folders_in(root)
    return is_drive(names) or not _PARTS.isdisjoint(map(str.upper, names))


def _is_project(root: Path) -> bool:
    """Return whether all KRL files below a root belong to one project."""
    disk = _Disk()
    is_whole = disk.is_of_krl(root) or (not any(map(os.DirEntry.is_file, _entries(root))))
    return _is_controller(root) or (is_whole and bool(disk.below(root)))


def _near(folder: Path, disk: "_Disk") -> list[Path]:
    """Return the KRL files in a folder and, recursively, in its folders that have some."""
    inner = (folder / name for name in disk.folders_in(folder))
    below = (_near(one, disk) for one in inner if not one.is_symlink() and disk.programs(one))
    return [*disk.programs(folder), *chain.from_iterable(below)]


def project_paths(path: Path) -> list[Path]:
    """Return the paths to read for everything a file or folder sees.

    This is its project, or the files beside it. For a folder or an archive without a controller
    around it, it is the path itself.
    """
    archive, _ = _in_archive(path)
    if archive is not None or not path.exists():
        return [archive or path]
    root, is_program = project_root(path), path.is_file() and _is_krl(path)
    if _is_controller(root) or (is_program and _is_project(root)):
        return [_as_given(root, path)]
    return _Disk().programs(path.parent) if is_program else [path]


def _as_given(root: Path, path: Path) -> Path:
    """Return a folder around a path; relative if the path is."""
    if root == path.resolve():
        return path
    is_near = not path.is_absolute() and root.drive == Path.cwd().drive
    return Path(os.path.relpath(root)) if is_near else root


class _Disk:
    """Folders on disk; an unreadable one counts as empty."""

    def folders_in(self, folder: Path) -> list[str]:
        return [one.name for one in _entries(folder) if one.is_dir()]

    def programs(self, folder: Path) -> list[Path]:
        """Return the KRL files directly in a folder."""
        return [path for one in _entries(folder) if _is_krl(path := Path(one))]

    def is_of_krl(self, folder: Path) -> bool:
        """Return whether at least half of the files in a folder are KRL."""
        files = [_is_krl(Path(one)) for one in _entries(folder) if one.is_file()]
        return 0 < len(files) <= 2 * sum(files)

    def below(self, folder: Path) -> list[Path]:
        """Return the KRL files below a folder.

        Empty if most of its files are others, if there are too many, or if one is a link.
        """
        todo, seen = [folder], list[Path]()
        while todo:
            for one in _entries(todo.pop()):
                if one.is_symlink() or len(seen) + len(todo) > _MOST_BELOW:
                    return []
                (todo if one.is_dir() else seen).append(Path(one))
        files = [*filter(_is_krl, seen)]
        return files if len(seen) <= 2 * len(files) else []

    def calls(self, file: PurePath) -> Set[str]:
        """Return the routines that a file calls, in upper case."""
        from support.files.decode import Decoded, decode
        from support.files.untrusted import read_bytes

        try:
            read = decode(read_bytes(Path(file)))
        except OSError:
            return frozenset()
        return _calls(read.text) if isinstance(read, Decoded) else frozenset()


def _entries(folder: Path) -> "list[os.DirEntry[str]]":
    try:
        with os.scandir(folder) as entries:
            return [one for one in entries if not one.name.startswith(".")]
    except OSError:
        return []


def _calls(text: str) -> Set[str]:
    return {name.upper() for name in _CALL.findall(text)}


def _is_krl(path: Path) -> bool:
    return path.suffix.lower() in _ENDINGS


class _Listing:
    """Folders of an archive, from the paths of its KRL files."""

    def __init__(self, files: "Mapping[PurePosixPath, Found]") -> None:
        self._files = files
        self._with_krl: set[PurePosixPath] = set()
        self._folders: dict[PurePosixPath, dict[str, None]] = {}
        for file in files:
            self._with_krl.add(file.parent)
            for folder in file.parents:
                if folder.name:
                    self._folders.setdefault(folder.parent, {})[folder.name] = None

    def folders_in(self, folder: PurePosixPath) -> list[str]:
        return list(self._folders.get(folder, ()))

    def is_of_krl(self, folder: PurePosixPath) -> bool:
        return folder in self._with_krl

    def below(self, folder: PurePosixPath) -> list[PurePosixPath]:
        return [one for one in self._files if folder in one.parents]

    def calls(self, file: PurePath) -> Set[str]:
        from support.files.discovery import SourceFile, read_source

        read = read_source(self._files[PurePosixPath(file)])
        return _calls(read.text) if isinstance(read, SourceFile) else frozenset()
