"""Causes: groups of lines that fail for one reason, and the edits that repair them."""

from __future__ import annotations

from dataclasses import dataclass

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
