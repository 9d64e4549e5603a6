"""Applies the edits of findings; each is tried before it is kept."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from grammar.check.project.project_check import read_source
from grammar.diagnostics.diagnostic import Diagnostic
from grammar.syntax.source import Source

# A line with more errors one behind the other is for people.
_MOST_STEPS = 4


@dataclass(frozen=True, slots=True)
class Repair:
    """A text after the repair of some findings: first those of checks, each kind in its order."""

    text: str
    mended: tuple[Diagnostic, ...]


def repair(
    source: Source,
    is_wanted: Callable[[Diagnostic], bool] = lambda _: True,
    checked: Sequence[Diagnostic] = (),
) -> Repair:
    """Apply the edits of syntax errors, and of ``checked``: other findings of the file, in order.

    The former are kept if fewer lines of the file are unreadable afterwards, the latter if no more
    are. ``is_wanted`` chooses among the findings. What cannot be mended stays as it is.
    """
    source, mended = _with_edits(source, [one for one in checked if is_wanted(one)])
    found = _wrong(source)
    for one in reversed(found):  # from the end, so that the places of the others stay
        done = _mended(source, one, len(found), is_wanted)
        if done is not None:
            source, steps = done
            mended = [*steps, *mended]
            found = _wrong(source)
    return Repair(source.text, tuple(mended))


def _with_edits(source: Source, checked: Sequence[Diagnostic]) -> tuple[Source, list[Diagnostic]]:
    """Return the text after the edits of findings of lines that can be read."""
    before = _wrong(source)
    unread = {one.region for one in before}
    kept: list[Diagnostic] = []
    for one in reversed(checked):
        text = None if one.region in unread else edited(source, one)
        if text is not None and len(_wrong(Source(text, source.path))) <= len(before):
            source = Source(text, source.path)
            kept.insert(0, one)
    return source, kept


def _mended(
    source: Source, found: Diagnostic, before: int, is_wanted: Callable[[Diagnostic], bool]
) -> tuple[Source, list[Diagnostic]] | None:
    """Return the text without the errors of a line, and the repaired findings, or ``None``.

    After one error of a line there may be another.
    """
    steps: list[Diagnostic] = []
    here: Diagnostic | None = found
    while here is not None and len(steps) < _MOST_STEPS and is_wanted(here):
        text = edited(source, here)
        if text is None:
            return None
        steps.append(here)
        source = Source(text, source.path)
        left = _wrong(source)
        if len(left) < before:
            return source, steps
        line = (one for one in left if one.region.line == found.region.line)
        here = next((one for one in line if one.region > here.region), None)
    return None


def edited(source: Source, found: Diagnostic) -> str | None:
    """Return the text after the edit of a finding; ``None`` for a finding without edit."""
    fix = found.fix
    if fix is None or fix.region is None or fix.replacement is None:
        return None
    start = source.offset(fix.region.line, fix.region.column)
    end = source.offset(fix.region.end_line, fix.region.end_column)
    return source.text[:start] + fix.replacement + source.text[end:]


def _wrong(source: Source) -> tuple[Diagnostic, ...]:
    return read_source(source).diagnostics
