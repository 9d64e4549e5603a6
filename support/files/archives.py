"""Reading `.zip` archives without trusting them.

Nothing is unpacked to disk. A member is addressed by its index in the directory of the archive and
read into memory. Names are only displayed, so a name such as `../x.src` has no effect. Sizes in the
directory are not trusted: bytes are counted while they are read, and reading stops at the limits
below.
"""

from __future__ import annotations

import atexit
import io
import os
import re
import stat
import struct
import threading
import zipfile
import zlib
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import IO

from support.files.untrusted import open_file
from support.lazy_dataclass import dataclass

MB = 1 << 20
#: One file, packed or not. The longest KRL file known has about 1 MB; point tables may have ten.
MAX_FILE_BYTES = 64 * MB
#: What the members read from one archive may have together, nested archives included.
MAX_ARCHIVE_BYTES = 2048 * MB
#: Members of one archive, nested ones included. A controller backup has about 5,000.
MAX_MEMBERS = 100_000
#: An archive's directory, read in one piece by `zipfile`: room for `MAX_MEMBERS` long names.
MAX_DIRECTORY_BYTES = 16 * MB
#: Archives kept open between two calls of `read` in one process.
OPEN_ARCHIVES = 4

# Both are unpacked in bounded steps. The bzip2 and LZMA readers of `zipfile` can expand a few
# kilobytes to gigabytes in one step; no controller and no common Windows tool uses them.
_METHODS = {zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED}
_OTHER_METHODS = {9: "Deflate64", 12: "bzip2", 14: "LZMA", 93: "Zstandard", 95: "XZ", 98: "PPMd"}
_ENCRYPTED = 0x1
_UNIX = 3  # `create_system` of archives whose attributes hold a file mode
_STEP = MB
_DRIVE = re.compile(r"\A[A-Za-z]:")

# Exceptions that `zipfile` raises for damaged archives, found by fuzzing.
_DAMAGE = (
    zipfile.BadZipFile,
    zipfile.LargeZipFile,
    zlib.error,
    struct.error,
    EOFError,
    OSError,
    OverflowError,
    RuntimeError,
    ValueError,
)

_TOO_DEEP = "an archive in an archive in an archive is not opened"
_TOO_MANY = f"more than {MAX_MEMBERS:,} members"
_OVERLAPPING = "its bytes are those of another member too"
_HEAD_BYTES = 30  # least size of the local header before a member
_CHANGED = "the archive changed while it was being read"


class ArchiveError(Exception):
    """An archive or a member of it that cannot be read; the message is the reason, one line."""


@dataclass(frozen=True, slots=True)
class Member:
    """A member worth reading, or one that cannot be read because of `problem`.

    `path` is for display: cleaned, `/` separated, unique in its archive. `address` is for `read`:
    the indices in the directories (`17`, or `3/17` for a member of a nested archive), because names
    may be duplicate or not decodable. `size` in bytes is the one in the directory. `nested` is the
    `path` of the inner archive that contains it, if any.
    """

    path: str
    address: str
    size: int
    nested: str | None
    problem: str | None


def is_archive(name: str) -> bool:
    """Return whether `name` is that of an archive."""
    return name.lower().endswith(".zip")


def why(error: OSError) -> str:
    """Return the reason of `error` without its path, which may contain anything."""
    return error.strerror or type(error).__name__


def read_whole(stream: io.RawIOBase | IO[bytes]) -> bytes:
    """Return the rest of `stream`; raises ArchiveError beyond the limit for one file."""
    data = bytearray()
    while step := stream.read(_STEP):
        data += step
        if len(data) > MAX_FILE_BYTES:
            raise ArchiveError(too_large())
    return bytes(data)


def too_large() -> str:
    """Return the message for a file beyond the size limit."""
    return f"larger than {_in_mb(MAX_FILE_BYTES)}"


