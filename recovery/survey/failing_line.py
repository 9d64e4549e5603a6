"""Failing lines of a file under a grammar, in a form that can be sent to a process and cached."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from functools import lru_cache
from operator import attrgetter
from typing import Any

from grammar.parser.failures import Failure, FailureFinder, Form

_LONGEST_LINE_KEPT = 1_000
_WORDS_KEPT = 24


@dataclass(frozen=True, slots=True)
class FailingLine:
    """One failing line of a file.

    ``line`` and ``column`` count from 1. ``token`` is the offending token as written, ``source``
    the line (cut at 1,000 characters). ``words`` are its tokens in upper case, up to the offending
    one and at least 24. ``form`` is an index into `Survey.forms`.
    """

    line: int
    column: int
    token: str
    source: str
    words: tuple[str, ...]
    form: int
    follows: bool

    def with_form(self, form: int) -> FailingLine:
        """Return the line with another form (`dataclasses.replace` takes twice as long)."""
        return FailingLine(
            self.line, self.column, self.token, self.source, self.words, form, self.follows
        )


#: The fields of a failing line in their order (`dataclasses.astuple` copies them, which is slow).
as_values = attrgetter(*(field.name for field in fields(FailingLine)))


def as_failing_line(values: Sequence[Any]) -> FailingLine:
    """Return the failing line with some values; raises `ValueError` if these are too few."""
    line, column, token, source, words, form, follows = values
    return FailingLine(line, column, token, source, tuple(words), form, follows)


def failures_of(
    finder: FailureFinder, text: str, forms: dict[Form, int]
) -> tuple[FailingLine, ...]:
    """Return the failing lines of a program; new forms are added to ``forms`` and numbered."""
    failures = finder.find(text)
    lines = source_lines(text) if failures else []
    return tuple(_failed(failure, lines, forms) for failure in failures)


def _failed(failure: Failure, lines: list[str], forms: dict[Form, int]) -> FailingLine:
    words = failure.lexemes[: max(_WORDS_KEPT, failure.form.index + 1)]
    source = lines[failure.line - 1] if failure.line <= len(lines) else ""
    return FailingLine(
        failure.line,
        failure.column,
        failure.text[:200],
        source[:_LONGEST_LINE_KEPT],
        tuple(map(_word, words)),
        forms.setdefault(failure.form, len(forms)),
        failure.follows,
    )


@lru_cache(maxsize=1 << 16)
def _word(lexeme: str) -> str:
    """Return a token in upper case, cut, and shared between equal tokens to save memory."""
    return lexeme.upper()[:40]


def source_lines(text: str) -> list[str]:
    """Return the lines of a program, separated by CRLF, LF or CR as in KRL."""
    return text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
