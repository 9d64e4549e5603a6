"""The public repositories of the corpus: which of their files are read, and how these are fetched.

`corpus/sources.toml` lists the repositories, each with a pinned commit and its licence;
`corpus/checksums.tsv` lists their KRL files. The files belong to other people. Users who want to
read them fetch them; they never become part of this project. A file is only accepted with the
listed SHA-256, so that everybody measures the same corpus.
"""

import csv
import hashlib
import io
import re
import tempfile
from collections import defaultdict
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from recovery.corpus.git_objects import (
    GitError,
    RefusedError,
    fetch_all,
    fetch_commit,
    find_mirror,
    read_files,
)
from support.files.atomic_write import write_atomic
from support.files.discovery import SUFFIXES
from support.files.untrusted import read_bytes, read_text, toml_of

_COLUMNS = ["repository", "path", "bytes", "sha256", "kind", "quality"]
_REPOSITORY = re.compile(r"[A-Za-z0-9][A-Za-z0-9-]*/[A-Za-z0-9_][A-Za-z0-9._-]*")
_COMMIT = re.compile(r"[0-9a-f]{40}")
_SHA256 = re.compile(r"[0-9a-f]{64}")
_SIZE = re.compile(r"[0-9]{1,12}")
_RESERVED_CHARACTERS = frozenset('<>:"|?*\\')
_RESERVED_NAMES = frozenset(
    ["con", "prn", "aux", "nul"]
    + [f"{port}{number}" for port in ("com", "lpt") for number in range(10)]
)


class SourceListError(ValueError):
    """The list of sources is not usable; the message says where and why in one line."""


@dataclass(frozen=True, slots=True)
class KrlFile:
    """A KRL file of another repository, identified by its checksum."""

    path: str  # in the repository, parts joined by "/"
    size: int  # bytes
    sha256: str
    kind: str  # who wrote it: user, vendor, config
    quality: str  # what it is: real, generated, template


@dataclass(frozen=True, slots=True)
class PublicSource:
    """A public repository with KRL files, pinned to one commit."""

    repository: str  # OWNER/NAME
    url: str
    commit: str
    licence: str  # SPDX identifier, or "none" where the owner states none
    generation: str  # controllers and software releases that the files are for
    note: str
    files: tuple[KrlFile, ...]

    @property
    def folder(self) -> str:
        """The folder that its files are written to, `OWNER__NAME`."""
        return self.repository.replace("/", "__")

    @property
    def size(self) -> int:
        """Total size of its KRL files in bytes."""
        return sum(file.size for file in self.files)


@dataclass(frozen=True, slots=True)
class Fetched:
    """The result for one source: files written, files already present, and a line per problem."""

    source: PublicSource
    written: int
    kept: int
    problems: tuple[str, ...]


def read_sources(corpus: Path) -> tuple[PublicSource, ...]:
    """Return the sources in `sources.toml` and `checksums.tsv` of the folder `corpus`.

    Raises OSError if one is missing, and SourceListError if one is damaged or has a path that is
    not safe to write on every system.
    """
    listed = corpus / "sources.toml"
    try:
        entries = toml_of(read_text(listed)).get("source")
    except ValueError as error:  # not TOML, or not UTF-8
        raise SourceListError(f"{listed}: {error}") from error
    if not isinstance(entries, list) or not entries:
        raise SourceListError(f"{listed}: no [[source]] in it")
    files = _read_checksums(corpus / "checksums.tsv")
    sources = tuple(_source(listed, entry, files) for entry in entries)
    named = {source.repository for source in sources}
    if len(named) < len(sources):
        raise SourceListError(f"{listed}: a repository is listed twice")
    if unclaimed := set(files) - named:
        raise SourceListError(f"{listed}: no source for the files of {min(unclaimed)}")
    return sources


def absent(source: PublicSource, out: Path) -> list[KrlFile]:
    """Return the files of `source` that are missing below `out` or have another content."""
    return [file for file in source.files if not _is_there(file, out / source.folder / file.path)]


def fetch(
    source: PublicSource,
    out: Path,
    mirrors: Path | None = None,
    on_file: Callable[[int], None] = lambda _count: None,
) -> Fetched:
    """Fetch the files of `source` to `out/OWNER__NAME/`, from a local mirror or from its URL.

    With `mirrors`, only that folder is read, and the network is not used. Files that are already
    there are left alone. `on_file` is called with the number of files finished since its last call.
    Files that could not be fetched are named in the result; only a failure to write raises
    (OSError).
    """
    wanted = absent(source, out)
    kept = len(source.files) - len(wanted)
    on_file(kept)
    if not wanted:
        return Fetched(source, 0, kept, ())
    target = out / source.folder
    try:
        if mirrors is None:
            problems = _from_network(source, wanted, target, on_file)
        else:
            problems = _from_mirror(source, wanted, target, mirrors, on_file)
    except GitError as error:
        missing = [file for file in wanted if not _is_there(file, target / file.path)]
        line = f"{source.repository}: {error} ({_count(missing)} missing)"
        return Fetched(source, len(wanted) - len(missing), kept, (line,))
    lines = tuple(f"{source.repository}: {path}: {why}" for path, why in problems.items())
    return Fetched(source, len(wanted) - len(problems), kept, lines)


