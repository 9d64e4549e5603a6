"""Diagnostics as values: place, severity, message, reason, fix.

The front end returns these for a bad program and raises no exception. This module sorts them and
makes records for JSON; `grammar.diagnostics.rendering` makes text and `grammar.diagnostics.sarif`
SARIF.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from heapq import merge
from typing import Any, Protocol

from grammar.diagnostics.codes import Severity, code
from support.lazy_dataclass import dataclass


class Places(Protocol):
    """A text that can convert offsets: a `grammar.syntax.source.Source` or a `parser.tree.Tree`."""

    def place(self, offset: int) -> tuple[int, int]:
        """Return the line and column of an offset, both from 1."""


@dataclass(frozen=True, slots=True, order=True)
class Region:
    """Part of a text. Lines and columns count from 1, columns in characters.

    ``end_column`` is the column after the last character; an empty region begins and ends at the
    same place.
    """

    line: int
    column: int
    end_line: int
    end_column: int

    @staticmethod
    def empty(line: int, column: int) -> Region:
        """Return an empty region before a column."""
        return Region(line, column, line, column)

    @staticmethod
    def of(text: Places, span: tuple[int, int]) -> Region:
        """Return the region of a span, which is a start offset and an exclusive end offset."""
        return Region(*text.place(span[0]), *text.place(span[1]))


@dataclass(frozen=True, slots=True)
class Fix:
    """How to correct the program: a sentence and, if it is certain enough, an edit.

    The edit replaces ``region`` in the file of the finding by ``replacement``. ``names`` are
    possible replacements of the finding's own region, the likeliest first, from which a person has
    to choose.
    """

    text: str
    region: Region | None = None
    replacement: str | None = None
    names: tuple[str, ...] = ()

    @property
    def is_edit(self) -> bool:
        """Whether a tool can apply the fix."""
        return self.region is not None and self.replacement is not None


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """One finding.

    ``path`` is the file as it was given, with ``/``. ``message`` says what is wrong and ``reason``
    why, both without a full stop; ``rules`` are the IDs of the rules that say so.
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
        """The edits to choose from, the likeliest first: description, region, replacement."""
        fix = self.fix
        if fix is None:
            return ()
        if fix.region is not None and fix.replacement is not None:
            return ((fix.text, fix.region, fix.replacement),)
        return tuple((f"write {name}", self.region, name) for name in fix.names)


#: A finding and its source line, empty where that is not known.
Located = tuple[Diagnostic, str]


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
    """Return a finding of the code with this slug.

    Severity and rules are those of the code by default. An unconfirmed finding is at most a
    warning. Raises `KeyError` if the slug is unknown.
    """
    entry = code(slug)
    severity = severity or entry.severity
    if is_unconfirmed and severity == "error":
        severity = "warning"
    rules = entry.rules if rules is None else rules
    return Diagnostic(path, region, severity, entry.code, message, reason, rules, fix)


def in_order(diagnostics: Iterable[Diagnostic]) -> list[Diagnostic]:
    """Return the findings without duplicates, sorted by path, place, code and message."""
    return sorted(dict.fromkeys(diagnostics), key=_key)


def merged(parts: Iterable[Iterable[Located]]) -> Iterator[Located]:
    """Yield the findings of all parts in order; each part is in order.

    Nothing beyond the first finding of a part is asked for before that has been yielded.
    """
    return merge(*parts, key=lambda one: _key(one[0]))


def _key(diagnostic: Diagnostic) -> tuple[str, Region, str, str]:
    return diagnostic.path, diagnostic.region, diagnostic.code, diagnostic.message


def records(diagnostics: Iterable[Diagnostic]) -> Iterator[dict[str, Any]]:
    """Yield what ``krl check --format json`` prints for findings, which are in order."""
    return map(_record, diagnostics)


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
