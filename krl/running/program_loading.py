"""The program that a file on the command line means: with all files of its project."""

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

#: Folders that lie directly below the root of a controller's files.
_PARTS = frozenset({"R1", "STEU"})
_OF_CONTROLLERS = frozenset({*_PARTS, "SYSTEM", "MADA"})
_ENDINGS = frozenset({".src", ".dat", ".sub"})
#: Of a project that is larger, only what is named is read: 16 MB take some 20 s.
_MOST_FILES, _MOST_BYTES = 20_000, 1 << 24
_MOST_SHOWN = 5
#: So many files at most are looked at to find out whether a folder holds mostly KRL.
_MOST_BELOW = 2_000
#: Behind a name in a comment nothing is called, but that does not matter here.
_CALL = re.compile(r"\b([A-Z_]\w*)[ \t]*\(", re.IGNORECASE | re.ASCII)

_T = TypeVar("_T")
_P = TypeVar("_P", bound=PurePath)
_Folder_contra = TypeVar("_Folder_contra", bound=PurePath, contravariant=True)


def load_program(
    file: Path, *, strict: bool = False, stands_in: bool = False, routine: str | None = None
) -> "tuple[CheckedProgram, list[str]]":
    """The program that begins with a file, and why files of its project were left out.

    ``archive.zip/folder/name.src`` names a file in an archive. Without ``strict`` an error that the
    checker finds is no obstacle: what it is about fails when it is reached. With ``stands_in`` the
    project gets stand-ins for what it lacks, also for arguments of ``routine``, its first by
    default, where it begins with that. A program that was loaded before is not checked anew
    (`support.files.kept_values`). Raises `InputError` for what cannot be read, and
    `interp.values.faults.LinkError` for what cannot be run.
    """
    from interp.program.load import load
    from interp.program.routine_callers import with_caller

    def loaded(sources: "list[Source]", main: str, unread: list[str]) -> "CheckedProgram":
        program = load(sources, main, strict=strict, stands_in=stands_in, unread=unread)
        return with_caller(program, routine) if stands_in else program

    return _made_once(file, f"{strict} {stands_in} {routine}", loaded)


class Image(NamedTuple):
    """A program compiled from so many files; ``refusals`` are what ends it when it is reached."""

    data: bytes
    files: int
    codes: int
    instructions: int
    refusals: tuple[str, ...]


def compile_project(file: Path, *, strict: bool = False) -> tuple[Image, list[str]]:
    """As `load_program`, but the image of the program; what was compiled before is not again."""

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
    """What is made of the project of a file, its main file and the list of what is left out."""
    from interp.executors import CODE
    from support.files.kept_values import kept

    sources, main, left = read_sources(file)

    def made() -> "tuple[_T, list[str]]":
        unread = left.copy()
        return make(sources, main, unread), unread

    texts = (text for one in sources for text in (one.path, one.text))
    return kept(CODE, (main, how, *left, *texts), made)


def sources_below(roots: Sequence[Path]) -> "Iterator[tuple[str, Source]]":
    """The files below folders and in archives that can be read, each with where it comes from.

    Raises `InputError` where there is no root, or one that cannot be looked into.
    """
    from grammar.syntax.source import Source
    from support.files.discovery import IngestError, source_files

    if not roots:
        raise InputError("there is no corpus/ here: name files, folders or .zip archives")
    with as_input_errors(IngestError):
        for one in source_files(roots):
            yield one.found.origin, Source(one.text, one.path)


