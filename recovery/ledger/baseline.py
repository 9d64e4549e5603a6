"""Measurement of a grammar: what it reads of the corpora, and which negatives it accepts.

Two grammars that differ by one construct are compared by their measurements
(`recovery.ledger.evaluation`). So a series of constructs costs one reading of the corpora each.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from grammar.blocks import BLOCKS, CLOSERS
from grammar.motion_kinds import MOTIONS
from grammar.notation.model import Grammar
from grammar.parser.recognizer import Recognizer
from recovery.negatives.generate import generate
from recovery.negatives.negatives import Negative, NegativeSet
from recovery.negatives.tokens import RESERVED, RESERVED_FIRST, lines
from recovery.survey.survey import Survey, survey
from support.files.discovery import source_files

# Words that `recovery.negatives.language_facts` treats as keywords.
_KEYWORDS = (
    RESERVED
    | RESERVED_FIRST
    | BLOCKS.keys()
    | CLOSERS.keys()
    | frozenset({"WAIT", "INTERRUPT", "TRIGGER", *MOTIONS})
)
_GENERATED = 3_000
_SEED = 2010


@dataclass(frozen=True, slots=True)
class GrammarMeasurement:
    """A grammar with the surveys under it and the negatives that it accepts.

    ``evidence`` is the survey of other people's files and ``own`` that of our programs; each is
    ``None`` if there are none. ``accepted_negatives`` leaves out programs that the grammar cannot
    reject yet: those with a keyword that is still a name to it.
    """

    recognizer: Recognizer
    evidence: Survey | None
    own: Survey | None
    accepted_negatives: frozenset[Negative]

    @property
    def grammar(self) -> Grammar:
        """The grammar that was measured."""
        return self.recognizer.grammar


class Corpora:
    """The inputs of a measurement: other people's files, our programs, negatives."""

    def __init__(
        self,
        evidence: Sequence[Path],
        own: Path | None,
        negatives: Iterable[Negative],
        *,
        generated: int = _GENERATED,
        cache: Path | None = None,
        jobs: int | None = None,
    ) -> None:
        """Create it; ``evidence`` are roots of other people's files, ``own`` our programs.

        Files below ``own``, and copies of them, are no evidence. ``generated`` is the number of
        negatives that are generated from our programs, besides those given. ``cache`` and ``jobs``
        are those of `recovery.survey.survey`. Raises `support.files.discovery.IngestError` if a
        folder has nothing to read.
        """
        self._roots = tuple(evidence)
        self._own = own
        self._cache = cache
        self._jobs = jobs
        texts = [file.text for file in source_files([own])] if own else []
        made = generate(texts, count=generated, seed=_SEED)
        self._negatives = NegativeSet((*negatives, *made))

    def measure(self, grammar: Grammar) -> GrammarMeasurement:
        """Return the measurement of a grammar; raises `support.files.discovery.IngestError`."""
        recognizer = Recognizer(grammar)
        own = self._survey([self._own] if self._own else [], grammar)
        evidence = self._survey(self._roots, grammar)
        if own is not None and evidence is not None:
            ours = {file.digest for file in own.files}
            others = tuple(file for file in evidence.files if file.digest not in ours)
            evidence = replace(evidence, files=others)
        return GrammarMeasurement(recognizer, evidence, own, frozenset(self._accepted(recognizer)))

    def _accepted(self, recognizer: Recognizer) -> Iterator[Negative]:
        lexer = recognizer.lexer
        names = {word for word in _KEYWORDS if not lexer.is_keyword(lexer.kinds[word])}
        for negative in self._negatives.accepted(recognizer):
            words = {token.word for line in lines(negative.text) for token in line.tokens}
            if names.isdisjoint(words):
                yield negative

    def _survey(self, roots: Sequence[Path], grammar: Grammar) -> Survey | None:
        return survey(roots, grammar, jobs=self._jobs, cache=self._cache) if roots else None
