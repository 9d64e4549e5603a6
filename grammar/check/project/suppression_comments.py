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
    r";+[ \t]*krl[ \t]*:[ \t]*(ignore(?:-file)?)(?![\w-])[ \t]*(?:\[([^\]]*)\])?",
    re.IGNORECASE | re.ASCII,
)


@dataclass(frozen=True, slots=True)
class Suppression:
    """A comment that suppresses findings of its line, or of its file, or tries to.

    ``codes`` are prefixes of codes; ``problem`` says why a comment suppresses nothing.
    """

    region: Region
    codes: tuple[str, ...] = ()
    is_file: bool = False
    problem: str = ""

    def covers(self, diagnostic: Diagnostic) -> bool:
        """Return whether it suppresses a finding of its file."""
        is_here = self.is_file or self.region.line == diagnostic.region.line
        return is_here and diagnostic.code.startswith(self.codes)


def suppression(comment: str, region: Region) -> Suppression | None:
    """Return the suppression in a comment, given with its semicolon; ``None`` if it is none."""
    found = _COMMENT.match(comment)
    if found is None:
        return None
    how, listed = found[1].lower(), found[2] or ""
    codes = tuple(word.strip().upper() for word in listed.split(",") if word.strip())
    if not codes:
        return Suppression(region, problem=f"name what to ignore: ; krl: {how}[CODE]")
    for prefix in codes:
        if not is_known(prefix):
            return Suppression(region, problem=f"no code begins with {prefix}")
    return Suppression(region, codes, how == "ignore-file")


def suppression_comments(source: Source) -> tuple[Suppression, ...]:
    """Return the comments of a file that suppress findings, or try to."""
    if not _MARK.search(source.text):
        return ()
    made = (
        suppression(one.text, Region(one.line, one.column, one.line, one.column + len(one.text)))
        for one in source.comments
    )
    return tuple(filter(None, made))


def apply_suppressions(
    path: str,
    diagnostics: Iterable[Diagnostic],
    comments: Sequence[Suppression],
    sought: tuple[str, ...] = ("",),
) -> list[Diagnostic]:
    """Return the findings that no comment suppresses, and findings on the comments.

    ``sought`` are the prefixes of the codes that were checked at all: a comment for other codes may
    be useful another time.
    """
    kept: list[Diagnostic] = []
    used: set[Suppression] = set()
    for diagnostic in diagnostics:
        acting = [one for one in comments if one.covers(diagnostic)]
        used.update(acting)
        if not acting:
            kept.append(diagnostic)
    for one in comments:
        if one.problem:
            kept.append(diagnose("bad-suppression", path, one.region, one.problem))
        elif one not in used and all(code.startswith(sought) for code in one.codes):
            message = f"nothing to suppress here: {', '.join(one.codes)}"
            kept.append(diagnose("unused-suppression", path, one.region, message))
    return kept