def read_sources(file: Path) -> "tuple[list[Source], str, list[str]]":
    """The files of the project of a file, the path of that file among them, and what was left out.

    What lies below `project_root`, of which `grammar.semantics.link` takes the file's own project.
    Files that cannot be read are left out, but not the one that was asked for.
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
    """The files whose names a file has, or one of these, and data and submit of the controller."""
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
    """What can be run in a folder or an archive, those that robot programmers write first."""
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
    """The files of the project of one of them, by where they lie."""
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
    """Whether a file lies in R1 or STEU; what lies beside them is another project."""
    return not _PARTS.isdisjoint(path.upper().split("/")[:-1])


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


def project_root(path: Path) -> Path:
    """The folder that holds the project of a file or folder, from wherever one enters it.

    That is what lies around R1 or STEU, or around a drive of another name (`is_drive`). A folder
    without such a layout around it is a project itself; the files of one that lies in a folder of
    KRL, Program for instance, belong to that, and so do those of folders beside it that have what
    its programs call (`_calling`). A folder with a few programs among much else is not
    taken for one: of that a program has what it names (`read_sources`).
    """
    path = path.resolve()
    return _root_around(path if path.is_dir() else path.parent, _Disk())


class _Folders(Protocol[_Folder_contra]):
    """What lies in folders, on disk or in an archive."""

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
    """The folder around it that also holds what its programs call and do not have.

    One that holds mostly files of the same names is a copy, or another controller.
    """
    own = folders.below(folder)
    names = {path.stem.upper() for path in own}
    called = {name for path in own for name in folders.calls(path)}
    found = folder
    for outer in folder.parents:
        every = folders.below(outer)
        more = [path for path in every if found not in path.parents]
        others = {path.stem.upper() for path in more}
        is_copy = more and 2 * len(others & names) >= min(len(others), len(names))
        if is_copy or not every or any(_is_of_controller(one.relative_to(outer)) for one in more):
            break
        if called & (others - names):
            found, names = outer, names | others
    return found


def _is_of_controller(path: PurePath) -> bool:
    """Whether a file lies in a folder that every controller has."""
    return not _OF_CONTROLLERS.isdisjoint(part.upper() for part in path.parts[:-1])


def _is_controller(root: Path) -> bool:
    from support.files.discovery import is_drive

    names = _Disk().folders_in(root)
    return is_drive(names) or not _PARTS.isdisjoint(map(str.upper, names))


def _is_project(root: Path) -> bool:
    """Whether all KRL below the root of a project belongs to it."""
    disk = _Disk()
    is_whole = disk.is_of_krl(root) or (not any(map(os.DirEntry.is_file, _entries(root))))
    return _is_controller(root) or (is_whole and bool(disk.below(root)))


def _near(folder: Path, disk: "_Disk") -> list[Path]:
    """The KRL files of a folder, and those of folders in it that hold some, and so on."""
    inner = (folder / name for name in disk.folders_in(folder))
    below = (_near(one, disk) for one in inner if not one.is_symlink() and disk.programs(one))
    return [*disk.programs(folder), *chain.from_iterable(below)]


def project_paths(path: Path) -> list[Path]:
    """What to read for all that a file or folder sees: its project, or the files beside it.

    A folder or an archive without a controller around it is all there is.
    """
    archive, _ = _in_archive(path)
    if archive is not None or not path.exists():
        return [archive or path]
    root, is_program = project_root(path), path.is_file() and _is_krl(path)
    if _is_controller(root) or (is_program and _is_project(root)):
        return [_as_given(root, path)]
    return _Disk().programs(path.parent) if is_program else [path]


def _as_given(root: Path, path: Path) -> Path:
    """A folder around a path, relative where that is."""
    if root == path.resolve():
        return path
    is_near = not path.is_absolute() and root.drive == Path.cwd().drive
    return Path(os.path.relpath(root)) if is_near else root


class _Disk:
    """Folders on disk; one that cannot be looked into holds nothing."""

    def folders_in(self, folder: Path) -> list[str]:
        return [one.name for one in _entries(folder) if one.is_dir()]

    def programs(self, folder: Path) -> list[Path]:
        """The KRL files directly in it."""
        return [path for one in _entries(folder) if _is_krl(path := Path(one))]

    def is_of_krl(self, folder: Path) -> bool:
        """Whether at least half of the files in it are KRL."""
        files = [_is_krl(Path(one)) for one in _entries(folder) if one.is_file()]
        return 0 < len(files) <= 2 * sum(files)

    def below(self, folder: Path) -> list[Path]:
        """The KRL files in it and in its folders; none where there is much else, or a link."""
        todo, seen = [folder], list[Path]()
        while todo:
            for one in _entries(todo.pop()):
                if one.is_symlink() or len(seen) + len(todo) > _MOST_BELOW:
                    return []
                (todo if one.is_dir() else seen).append(Path(one))
        files = [*filter(_is_krl, seen)]
        return files if len(seen) <= 2 * len(files) else []

    def calls(self, file: PurePath) -> Set[str]:
        """The routines that a file calls, in upper case."""
        from support.files.decode import Decoded, decode

        try:
            read = decode(Path(file).read_bytes())
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
    """Folders as the paths of the KRL files in an archive have them, with these files."""

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
