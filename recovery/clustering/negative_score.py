"""Scoring an edit on negatives: how many programs it would wrongly accept."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence, Set
from functools import cache
from typing import Protocol

from grammar.notation.edits import Edit
from grammar.notation.model import Grammar
from grammar.parser.recognizer import Recognizer
from recovery.clustering.edit_trial import edited
from recovery.clustering.joint_trial import DetourReader, Path
from recovery.negatives.generate import generate
from recovery.negatives.negatives import Negative, NegativeSet
from recovery.tuning import GENERATED_NEGATIVES, NEGATIVES_SEED

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


def negative_counter(grammar: Grammar, negatives: Iterable[Negative]) -> NegativeCounter:
    """Return a function that counts the negatives that edits of ``grammar`` newly accept.

    They are ``negatives`` and a fixed sample of generated ones (`recovery.negatives.generate`),
    without those that the grammar accepts already.
    """
    recognizer = Recognizer(grammar)
    rejected = NegativeSet((*negatives, *_generated())).rejected_by(recognizer)
    programs = _Programs(recognizer, rejected)
    known: dict[tuple[Edit, ...], frozenset[int]] = {}
    nothing = frozenset[int]()

    def accepted(edits: tuple[Edit, ...]) -> frozenset[int]:
        if edits not in known:
            known[edits] = programs.accepted(edits)
        return known[edits]

    def count_negatives(edits: Sequence[Edit], rivals: Rivals = ()) -> int:
        own = accepted(tuple(edits))
        others = nothing.union(*map(accepted, rivals)) - own
        return len(own) + programs.count_read(edits, others)

    return count_negatives


class _Programs:
    """Negatives prepared for reading with edits of a grammar that rejects them."""

    def __init__(self, recognizer: Recognizer, negatives: NegativeSet) -> None:
        self._recognizer = recognizer
        self._negatives = negatives
        self._reader = DetourReader(recognizer.grammar, recognizer.network)
        self._texts: dict[frozenset[str], list[tuple[int, ...]]] = {}

    def accepted(self, edits: Sequence[Edit]) -> frozenset[int]:
        """Return the numbers of the negatives that the edits accept."""
        found = self._read(edits)
        if found is not None:
            return frozenset(n for n, (_, failed) in enumerate(found) if failed is None)
        wider = edited(self._recognizer, edits)
        accepted = set(self._negatives.accepted(wider)) if wider else set()
        every = enumerate(self._negatives.negatives)
        return frozenset(number for number, negative in every if negative in accepted)

    def count_read(self, edits: Sequence[Edit], among: Set[int]) -> int:
        """Return how many of some negatives can be read beyond the line at which they fail.

        None is counted for edits that are no detours.
        """
        found = (self._read(edits) if among else None) or ()
        end = self._recognizer.lexer.line_kind
        return sum(
            failed is None or end in path.kinds[len(path.states) - 1 : failed]
            for number, (path, failed) in enumerate(found)
            if number in among
        )

    def _read(self, edits: Sequence[Edit]) -> list[tuple[Path, int | None]] | None:
        """Return each negative with where it fails; ``None`` if the edits are no detours."""
        detours = self._reader.detours(edits)
        if detours is None:
            return None
        if detours.words not in self._texts:
            self._texts[detours.words] = list(self._kinds(detours.words))
        return list(self._reader.read(detours, self._texts[detours.words]))

    def _kinds(self, words: frozenset[str]) -> Iterator[tuple[int, ...]]:
        """Yield the token kinds of each program, as the reader numbers them; ``words`` reserved."""
        lexer, own = self._recognizer.lexer, len(self._recognizer.lexer.names)
        for word in sorted(words):
            lexer = lexer.with_keyword(word)
        kind_here = [*range(own), *map(self._reader.kind, lexer.names[own:])]
        for program in self._negatives.kinds(lexer):
            yield tuple(kind_here[kind] if kind > 0 else kind for kind in program)


@cache
def _generated() -> tuple[Negative, ...]:
    return tuple(generate(count=GENERATED_NEGATIVES, seed=NEGATIVES_SEED))
