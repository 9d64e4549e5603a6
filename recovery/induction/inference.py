"""Infers edits from all failing lines of a kind at once: operators, brackets, statements, blocks.

Each source examines the lines from a different point of view and writes edits that apply to many of
them. The edits are only candidates: `recovery.induction.rounds` tries all of them and keeps those
that have evidence.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from recovery.induction.block_edits import BlockEdits
from recovery.induction.bracket_edits import BracketEdits
from recovery.induction.line_edits import LineEdits
from recovery.induction.line_hosts import LineHosts
from recovery.induction.line_symbols import LineSymbols
from recovery.induction.operand_edits import OperandEdits
from recovery.induction.steps import InferredStep
from recovery.induction.supported_forms import SupportedForms
from recovery.proposals.blocks import BlockLines


def inner_edits(at: LineSymbols, forms: SupportedForms) -> Iterator[InferredStep]:
    """Return edits inside operands: operators and contents of brackets."""
    operands = OperandEdits(at, forms)
    yield from operands.edits()
    yield from BracketEdits(at, forms, operands).edits()


def outer_edits(
    at: LineSymbols,
    forms: SupportedForms,
    blocks: Sequence[BlockLines],
    prefixes: frozenset[str],
    inner_words: frozenset[str],
) -> Iterator[InferredStep]:
    """Return edits of whole lines and blocks of lines.

    ``blocks`` are those of the corpus that the grammar does not have, ``prefixes`` words that may
    be missing at the head of a line, ``inner_words`` those that often follow another word.
    """
    hosts = LineHosts(at)
    block_edits = BlockEdits(at, forms, hosts, blocks)
    yield from block_edits.edits()
    yield from LineEdits(at, forms, hosts, prefixes, inner_words, block_edits.words).edits()