def _from_mirror(
    source: PublicSource,
    wanted: Sequence[KrlFile],
    target: Path,
    mirrors: Path,
    on_file: Callable[[int], None],
) -> dict[str, str]:
    git_dir = find_mirror(mirrors, source.repository)
    if git_dir is None:
        raise GitError(f"no mirror in {mirrors}")
    return _take(git_dir, source, wanted, target, on_file)


def _from_network(
    source: PublicSource, wanted: Sequence[KrlFile], target: Path, on_file: Callable[[int], None]
) -> dict[str, str]:
    with tempfile.TemporaryDirectory(prefix="krl-fetch-", ignore_cleanup_errors=True) as scratch:
        pinned, whole = Path(scratch, "pinned"), Path(scratch, "whole")
        try:
            fetch_commit(source.url, source.commit, pinned)
            problems = _take(pinned, source, wanted, target, on_file)
        except RefusedError:
            problems = {file.path: "" for file in wanted}
        if not problems:
            return problems
        fetch_all(source.url, whole)
        rest = [file for file in source.files if file.path in problems]
        return _take(whole, source, rest, target, on_file)


def _take(
    git_dir: Path,
    source: PublicSource,
    wanted: Sequence[KrlFile],
    target: Path,
    on_file: Callable[[int], None],
) -> dict[str, str]:
    """Write what `git_dir` holds of `wanted`; return the paths it lacks, each with the reason.

    The pinned commit is asked first and the branch in force second: a repository may have been
    rewritten and still hold the same files.
    """
    problems = {file.path: "not in the repository any more" for file in wanted}
    for revision in (source.commit, "HEAD"):
        left = {file.path: file for file in wanted if file.path in problems}
        sizes = {path: file.size for path, file in left.items()}
        for path, content in read_files(git_dir, revision, sizes):
            if content is None or hashlib.sha256(content).hexdigest() != left[path].sha256:
                problems[path] = "changed, its checksum is not the listed one"
                continue
            write_atomic(target / path, content)
            del problems[path]
            on_file(1)
    return problems


def _is_there(file: KrlFile, path: Path) -> bool:
    try:
        if path.stat().st_size != file.size:
            return False
        return hashlib.sha256(path.read_bytes()).hexdigest() == file.sha256
    except (FileNotFoundError, NotADirectoryError):
        return False


def _count(files: list[KrlFile]) -> str:
    return f"{len(files)} file" if len(files) == 1 else f"{len(files)} files"


def _source(listed: Path, entry: object, files: Mapping[str, tuple[KrlFile, ...]]) -> PublicSource:
    names = ("repository", "url", "commit", "licence", "generation", "note")
    if not isinstance(entry, dict) or set(entry) != set(names):
        raise SourceListError(f"{listed}: a source has exactly {', '.join(names)}")
    if not all(isinstance(value, str) and value for value in entry.values()):
        raise SourceListError(f"{listed}: {entry['repository']}: every value must be a text")
    repository = entry["repository"]
    if not _REPOSITORY.fullmatch(repository):
        raise SourceListError(f"{listed}: {repository} is not OWNER/NAME")
    if not entry["url"].startswith("https://"):
        raise SourceListError(f"{listed}: {repository}: the url must begin with https://")
    if not _COMMIT.fullmatch(entry["commit"]):
        raise SourceListError(f"{listed}: {repository}: the commit is not a full hash")
    if repository not in files:
        raise SourceListError(f"{listed}: {repository}: no files of it in checksums.tsv")
    return PublicSource(**entry, files=files[repository])


def _read_checksums(table: Path) -> dict[str, tuple[KrlFile, ...]]:
    files: dict[str, list[KrlFile]] = defaultdict(list)
    seen: set[str] = set()
    try:
        with io.StringIO(read_bytes(table).decode("utf-8"), newline="") as lines:
            rows = csv.reader(lines, delimiter="\t", quoting=csv.QUOTE_NONE)
            if next(rows, None) != _COLUMNS:
                raise SourceListError(f"{table}: the columns must be {' '.join(_COLUMNS)}")
            for row in rows:
                where = f"{table}:{rows.line_num}"
                if len(row) != len(_COLUMNS):
                    raise SourceListError(f"{where}: {len(_COLUMNS)} columns expected")
                repository, path, size, sha256, kind, quality = row
                if why := _unsafe(path):
                    raise SourceListError(f"{where}: {path!r} {why}")
                if not _SIZE.fullmatch(size) or not _SHA256.fullmatch(sha256):
                    raise SourceListError(f"{where}: not a size and a SHA-256")
                if (place := f"{repository}/{path}".casefold()) in seen:
                    raise SourceListError(f"{where}: {path!r} is listed twice")
                seen.add(place)
                files[repository].append(KrlFile(path, int(size), sha256, kind, quality))
    except (UnicodeDecodeError, csv.Error) as error:
        raise SourceListError(f"{table}: {error}") from error
    return {repository: tuple(listed) for repository, listed in files.items()}


def _unsafe(path: str) -> str | None:
    """Return why `path` must not be written on any system, or None if it may be."""
    if not path.lower().endswith(SUFFIXES):
        return "is not a KRL file"
    for part in path.split("/"):
        if part in ("", ".", ".."):
            return "leads elsewhere"
        if not part.isprintable() or _RESERVED_CHARACTERS & set(part):
            return "holds a character that not every system can store"
        if part[-1] in " ." or part.partition(".")[0].rstrip().lower() in _RESERVED_NAMES:
            return "holds a name that not every system can store"
        if part.lower() == ".git":
            return "leads into a git directory"
    return None
