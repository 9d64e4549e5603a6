"""Infers edits from all failing lines of a kind at once: operators, brackets, statements, blocks.

Each source examines the lines from a different point of view and writes edits that apply to many of
them. The edits are only candidates: `recovery.induction.rounds` tries all of them and keeps those
that have evidence.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence

from grammar.parser.failures import FailureContext
from grammar.parser.recognizer import Recognizer
from recovery.induction.block_edits import BlockEdits
from recovery.induction.bracket_edits import BracketEdits
from recovery.induction.line_edits import LineEdits
from recovery.induction.line_hosts import LineHosts
from recovery.induction.line_symbols import LineSymbols
from recovery.induction.operand_edits import OperandEdits
from recovery.induction.steps import InferredStep
from recovery.induction.supported_forms import SupportedForms
from recovery.proposals.blocks import BlockLines
from recovery.proposals.edit_site import LinePattern


class Inference:
    """Infers edits of one grammar from its failing lines."""

    def __init__(
        self,
        recognizer: Recognizer,
        lines: Sequence[LinePattern],
        contexts: Sequence[FailureContext],
        origins: Sequence[Collection[str]],
        blocks: Sequence[BlockLines] = (),
        prefixes: frozenset[str] = frozenset(),
        inner_words: frozenset[str] = frozenset(),
        least: int = 1,
    ) -> None:
        """``contexts`` as of `LineSymbols`, ``origins`` and ``least`` as of `SupportedForms`.

        ``blocks`` are those of the corpus that the grammar does not have, ``prefixes`` words that
        may be missing at the head of a line, ``inner_words`` those that often follow another word.
        """
        self._at = LineSymbols(recognizer, lines, contexts)
        self._forms = SupportedForms(self._at, origins, least)
        self._blocks = blocks
        self._prefixes = prefixes
        self._inner_words = inner_words
        self.profile = self._at.profile

    def inner(self) -> Iterator[InferredStep]:
        """Return edits inside operands: operators and contents of brackets."""
        operands = OperandEdits(self._at, self._forms)
        yield from operands.edits()
        yield from BracketEdits(self._at, self._forms, operands).edits()

    def outer(self) -> Iterator[InferredStep]:
        """Return edits of whole lines and blocks of lines."""
        hosts = LineHosts(self._at)
        blocks = BlockEdits(self._at, self._forms, hosts, self._blocks)
        yield from blocks.edits()
        lines = LineEdits(
            self._at, self._forms, hosts, self._prefixes, self._inner_words, blocks.words
        )
        yield from lines.edits()
