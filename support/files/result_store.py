"""A persistent store of results, in one SQLite file for each folder.

A damaged or foreign file is renamed and replaced by a new one, because its content can always be
computed again.
"""

from __future__ import annotations

import contextlib
import json
import sqlite3
import zlib
from collections.abc import Iterable
from pathlib import Path
from typing import Any, Self

# Exceptions for a damaged file; Python cannot decode a message of SQLite that quotes the damage.
_DAMAGE = (sqlite3.Error, UnicodeDecodeError)
#: Errors of the file itself, as opposed to a full disk or a file in use.
_DAMAGED = (sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_NOTADB, sqlite3.SQLITE_ERROR)


class ResultStore:
    """JSON values or bytes by digest, under one key; a context manager.

    The key identifies everything else that the values depend on: code, tables, a grammar. Values
    under other keys are not visible. Without a folder nothing is stored, nor if the file cannot be
    opened or written.
    """

    def __init__(self, folder: Path | None, key: str) -> None:
        self._key = key
        self._base: sqlite3.Connection | None = None
        if folder is None:
            return
        folder.mkdir(parents=True, exist_ok=True)
        file = folder / "results.sqlite"
        with contextlib.suppress(*_DAMAGE):
            try:
                self._base = self._opened(file)
            except _DAMAGE as error:
                code = getattr(error, "sqlite_errorcode", sqlite3.SQLITE_CORRUPT)
                if code & 0xFF in _DAMAGED:  # the low byte is the primary code
                    with contextlib.suppress(OSError):
                        file.replace(file.with_suffix(".damaged"))
                    self._base = self._opened(file)

    def _opened(self, file: Path) -> sqlite3.Connection:
        base = sqlite3.connect(file, timeout=30)
        try:
            base.execute("PRAGMA journal_mode=WAL")
            base.execute(
                "CREATE TABLE IF NOT EXISTS result"
                " (key TEXT, digest TEXT, body BLOB, PRIMARY KEY (key, digest)) WITHOUT ROWID"
            )
            base.execute("SELECT key, digest, body FROM result LIMIT 1").fetchall()
        except _DAMAGE:
            base.close()
            raise
        return base

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_error: object) -> None:
        if self._base is not None:
            self._base.close()

    @property
    def is_open(self) -> bool:
        """Whether values are stored."""
        return self._base is not None

    def get(self, digest: str) -> object:
        """Return the value stored under a digest, or ``None`` if none can be read."""
        body = self.get_bytes(digest)
        try:
            value: object = None if body is None else json.loads(body)
        except (ValueError, RecursionError):
            return None
        return value

    def get_bytes(self, digest: str) -> bytes | None:
        """Return the bytes stored under a digest, or ``None`` if none can be read."""
        if self._base is None:
            return None
        try:
            row = self._base.execute(
                "SELECT body FROM result WHERE key = ? AND digest = ?", (self._key, digest)
            ).fetchone()
            return None if row is None else zlib.decompress(row[0])
        except (*_DAMAGE, zlib.error, TypeError):
            return None

    def get_record(self, digest: str) -> dict[str, Any] | None:
        """Return the value stored under a digest if it is a JSON object, else ``None``."""
        record = self.get(digest)
        return record if isinstance(record, dict) else None

    def put(self, values: Iterable[tuple[str, object]]) -> None:
        """Store values or bytes under their digests in one transaction, replacing old ones."""
        if self._base is None:
            return
        with contextlib.suppress(*_DAMAGE), self._base:
            self._base.executemany(
                "INSERT OR REPLACE INTO result VALUES (?, ?, ?)",
                ((self._key, digest, _packed(value)) for digest, value in values),
            )


def _packed(value: object) -> bytes:
    body = value if isinstance(value, bytes) else json.dumps(value, separators=(",", ":")).encode()
    return zlib.compress(body, 1)