def members(file: Path, wanted: Callable[[str], bool]) -> list[Member]:
    """Return the members of the archive `file` whose cleaned path is `wanted`, sorted by path.

    Archives in it are opened too, one level deep. Raises ArchiveError if `file` is not a readable
    archive or has too many members.
    """
    with _on_disk(file) as archive:
        return list(_listed(archive, wanted, _Budget(MAX_MEMBERS, MAX_ARCHIVE_BYTES)))


def read(file: Path, address: str, size: int) -> bytes:
    """Return the content of a member that `members` listed with this `address` and `size`.

    A few archives stay open in each process for the next call. Raises ArchiveError.
    """
    *outer, last = (int(place) for place in address.split("/"))
    with _lock:
        infos = (archive := _kept(file, outer[0] if outer else None)).infolist()
        if last >= len(infos) or infos[last].file_size != size:
            raise ArchiveError(_CHANGED)
        return archive.content(infos[last])


def close_archives() -> None:
    """Close the archives that `read` keeps open in this process."""
    with _lock:
        _opened.cache_clear()


# -- listing ---------------------------------------------------------------------------------------


@dataclass(slots=True)
class _Budget:
    """What remains of the limits of one archive."""

    members: int
    bytes: int

    def spend(self, size: int) -> str | None:
        """Subtract `size` bytes; return a problem instead if they exceed the rest."""
        if size > self.bytes:
            return f"the archive holds more than {_in_mb(MAX_ARCHIVE_BYTES)}"
        self.bytes -= size
        return None


def _listed(
    archive: _Archive, wanted: Callable[[str], bool], budget: _Budget, inside: Member | None = None
) -> Iterator[Member]:
    infos = archive.infolist()
    budget.members -= len(infos)
    if budget.members < 0:
        raise ArchiveError(_TOO_MANY)
    prefix, place = (f"{inside.path}/", f"{inside.address}/") if inside else ("", "")
    overlapping = _overlapping(infos)
    for path, index in _named(infos, wanted):
        info = infos[index]
        problem = _OVERLAPPING if index in overlapping else _problem(info)
        problem = problem or budget.spend(info.file_size)
        if problem is None and is_archive(path):
            problem = _TOO_DEEP if inside else _TOO_MANY if budget.members <= 0 else None
        member = Member(
            path=prefix + path,
            address=f"{place}{index}",
            size=info.file_size,
            nested=inside.path if inside else None,
            problem=problem,
        )
        if problem or not is_archive(path):
            yield member
            continue
        try:
            with archive.inner(info) as opened:
                yield from _listed(opened, wanted, budget, member)
        except ArchiveError as error:
            yield replace(member, problem=str(error))


def _named(infos: list[zipfile.ZipInfo], wanted: Callable[[str], bool]) -> list[tuple[str, int]]:
    """Return the cleaned, unique path and the index of each wanted member, sorted by path."""
    paths = [(_clean(info.filename), index) for index, info in enumerate(infos)]
    chosen = [
        (path, index)
        for path, index in paths
        if wanted(path) and not infos[index].filename.endswith(("/", "\\"))
    ]
    chosen.sort(key=lambda pair: (pair[0].casefold(), *pair))
    seen: Counter[str] = Counter()
    unique = []
    for path, index in chosen:
        seen[path] += 1
        unique.append((f"{path} ({seen[path]})" if seen[path] > 1 else path, index))
    return unique


def _clean(name: str) -> str:
    """Return the relative path in a member's name.

    Backslashes of Windows tools become slashes; drive letters, leading slashes and `..` are
    dropped.
    """
    parts = _DRIVE.sub("", name.replace("\\", "/"), count=1).split("/") if name else []
    return "/".join(part for part in parts if part not in ("", ".", ".."))


