"""The files that an editor works on: those of its folder, and the open ones as they are typed.

A file is read when its text changes; linking takes the tables of all files, and only files that are
looked at are checked. Paths are absolute with ``/``, lines and columns count from 1 as everywhere
in the project; what editors count otherwise is translated at the door, in
`krl.language_server.server`.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

from grammar.check.framework import Checked, check_module, check_project
from grammar.check.project_check import Reading, read_source
from grammar.check.suppression_comments import apply_suppressions, suppression_comments
from grammar.diagnostics.diagnostic import Diagnostic
from grammar.diagnostics.suppression import Selection
from grammar.semantics.link import File, Project, link
from grammar.semantics.scopes import Module
from grammar.semantics.symbol_table import table_of
from grammar.syntax.source import Source
from krl.errors import InputError
from krl.project_settings import settings_of
from support.files import discovery
from support.files.decode import decode
from support.files.untrusted import read_bytes

__all__ = ["MOST_FILES", "Looked", "OpenProject"]

#: More files than the largest backup has; a folder with more is somebody's whole disk.
MOST_FILES = 5_000
#: Findings that are no faults: why the robot stops. `krl check` tells them when asked.
_SOUGHT = ("KSS", *(f"KRL{digit}" for digit in "01234579"))


@dataclass(frozen=True, slots=True, eq=False)
class _Read:
    """A text, as far as it can be read, and what others are to know of it."""

    source: Source
    reading: Reading
    file: File


@dataclass(frozen=True, slots=True, eq=False)
class Looked:
    """All that is known of one file.

    ``module``, ``project`` and ``checked`` are ``None`` for a file that cannot be read.
    """

    source: Source
    diagnostics: tuple[Diagnostic, ...]
    module: Module | None = None
    project: Project | None = None
    checked: Checked | None = None


class OpenProject:
    """Files by path, and what is known of them today."""

    def __init__(self) -> None:
        self._files: dict[str, _Read] = {}
        self._linked: Mapping[str, tuple[Project, Module]] | None = None
        self._looked: dict[str, Looked] = {}

    def add_folder(self, folder: Path) -> int:
        """Take in the KRL files below a folder; how many there are. A missing folder has none.

        Files beyond `MOST_FILES` are left out, and so are files that are open already.
        """
        try:
            found = [
                one for one in discovery.discover([folder]) if isinstance(one, discovery.Found)
            ]
        except discovery.IngestError:
            return 0
        for one in found[:MOST_FILES]:
            path = one.file.absolute().as_posix()
            if one.member is None and path not in self._files:
                self.reload(path)
        return len(found)

    def reload(self, path: str) -> None:
        """Take a file as it is on the disk; forget it where it is gone or no KRL."""
        try:
            decoded = decode(read_bytes(Path(path)))
        except OSError:
            decoded = ""
        if isinstance(decoded, str):
            self.forget(path)
        else:
            self.change(path, decoded.text)

    def change(self, path: str, text: str) -> None:
        """A file has this text now."""
        known = self._files.get(path)
        if known is not None and known.source.text == text:
            return
        self._files[path] = _read(path, text)
        self._linked = None
        self._looked.clear()

    def forget(self, path: str) -> None:
        """A file is gone."""
        if self._files.pop(path, None) is not None:
            self._linked = None
            self._looked.clear()

    def paths(self) -> list[str]:
        """All files, in order."""
        return sorted(self._files)

    def source(self, path: str) -> Source | None:
        """The text of a file as it is known."""
        known = self._files.get(path)
        return None if known is None else known.source

    def look(self, path: str) -> Looked | None:
        """What is known of a file; ``None`` for one that is not here."""
        known = self._files.get(path)
        if known is None:
            return None
        if path not in self._looked:
            self._looked[path] = self._fresh(known)
        return self._looked[path]

    def _fresh(self, known: _Read) -> Looked:
        source, reading = known.source, known.reading
        place = self._projects().get(source.path)
        if reading.syntax is None or place is None:
            return Looked(source, _kept(source, reading.diagnostics))
        project, module = place
        checked = check_module(project, module, source)
        found = check_project([reading.completed(checked.findings)], is_whole=False)
        return Looked(source, _kept(source, found), module, project, checked)

    def _projects(self) -> Mapping[str, tuple[Project, Module]]:
        if self._linked is None:
            workspace = link([one.file for one in self._files.values()], packages=frozenset())
            self._linked = {module.path: (at, module) for at, module in workspace.modules()}
        return self._linked


def _read(path: str, text: str) -> _Read:
    source = Source(text, path)
    reading = read_source(source)
    table = None if reading.syntax is None else table_of(reading.syntax)
    return _Read(source, reading, File(path, reading.syntax, table=table, words=reading.words))


def _kept(source: Source, found: Iterable[Diagnostic]) -> tuple[Diagnostic, ...]:
    """Findings that are wanted, by the settings of the project too, and that no comment silences.

    Settings that cannot be read count as none: who checks on the command line is told of them.
    """
    wanted = [one for one in found if one.code.startswith(_SOUGHT)]
    kept = apply_suppressions(source.path, wanted, suppression_comments(source), _SOUGHT)
    try:
        agreed = settings_of([Path(source.path)])
    except InputError:
        agreed = None
    if agreed is None:
        return tuple(kept)
    selection = Selection(agreed.select, agreed.ignore)
    return tuple(one for one in agreed.adjusted(kept) if selection.keeps(one.code))
