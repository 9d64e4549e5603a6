"""Comments that silence findings of their line or file, applied to the findings of one file."""

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
    """A comment that silences, or is meant to, and where it stands."""

    what: Suppression | Malformed
    region: Region


def suppression_comments(source: Source) -> tuple[SuppressionComment, ...]:
    """The comments of a file that silence something, or are meant to."""
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
    """The findings of a file that no comment silences, and what is wrong with the comments.

    ``sought`` are the beginnings of the codes that were looked for at all: a comment for others may
    well be of use another time.
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
