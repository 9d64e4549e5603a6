"""The files of a survey and their failing lines, on disk: there may be more than memory.

They are rows of a temporary SQLite database, which the system removes with the process.
"""

from __future__ import annotations

import json
import marshal
import sqlite3
import zlib
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path
from typing import overload
from weakref import finalize

from recovery.survey.failing_line import FailingLine, as_failing_line, as_values, source_lines
from support.files.decode import digest
from support.files.discovery import FoundFile, Skipped, read_source


@dataclass(frozen=True, slots=True)
class SurveyedFile:
    """A distinct content, with its locations and its failures.

    ``places`` are (path, origin) of the file and of every copy, in the order of discovery;
    ``found`` is the first of them. Each iteration over ``failures`` may read them anew.
    """

    found: FoundFile
    places: tuple[tuple[str, str], ...]
    digest: str
    size: int
    failures: Sequence[FailingLine] = ()

    @property
    def path(self) -> str:
        """The path of the first location, as it is shown."""
        return self.found.path

    def text(self) -> str | None:
        """Return the text of the file, read again; ``None`` if it has changed since the survey."""
        file = read_source(self.found)
        if isinstance(file, Skipped) or digest(file.data) != self.digest:
            return None
        return file.text

    def lines(self) -> list[str]:
        """Return the lines of the file, read again; empty if it has changed since the survey."""
        text = self.text()
        return [] if text is None else source_lines(text)


class _Failures(Sequence[FailingLine]):
    """The failing lines of a content, on disk; its files are kept open as long as they are."""

    __slots__ = ("_content", "_count", "_files")

    def __init__(self, files: SurveyedFiles, content: int, count: int) -> None:
        self._files = files
        self._content = content
        self._count = count

    def __len__(self) -> int:
        return self._count

    def __iter__(self) -> Iterator[FailingLine]:
        return self._files.failures(self._content)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Sequence) and tuple(self) == tuple(other)

    def __hash__(self) -> int:
        return hash(tuple(self))

    @overload
    def __getitem__(self, place: int) -> FailingLine: ...
    @overload
    def __getitem__(self, place: slice) -> list[FailingLine]: ...
    def __getitem__(self, place: int | slice) -> FailingLine | list[FailingLine]:
        return list(self)[place]


class SurveyedFiles(Sequence[SurveyedFile]):
    """The files with KRL, in the order of discovery; each iteration makes them anew.

    First all candidates are added. Then each is registered with its content, or stays without one.
    """

    def __init__(self) -> None:
        """Create it without files."""
        self._base = sqlite3.connect("")  # a temporary file, once it is large
        finalize(self, self._base.close)
        self._base.executescript(
            """
            PRAGMA journal_mode = OFF;
            CREATE TABLE candidate (number INTEGER PRIMARY KEY, item TEXT, content INTEGER);
            CREATE INDEX place ON candidate (content) WHERE content IS NOT NULL;
            CREATE TABLE content
                (number INTEGER PRIMARY KEY, digest TEXT UNIQUE, size INTEGER, reason TEXT,
                failing INTEGER DEFAULT 0, failures BLOB);
            """
        )

    def add(self, candidates: Iterable[FoundFile | Skipped]) -> tuple[int, int]:
        """Add all candidates; return their number, and the bytes of those that were found."""
        size = 0

        def rows() -> Iterator[tuple[str]]:
            nonlocal size
            item: tuple[str | int | None, ...]
            for one in candidates:
                if isinstance(one, FoundFile):
                    size += one.size
                    item = (one.path, one.origin, one.size, str(one.file), one.member)
                else:
                    item = (one.path, one.reason, one.origin)
                yield (json.dumps(item),)

        self._base.executemany("INSERT INTO candidate (item) VALUES (?)", rows())
        ((count,),) = self._base.execute("SELECT COUNT(*) FROM candidate")
        return count, size

    def candidates(self) -> Iterator[tuple[int, FoundFile | Skipped]]:
        """Yield all candidates with their numbers."""
        for number, item in self._base.execute("SELECT number, item FROM candidate"):
            yield number, _candidate(item)

    def register(self, number: int, key: str, size: int) -> bool:
        """Give a candidate its content by digest and size; return whether the content is new."""
        added = self._base.execute(
            "INSERT OR IGNORE INTO content (digest, size) VALUES (?, ?)", (key, size)
        )
        self._base.execute(
            "UPDATE candidate SET content = (SELECT number FROM content WHERE digest = ?)"
            " WHERE number = ?",
            (key, number),
        )
        return added.rowcount == 1

    def set_failures(self, key: str, failures: Sequence[FailingLine]) -> None:
        """Set what fails in the content with a digest; at first nothing does."""
        if failures:
            packed = zlib.compress(marshal.dumps(list(map(as_values, failures))), 1)
            self._base.execute(
                "UPDATE content SET failing = ?, failures = ? WHERE digest = ?",
                (len(failures), packed, key),
            )

    def failures(self, content: int) -> Iterator[FailingLine]:
        """Yield the failing lines of the content with a number."""
        query = "SELECT failures FROM content WHERE number = ?"
        ((packed,),) = self._base.execute(query, (content,))
        return map(as_failing_line, marshal.loads(zlib.decompress(packed)))

    def leave_out(self, key: str, reason: str) -> None:
        """Leave out the content with a digest, which is no KRL."""
        self._base.execute("UPDATE content SET reason = ? WHERE digest = ?", (reason, key))

    def left_out(self) -> Iterator[Skipped]:
        """Yield every file that was left out."""
        for _, _, _, reason, _, items in self._contents("IS NOT NULL"):
            for one in items:
                yield Skipped(one.path, reason, one.origin)

    def __iter__(self) -> Iterator[SurveyedFile]:
        for number, key, size, _, failing, items in self._contents("IS NULL"):
            places = tuple((one.path, one.origin) for one in items)
            failures = _Failures(self, number, failing) if failing else ()
            yield SurveyedFile(items[0], places, key, size, failures)

    def __len__(self) -> int:
        ((count,),) = self._base.execute("SELECT COUNT(*) FROM content WHERE reason IS NULL")
        return int(count)

    @overload
    def __getitem__(self, place: int) -> SurveyedFile: ...
    @overload
    def __getitem__(self, place: slice) -> list[SurveyedFile]: ...
    def __getitem__(self, place: int | slice) -> SurveyedFile | list[SurveyedFile]:
        return list(self)[place]

    def _contents(self, reason: str) -> Iterator[tuple[int, str, int, str, int, list[FoundFile]]]:
        """Yield number, digest, size, reason, count of failures and files of each content."""
        rows = self._base.execute(
            "SELECT content.number, digest, size, reason, failing, item"
            " FROM content JOIN candidate ON candidate.content = content.number"
            f" WHERE reason {reason} ORDER BY content.number, candidate.number"
        )
        for content, several in groupby(rows, lambda row: row[:5]):
            found = (_candidate(row[5]) for row in several)
            yield *content, [one for one in found if isinstance(one, FoundFile)]


def _candidate(item: str) -> FoundFile | Skipped:
    path, *others = json.loads(item)
    if len(others) == 2:
        return Skipped(path, *others)
    origin, size, file, member = others
    return FoundFile(path, origin, size, Path(file), member)
