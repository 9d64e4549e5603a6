"""What a search for causes finds: lines with one cause, and edits that would mend them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from grammar.notation.edits import Edit

__all__ = ["Cause", "Judge", "Proposal", "no_judge"]


@dataclass(frozen=True, slots=True)
class Proposal:
    """An edit that was tried: the lines it mends, lets be read further, and what it costs.

    ``accepts_negatives`` counts programs that must stay rejected and no longer would be.
    """

    edits: tuple[Edit, ...]
    mended: frozenset[int]
    advanced: frozenset[int]
    breadth: int
    accepts_negatives: int


@dataclass(frozen=True, slots=True)
class Cause:
    """Lines with one cause, and what would mend it, the best first."""

    lines: tuple[int, ...]
    proposals: tuple[Proposal, ...]


#: How many negatives an edit would let in.
Judge = Callable[[Sequence[Edit]], int]


def no_judge(edits: Sequence[Edit]) -> int:
    """Where there are no negatives nothing speaks against an edit."""
    del edits
    return 0
