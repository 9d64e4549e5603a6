"""Which files are one project: one rule for folders and archives, wherever one enters them.

1. What a controller holds is a project: a folder with R1 or STEU in it, or a drive under another
   name. Programs around it are no part of it. Where other files have several $CONFIG lists, each of
   these begins a project.
2. Any other file belongs to the outermost folder around it that is one project; without such a
   folder, to the files beside it. A folder is one project, with all that is below it, if no file
   name occurs twice in it, and it holds programs itself or its folders call one another. If a name
   occurs twice, programs in the folder are one project with the folders without such a name that
   call them or are called. So two robots, copies, and the repositories of a corpus stay apart.
3. An archive is a folder that shares nothing with what lies around it.

Only files with KRL count, so that a folder and its archive give the same.
"""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Iterator, Sequence, Set
from functools import cache
from itertools import chain
from typing import Generic, Protocol, TypeAlias, TypeVar

from support.files.archives import is_archive
from support.files.discovery import (
    DRIVE_FOLDERS,
    FoundFile,
    Skipped,
    SourceFile,
    is_drive,
    read_source,
)
from support.lazy_dataclass import dataclass

DRIVES = {"r1", "steu"}
_CONFIG = "$config.dat"
#: Calls, and what only looks like one.
_CALL = re.compile(
    r";[^\r\n]*|(?:\A|(?<=[\r\n]))[ \t]*(?:GLOBAL[ \t]+)?DEF(?:FCT)?\b[^\r\n]*"
    r"|\b([A-Z_]\w*)[ \t]*\(",
    re.IGNORECASE | re.ASCII,
)

_Folder = tuple[str, ...]


class _HasPath(Protocol):
    @property
    def path(self) -> str: ...


_File = TypeVar("_File", bound=_HasPath)
_Candidate = TypeVar("_Candidate", bound=FoundFile | Skipped)


@dataclass(frozen=True, slots=True)
class _Placed(Generic[_File]):
    """A file and its folders, as written and with letter case folded."""

    file: _File
    folders: _Folder
    folded: _Folder
    name: str


#: Files that are in the same project.
_Part: TypeAlias = list[_Placed[_File]]


def _placed(files: Iterable[_File]) -> Iterator[_Placed[_File]]:
    """Yield the places of files; those in one folder share it."""

    @cache
    def folders(path: str, slash: str) -> tuple[_Folder, _Folder]:
        written = tuple(path.split("/")) if slash else ()
        return written, tuple(map(str.casefold, written))

    for file in files:
        folder, slash, name = file.path.rpartition("/")
        yield _Placed(file, *folders(folder, slash), name.casefold())


def projects_of(files: Iterable[_Candidate]) -> Iterator[tuple[str, bool, list[_Candidate]]]:
    """Yield the root of each project, whether it is a controller's, and its files.

    Few of the files are read: those whose calls decide.
    """
    files = list(files)
    stems = {_stem(file.path.rpartition("/")[2].casefold()) for file in files}

    @cache
    def calls(file: _Candidate) -> Set[str]:
        read = read_source(file)
        text = read.text if isinstance(read, SourceFile) else ""
        lines = text.replace("\r", "\n").split("\n")
        some = "\n".join(line for line in lines if "(" in line.partition(";")[0])  # most have none
        return stems.intersection(map(str.casefold, _CALL.findall(some)))

    yield from grouped(files, calls)


def grouped(
    files: Iterable[_File], calls: Callable[[_File], Set[str]] | None = None
) -> Iterator[tuple[str, bool, list[_File]]]:
    """Yield the files of each project with its root, and whether the root holds a drive.

    ``calls`` are the names of files that a file calls, in lower case. Without it, files outside a
    controller are taken to be one project, unless they have several $CONFIG lists.
    """
    by_archive: dict[_Folder, list[_Placed[_File]]] = defaultdict(list)
    for placed in _placed(files):
        depths = [d for d, name in enumerate(placed.folded, 1) if is_archive(name)]
        by_archive[placed.folded[: max(depths, default=0)]].append(placed)
    for _, inside in sorted(by_archive.items()):
        for (is_controller, root), members in sorted(_by_layout(inside).items()):
            for some in [members] if is_controller or not calls else _joined(members, calls):
                depth = len(root) if is_controller else _shared(some)
                shown = "/".join(some[0].folders[:depth])
                yield shown, is_controller, [placed.file for placed in some]


def _by_layout(
    files: Sequence[_Placed[_File]],
) -> dict[tuple[bool, _Folder], list[_Placed[_File]]]:
    """Return the files of each controller, and the others, those of each of several $CONFIG."""
    groups: dict[tuple[bool, _Folder], list[_Placed[_File]]] = defaultdict(list)
    loose = []
    drives = {root for placed in files for root in drive_roots(placed.folded)}
    renamed = _renamed_drives(files)
    for placed in files:
        root = _last(drives, placed.folded, DRIVES)
        if root is None:
            drive = _last(renamed.keys(), placed.folded)
            root = None if drive is None else renamed[drive]
        if root is None:
            loose.append(placed)
        else:
            groups[True, root].append(placed)
    configs = {_config_root(placed.folded) for placed in loose if placed.name == _CONFIG}
    for placed in loose:
        root = _last(configs, placed.folded) if len(configs) > 1 else None
        groups[False, root or ()].append(placed)
    return groups


