"""The lock of the folder of nightly runs: one run at a time."""

import os
import sqlite3
from collections.abc import Iterator
from contextlib import closing, contextmanager, suppress
from pathlib import Path

from krl.errors import InputError, as_input_errors


@contextmanager
def alone(out: Path) -> Iterator[None]:
    """Raise `InputError` if another nightly run is at work in a folder.

    The lock is one of SQLite, which every system releases when the process ends, however it ends.
    """
    file = out / "nightly.lock"
    with as_input_errors(OSError):
        out.mkdir(parents=True, exist_ok=True)
    with closing(sqlite3.connect(file, timeout=0, isolation_level=None)) as lock:
        try:
            lock.execute(f"PRAGMA user_version = {os.getpid()}")
            lock.execute("BEGIN IMMEDIATE")
        except sqlite3.Error as error:
            with suppress(sqlite3.Error):
                (process,) = lock.execute("PRAGMA user_version").fetchone()
                raise InputError(f"{file}: process {process} is a nightly run there") from None
            raise InputError(f"{file}: {error}") from None
        yield
