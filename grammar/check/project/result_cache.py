"""Check results of projects and files as they are stored, each under its place.

A result is valid for the same content, code, tables and options only, which its state identifies.
If it cannot be read, the project or the file is checked again.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Mapping
from typing import TypeVar

from grammar.check.project.project_check import CheckOptions, Content
from grammar.diagnostics.diagnostic import Diagnostic
from support.files.code_digest import code_digest
from support.files.decode import digest
from support.files.discovery import Skipped
from support.files.restricted_pickle import dumps, loads
from support.files.result_store import ResultStore
from support.lazy_dataclass import dataclass

_T = TypeVar("_T")


@dataclass(frozen=True, slots=True)
class ProjectResult:
    """The findings in a project in order, with source lines by path and number.

    ``sizes`` are the bytes of the checked files by path; the results of ``kept`` of them came from
    the cache.
    """

    diagnostics: tuple[Diagnostic, ...]
    lines: Mapping[tuple[str, int], str]
    skipped: tuple[Skipped, ...]
    sizes: Mapping[str, int]
    kept: frozenset[str]

    @property
    def files(self) -> int:
        """The number of checked files."""
        return len(self.sizes)


def state_of(contents: Iterable[Content], options: CheckOptions) -> str:
    """Return a digest of all inputs of a result: files, code, tables, options."""
    code = code_digest("support", "grammar") if options.kept else ""
    state = hashlib.sha256(f"{code} {options}".encode())
    for content in contents:
        line = f"\n{digest(content.data)} {content.origin}\t{content.path}"
        state.update(line.encode("utf-8", "surrogatepass"))
    return state.hexdigest()


def stored(state: str, result: object) -> bytes:
    """Return the result for a state as it is stored."""
    return dumps((state, result))


def recalled(store: ResultStore, place: str, state: str, kind: type[_T]) -> _T | None:
    """Return the result stored under a place; ``None`` if it is for another state or damaged."""
    try:
        of, result = loads(store.get_bytes(place) or b"", ("grammar", "support"))
    except (TypeError, ValueError):
        return None
    return result if of == state and isinstance(result, kind) else None
