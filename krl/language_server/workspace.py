"""The files that an editor works on: those in its folder, and open ones with unsaved changes.

A file is parsed when its text changes; linking uses the symbol tables of all files. The file that
the editor shows is checked at once. Other files are checked in the background
(`OpenProject.catch_up`), and the certainty of an unknown name is only decided when all files of the
project are checked. Paths are absolute and use ``/``; lines and columns count from 1. Positions of
the protocol are converted in `krl.language_server.server`.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path

from grammar.check.names.unresolved_name import Files
from grammar.check.project.dependencies import Contribution, Needs, contribution, needs_of
from grammar.check.project.framework import Checked, Findings, check_module, check_project
from grammar.check.project.project_check import Reading, read_source
from grammar.check.project.suppression_comments import apply_suppressions, suppression_comments
from grammar.diagnostics.diagnostic import Diagnostic, in_order
from grammar.diagnostics.selection import Selection
from grammar.semantics.link import File, Project, Workspace, link
from grammar.semantics.project_grouping import projects_of
from grammar.semantics.scopes import Answer, Found, Module, Scope, Undetermined
from grammar.semantics.symbol_table import table_of
from grammar.semantics.symbols import ModuleTable
from grammar.syntax.ast import Name
from grammar.syntax.source import Source
from krl.baseline_file import baseline_place, read_baseline
from krl.errors import InputError
from krl.project_settings import FILE_NAME, Settings, read_settings, settings_file
from support.files import discovery
from support.files.decode import Decoded, decode
from support.files.untrusted import read_bytes
from support.gc_pause import gc_paused

#: More files than the largest backup has; a folder with more is somebody's whole disk.
MOST_FILES = 5_000
_NONE = Settings(Path())
#: Findings that are no faults: why the robot stops. `krl check` reports them with --stops.
_SOUGHT = ("KSS", *(f"KRL{digit}" for digit in "01234579"))


@dataclass(frozen=True, slots=True, eq=False)
class _Read:
    """A parsed file, and what it contributes to others."""

    source: Source
    reading: Reading
    file: File
    given: Contribution
    is_krl: bool


@dataclass(frozen=True, slots=True)
class _Judged:
    """The last findings of a file, and the facts on which they depend, if known."""

    findings: Findings
    is_open: bool
    needs: Needs | None = None

    def stands(self, needs: Needs) -> bool:
        return self.needs is not None and needs.keep(self.needs, is_open=self.is_open)


@dataclass(frozen=True, slots=True, eq=False)
class AnalysedFile:
    """All that is known of one file.

    ``module``, ``project`` and ``checked`` are ``None`` for a file that cannot be read.
    """

    source: Source
    diagnostics: tuple[Diagnostic, ...]
    module: Module | None = None
    project: Project | None = None
    checked: Checked | None = None

    def scope(self, line: int) -> Scope | None:
        """Return the scope at a line: that of its routine, if it is in one."""
        if self.project is None or self.module is None or self.module.table is None:
            return None
        for routine in reversed(self.module.table.routines):
            if self.source.place(routine.routine.span[0])[0] <= line:
                return self.project.scope(self.module, routine)
        return self.project.scope(self.module)

    def names(self) -> Iterator[tuple[Name, Found]]:
        """Yield each name with its declaration, even if an unreadable line may declare it, too."""
        if self.checked is not None:
            for name, answer in self.checked.resolution.answers.items():
                found = certain(answer)
                if isinstance(found, Found):
                    yield name, found


def certain(answer: Answer) -> Answer:
    """Return the only candidate, even if the line being typed makes it uncertain."""
    if isinstance(answer, Undetermined) and len(answer.candidates) == 1:
        return answer.candidates[0]
    return answer


class OpenProject:
    """The files of a workspace by path, with their current state."""

    def __init__(self) -> None:
        self._files: dict[str, _Read] = {}
        self._linked: Mapping[str, tuple[Project, Module]] | None = None
        self._workspaces: dict[Settings, Workspace] = {}
        self._caught_up: set[Project] = set()
        self._looked: dict[str, AnalysedFile] = {}
        self._judged: dict[str, _Judged] = {}
        self._origins: dict[Path, str] = {}
        self._agreed: dict[Path | None, Settings] = {}
        self._groups: dict[str, tuple[Settings, str] | None] = {}
        self._folders: dict[Path, None] = {}
        #: By file of settings what `krl check` says of it instead of checking.
        self.refused: dict[Path, str] = {}

    def add_folder(self, folder: Path) -> Iterator[str]:
        """Add the KRL files in a folder one by one, and yield their paths.

        Files beyond `MOST_FILES` and files that are already open are skipped; a missing folder has
        none.
        """
        self._folders[folder] = None
        try:
            found = [
                one for one in discovery.discover([folder]) if isinstance(one, discovery.FoundFile)
            ]
        except discovery.IngestError:
            return
        for root, _, members in projects_of(found):
            for one in members:
                self._origins.setdefault(one.file.parent, root)
        self._groups.clear()
        for one in found[:MOST_FILES]:
            path = one.file.as_posix()
            if one.member is not None:
                continue
            if path not in self._files:
                self.reload(path)
                yield path

    def reload(self, path: str) -> None:
        """Read a file from disk; forget it if it is gone or not KRL."""
        try:
            decoded = decode(read_bytes(Path(path)))
        except OSError:
            decoded = ""
        if isinstance(decoded, str):
            self.forget(path)
        else:
            self.change(path, decoded.text)

    def change(self, path: str, text: str) -> None:
        """Set the text of a file."""
        known = self._files.get(path)
        if known is not None and known.source.text == text:
            return
        with gc_paused():
            self._files[path] = _read(path, text)
        if path in self._judged:
            self._judged[path] = replace(self._judged[path], needs=None)
        self._unlink()

    def changed(self) -> None:
        """Read the settings again."""
        self._unlink()
        self._groups.clear()
        self._agreed.clear()
        self.refused.clear()

    def changed_on_disk(self, path: str, shown: Container[str]) -> None:
        """Read what changed at a path: a program, a file of settings, a folder with all in it.

        The text of files that are ``shown`` is that of the editor.
        """
        place = Path(path)
        if place.name == FILE_NAME or place in {one.baseline for one in self._agreed.values()}:
            self.changed()
        elif path.lower().endswith(discovery.SUFFIXES):
            if path not in shown:
                self.reload(path)
        elif place.is_dir() or any(one.startswith(f"{path}/") for one in self._files):
            self.changed()
            for one in [one for one in self._files if one.startswith(f"{path}/")]:
                if one not in shown:
                    self.reload(one)
            for folder in list(self._folders):
                for _ in self.add_folder(folder):
                    pass

    def _unlink(self) -> None:
        self._linked = None
        self._looked.clear()

    def forget(self, path: str) -> None:
        """Remove a file."""
        if self._files.pop(path, None) is not None:
            self._judged.pop(path, None)
            self._unlink()

    def paths(self) -> list[str]:
        """Return all paths, sorted."""
        return sorted(self._files)

    def tables(self) -> Iterator[tuple[Source, ModuleTable]]:
        """Yield the texts and symbol tables of all readable files, sorted by path."""
        for path in self.paths():
            known = self._files[path]
            if known.file.table is not None:
                yield known.source, known.file.table

    def source(self, path: str) -> Source | None:
        """Return the current text of a file, or ``None``."""
        known = self._files.get(path)
        return None if known is None else known.source

    def look(self, path: str) -> AnalysedFile | None:
        """Return all that is known of a file, or ``None`` if it is unknown."""
        known = self._files.get(path)
        if known is None:
            return None
        if path not in self._looked:
            self._looked[path] = self._fresh(known)
        return self._looked[path]

    def _fresh(self, known: _Read) -> AnalysedFile:
        source = known.source
        place = self._projects().get(source.path)
        if place is None:
            return AnalysedFile(source, ())
        project, module = place
        checked = self._check(known, project, module)
        found = [one for one in self._graded(project, source.path) if one.path == source.path]
        kept = _kept(source, found, self._settings(source.path))
        if checked is None:
            return AnalysedFile(source, kept)
        return AnalysedFile(source, kept, module, project, checked)

    def _check(
        self, known: _Read, project: Project, module: Module, needs: Needs | None = None
    ) -> Checked | None:
        """Check a file and store its findings; return ``None`` if it cannot be read."""
        path, reading = known.source.path, known.reading
        if reading.syntax is None:
            self._judged[path] = _Judged(reading.alone(), False, needs)
            return None
        checked = check_module(project, module, known.source)
        found = reading.completed(checked.findings)
        self._judged[path] = _Judged(found, bool(checked.resolution.open_uses), needs)
        return checked

    def _graded(self, project: Project, path: str) -> Iterable[Diagnostic]:
        """Return the findings of a project; only those of the file until all files are checked."""
        paths = [module.path for module in project.modules]
        if all(one in self._judged for one in paths):
            files = Files.of((self._files[one.path].source, one.table) for one in project.modules)
            return check_project((self._judged[one].findings for one in paths), files)
        return self._judged[path].findings.diagnostics

    def catch_up(self) -> Iterator[str]:
        """Check the files whose findings depend on a change, one by one; yield their paths.

        Afterwards the state of files that were looked at may differ. It ends early if something
        changes meanwhile.
        """
        linked = self._projects()
        projects = dict.fromkeys(project for project, _ in linked.values())
        self._caught_up &= projects.keys()
        for project in [one for one in projects if one not in self._caught_up]:
            if self._linked is not linked:
                return
            files = [self._files[module.path] for module in project.modules]
            needed = needs_of(project, [one.given for one in files])
            for known, module, needs in zip(files, project.modules, needed, strict=True):
                if self._linked is not linked:
                    return
                before = self._judged.get(module.path)
                if before is not None and module.path in self._looked:  # in this very state
                    self._judged[module.path] = replace(before, needs=needs)
                    continue
                if before is not None and before.stands(needs):
                    continue
                self._check(known, project, module, needs)
                yield module.path
            self._caught_up.add(project)
        self._looked.clear()

    def _projects(self) -> Mapping[str, tuple[Project, Module]]:
        if self._linked is None:
            groups: dict[Settings, list[File]] = {}
            for path, one in self._files.items():
                if path not in self._groups:
                    agreed = self._settings(path)
                    is_left_out = _is_left_out(path, agreed)
                    self._groups[path] = None if is_left_out else (agreed, self._origin(path))
                if (group := self._groups[path]) is not None and one.is_krl:
                    file = replace(one.file, origin=group[1])
                    groups.setdefault(group[0], []).append(file)
            self._workspaces = {
                agreed: link(
                    files,
                    is_complete=agreed.complete or None,
                    packages=frozenset(agreed.packages),
                    before=self._workspaces.get(agreed),
                )
                for agreed, files in groups.items()
            }
            self._linked = {
                module.path: (project, module)
                for workspace in self._workspaces.values()
                for project, module in workspace.modules()
            }
        return self._linked

    def _origin(self, path: str) -> str:
        """Return the origin of a file, which may be new: that of the nearest known folder."""
        known = (self._origins.get(folder) for folder in Path(path).parents)
        return next((origin for origin in known if origin is not None), "")

    def _settings(self, path: str) -> Settings:
        """Return the settings for a file.

        Those that cannot be used are `refused`, and the file is checked without them.
        """
        folder = Path(path).parent
        if folder not in self._agreed:
            file = settings_file(folder)
            if file not in self._agreed:  # one object for each file, by which files are grouped
                self._agreed[file] = self._read_settings(file) if file else _NONE
            self._agreed[folder] = self._agreed[file]
        return self._agreed[folder]

    def _read_settings(self, file: Path) -> Settings:
        agreed = _NONE
        try:
            agreed = read_settings(file)
            if agreed.baseline:
                read_baseline(agreed.baseline)
        except InputError as error:
            self.refused[file] = str(error)
        return agreed


def _read(path: str, text: str) -> _Read:
    source = Source(text, path)
    reading = read_source(source)
    table = None if reading.syntax is None else table_of(reading.syntax)
    file = File(path, reading.syntax, table=table, words=reading.words)
    given = contribution(path, text, table, reading.words)
    is_krl = isinstance(decode(text.encode(errors="replace")), Decoded)
    return _Read(source, reading, file, given, is_krl)


def _is_left_out(path: str, agreed: Settings) -> bool:
    return agreed.leaves_out(discovery.FoundFile(path, "", 0, Path(path), None))


def _kept(source: Source, found: Iterable[Diagnostic], agreed: Settings) -> tuple[Diagnostic, ...]:
    """Return the findings that are selected, not suppressed and not in the baseline."""
    wanted = [one for one in found if one.code.startswith(_SOUGHT)]
    kept = apply_suppressions(source.path, wanted, suppression_comments(source), _SOUGHT)
    selection = Selection(agreed.select, agreed.ignore)
    kept = [one for one in map(agreed.adjusted, kept) if one and selection.keeps(one.code)]
    if agreed.baseline is not None:
        with suppress(InputError):
            known = read_baseline(agreed.baseline)
            located = ((one, source.line(one.region.line)) for one in in_order(kept))
            new, _ = known.new(located, baseline_place(agreed.baseline))
            kept = [one for one, _ in new]
    return tuple(kept)