def _problem(info: zipfile.ZipInfo) -> str | None:
    """Return why a member cannot be read, as far as the directory shows it, or ``None``."""
    mode = info.external_attr >> 16 if info.create_system == _UNIX else 0
    if stat.S_ISLNK(mode):
        return "symbolic link"
    if stat.S_IFMT(mode) not in (0, stat.S_IFREG):
        return "not a regular file"
    if info.flag_bits & _ENCRYPTED:
        return "encrypted"
    if info.compress_type not in _METHODS:
        name = _OTHER_METHODS.get(info.compress_type, f"number {info.compress_type}")
        return f"compression method {name} is not supported"
    if info.file_size > MAX_FILE_BYTES:
        return too_large()
    return None


def _overlapping(infos: list[zipfile.ZipInfo]) -> set[int]:
    """Return the indices of members that begin before another one ends.

    A few kilobytes could thus claim to hold gigabytes (a zip bomb); no packing tool writes that.
    """
    found, end = set(), 0
    for place in sorted(range(len(infos)), key=lambda place: infos[place].header_offset):
        info = infos[place]
        if info.header_offset < end:
            found.add(place)
        end = max(end, info.header_offset + _HEAD_BYTES + info.compress_size)
    return found


def _in_mb(size: int) -> str:
    return f"{size // MB:,} MB"


# -- reading ---------------------------------------------------------------------------------------


class _Stream(io.BufferedReader):
    """The bytes of an archive; refuses large reads, such as that of a huge directory."""

    def read(self, size: int | None = -1, /) -> bytes:
        if size is not None and size > MAX_DIRECTORY_BYTES:
            raise ArchiveError(f"its directory is larger than {_in_mb(MAX_DIRECTORY_BYTES)}")
        return super().read(size)


class _Archive(zipfile.ZipFile):
    """An open archive; it closes when nothing refers to it."""

    def __init__(self, raw: io.RawIOBase | io.BytesIO) -> None:
        self._stream = _Stream(raw)
        try:
            super().__init__(self._stream)
        except _DAMAGE as error:
            raise ArchiveError(self._close_unopened()) from error
        except ArchiveError:
            self._stream.close()
            raise

    def _close_unopened(self) -> str:
        """Close the stream, and return why the bytes are no archive."""
        with self._stream as stream:
            stream.seek(0)
            start = stream.read(4)
        if not start:
            return "empty file"
        return "truncated or damaged archive" if start[:2] == b"PK" else "not a zip archive"

    def content(self, info: zipfile.ZipInfo) -> bytes:
        """Return the content of the member `info`; raises ArchiveError."""
        if problem := _problem(info):
            raise ArchiveError(problem)
        try:
            with self.open(info) as stream:
                return read_whole(stream)
        except _DAMAGE as error:
            checksum = str(error).startswith("Bad CRC")
            reason = "damaged: wrong checksum" if checksum else "damaged in the archive"
            raise ArchiveError(reason) from error

    def inner(self, info: zipfile.ZipInfo) -> _Archive:
        """Return the archive that is the member `info`, opened in memory; raises ArchiveError."""
        return _Archive(io.BytesIO(self.content(info)))

    def close(self) -> None:
        super().close()
        self._stream.close()


def _on_disk(file: Path) -> _Archive:
    try:
        return _Archive(open_file(file))
    except OSError as error:
        raise ArchiveError(f"cannot be read: {why(error)}") from error


_lock = threading.Lock()
atexit.register(close_archives)


def _kept(file: Path, outer: int | None) -> _Archive:
    """Return the open archive `file`, or the one at index `outer` in it."""
    try:
        state = file.stat()
    except OSError as error:
        raise ArchiveError(f"cannot be read: {why(error)}") from error
    # the process counts too: a forked child shares the file position of open archives
    return _opened(file, outer, os.getpid(), state.st_mtime_ns, state.st_size)


@lru_cache(maxsize=OPEN_ARCHIVES)
def _opened(file: Path, outer: int | None, *_state: int) -> _Archive:
    if outer is None:
        return _on_disk(file)
    infos = (around := _kept(file, None)).infolist()
    if outer >= len(infos):
        raise ArchiveError(_CHANGED)
    return around.inner(infos[outer])
