"""Selection of findings: by code for a whole run, or suppressed by a comment.

``; krl: ignore[KSS2296,KRL2] reason`` silences findings of its own line, ``; krl:
ignore-file[KRL601]`` those of its file. Codes are given whole or by their beginning.
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
    """A comment that silences: the beginnings of codes, and why.

    It acts on its own ``line``, from 1, or on the whole file.
    """

    line: int
    codes: tuple[str, ...]
    is_file: bool
    reason: str

    def covers(self, diagnostic: Diagnostic) -> bool:
        """Whether it silences a finding of its file."""
        is_here = self.is_file or self.line == diagnostic.region.line
        return is_here and diagnostic.code.startswith(self.codes)


@dataclass(frozen=True, slots=True)
class Malformed:
    """A comment that is meant to silence something and does not; ``problem`` says why."""

    line: int
    problem: str


def suppression(comment: str, line: int) -> Suppression | Malformed | None:
    """What a comment, from its semicolon on, silences; ``None`` for any other comment."""
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
    """The findings of one file that no comment silences, and the comments that silence none."""
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
    """Findings chosen by the beginnings of their codes; the longest beginning that fits decides.

    Nothing selected means everything. Where a code is selected and ignored alike it is ignored.
    """

    select: tuple[str, ...] = ()
    ignore: tuple[str, ...] = ()

    @staticmethod
    def of(select: Iterable[str] = (), ignore: Iterable[str] = ()) -> Selection:
        """From words of a command line, each one or several codes joined by commas.

        Raises `ValueError` for a word that no code begins with.
        """
        return Selection(_codes(select), _codes(ignore))

    def keeps(self, code: str) -> bool:
        """Whether findings of a code are wanted."""
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
