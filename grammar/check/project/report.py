"""The report of a check, made from the results of its projects.

The findings of a large corpus take more memory than anything else of it, some 500 bytes each. So
those of a finished project are compressed, and expanded again when it is their turn; beyond a few
megabytes they wait in a temporary file.
"""

from __future__ import annotations

import os
import pickle
import tempfile
import zlib
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import field

from grammar.check.project.result_cache import ProjectResult
from grammar.diagnostics.diagnostic import Diagnostic, Located, Region, diagnose, in_order, merged
from support.files import archives
from support.files.discovery import FoundFile, Skipped
from support.lazy_dataclass import dataclass

#: Bytes of compressed findings that are held in memory.
_MOST_IN_MEMORY = 8_000_000


@dataclass(frozen=True, slots=True)
class CheckReport:
    """The findings, and what was checked.

    ``files`` is the number of checked files, of ``bytes`` in all, in ``projects``; results of
    ``unchanged`` files came from the cache. ``skipped`` are files that are not KRL, ``paths`` those
    that are, sorted.
    """

    skipped: tuple[Skipped, ...]
    files: int
    bytes: int
    projects: int
    unchanged: int
    paths: tuple[str, ...]
    _parts: Sequence[_Part] = field(repr=False, compare=False)

    def located(self) -> Iterator[Located]:
        """Yield all findings in order, each with its source line."""
        return merged(self._parts)

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """All findings in order, which for a large corpus is too much to hold in memory."""
        return tuple(finding for finding, _ in self.located())


class _File:
    """Compressed findings, in a temporary file if they are many."""

    def __init__(self) -> None:
        self._file = tempfile.SpooledTemporaryFile(_MOST_IN_MEMORY)  # noqa: SIM115  closed with this

    def __del__(self) -> None:
        self._file.close()

    def append(self, found: Sequence[Located]) -> tuple[int, int]:
        """Return where they are; raises `OSError` with the folder if its disk is full."""
        start = self._file.seek(0, os.SEEK_END)
        try:
            return start, self._file.write(zlib.compress(pickle.dumps(found, 5), 1))
        except OSError as error:
            raise OSError(error.errno, error.strerror, tempfile.gettempdir()) from error

    def at(self, start: int, size: int) -> Sequence[Located]:
        """Return the findings that are there."""
        self._file.seek(start)
        found: Sequence[Located] = pickle.loads(zlib.decompress(self._file.read(size)))
        return found


class _Part:
    """The findings of a project in order; all but the first are in a file."""

    def __init__(self, found: Sequence[Located], file: _File) -> None:
        self._first = found[0]
        self._file = file
        self._place = file.append(found[1:])

    def __iter__(self) -> Iterator[Located]:
        yield self._first
        yield from self._file.at(*self._place)


def together(results: Iterable[ProjectResult], skipped: Sequence[Skipped]) -> CheckReport:
    """Return the report of all projects; ``skipped`` are the files that none of them has."""
    # a file that could be a program is a finding, not only skipped
    start = Region(1, 1, 1, 1)
    large = in_order(
        diagnose("too-large", one.path, start, one.reason) for one in skipped if is_large(one)
    )
    left_out = [one for one in skipped if not is_large(one)]
    file = _File()
    parts = [_Part([(one, "") for one in large], file)] if large else []
    paths: list[str] = []
    size = projects = unchanged = 0
    for result in results:
        lines = result.lines
        found = [(one, lines.get((one.path, one.region.line), "")) for one in result.diagnostics]
        if found:
            parts.append(_Part(found, file))
        left_out += result.skipped
        paths += result.sizes
        size += sum(result.sizes.values())
        unchanged += len(result.kept & result.sizes.keys())
        projects += 1
    return CheckReport(
        tuple(sorted(left_out, key=lambda one: one.path)),
        len(paths),
        size,
        projects,
        unchanged,
        tuple(sorted(paths)),
        parts,
    )


def is_large(one: FoundFile | Skipped) -> bool:
    """Return whether a file was skipped for its size, though it may be a program."""
    return isinstance(one, Skipped) and one.reason == archives.too_large()
