"""Steps of a growth: edits accepted or refused, their evidence, and how files then parse."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from grammar.notation.edits import AddAlternative, AddToken, Edit


@dataclass(frozen=True, slots=True)
class Inferred:
    """Edits, why they were written, and the lines they were written for.

    Those that are ``is_strict`` read so much that they may accept nothing which must be rejected.
    ``breadth`` is how much more they read than others for the same lines, in symbols of a rule.
    """

    title: str
    edits: tuple[Edit, ...]
    lines: tuple[int, ...]
    is_strict: bool = False
    is_block: bool = False
    breadth: int = 0


@dataclass(frozen=True, slots=True)
class Evidence:
    """What speaks for edits: files and origins with lines that they mend, and up to ten places."""

    files: int
    origins: int
    lines: int
    seen: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Taken:
    """A step of the growth: edits, why, and on what evidence."""

    title: str
    edits: tuple[Edit, ...]
    evidence: Evidence


@dataclass(frozen=True, slots=True)
class Refused:
    """Edits that were tried and not taken, with the reason."""

    title: str
    edits: tuple[Edit, ...]
    gain: float
    reason: str


@dataclass(frozen=True, slots=True)
class Reading:
    """How files read under a grammar: which parse, and which of their lines fail."""

    parsed: int
    files: int
    failing: int


@dataclass(frozen=True, slots=True)
class Round:
    """One round: how the files read before it, what it took and what it refused."""

    shown: Reading
    held: Reading
    taken: tuple[Taken, ...]
    refused: tuple[Refused, ...]


def joined(steps: Sequence[Taken]) -> list[Edit]:
    """The edits of all steps; what two of them reserve or add alike comes once."""
    found: list[Edit] = []
    for edit in (edit for step in steps for edit in step.edits):
        if not (isinstance(edit, AddToken | AddAlternative) and edit in found):
            found.append(edit)
    return found
