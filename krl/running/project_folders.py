"""The project of a file: the folder around all files that it can see."""

import os
from collections.abc import Set
from itertools import chain
from pathlib import Path, PurePath
from typing import TypeVar

from krl.running.folder_contents import DiskFolders, Folders, entries_in, is_krl

#: Folders directly below the root of a controller's files.
PARTS = frozenset({"R1", "STEU"})
_OF_CONTROLLERS = frozenset({*PARTS, "SYSTEM", "MADA"})

_P = TypeVar("_P", bound=PurePath)


def project_root(path: Path) -> Path:
    """Return the folder of the project to which a file or folder belongs.

    It is the folder around R1 or STEU, or around a drive with another name (`is_drive`). Without
    such a layout the folder itself is the project; but if it lies in a folder of KRL, such as
    Program, that is. A folder with a few programs among many other files is no project: a program
    then has the files to which it refers (`read_sources`).
    """
    path = path.resolve()
    return root_around(path if path.is_dir() else path.parent, DiskFolders())


def project_paths(path: Path) -> list[Path]:
    """Return the paths to read for everything a file or folder sees.

    This is its project; else the files beside a program, and otherwise the path itself.
    """
    archive, _ = in_archive(path)
    if archive is not None or not path.exists():
        return [archive or path]
    root, is_program = project_root(path), path.is_file() and is_krl(path)
    if _is_controller(root) or ((is_program or path.is_dir()) and is_project(root)):
        return [_as_given(root, path)]
    return DiskFolders().programs(path.parent) if is_program else [path]


def root_around(folder: _P, folders: Folders[_P]) -> _P:
    """Return the folder of the project around a folder, as `project_root`."""
    from support.files.discovery import is_drive

    for one in (folder, *folder.parents):
        if one.name.upper() in PARTS:
            return one.parent
        names = folders.folders_in(one)
        if is_drive(names):
            beside = map(str.upper, folders.folders_in(one.parent))
            return one.parent if "STEU" in beside else one
        if PARTS & set(map(str.upper, names)) and one.name.upper() == "KRC":
            return one
    while folder != folder.parent and folders.is_of_krl(folder.parent):
        folder = folder.parent
    return _calling(folder, folders)


def in_archive(file: Path) -> tuple[Path | None, str]:
    """Return the archive in a path and the rest of the path; ``None`` for a plain file."""
    for parent in file.parents:
        if parent.suffix.lower() == ".zip" and parent.is_file():
            return parent, file.relative_to(parent).as_posix()
    return None, ""


def is_project(root: Path) -> bool:
    """Return whether all KRL files below a root belong to one project."""
    disk = DiskFolders()
    is_whole = disk.is_of_krl(root) or (not any(map(os.DirEntry.is_file, entries_in(root))))
    return _is_controller(root) or (is_whole and bool(disk.below(root)))


def files_near(folder: Path) -> list[Path]:
    """Return the KRL files in a folder and, recursively, in its folders that have some."""
    disk = DiskFolders()
    inner = (folder / name for name in disk.folders_in(folder))
    below = (files_near(one) for one in inner if not one.is_symlink() and disk.programs(one))
    return [*disk.programs(folder), *chain.from_iterable(below)]


def _calling(folder: _P, folders: Folders[_P]) -> _P:
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

    names = DiskFolders().folders_in(root)
    return is_drive(names) or not PARTS.isdisjoint(map(str.upper, names))


def _as_given(root: Path, path: Path) -> Path:
    """Return a folder around a path; relative if the path is."""
    if root == path.resolve():
        return path
    is_near = not path.is_absolute() and root.drive == Path.cwd().drive
    return Path(os.path.relpath(root)) if is_near else root
