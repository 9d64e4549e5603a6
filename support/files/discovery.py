"""Discovery of KRL files in folders and archives, each file exactly once.

`discover` finds the candidates, `files_around` those in the folders around one. `read` returns the
bytes of one, in any process, and `read_source` its text too. Nothing is lost silently: what cannot
be read becomes a `Skipped` with its reason. The order is that of sorted paths, the same on every
system and for every order of the roots.
"""

from __future__ import annotations

import os
import stat
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path, PurePosixPath

from support.files import archives
from support.files.archives import ArchiveError, is_archive
from support.files.decode import Decoded, decode
from support.files.untrusted import open_file
from support.input_error import InputError
from support.lazy_dataclass import dataclass

#: How names of KRL files end, in any case of letters.
SUFFIXES = (".src", ".dat", ".sub")

#: Folders, in lower case, that hold no programs of users. Hidden ones, `.git` too, are ignored.
IGNORED_FOLDERS = {"node_modules", "__pycache__", "__macosx"}

#: Folders, in lower case, that lie in R1: one called R1 may be somebody's name for a robot.
DRIVE_FOLDERS = {"program", "system", "mada", "tp", "folgen"}

_BACKUP_SIGNS = {".git", "krc", "r1", "steu"}  # a folder that holds one of these is one origin
_CORPUS_SIGN = "sources.toml"
_CORPUS_FOLDERS = {"programs", "open"}  # negatives and the like are no production code
_LINK = "symbolic link, not followed"
_JUNCTION = 0xA0000003  # stat.IO_REPARSE_TAG_MOUNT_POINT, which only Windows has


class IngestError(InputError):
    """A root that cannot be surveyed; the message is one line."""


@dataclass(frozen=True, slots=True)
class FoundFile:
    """A candidate file whose bytes have not been read yet.

    `path` is for display: `/` separated, relative if the root was given so, control characters
    escaped. `size` in bytes is the one that the file system or the archive states. `file` is
    absolute; for a member of an archive it is the archive, and `member` is its address in
    `support.files.archives`.
    """

    path: str
    origin: str
    size: int
    file: Path
    member: str | None


@dataclass(frozen=True, slots=True)
class Skipped:
    """A candidate, archive or folder that is not surveyed, and the reason in one line."""

    path: str
    reason: str
    origin: str


@dataclass(frozen=True, slots=True)
class SourceFile:
    """A file with KRL: its location, bytes and text."""

    found: FoundFile
    data: bytes
    decoded: Decoded

    @property
    def path(self) -> str:
        """See `FoundFile.path`."""
        return self.found.path

    @property
    def text(self) -> str:
        """See `Decoded.text`."""
        return self.decoded.text


def discover(roots: Sequence[Path]) -> Iterator[FoundFile | Skipped]:
    """Yield the candidates below `roots`: files, folders, `.zip` archives, paths inside archives.

    The roots are checked before anything is returned. A file below two roots belongs to the nearer
    one. Links are not followed, except the roots themselves. Raises IngestError if a root is
    missing or unreadable and, at the end of the iteration, if there was nothing to survey.
    """
    return _survey(_resolved(roots))


def files_around(folder: Path, most: int) -> list[FoundFile]:
    """Return the files below the outermost folder around ``folder`` that holds few others.

    That is at most ``most`` files and folders; none are returned if ``folder`` itself has more.
    Archives are not opened; what cannot be read is left out.
    """
    found: list[FoundFile] = []
    inner = folder
    for outer in (folder, *folder.parents):
        more: list[str] = []
        pending = [str(outer)]
        while pending:
            try:
                with os.scandir(pending.pop()) as entries:
                    listed = list(entries)
            except OSError:
                continue
            most -= len(listed)
            if most < 0:
                return found
            for entry in listed:
                with suppress(OSError):  # it may be gone meanwhile
                    if entry.is_dir(follow_symlinks=False):
                        if not (entry.path == str(inner) or _ignored(entry.name)):
                            pending += [] if _is_link(entry) else [entry.path]
                    elif _is_program(entry.name) and entry.is_file(follow_symlinks=False):
                        more.append(entry.path)
        found += [
            FoundFile(printable(Path(one).as_posix()), "", 0, Path(one), None) for one in more
        ]
        inner = outer
    return found


