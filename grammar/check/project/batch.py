"""Checks folders and archives: every file is checked as part of its project.

Files are grouped into projects by their location (`grammar.semantics.project_grouping`).
Projects are checked one after another in parallel processes; a large one uses all processes
(`support.parallel.sticky_pool`). The order of the findings does not depend on processes. Results
are cached: of an unchanged project completely, of any other project those of the files that need
not be checked again (`grammar.check.project.project_check`).
"""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Future
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

from grammar.check.project.project_check import (
    MANY_OBJECTS,
    CheckOptions,
    Content,
    FileResult,
    KnownFile,
    check_part,
    completed,
    found_in_project,
    linked,
    needs,
    read_part,
    recheck,
)
from grammar.check.project.report import CheckReport, is_large, together
from grammar.check.project.result_cache import ProjectResult, recalled, state_of, stored
from grammar.check.project.suppression_comments import apply_suppressions
from grammar.diagnostics.diagnostic import Diagnostic, Region, diagnose, in_order
from grammar.semantics.project_grouping import projects_of
from support.files.decode import digest
from support.files.discovery import FoundFile, IngestError, Skipped, discover, read
from support.files.result_store import ResultStore
from support.gc_pause import gc_paused
from support.lazy_dataclass import dataclass
from support.parallel.progress import Progress, no_progress
from support.parallel.sticky_pool import StickyPool

__all__ = ["CheckOptions", "check_paths"]

# Starting a process takes as long as checking so many bytes.
_WORTH_A_PROCESS = 1_000_000
# A project of so many bytes is shared by all processes.
_LARGE = 400_000
# So many bytes a process wait for their turn, so that memory stays flat.
_MOST_WAITING = 2_000_000


