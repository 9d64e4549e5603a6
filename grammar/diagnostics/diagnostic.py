"""Findings as values: place, severity, message, reason, fix.

The front end raises nothing for a bad program, it returns these. They are ordered here and become
records for JSON; `grammar.diagnostics.rendering` makes text of them and `grammar.diagnostics.sarif`
SARIF.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Protocol

from grammar.diagnostics.codes import Severity, code
from support.lazy_dataclass import dataclass


class Places(Protocol):
    """A text that knows its lines: a `grammar.syntax.source.Source`, a `parser.tree.Tree`."""

    def place(self, offset: int) -> tuple[int, int]:
        """Line and column of a character, both from 1."""


@dataclass(frozen=True, slots=True, order=True)
class Region:
    """Part of a text. Lines and columns count from 1, columns in characters.

    ``end_column`` is the column behind the last character, so a region of no characters has both
    ends at the same place.
    """

    line: int
    column: int
    end_line: int
    end_column: int

    @staticmethod
    def of(text: Places, span: tuple[int, int]) -> Region:
        """The region of a span: offsets of the first character and of the one behind the last."""
        return Region(*text.place(span[0]), *text.place(span[1]))


@dataclass(frozen=True, slots=True)
class Fix:
    """What would mend it, in words; and as an edit where one is plain.

    The edit writes ``replacement`` in place of ``region``, in the file of the finding. ``names``
    are what may be meant in place of the finding, the likeliest first: for a person to choose.
    """

    text: str
    region: Region | None = None
    replacement: str | None = None
    names: tuple[str, ...] = ()

    @property
    def is_edit(self) -> bool:
        """Whether a tool could apply it."""
        return self.region is not None and self.replacement is not None


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """One finding.

    ``path`` is the file as it was named, with ``/``. ``message`` says what is wrong, ``reason``
    why, both without a full stop; ``rules`` are the IDs that say so.
    """

    path: str
    region: Region
    severity: Severity
    code: str
    message: str
    reason: str = ""
    rules: tuple[str, ...] = ()
    fix: Fix | None = None

    @property
    def edits(self) -> tuple[tuple[str, Region, str], ...]:
        """The edits a person can choose from, the likeliest first: in words, where, what there."""
        fix = self.fix
        if fix is None:
            return ()
        if fix.region is not None and fix.replacement is not None:
            return ((fix.text, fix.region, fix.replacement),)
        return tuple((f"write {name}", self.region, name) for name in fix.names)


def diagnose(
    slug: str,
    path: str,
    region: Region,
    message: str,
    *,
    reason: str = "",
    rules: tuple[str, ...] | None = None,
    severity: Severity | None = None,
    is_unconfirmed: bool = False,
    fix: Fix | None = None,
) -> Diagnostic:
    """A finding of the code with this slug; severity and rules are those of the code if not given.

    What is unconfirmed is at most a warning. Raises `KeyError` for an unknown slug.
    """
    entry = code(slug)
    severity = severity or entry.severity
    if is_unconfirmed and severity == "error":
        severity = "warning"
    rules = entry.rules if rules is None else rules
    return Diagnostic(path, region, severity, entry.code, message, reason, rules, fix)


def in_order(diagnostics: Iterable[Diagnostic]) -> list[Diagnostic]:
    """By path, place, code and message, each once: the same whatever order they were found in."""
    return sorted(dict.fromkeys(diagnostics), key=_key)


def _key(diagnostic: Diagnostic) -> tuple[str, Region, str, str]:
    return diagnostic.path, diagnostic.region, diagnostic.code, diagnostic.message


def records(diagnostics: Iterable[Diagnostic]) -> list[dict[str, Any]]:
    """What ``krl check --format json`` prints, in order."""
    return [_record(diagnostic) for diagnostic in in_order(diagnostics)]


def _record(diagnostic: Diagnostic) -> dict[str, Any]:
    region, fix = diagnostic.region, diagnostic.fix
    return {
        "path": diagnostic.path,
        "line": region.line,
        "column": region.column,
        "end_line": region.end_line,
        "end_column": region.end_column,
        "severity": diagnostic.severity,
        "code": diagnostic.code,
        "message": diagnostic.message,
        "reason": diagnostic.reason,
        "rules": list(diagnostic.rules),
        "fix": fix and {"text": fix.text, "replacement": fix.replacement if fix.is_edit else None},
    }
