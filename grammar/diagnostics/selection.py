"""Selection of findings: by code for a whole run, or suppressed by a comment.

``; krl: ignore[KSS2296,KRL2] reason`` suppresses findings on its own line, ``; krl:
ignore-file[KRL601]`` those in its file. A code can be shortened to its first characters.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

from grammar.diagnostics.codes import by_code
from grammar.diagnostics.diagnostic import Diagnostic
from support.lazy_dataclass import dataclass

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
        if not _is_known(prefix):
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
class Selection:
    """Findings chosen by prefixes of their codes; the longest prefix that fits decides.

    If ``select`` is empty, everything is selected. On a tie ``ignore`` wins.
    """

    select: tuple[str, ...] = ()
    ignore: tuple[str, ...] = ()

    @staticmethod
    def of(select: Iterable[str] = (), ignore: Iterable[str] = ()) -> Selection:
        """Return a selection from words of a command line, each one or more codes with commas.

        Raises `ValueError` for a word that is no prefix of a code.
        """
        return Selection(_codes(select), _codes(ignore))

    def keeps(self, code: str) -> bool:
        """Return whether findings of a code are selected."""
        chosen = _longest(code, self.select) if self.select else 0
        return chosen > _longest(code, self.ignore)


def _codes(words: Iterable[str]) -> tuple[str, ...]:
    codes = [code.strip().upper() for word in words for code in word.split(",") if code.strip()]
    for code in codes:
        if not _is_known(code):
            raise ValueError(f"no code begins with {code}; krl explain lists them")
    return tuple(codes)


def _is_known(prefix: str) -> bool:
    return any(code.startswith(prefix) for code in by_code())


def _longest(code: str, prefixes: tuple[str, ...]) -> int:
    return max((len(prefix) for prefix in prefixes if code.startswith(prefix)), default=-1)
