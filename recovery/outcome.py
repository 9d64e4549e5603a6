"""What reading one file under a grammar gives: its failing lines, ready to travel and to keep."""

from __future__ import annotations

from dataclasses import dataclass

from grammar.failures import Failure, FailureFinder, Form

__all__ = ["Failed", "failures_of", "source_lines"]

_LONGEST_LINE_KEPT = 1_000
_WORDS_KEPT = 24


@dataclass(frozen=True, slots=True)
class Failed:
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


def failures_of(finder: FailureFinder, text: str, forms: dict[Form, int]) -> tuple[Failed, ...]:
    """The failing lines of a program; ``forms`` numbers their forms and is added to."""
    failures = finder.find(text)
    lines = source_lines(text) if failures else []
    return tuple(_failed(failure, lines, forms) for failure in failures)


def _failed(failure: Failure, lines: list[str], forms: dict[Form, int]) -> Failed:
    lexemes, index = failure.lexemes, failure.form.index
    words = tuple(lexeme.upper()[:40] for lexeme in lexemes[: max(_WORDS_KEPT, index + 1)])
    source = lines[failure.line - 1] if failure.line <= len(lines) else ""
    return Failed(
        line=failure.line,
        column=failure.column,
        token=failure.text[:200],
        source=source[:_LONGEST_LINE_KEPT],
        words=words,
        form=forms.setdefault(failure.form, len(forms)),
        follows=failure.follows,
    )


def source_lines(text: str) -> list[str]:
    """The lines of a program as KRL ends them: CRLF, LF or CR, and nothing else."""
    return text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
