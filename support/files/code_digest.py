"""A digest of code and tables; caches and cluster workers are invalid when it changes."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from functools import cache
from importlib import resources
from importlib.resources.abc import Traversable
from typing import Final

_SUFFIXES: Final = (".py", ".g4", ".lark", ".tsv", ".toml", ".dat", ".src", ".xml")
# Conformance cases are input to the work, not part of the code that does it.
_INPUT: Final = "cases"


@cache
def code_digest(*packages: str) -> str:
    """Return the SHA-256 of every file in the packages that can influence a result.

    It covers relative paths and contents of whole folders. It errs on the safe side: computing a
    result again is better than using a stale one.
    """
    code = hashlib.sha256()
    for package in packages:
        for path, data in _files(resources.files(package), package):
            code.update(f"{path}\0{len(data)}\0".encode())
            code.update(data)
    return code.hexdigest()


def _files(folder: Traversable, path: str) -> Iterator[tuple[str, bytes]]:
    for entry in sorted(folder.iterdir(), key=lambda entry: entry.name):
        if entry.name.endswith(_SUFFIXES):
            yield f"{path}/{entry.name}", entry.read_bytes()
        elif entry.is_dir() and entry.name != _INPUT:
            yield from _files(entry, f"{path}/{entry.name}")
