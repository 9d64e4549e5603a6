"""Atomic writes: one file, or several together, are written completely or not at all.

New content is written beside its target and then renamed over it. So a full disk, an error or a
killed process never leaves half a file. If renaming one of several files fails, those already
replaced are restored. A killed process restores nothing. For that case there is a journal, itself
written atomically: once it exists, the change counts as made, and `finish` completes it.
"""

from __future__ import annotations

import contextlib
import errno
import hashlib
import json
import os
import stat
from collections.abc import Iterator, Mapping
from pathlib import Path

from support.files.untrusted import json_of, read_bytes

_FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)


@contextlib.contextmanager
def naming(file: Path) -> Iterator[None]:
    """Add the file name to an error about a full disk, which the system leaves out."""
    try:
        yield
    except OSError as error:
        if error.filename is None and error.errno in _FULL:
            error.filename = str(file)
        raise


@contextlib.contextmanager
def atomic_path(target: Path) -> Iterator[Path]:
    """Yield a path to write to, which replaces ``target`` when the context ends without error.

    It lies beside the target, has the same suffix, and gets the permissions of an existing file. If
    the target is a device or a pipe, such as /dev/stdout, the target itself is yielded and not
    replaced. Missing folders are created. Raises `OSError`.
    """
    if target.exists() and not target.is_file():
        yield target
        return
    target.parent.mkdir(parents=True, exist_ok=True)
    part = target.with_name(f".part-{os.urandom(4).hex()}-{target.name}")
    try:
        with naming(target):
            yield part
        if target.exists() and (mode := target.stat().st_mode) != part.stat().st_mode:
            part.chmod(stat.S_IMODE(mode))
        part.replace(target)
    except OSError as error:
        if error.filename == str(part):  # it cannot be created, as in a folder that is read-only
            error.filename = str(target)
        raise
    finally:
        with contextlib.suppress(OSError):  # it was moved, or never created
            part.unlink()


def write_atomic(target: Path, content: bytes | str) -> Path:
    """Write one file and return its path; see `atomic_path`. Text is encoded as UTF-8 unchanged."""
    with atomic_path(target) as part:
        part.write_bytes(content.encode() if isinstance(content, str) else content)
    return target


class JournalError(ValueError):
    """A journal that cannot be trusted; the message names it."""


def write_together(
    changes: Mapping[Path, bytes | None], *, journal: Path | None = None
) -> list[Path]:
    """Write the new content of each file, or remove it if that is ``None``; all or nothing.

    Returns the files that changed. Missing folders are created. ``journal`` is the file by which
    `finish` completes the change after a killed process. Raises `OSError`; then nothing has
    changed.
    """
    olds = {path: path.read_bytes() if path.is_file() else None for path in changes}
    staged: dict[Path, Path] = {}
    done: list[Path] = []
    try:
        for path, content in changes.items():
            if content is not None and content != olds[path]:
                path.parent.mkdir(parents=True, exist_ok=True)
                staged[path] = path.with_name(f"{path.name}.part")
                _write_through(staged[path], content)
        if journal is not None:
            _note(journal, changes)
        for path, content in changes.items():
            if path in staged:
                done.append(path)
                staged[path].replace(path)
            elif content is None and olds[path] is not None:
                done.append(path)
                path.unlink()
    except BaseException:
        for path in done:
            old = olds[path]
            with contextlib.suppress(OSError):
                path.unlink() if old is None else path.write_bytes(old)
        raise
    finally:
        for part in staged.values():
            part.unlink(missing_ok=True)
        if journal is not None:
            journal.unlink(missing_ok=True)
    return done


def _note(journal: Path, changes: Mapping[Path, bytes | None]) -> None:
    """Write the journal: the digest of the new content of each file."""
    wanted = {
        str(path.absolute()): None if content is None else hashlib.sha256(content).hexdigest()
        for path, content in changes.items()
    }
    part = journal.with_name(f"{journal.name}.part")
    _write_through(part, json.dumps(wanted).encode())
    part.replace(journal)


def _write_through(file: Path, content: bytes) -> None:
    """Write a file and flush it to disk, because the journal must not exist before its parts."""
    with naming(file), file.open("wb") as stream:
        stream.write(content)
        stream.flush()
        os.fsync(stream.fileno())


def finish(journal: Path) -> list[Path]:
    """Complete the change that a killed process left in a journal; return the changed files.

    Returns an empty list if there is no journal. A part with another content than the journal says
    is left alone. Raises `OSError`, and `JournalError` for a journal that is damaged or names files
    outside the parent of its own folder.
    """
    try:
        wanted = json_of(read_bytes(journal).decode("utf-8"))
    except FileNotFoundError:
        return []
    except ValueError as error:
        raise JournalError(f"{journal}: {error}") from None
    home = journal.resolve().parent.parent
    if not isinstance(wanted, dict) or not all(_is_below(home, name) for name in wanted):
        raise JournalError(f"{journal}: not the journal of an acceptance that was interrupted here")
    done = []
    for name, digest in wanted.items():
        path = Path(name)
        part = path.with_name(f"{path.name}.part")
        if digest is None:
            if path.is_file():
                path.unlink()
                done.append(path)
        elif part.is_file() and hashlib.sha256(part.read_bytes()).hexdigest() == digest:
            part.replace(path)
            done.append(path)
    journal.unlink(missing_ok=True)
    return done


def _is_below(home: Path, name: str) -> bool:
    """Return whether a path lies below ``home``, links resolved; it may be any text."""
    try:
        return Path(name).is_absolute() and home in Path(name).resolve().parents
    except (OSError, ValueError, RuntimeError):
        return False
