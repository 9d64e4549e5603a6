"""Causes: groups of lines that fail for one reason, and the edits that repair them."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import Protocol

from grammar.notation.edits import Edit


@dataclass(frozen=True, slots=True)
class Proposal:
    """Edits with the result of their trial.

    ``mended`` are the lines that can be read with them, ``advanced`` those that fail at a later
    token. ``breadth`` estimates how much else they accept, and ``accepts_negatives`` is the number
    of programs that must stay rejected and would be accepted.
    """

    edits: tuple[Edit, ...]
    mended: frozenset[int]
    advanced: frozenset[int]
    breadth: int
    accepts_negatives: int


@dataclass(frozen=True, slots=True)
class Cause:
    """Lines with one cause, and the proposals that repair them, the best first."""

    lines: tuple[int, ...]
    proposals: tuple[Proposal, ...]


#: Edits that compete with others for the same lines.
Rivals = Collection[tuple[Edit, ...]]


class NegativeCounter(Protocol):
    """Counts negatives: programs that must stay rejected."""

    def __call__(self, edits: Sequence[Edit], rivals: Rivals = ()) -> int:
        """Return how many negatives the grammar would accept with the edits.

        Those that one of the ``rivals`` accepts also count if the edits read the line at which they
        fail: what leaves a block open accepts no program with it, and is no better for that.
        """
        ...


def no_negatives(edits: Sequence[Edit], rivals: Rivals = ()) -> int:
    """Return 0: the `NegativeCounter` for a survey without negatives."""
    del edits, rivals
    return 0