def is_drive(names: Iterable[str]) -> bool:
    """Return whether a folder with subfolders of these names is a drive of a controller.

    Like R1 it has System or Mada and at least one other of the usual folders; its own name does not
    matter.
    """
    parts = DRIVE_FOLDERS & {name.casefold() for name in names}
    return len(parts) > 1 and not parts.isdisjoint({"system", "mada"})


def read(found: FoundFile) -> bytes | Skipped:
    """Return the content of a candidate, or why it cannot be read. Works in any process."""
    try:
        if found.member is not None:
            return archives.read(found.file, found.member, found.size)
        with open_file(found.file) as stream:
            return archives.read_whole(stream)
    except ArchiveError as error:
        return Skipped(found.path, printable(str(error)), found.origin)
    except OSError as error:
        return Skipped(found.path, f"cannot be read: {archives.why(error)}", found.origin)


def read_source(candidate: FoundFile | Skipped) -> SourceFile | Skipped:
    """Return the text of a candidate, or why it has none."""
    if isinstance(candidate, Skipped):
        return candidate
    data = read(candidate)
    if isinstance(data, Skipped):
        return data
    decoded = decode(data)
    if isinstance(decoded, str):
        return Skipped(candidate.path, decoded, candidate.origin)
    return SourceFile(candidate, data, decoded)


def source_files(roots: Sequence[Path]) -> Iterator[SourceFile]:
    """Yield every file with KRL below `roots` and skip the others; raises as `discover` does."""
    for candidate in discover(roots):
        file = read_source(candidate)
        if isinstance(file, SourceFile):
            yield file


def printable(text: str) -> str:
    """Return `text` with escapes for characters that a terminal or a page would not show."""
    if text.isprintable():
        return text
    return "".join(c if c.isprintable() else _escaped(ord(c)) for c in text)


def _escaped(code: int) -> str:
    if 0xDC80 <= code <= 0xDCFF:  # how Python carries a byte of a name that is not UTF-8
        code -= 0xDC00
    return f"\\x{code:02x}" if code < 0x100 else f"\\u{code:04x}"


# -- roots -----------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class _Root:
    """A root as it was given and its real path; ``inside`` is a path in an archive."""

    shown: str
    real: Path
    folder: bool
    inside: str = ""

    def holds(self, item: FoundFile | Skipped) -> bool:
        """Return whether something found in the root's file is part of the root."""
        return not self.inside or f"{item.path}/".startswith(printable(f"{self.inside}/"))


def _resolved(roots: Sequence[Path]) -> list[_Root]:
    """Return the checked roots, sorted and without duplicates."""
    if not roots:
        raise IngestError("no file or folder was named")
    found: dict[tuple[Path, str], _Root] = {}
    for given in sorted(map(Path, roots), key=lambda root: _order(root.as_posix())):
        root = archive_around(given) or given
        shown, inside = root.as_posix(), "" if root == given else given.as_posix()
        try:
            mode = root.stat().st_mode
            real = root.resolve()
            if stat.S_ISDIR(mode):
                os.scandir(real).close()
            elif not stat.S_ISREG(mode):
                raise IngestError(printable(f"{shown}: neither a file nor a folder"))
            else:
                open_file(real).close()
        except (FileNotFoundError, NotADirectoryError) as error:
            raise IngestError(printable(f"{shown}: no such file or folder")) from error
        except (OSError, RuntimeError, ValueError) as error:
            reason = archives.why(error) if isinstance(error, OSError) else str(error)
            raise IngestError(printable(f"{shown}: cannot be read: {reason}")) from error
        found.setdefault((real, inside), _Root(shown, real, stat.S_ISDIR(mode), inside))
    return list(found.values())


def archive_around(path: Path) -> Path | None:
    """Return the archive through which a path leads, or ``None``."""
    try:
        return next((one for one in path.parents if is_archive(one.name) and one.is_file()), None)
    except (OSError, ValueError):
        return None


