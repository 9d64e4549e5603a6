"""Causes: lines that fail for one reason, and edits that would mend them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from grammar.notation.edits import Edit


@dataclass(frozen=True, slots=True)
class Proposal:
    """An edit that was tried.

    ``mended`` are the lines that can be read with it, ``advanced`` those that fail further on;
    ``breadth`` says how much it accepts besides, and ``accepts_negatives`` counts programs that
    must stay rejected and no longer would be.
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


#: How many negatives the grammar would accept with the edits.
NegativeCounter = Callable[[Sequence[Edit]], int]


def no_negatives(edits: Sequence[Edit]) -> int:
    """Count none, where there are no negatives."""
    del edits
    return 0
