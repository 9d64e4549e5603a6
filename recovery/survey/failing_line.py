"""Failing lines of a file under a grammar, ready to be sent and cached."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

from grammar.parser.failures import Failure, FailureFinder, Form

_LONGEST_LINE_KEPT = 1_000
_WORDS_KEPT = 24


@dataclass(frozen=True, slots=True)
class FailingLine:
    """One failing line of a file.

    ``line`` and ``column`` from 1; ``token`` is the offending token as written; ``source`` the line
    (cut at 1,000 characters); ``words`` its tokens in upper case, to the offending one and at
    least 24; ``form`` indexes `Survey.forms`.
    """

    line: int
    column: int
    token: str
    source: str
    words: tuple[str, ...]
    form: int
    follows: bool

    def with_form(self, form: int) -> FailingLine:
        """The same with another number for its form (`dataclasses.replace` takes twice as long)."""
        return FailingLine(
            self.line, self.column, self.token, self.source, self.words, form, self.follows
        )


def failures_of(
    finder: FailureFinder, text: str, forms: dict[Form, int]
) -> tuple[FailingLine, ...]:
    """The failing lines of a program; ``forms`` numbers their forms and is added to."""
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
    """The token in upper case, cut; the same object each time, for there are many."""
    return lexeme.upper()[:40]


def source_lines(text: str) -> list[str]:
    """The lines of a program as KRL ends them: CRLF, LF or CR, and nothing else."""
    return text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
