"""Comments that suppress findings of their line or file, applied to the findings of one file.

``; krl: ignore[KSS2296,KRL2] reason`` suppresses findings on its own line, ``; krl:
ignore-file[KRL601]`` those in its file. A code can be shortened to its first characters.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

from grammar.diagnostics.diagnostic import Diagnostic, Region, diagnose
from grammar.diagnostics.selection import is_known
from grammar.syntax.source import Source
from support.lazy_dataclass import dataclass

# Most files have no such comment, and looking at each comment takes time.
_MARK = re.compile(r";[ \t]*krl[ \t]*:", re.IGNORECASE)
_COMMENT = re.compile(
    r";+[ \t]*krl[ \t]*:[ \t]*(ignore(?:-file)?)(?![\w-])[ \t]*(?:\[([^\]]*)\])?(.*)",
    re.IGNORECASE | re.ASCII | re.DOTALL,
)


@dataclass(frozen=True, slots=True)
class Suppression:
    """A comment that suppresses findings: prefixes of codes, and the reason.

    It applies to its own ``line``, from 1, or to the whole file.
    """

    line: int
    codes: tuple[str, ...]
    is_file: bool
    reason: str

    def covers(self, diagnostic: Diagnostic) -> bool:
        """Return whether it suppresses a finding of its file."""
        is_here = self.is_file or self.line == diagnostic.region.line
        return is_here and diagnostic.code.startswith(self.codes)


@dataclass(frozen=True, slots=True)
class Malformed:
    """A comment that looks like a suppression but is not valid; ``problem`` says why."""

    line: int
    problem: str


def suppression(comment: str, line: int) -> Suppression | Malformed | None:
    """Return the suppression in a comment, given with its semicolon; ``None`` if it is none."""
    found = _COMMENT.match(comment)
    if found is None:
        return None
    how, listed, reason = found.groups()
    codes = tuple(word.strip().upper() for word in (listed or "").split(",") if word.strip())
    if not codes:
        return Malformed(line, f"name what to ignore: ; krl: {how.lower()}[CODE]")
    for prefix in codes:
        if not is_known(prefix):
            return Malformed(line, f"no code begins with {prefix}")
    return Suppression(line, codes, how.lower() == "ignore-file", reason.strip())


def unsuppressed(
    diagnostics: Iterable[Diagnostic], suppressions: Sequence[Suppression]
) -> tuple[list[Diagnostic], list[Suppression]]:
    """Return the findings of a file that are not suppressed, and the comments without effect."""
    kept: list[Diagnostic] = []
    idle = dict.fromkeys(suppressions)
    for diagnostic in diagnostics:
        acting = [one for one in suppressions if one.covers(diagnostic)]
        for one in acting:
            idle.pop(one, None)
        if not acting:
            kept.append(diagnostic)
    return kept, list(idle)


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
