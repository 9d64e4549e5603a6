"""Results kept from one survey to the next, by content and grammar.

A file whose bytes and whose grammar are unchanged is not read again. Results lie in one SQLite file
a folder; a damaged or foreign one is put aside and begun anew, never trusted: what is in it can
always be worked out again.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import sqlite3
import zlib
from collections.abc import Iterable, Iterator
from dataclasses import astuple
from importlib import resources
from pathlib import Path
from types import TracebackType
from typing import Any

from grammar.notation.g4 import Grammar
from grammar.parser.failures import Form
from recovery.survey.failing_line import Failed

__all__ = ["Kept", "Memory", "key_of"]

#: What is kept of a content: its failures with their forms, or why it is no KRL.
Kept = tuple[tuple[Failed, ...], tuple[Form, ...]] | str

# What a damaged file raises: Python cannot read an error message of SQLite that quotes the damage.
_DAMAGE = (sqlite3.Error, UnicodeDecodeError)


def key_of(grammar: Grammar) -> str:
    """What results depend on besides the content: the grammar, and the code that reads and judges.

    Any change to a module of ours counts: a stale result would be worse than one worked out again.
    """
    code = hashlib.sha256(grammar.sha256.encode())
    for package in ("grammar", "recovery"):
        modules = (m for m in resources.files(package).iterdir() if m.name.endswith(".py"))
        for module in sorted(modules, key=lambda m: m.name):
            code.update(module.read_bytes())
    return code.hexdigest()


class Memory:
    """Results of one grammar; use as a context manager, so that what is new is kept."""

    def __init__(self, folder: Path, key: str) -> None:
        self._key = key
        self._file = folder / "results.sqlite"
        folder.mkdir(parents=True, exist_ok=True)
        try:
            self._base = self._opened()
        except _DAMAGE:
            with contextlib.suppress(OSError):
                self._file.replace(self._file.with_suffix(".damaged"))
            self._base = self._opened()

    def _opened(self) -> sqlite3.Connection:
        base = sqlite3.connect(self._file, timeout=30)
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

    def __enter__(self) -> Memory:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._base.commit()  # what is done is done, even where the survey was broken off
        self._base.close()

    def recall(self, digest: str) -> Kept | None:
        """What was found in a content, or ``None`` where it is new or its entry is damaged."""
        try:
            data = self._recalled(digest)
            return None if data is None else _read(data)
        except (ValueError, TypeError, KeyError, IndexError, AssertionError):
            return None

    def recall_record(self, digest: str) -> dict[str, Any] | None:
        """A whole record kept under a digest, or ``None``."""
        record = self._recalled(digest)
        return record if isinstance(record, dict) else None

    def keep(self, results: Iterable[tuple[str, Kept]]) -> None:
        """Remember results by the digest of their content."""
        self._keep((digest, _written(kept)) for digest, kept in results)

    def keep_record(self, digest: str, record: dict[str, Any]) -> None:
        """Remember a whole record."""
        self.keep_records([(digest, record)])

    def keep_records(self, records: Iterable[tuple[str, dict[str, Any]]]) -> None:
        """Remember whole records by their digests, all of them or none."""
        self._keep(records)

    def _recalled(self, digest: str) -> Any:
        """What lies under a digest; ``None`` where nothing does, or nothing that can be read."""
        try:
            row = self._base.execute(
                "SELECT body FROM result WHERE key = ? AND digest = ?", (self._key, digest)
            ).fetchone()
            return None if row is None else json.loads(zlib.decompress(row[0]))
        except (*_DAMAGE, zlib.error, ValueError, TypeError, RecursionError):
            return None

    def _keep(self, entries: Iterable[tuple[str, object]]) -> None:
        with contextlib.suppress(*_DAMAGE), self._base:
            self._base.executemany(
                "INSERT OR REPLACE INTO result VALUES (?, ?, ?)",
                ((self._key, digest, _packed(data)) for digest, data in entries),
            )


def _packed(data: object) -> bytes:
    return zlib.compress(json.dumps(data, separators=(",", ":")).encode(), 1)


def _written(kept: Kept) -> object:
    if isinstance(kept, str):
        return kept
    failures, forms = kept
    return [[astuple(f) for f in failures], [astuple(form) for form in forms]]


def _read(data: Any) -> Kept:
    if isinstance(data, str):
        return data
    failures, forms = data
    return tuple(_failed(f) for f in failures), tuple(_forms(forms))


def _failed(values: list[Any]) -> Failed:
    line, column, token, source, words, form, follows = values
    return Failed(line, column, token, source, tuple(words), form, follows)


def _forms(forms: list[list[object]]) -> Iterator[Form]:
    for before, kinds, index in forms:
        assert isinstance(before, list)
        assert isinstance(kinds, list)
        assert isinstance(index, int)
        yield Form(tuple(map(tuple, before)), tuple(kinds), index)