def check_paths(
    roots: Sequence[Path],
    options: CheckOptions,
    *,
    around: Sequence[Path] = (),
    leaves_out: Callable[[FoundFile], bool] | None = None,
    jobs: int | None = None,
    cache: Path | None = None,
    on_found: Progress = no_progress,
    on_done: Progress = no_progress,
) -> CheckReport:
    """Check everything below ``roots``.

    ``around`` are the folders and archives of the projects that these belong to, if they are more:
    what is there is read, and not reported. ``leaves_out`` says which files are not to be read.
    ``jobs`` is the number of processes, by default one a core, or one where there is little to do.
    ``cache`` is the folder where findings are kept for the next time; without one nothing is kept.
    ``on_found`` is given the number of candidates once it is known, ``on_done`` how many
    more are done.

    Raises `support.files.discovery.IngestError` where there is nothing to check.
    """
    work = _work_of(roots, around, leaves_out)
    on_found(work.count + len(work.skipped))
    on_done(len(work.skipped))
    processes = jobs or min(os.cpu_count() or 1, 1 + work.size // _WORTH_A_PROCESS)
    with (
        gc_paused(MANY_OBJECTS),
        ResultStore(cache, "check") as store,
        StickyPool(processes) as pool,
    ):

        def results() -> Iterator[ProjectResult]:
            for result in _run(work.taken(), pool, store, replace(options, kept=store.is_open)):
                on_done(result.files + len(result.skipped))
                yield _reported(result, work.names)

        return together(results(), work.skipped)


@dataclass(frozen=True, slots=True)
class _Work:
    """The projects to check, of ``count`` files with ``size`` bytes.

    ``names`` are the paths to report the files under, by their own paths; others are only read.
    """

    projects: deque[list[FoundFile | Skipped]]
    names: Mapping[str, str]
    skipped: Sequence[Skipped]
    count: int
    size: int

    def taken(self) -> Iterator[list[FoundFile | Skipped]]:
        """Yield each project, and keep none: there may be more files than memory."""
        while self.projects:
            yield self.projects.popleft()


def _work_of(
    roots: Sequence[Path], around: Sequence[Path], leaves_out: Callable[[FoundFile], bool] | None
) -> _Work:
    def is_left(one: FoundFile | Skipped) -> bool:
        return leaves_out is None or isinstance(one, Skipped) or not leaves_out(one)

    asked = list(filter(is_left, discover(roots)))
    skipped = [candidate for candidate in asked if isinstance(candidate, Skipped)]
    wanted = {_place(one): one.path for one in asked if isinstance(one, FoundFile)}
    names: dict[str, str] = {}
    projects = deque[list[FoundFile | Skipped]]()
    size = 0
    everywhere = [
        asked if [root] == list(roots) else list(filter(is_left, _below(root)))
        for root in _outermost(around or roots)
    ]
    there = {_place(one) for every in everywhere for one in every if isinstance(one, FoundFile)}
    # a hidden folder is read where it is asked for, and not as part of what is around
    everywhere.append(
        [one for one in asked if isinstance(one, FoundFile) and _place(one) not in there]
    )
    for every in everywhere:
        known = [one for one in every if isinstance(one, FoundFile) or is_large(one)]
        for _, _, members in projects_of(known):
            found = [one for one in members if isinstance(one, FoundFile)]
            own = {one.path: wanted[_place(one)] for one in found if _place(one) in wanted}
            if own:
                names |= own
                projects.append(members)
                size += sum(one.size for one in found)
    count = sum(isinstance(one, FoundFile) for some in projects for one in some)
    return _Work(projects, names, skipped, count, size)


def _outermost(roots: Sequence[Path]) -> list[Path]:
    """Return the roots that do not lie in others, each once."""
    places = {root.resolve(): root for root in reversed(roots)}
    return [root for place, root in places.items() if places.keys().isdisjoint(place.parents)]


def _below(root: Path) -> Iterator[FoundFile | Skipped]:
    """Yield what is below a root, if anything."""
    with suppress(IngestError):
        yield from discover([root])


def _reported(result: ProjectResult, names: Mapping[str, str]) -> ProjectResult:
    """Return what is to be said of a project: that of the files with a name, under that."""
    return replace(
        result,
        diagnostics=tuple(
            replace(one, path=names[one.path]) for one in result.diagnostics if one.path in names
        ),
        lines={(names[at], n): line for (at, n), line in result.lines.items() if at in names},
        skipped=tuple(
            replace(one, path=names[one.path]) for one in result.skipped if one.path in names
        ),
        sizes={names[path]: size for path, size in result.sizes.items() if path in names},
        kept=frozenset(names[path] for path in result.kept if path in names),
    )


def _place(found: FoundFile) -> tuple[Path, str | None]:
    """Return the location of a file, however it was found."""
    return found.file, found.member


# --------------------------------------------------------------------------------- one by one


class _Project:
    """A project that is being checked."""

    def __init__(self, members: Sequence[FoundFile | Skipped], options: CheckOptions) -> None:
        self.options = options
        self.contents: list[Content] = []
        self.unread: list[Diagnostic] = []
        for member in members:
            data = read(member) if isinstance(member, FoundFile) else member
            if isinstance(data, bytes):
                self.contents.append(Content(member.path, member.origin, data))
                continue
            self.contents.append(Content(member.path, member.origin, data.reason.encode(), True))
            if data is not member:
                region = Region(1, 1, 1, 1)
                self.unread.append(diagnose("unreadable", member.path, region, data.reason))
        self.places = list(map(_address, members))
        self.place = digest("\n".join(self.places).encode())
        self.size = sum(len(content.data) for content in self.contents)
        self.state = state_of(self.contents, options)
        self._known: Mapping[int, KnownFile] = {}
        self._whole: Future[list[KnownFile]] | None = None
        self._parts: list[Future[dict[int, FileResult]]] = []

    def start(self, number: int, pool: StickyPool, store: ResultStore) -> None:
        """Have the project checked; with several processes this waits until it has been read."""
        known = self._known = {
            index: one
            for index, place in enumerate(self.places)
            if (one := recalled(store, place, self._state_of(index), KnownFile))
        }
        new = {index: one for index, one in enumerate(self.contents) if index not in known}
        size = sum(len(content.data) for content in new.values())
        if pool.count == 1 or size < _LARGE:
            process = pool.least_loaded(size)
            self._whole = pool.submit(process, recheck, self.contents, self.options, known)
            return
        reading = [
            pool.submit(process, read_part, number, share, self.options)
            for process, share in enumerate(_shares(new, pool.count))
        ]
        looked = {index: one.read for index, one in known.items()}
        for part in reading:
            looked |= part.result()
        self._read = looked
        paths = [content.path for content in self.contents]
        projects = linked(paths, looked, self.options) if self.options.kept else ()
        self._needs = needs(paths, looked, projects)
        for project in projects:
            project.forget()
        stale = {i: self.contents[i] for i, one in known.items() if not one.stands(self._needs[i])}
        self._parts = [
            pool.submit(process, check_part, number, paths, looked, again, self.options)
            for process, again in enumerate(_shares(stale, pool.count))
        ]

    @property
    def is_done(self) -> bool:
        """Return whether `result` returns at once."""
        return all(part.done() for part in ([self._whole] if self._whole else self._parts))

    def keep(self, result: ProjectResult, store: ResultStore) -> None:
        """Keep what was found, and what is now known of files."""
        new = (i for i, file in enumerate(self._files) if file is not self._known.get(i))
        store.put((self.places[i], stored(self._state_of(i), self._files[i])) for i in new)
        # what is recalled of a project comes from the cache as a whole
        whole = replace(result, kept=frozenset(result.sizes))
        store.put([(self.place, stored(self.state, whole))])

    def _state_of(self, index: int) -> str:
        return state_of([self.contents[index]], self.options)

    def result(self) -> ProjectResult:
        """Wait for the findings and return them."""
        if self._whole is not None:
            self._files = self._whole.result()
        else:
            checked: dict[int, FileResult] = {}
            for part in self._parts:
                checked |= part.result()
            self._files = completed(self._read, self._known, checked, self._needs)
        looked = [known.checked for known in self._files]
        diagnostics = found_in_project(self.contents, self._files)
        by_path: dict[str, list[Diagnostic]] = {content.path: [] for content in self.contents}
        for diagnostic in diagnostics:
            by_path[diagnostic.path].append(diagnostic)
        found = list(self.unread)
        lines: dict[tuple[str, int], str] = {}
        skipped = []
        sizes = {one.path: 0 for one in self.unread}
        for content, one in zip(self.contents, looked, strict=True):
            if content.is_unread:
                continue
            if one.skipped is not None:
                skipped.append(Skipped(content.path, one.skipped, content.origin))
                continue
            sizes[content.path] = len(content.data)
            lines |= {(content.path, number): line for number, line in (one.lines or {}).items()}
            its = by_path.pop(content.path, [])  # of two with one path, together with the first
            if late := {diagnostic.region.line for diagnostic in its} - (one.lines or {}).keys():
                source = content.source()
                lines |= {(content.path, number): source.line(number) for number in late}
            found += apply_suppressions(content.path, its, one.comments, self.options.wanted_codes)
        kept = frozenset(
            content.path
            for index, content in enumerate(self.contents)
            if self._files[index] is self._known.get(index)
        )
        return ProjectResult(tuple(in_order(found)), lines, tuple(skipped), sizes, kept)


def _address(found: FoundFile | Skipped) -> str:
    """Identifies a file, and how it was named."""
    file = _place(found) if isinstance(found, FoundFile) else ()
    place = f"{file}\n{found.path}\n{found.origin}"
    return digest(place.encode("utf-8", "surrogatepass"))


def _shares(contents: Mapping[int, Content], count: int) -> list[dict[int, Content]]:
    """Return files in shares of about the same size."""
    shares: list[dict[int, Content]] = [{} for _ in range(count)]
    sizes = [0] * count
    for index, content in sorted(contents.items(), key=lambda item: -len(item[1].data)):
        smallest = sizes.index(min(sizes))
        sizes[smallest] += len(content.data)
        shares[smallest][index] = content
    return [dict(sorted(share.items())) for share in shares]


def _run(
    projects: Iterator[list[FoundFile | Skipped]],
    pool: StickyPool,
    store: ResultStore,
    options: CheckOptions,
) -> Iterator[ProjectResult]:
    """Yield the results of projects in order; only a limited number is in flight."""
    waiting: deque[_Project | ProjectResult] = deque()
    size = 0
    most = _MOST_WAITING * pool.count

    def is_done(project: _Project | ProjectResult) -> bool:
        return isinstance(project, ProjectResult) or project.is_done

    def first() -> ProjectResult:
        nonlocal size
        project = waiting.popleft()
        if isinstance(project, ProjectResult):
            return project
        size -= project.size
        result = project.result()
        project.keep(result, store)
        return result

    for number, members in enumerate(projects):
        project = _Project(members, options)
        known = recalled(store, project.place, project.state, ProjectResult)
        if known is not None:
            waiting.append(known)
        else:
            project.start(number, pool, store)
            waiting.append(project)
            size += project.size
        while waiting and (size > most or is_done(waiting[0])):
            yield first()
    while waiting:
        yield first()