def _order(name: str) -> tuple[str, str]:
    return name.casefold(), name


# -- the walk --------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class _Place:
    """A folder to enter or a file; `problem` is why it is neither entered nor read.

    `names_origins` says that each of its folders is an origin of its own.
    """

    shown: str
    real: Path
    origin: str
    folder: bool = False
    names_origins: bool = False
    problem: str | None = None


def _walk(root: _Root, others: frozenset[Path]) -> Iterator[_Place]:
    """Yield candidates, archives and problems below `root`, sorted, without `others`."""
    if not root.folder:
        problem = None if _wanted(root.real.name) else "not a .src, .dat, .sub or .zip file"
        yield _Place(root.shown, root.real, _origin(root.real.parent), problem=problem)
        return
    pending = [_Place(root.shown, root.real, _origin(root.real), folder=True)]
    is_collection = False
    while pending:  # not recursive: folders may be nested deeper than Python's stack
        place = pending.pop()
        if not place.folder or place.problem:
            yield place
            continue
        try:
            with os.scandir(place.real) as entries:
                listed = sorted(entries, key=lambda entry: _order(entry.name))
        except OSError as error:
            yield replace(place, problem=f"folder cannot be read: {archives.why(error)}")
            continue
        if place.real == root.real:
            is_collection = not _is_backup(listed)
            place = replace(place, names_origins=is_collection and not _has_programs(listed))
        elif is_collection and place.real.parent == root.real and _is_backup(listed):
            place = replace(place, origin=_origin(place.real))
        below = [found for entry in listed for found in _at(entry, place)]
        if _is_corpus(listed):
            below = [
                replace(found, names_origins=True, origin=_origin(found.real))
                if found.folder
                else found
                for found in below
                if not found.folder or found.real.name in _CORPUS_FOLDERS
            ]
        pending += [found for found in reversed(below) if found.real not in others]


def _at(entry: os.DirEntry[str], place: _Place) -> Iterator[_Place]:
    """Yield the places for an entry of a folder: none, a file, a folder, or a problem."""
    real = place.real / entry.name
    shown = entry.name if place.shown == "." else f"{place.shown.rstrip('/')}/{entry.name}"
    candidate = _wanted(entry.name)
    try:
        folder, link = entry.is_dir(), _is_link(entry)
        regular = entry.is_file(follow_symlinks=False)
    except OSError as error:
        problem = f"cannot be read: {archives.why(error)}"
        yield _Place(shown, real, place.origin, problem=problem)
        return
    if not folder:
        if candidate:
            irregular = None if regular else "not a regular file"
            yield _Place(shown, real, place.origin, problem=_LINK if link else irregular)
    elif not _ignored(entry.name):
        origin = _origin(real) if place.names_origins else place.origin
        if candidate and not link and not is_archive(entry.name):
            yield _Place(shown, real, place.origin, problem="a folder, not a file")
        yield _Place(shown, real, origin, folder=True, problem=_LINK if link else None)


def _is_link(entry: os.DirEntry[str]) -> bool:
    """Return whether `entry` is a link or a junction (Windows' link to a folder)."""
    if entry.is_symlink():
        return True
    tag = getattr(entry.stat(follow_symlinks=False), "st_reparse_tag", 0)
    return bool(tag == _JUNCTION)


def _is_backup(listed: list[os.DirEntry[str]]) -> bool:
    """Return whether a folder with these entries is a repository or a controller's backup."""
    names = {entry.name.casefold() for entry in listed}
    drives = [Path(entry.path) for entry in listed if entry.name.casefold() == "c"]
    return (
        not names.isdisjoint(_BACKUP_SIGNS)
        or is_drive(names)
        or any((c / "KRC").is_dir() for c in drives)
    )


def _has_programs(listed: list[os.DirEntry[str]]) -> bool:
    """Return whether a folder has programs itself, so that its folders are no origins."""
    return any(_is_program(entry.name) for entry in listed)


def _is_corpus(listed: list[os.DirEntry[str]]) -> bool:
    names = {entry.name for entry in listed}
    return _CORPUS_SIGN in names and not names.isdisjoint(_CORPUS_FOLDERS)


