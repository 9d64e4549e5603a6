"""One digest of code and tables, which invalidates caches and workers of a cluster."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from functools import cache
from importlib import resources
from importlib.resources.abc import Traversable
from typing import Final

_SUFFIXES: Final = (".py", ".g4", ".lark", ".tsv", ".toml", ".dat", ".src", ".xml")
# Cases are input: they travel with the work and are not what it is done with.
_INPUT: Final = "cases"


@cache
def code_digest(*packages: str) -> str:
    """The SHA-256 of every file of the packages that a result of theirs may depend on.

    Folders count whole, by relative path and content. Anything may matter, so nothing is left out:
    a stale result is worse than one worked out again.
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
