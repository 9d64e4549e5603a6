"""The contents of folders, on disk and in archives, as far as projects are found by them."""

import os
import re
from collections.abc import Mapping, Sequence, Set
from pathlib import Path, PurePath, PurePosixPath
from typing import TYPE_CHECKING, Protocol, TypeVar

if TYPE_CHECKING:
    from support.files.discovery import Found

_ENDINGS = frozenset({".src", ".dat", ".sub"})
#: The most files that are examined to find out whether a folder has mostly KRL.
_MOST_BELOW = 2_000
#: Also matches names in comments, which does no harm here.
_CALL = re.compile(r"\b([A-Z_]\w*)[ \t]*\(", re.IGNORECASE | re.ASCII)

_Folder_contra = TypeVar("_Folder_contra", bound=PurePath, contravariant=True)


class Folders(Protocol[_Folder_contra]):
    """The contents of folders, on disk or in an archive."""

    def folders_in(self, folder: _Folder_contra) -> list[str]:
        """Return the names of the folders in a folder."""

    def is_of_krl(self, folder: _Folder_contra) -> bool:
        """Return whether a folder holds KRL, not mostly other files."""

    def below(self, folder: _Folder_contra) -> Sequence[PurePath]:
        """Return the KRL files below a folder; none if most of its files are others."""

    def calls(self, file: PurePath) -> Set[str]:
        """Return the routines that a file calls, in upper case."""


class DiskFolders:
    """Folders on disk; an unreadable one counts as empty."""

    def folders_in(self, folder: Path) -> list[str]:
        """Return the names of the folders in a folder."""
        return [one.name for one in entries_in(folder) if one.is_dir()]

    def programs(self, folder: Path) -> list[Path]:
        """Return the KRL files directly in a folder."""
        return [path for one in entries_in(folder) if is_krl(path := Path(one))]

    def is_of_krl(self, folder: Path) -> bool:
        """Return whether at least half of the files in a folder are KRL."""
        files = [is_krl(Path(one)) for one in entries_in(folder) if one.is_file()]
        return 0 < len(files) <= 2 * sum(files)

    def below(self, folder: Path) -> list[Path]:
        """Return the KRL files below a folder.

        None if most of its files are others, if there are too many, or if one is a link.
        """
        todo, seen = [folder], list[Path]()
        while todo:
            for one in entries_in(todo.pop()):
                if one.is_symlink() or len(seen) + len(todo) > _MOST_BELOW:
                    return []
                (todo if one.is_dir() else seen).append(Path(one))
        files = [*filter(is_krl, seen)]
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


class ArchiveFolders:
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
        """Return the names of the folders in a folder, without those that hold no KRL."""
        return list(self._folders.get(folder, ()))

    def is_of_krl(self, folder: PurePosixPath) -> bool:
        """Return whether a folder has KRL files."""
        return folder in self._with_krl

    def below(self, folder: PurePosixPath) -> list[PurePosixPath]:
        """Return the KRL files below a folder."""
        return [one for one in self._files if folder in one.parents]

    def calls(self, file: PurePath) -> Set[str]:
        """Return the routines that a file calls, in upper case."""
        from support.files.discovery import SourceFile, read_source

        read = read_source(self._files[PurePosixPath(file)])
        return _calls(read.text) if isinstance(read, SourceFile) else frozenset()


def entries_in(folder: Path) -> "list[os.DirEntry[str]]":
    """Return what is directly in a folder and not hidden, nothing if it cannot be read."""
    try:
        with os.scandir(folder) as entries:
            return [one for one in entries if not one.name.startswith(".")]
    except OSError:
        return []


def is_krl(path: Path) -> bool:
    """Return whether a file has a suffix of KRL."""
    return path.suffix.lower() in _ENDINGS


def _calls(text: str) -> Set[str]:
    return {name.upper() for name in _CALL.findall(text)}
