"""What checking a project gave, as a record that can be kept and read back.

A record counts only for the same files, code, tables and options; where it cannot be read, the
project is checked again.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import astuple, dataclass
from typing import Any

from grammar.check.project_check import CheckOptions, Content
from grammar.diagnostics.diagnostic import Diagnostic, Fix, Region
from support.files.code_digest import code_digest
from support.files.decode import digest
from support.files.discovery import Skipped

__all__ = ["ProjectResult", "read_result", "result_record", "state_of"]


@dataclass(frozen=True, slots=True)
class ProjectResult:
    """What was found in a project, in order, with source lines by path and number.

    ``sizes`` are the bytes of the files that were checked, by path; ``is_kept``: it was known from
    before.
    """

    diagnostics: tuple[Diagnostic, ...]
    lines: Mapping[tuple[str, int], str]
    skipped: tuple[Skipped, ...]
    sizes: Mapping[str, int]
    is_kept: bool

    @property
    def files(self) -> int:
        """How many files were checked."""
        return len(self.sizes)


def state_of(contents: Sequence[Content], options: CheckOptions) -> str:
    """What a result depends on: all files of the project, our code and tables, the options."""
    state = hashlib.sha256(f"{code_digest('support', 'grammar')} {options}".encode())
    for content in contents:
        line = f"\n{digest(content.data)} {content.origin}\t{content.path}"
        state.update(line.encode("utf-8", "surrogatepass"))
    return state.hexdigest()


def result_record(result: ProjectResult, state: str) -> dict[str, object]:
    """The record of a result that belongs to a state."""
    return {
        "state": state,
        "diagnostics": [_written(one) for one in result.diagnostics],
        "lines": [[path, number, line] for (path, number), line in result.lines.items()],
        "skipped": [[one.path, one.reason, one.origin] for one in result.skipped],
        "sizes": dict(result.sizes),
    }


def read_result(record: Mapping[str, Any], state: str) -> ProjectResult | None:
    """The result of a record; ``None`` where it belongs to another state or is damaged."""
    if record.get("state") != state:
        return None
    try:
        return ProjectResult(
            tuple(_read(values) for values in record["diagnostics"]),
            {(path, number): line for path, number, line in record["lines"]},
            tuple(Skipped(*values) for values in record["skipped"]),
            {str(path): int(size) for path, size in record["sizes"].items()},
            True,
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
        fix and [fix.text, fix.region and list(astuple(fix.region)), fix.replacement],
    ]


def _read(values: Sequence[Any]) -> Diagnostic:
    path, region, severity, code, message, reason, rules, fix = values
    mended = None
    if fix is not None:
        text, place, replacement = fix
        mended = Fix(text, None if place is None else Region(*place), replacement)
    return Diagnostic(path, Region(*region), severity, code, message, reason, tuple(rules), mended)