def _joined(
    files: Sequence[_Placed[_File]], calls: Callable[[_File], Set[str]]
) -> list[_Part[_File]]:
    """Return the files of each project; none of them is a controller's."""
    own: dict[_Folder, _Part[_File]] = defaultdict(list)
    for placed in files:
        own[placed.folded].append(placed)
    below: dict[_Folder, list[_Part[_File]]] = defaultdict(list)
    every = {folder[:depth] for folder in own for depth in range(len(folder) + 1)}
    for folder in sorted(every, key=len, reverse=True):
        parts = _joined_in(own.get(folder, []), below.pop(folder, []), calls)
        below[folder[:-1]] += parts
    numbers = {id(placed): number for number, part in enumerate(below[()]) for placed in part}
    found: dict[int, _Part[_File]] = defaultdict(list)
    for placed in files:  # in their order
        found[numbers[id(placed)]].append(placed)
    return [*found.values()]


def _joined_in(
    own: _Part[_File], parts: list[_Part[_File]], calls: Callable[[_File], Set[str]]
) -> list[_Part[_File]]:
    """Return the parts of a folder: its own files, and those below it, as far as they are joined.

    What is not joined may still be so in an outer folder.
    """
    counts = Counter(placed.name for placed in chain(own, *parts))
    if max(counts.values()) == 1:
        is_one = own or any(True for _ in _calls_between(parts, calls))
        return [[*own, *chain.from_iterable(parts)]] if is_one else parts
    if not own:
        return parts
    free, apart = [own], list[_Part[_File]]()
    for part in parts:
        (apart if any(counts[placed.name] > 1 for placed in part) else free).append(part)
    near = _connected_to_first(_calls_between(free, calls))
    joined = [*chain.from_iterable(part for number, part in enumerate(free) if number in near)]
    return [joined, *apart, *(part for number, part in enumerate(free) if number not in near)]


def _calls_between(
    parts: Sequence[_Part[_File]], calls: Callable[[_File], Set[str]]
) -> Iterator[tuple[int, int]]:
    """Yield the numbers of two parts where the first calls a file of the second by its name."""
    having: dict[str, set[int]] = defaultdict(set)
    for number, part in enumerate(parts):
        for placed in part:
            having[_stem(placed.name)].add(number)
    for number, part in enumerate(parts):
        for placed in part:
            for name in calls(placed.file) & having.keys():
                yield from ((number, other) for other in having[name] if other != number)


def _stem(name: str) -> str:
    return name.rpartition(".")[0]


def _connected_to_first(pairs: Iterable[tuple[int, int]]) -> set[int]:
    """Return 0 and all numbers that pairs connect with it."""
    near: dict[int, set[int]] = defaultdict(set)
    for one, other in pairs:
        near[one].add(other)
        near[other].add(one)
    found, todo = {0}, [0]
    while todo:
        more = near[todo.pop()] - found
        found |= more
        todo += more
    return found


def drive_roots(folders: _Folder) -> Iterator[_Folder]:
    """Yield the folders on a path that certainly hold the drives of a controller."""
    for depth, name in enumerate(folders):
        if name in DRIVES:
            is_below_krc = depth > 0 and folders[depth - 1] == "krc"
            if is_below_krc or (depth + 1 < len(folders) and folders[depth + 1] in DRIVE_FOLDERS):
                yield folders[:depth]


def _renamed_drives(files: Iterable[_Placed[_File]]) -> dict[_Folder, _Folder]:
    """Return the drives that are not called R1, each with the root of its project.

    The root is the parent folder if it also has STEU, otherwise the drive itself.
    """
    inside: dict[_Folder, set[str]] = defaultdict(set)
    for placed in files:
        for depth, name in enumerate(placed.folded):
            inside[placed.folded[:depth]].add(name)
    return {
        folder: folder[:-1] if folder and "steu" in inside[folder[:-1]] else folder
        for folder, names in inside.items()
        if is_drive(names) and not (folder and folder[-1] in DRIVES)
    }


def _last(roots: Set[_Folder], folders: _Folder, inside: Set[str] | None = None) -> _Folder | None:
    """Return the innermost root on a path, if the next folder is one of ``inside``."""
    for depth in range(len(folders), -1, -1):
        if folders[:depth] in roots and (
            inside is None or (depth < len(folders) and folders[depth] in inside)
        ):
            return folders[:depth]
    return None


def _config_root(folders: _Folder) -> _Folder:
    return folders[:-1] if folders and folders[-1] == "system" else folders


def _shared(members: Sequence[_Placed[_File]]) -> int:
    """Return the number of leading folders that all files have in common."""
    first, last = min(placed.folded for placed in members), max(p.folded for p in members)
    return next(
        (depth for depth, (a, b) in enumerate(zip(first, last, strict=False)) if a != b),
        min(len(first), len(last)),
    )