def _origin(folder: Path) -> str:
    """Return the name of the origin `folder`; `OWNER__NAME` stands for OWNER/NAME."""
    name = folder.name or folder.anchor
    owner, mark, repository = name.partition("__")
    return printable(f"{owner}/{repository}" if owner and mark and repository else name)


def _is_program(name: str) -> bool:
    return name.lower().endswith(SUFFIXES)


def _wanted(name: str) -> bool:
    return _is_program(name) or is_archive(name)


def _ignored(folder: str) -> bool:
    return folder.startswith(".") or folder.casefold() in IGNORED_FOLDERS


def _wanted_member(path: str) -> bool:
    *folders, name = path.split("/")
    return _wanted(name) and not any(map(_ignored, folders))


# -- the survey of places --------------------------------------------------------------------------


def _survey(roots: list[_Root]) -> Iterator[FoundFile | Skipped]:
    """Yield everything below `roots`; see `discover`."""
    places = frozenset(root.real for root in roots)
    names = _archive_names(
        place.real
        for root in roots
        for place in _walk(root, places - {root.real})
        if is_archive(place.real.name) and not place.problem
    )
    found = 0
    first: Skipped | None = None
    for root in roots:
        for place in _walk(root, places - {root.real}):
            for item in filter(root.holds, _items(place, names)):
                if isinstance(item, FoundFile):
                    found += 1
                else:
                    first = first or item
                yield item
    if found:
        return
    lone = roots[0] if len(roots) == 1 else None
    if lone and first and not lone.folder:
        raise IngestError(f"{first.path}: {first.reason}")
    if not first:
        where = printable(lone.inside or lone.shown) if lone else f"{len(roots)} places"
        raise IngestError(f"{where}: no .src, .dat or .sub file in {'it' if lone else 'any'}")


def _items(place: _Place, names: dict[Path, str]) -> Iterator[FoundFile | Skipped]:
    """Yield the candidates at a place, or why there is none."""
    shown = printable(place.shown)
    if place.problem:
        yield Skipped(shown, printable(place.problem), place.origin)
    elif is_archive(place.real.name):
        yield from _in_archive(place.real, shown, names.get(place.real, place.real.stem))
    else:
        try:
            size = place.real.stat().st_size
        except OSError as error:
            yield Skipped(shown, f"cannot be read: {archives.why(error)}", place.origin)
            return
        if size > archives.MAX_FILE_BYTES:
            yield Skipped(shown, archives.too_large(), place.origin)
        else:
            yield FoundFile(shown, place.origin, size, place.real, None)


def _in_archive(file: Path, shown: str, origin: str) -> Iterator[FoundFile | Skipped]:
    """Yield the candidates in an archive.

    If all candidates are in nested archives, each of these is an origin.
    """
    try:
        listed = archives.members(file, _wanted_member)
    except ArchiveError as error:
        yield Skipped(shown, printable(str(error)), origin)
        return
    collection = not any(member.nested is None and not is_archive(member.path) for member in listed)
    for member in listed:
        name = origin
        if collection and member.nested:
            name = printable(f"{origin}/{PurePosixPath(member.nested).with_suffix('')}")
        path = printable(f"{shown}/{member.path}")
        if member.problem:
            yield Skipped(path, printable(member.problem), name)
        else:
            yield FoundFile(path, name, member.size, file, member.address)


def _archive_names(files: Iterable[Path]) -> dict[Path, str]:
    """Return a unique name for each archive: its file name, with folders if necessary."""
    names: dict[Path, str] = {}
    alike = list(dict.fromkeys(files))
    for depth in range(1, 1 + max((len(file.parts) for file in alike), default=0)):
        candidates = {file: "/".join((*file.parts[-depth:-1], file.stem)) for file in alike}
        shared = Counter(candidates.values())
        names |= {file: printable(name) for file, name in candidates.items() if shared[name] == 1}
        alike = [file for file in alike if file not in names]
    return names | {file: printable(file.as_posix()) for file in alike}
