"""Files written whole or not at all: one, or several together.

What is written is laid beside its target first and then exchanged, so that a full disk, an error
or a killed process leaves no half of a file. Of several files, those already exchanged are put back
where a later exchange fails. A process that is killed puts nothing back. For that there is a
journal, itself written whole: once it stands, the change counts as made, and `finish` exchanges
what the process did not come to.
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
    """Let a full disk say which file it was full for, as the system does not."""
    try:
        yield
    except OSError as error:
        if error.filename is None and error.errno in _FULL:
            error.filename = str(file)
        raise


@contextlib.contextmanager
def atomic_path(target: Path) -> Iterator[Path]:
    """A path to write to, which takes the place of ``target`` once the block has ended well.

    It lies beside the target, with its suffix, and keeps the permissions of a file that is there. A
    device or a pipe, as /dev/stdout, is itself that path: it is not replaced. Folders above are
    made. Raises `OSError`.
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
    finally:
        with contextlib.suppress(OSError):  # there is none any more, or there never was
            part.unlink()


def write_atomic(target: Path, content: bytes | str) -> Path:
    """Write one file and return its path; see `atomic_path`. Text becomes UTF-8 as it stands."""
    with atomic_path(target) as part:
        part.write_bytes(content.encode() if isinstance(content, str) else content)
    return target


class JournalError(ValueError):
    """A journal that is not to be followed; the text names it."""


def write_together(
    changes: Mapping[Path, bytes | None], *, journal: Path | None = None
) -> list[Path]:
    """Give each file its new content; ``None`` removes it. Returns the files that have changed.

    Folders of new files are made. ``journal`` is where a killed process leaves word of what it was
    about to do. Raises `OSError`, and then nothing has changed.
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
    """Write down which file is to have which content, by its digest."""
    wanted = {
        str(path.absolute()): None if content is None else hashlib.sha256(content).hexdigest()
        for path, content in changes.items()
    }
    part = journal.with_name(f"{journal.name}.part")
    _write_through(part, json.dumps(wanted).encode())
    part.replace(journal)


def _write_through(file: Path, content: bytes) -> None:
    """Write a file, and wait until the disk has it: the journal may not stand before its parts."""
    with naming(file), file.open("wb") as stream:
        stream.write(content)
        stream.flush()
        os.fsync(stream.fileno())


def finish(journal: Path) -> list[Path]:
    """Exchange what a killed process had laid ready; the files that changed.

    Without a journal nothing was begun, or all of it is done. A part whose content is not the one
    noted is another's, and left alone. Raises `OSError`, and `JournalError` for a journal that is
    damaged or names files elsewhere than below the folder that the journal's folder lies in.
    """
    try:
        wanted = json_of(read_bytes(journal).decode("utf-8"))
    except FileNotFoundError:
        return []
    except ValueError as error:
        raise JournalError(f"{journal}: {error}") from None
    home = journal.resolve().parent.parent
    if not isinstance(wanted, dict) or not all(_is_below(home, name) for name in wanted):
        raise JournalError(f"{journal}: not what an acceptance wrote that was broken off here")
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
    """Whether a file may be one of ours; its name may hold anything, links on the way too."""
    try:
        return Path(name).is_absolute() and home in Path(name).resolve().parents
    except (OSError, ValueError, RuntimeError):
        return False
