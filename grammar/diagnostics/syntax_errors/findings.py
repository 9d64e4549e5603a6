"""Findings for the syntax failures of a text."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from grammar.blocks import OUTERMOST
from grammar.diagnostics.diagnostic import Diagnostic, Region, diagnose
from grammar.diagnostics.open_blocks import lead, open_blocks
from grammar.diagnostics.syntax_errors import blocks, corrections, signs, statements, words
from grammar.diagnostics.syntax_errors.error_site import ErrorSite, Mistake
from grammar.diagnostics.syntax_errors.unexpected import unexpected
from grammar.syntax.build import SyntaxFailure
from grammar.syntax.source import Source

#: A file with more failing lines is probably no KRL; only so many are listed.
MOST_LISTED = 1_000
# Beyond this column a failure is not examined: that takes long, and real lines are shorter.
_FARTHEST = 20_000

#: The kinds of mistake in order; the first that is recognised is reported.
_MISTAKES: tuple[Callable[[ErrorSite], Mistake | None], ...] = (
    blocks.unbalanced_block,
    words.fold_without_semicolon,
    words.foreign_letter,
    words.foreign_word,
    corrections.misspelt_keyword,
    corrections.repeated_token,
    corrections.missing_bracket,
    statements.motion_without_points,
    signs.malformed_number,
    signs.foreign_sign,
    words.misplaced_word,
    statements.incomplete_line,
    statements.misplaced_declaration,
    statements.no_constant,
    corrections.missing_sign,
    statements.misplaced_name,
    words.prose,
)


def syntax_findings(failures: Sequence[SyntaxFailure], source: Source) -> list[Diagnostic]:
    """Return the findings for the failures of a text, without those that follow from others."""
    direct = [failure for failure in failures if not failure.follows] or list(failures)
    reported = [
        failure
        for before, failure in zip([None, *direct], direct, strict=False)
        if before is None or not _is_same_gap(before, failure, source)
    ]
    listed = reported[:MOST_LISTED]
    open_at = open_blocks(source, (failure.line for failure in listed))
    found = [_finding(ErrorSite(failure, source, open_at[failure.line])) for failure in listed]
    if len(reported) > len(listed):
        message = f"{len(reported) - len(listed):,} more unreadable lines are not listed"
        found.append(diagnose("too-large", source.path, found[-1].region, message))
    return found


def _is_same_gap(before: SyntaxFailure, failure: SyntaxFailure, source: Source) -> bool:
    """Return whether two lines are outside all routines because of the same missing first line."""
    lines = source.lines[before.line - 1 : failure.line]
    is_outside = before.rule == failure.rule == "module"
    return is_outside and not any(lead(line) in OUTERMOST for line in lines)


def _finding(site: ErrorSite) -> Diagnostic:
    region = _offending(site)
    if site.failure.reason is not None:
        message = f"this line is {site.failure.reason}, so the file was not checked"
        return diagnose("too-large", site.source.path, region, message)
    mistake = None
    if site.failure.column <= _FARTHEST:
        mistake = next(filter(None, (recognised(site) for recognised in _MISTAKES)), None)
    mistake = mistake or unexpected(site)
    return diagnose(
        mistake.slug,
        site.source.path,
        mistake.region or region,
        mistake.message,
        reason=mistake.reason,
        is_unconfirmed=mistake.is_unconfirmed,
        fix=mistake.fix,
    )


def _offending(site: ErrorSite) -> Region:
    """Return the region of the offending token, or the end of the last line that is not blank."""
    failure, source = site.failure, site.source
    if failure.text:
        line = source.line(failure.line)[failure.column - 1 :]
        width = min(len(failure.text.splitlines()[0]), len(line)) if failure.text.strip() else 0
        return Region(failure.line, failure.column, failure.line, failure.column + width)
    number = min(failure.line, len(source.lines))
    while number > 1 and not source.line(number).strip():
        number -= 1
    return Region.empty(number, len(source.line(number).rstrip()) + 1)
