"""Check results of projects and files as records that can be stored and read back.

A record is valid for the same content, code, tables and options only. If it cannot be read, the
project or the file is checked again.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import astuple
from typing import Any

from grammar.check.project.project_check import CheckOptions, Content, KnownFile
from grammar.diagnostics.diagnostic import Diagnostic, Fix, Region
from support.files.code_digest import code_digest
from support.files.decode import digest
from support.files.discovery import Skipped
from support.files.restricted_pickle import dumps, loads
from support.files.result_store import ResultStore
from support.lazy_dataclass import dataclass


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


def state_of(contents: Sequence[Content], options: CheckOptions) -> str:
    """Return a digest of all inputs of a result: files of the project, code, tables, options."""
    state = hashlib.sha256(_versions(options).encode())
    for content in contents:
        line = f"\n{digest(content.data)} {content.origin}\t{content.path}"
        state.update(line.encode("utf-8", "surrogatepass"))
    return state.hexdigest()


def _versions(options: CheckOptions) -> str:
    code = code_digest("support", "grammar") if options.kept else ""
    return f"{code} {options}"


def known_files(
    store: ResultStore,
    places: Sequence[str],
    contents: Sequence[Content],
    options: CheckOptions,
) -> dict[int, KnownFile]:
    """Return the files of a project with cached results, by index; ``places`` are their paths."""
    found = {}
    versions = _versions(options)
    for index, (place, content) in enumerate(zip(places, contents, strict=True)):
        data = store.get_bytes(place)
        if data is None:
            continue
        try:
            of, known = loads(data, ("grammar",))
        except ValueError:
            continue
        if of == versions and isinstance(known, KnownFile) and known.digest == digest(content.data):
            found[index] = known
    return found


def known_records(
    places: Sequence[str],
    files: Sequence[KnownFile],
    known: Mapping[int, KnownFile],
    options: CheckOptions,
) -> Iterator[tuple[str, bytes]]:
    """Return the records to store for the files of a project; ``known`` ones are stored already."""
    versions = _versions(options)
    for index, (place, file) in enumerate(zip(places, files, strict=True)):
        if file is not known.get(index):
            yield place, dumps((versions, file))


def result_record(result: ProjectResult, state: str) -> dict[str, object]:
    """Return the record of a result for a state."""
    return {
        "state": state,
        "diagnostics": [_written(one) for one in result.diagnostics],
        "lines": [[path, number, line] for (path, number), line in result.lines.items()],
        "skipped": [[one.path, one.reason, one.origin] for one in result.skipped],
        "sizes": dict(result.sizes),
    }


def read_result(record: Mapping[str, Any], state: str) -> ProjectResult | None:
    """Return the result in a record; ``None`` if it is for another state or damaged."""
    if record.get("state") != state:
        return None
    try:
        return ProjectResult(
            tuple(_read(values) for values in record["diagnostics"]),
            {(path, number): line for path, number, line in record["lines"]},
            tuple(Skipped(*values) for values in record["skipped"]),
            {str(path): int(size) for path, size in record["sizes"].items()},
            frozenset(record["sizes"]),
        )
    except (AttributeError, KeyError, TypeError, ValueError):
        return None


def _written(diagnostic: Diagnostic) -> list[object]:
    fix = diagnostic.fix
    return [
        diagnostic.path,
        list(astuple(diagnostic.region)),
        diagnostic.severity,
        diagnostic.code,
        diagnostic.message,
        diagnostic.reason,
        list(diagnostic.rules),
        fix and list(astuple(fix)),
    ]


def _read(values: Sequence[Any]) -> Diagnostic:
    path, region, severity, code, message, reason, rules, fix = values
    mended = None
    if fix is not None:
        text, place, replacement, names = fix
        mended = Fix(text, None if place is None else Region(*place), replacement, tuple(names))
    return Diagnostic(path, Region(*region), severity, code, message, reason, tuple(rules), mended)
