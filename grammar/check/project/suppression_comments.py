"""Comments that suppress findings of their line or file, applied to the findings of one file."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

from grammar.diagnostics.diagnostic import Diagnostic, Region, diagnose
from grammar.diagnostics.suppression import Malformed, Suppression, suppression, unsuppressed
from grammar.syntax.source import Source
from support.lazy_dataclass import dataclass

# Most files have no such comment, and looking at each comment takes time.
_MARK = re.compile(r";[ \t]*krl[ \t]*:", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class SuppressionComment:
    """A comment that suppresses findings, or tries to, and its place."""

    what: Suppression | Malformed
    region: Region


def suppression_comments(source: Source) -> tuple[SuppressionComment, ...]:
    """Return the comments of a file that suppress findings, or try to."""
    if not _MARK.search(source.text):
        return ()
    found = []
    for comment in source.comments:
        what = suppression(comment.text, comment.line)
        if what is not None:
            end = comment.column + len(comment.text)
            found.append(
                SuppressionComment(what, Region(comment.line, comment.column, comment.line, end))
            )
    return tuple(found)


def apply_suppressions(
    path: str,
    diagnostics: Iterable[Diagnostic],
    comments: Sequence[SuppressionComment],
    sought: tuple[str, ...] = ("",),
) -> list[Diagnostic]:
    """Return the findings that no comment suppresses, and findings on the comments.

    ``sought`` are the prefixes of the codes that were checked at all: a comment for other codes may
    be useful another time.
    """
    regions = {comment.what: comment.region for comment in comments}
    acting = [what for what in regions if isinstance(what, Suppression)]
    kept, idle = unsuppressed(diagnostics, acting)
    for what, region in regions.items():
        if isinstance(what, Malformed):
            kept.append(diagnose("bad-suppression", path, region, what.problem))
        elif what in idle and all(code.startswith(sought) for code in what.codes):
            message = f"nothing to suppress here: {', '.join(what.codes)}"
            kept.append(diagnose("unused-suppression", path, region, message))
    return kept
