"""Scoring an edit on negatives: how many programs it would wrongly accept."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence, Set
from functools import cache
from typing import Protocol

from grammar.notation.edits import AddToken, Edit, Insert
from grammar.notation.model import Grammar
from grammar.parser.recognizer import Recognizer
from recovery.clustering.edit_trial import edited
from recovery.clustering.joint_trial import DetourReader, Path
from recovery.forms.parts import parts, unwrapped
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
        self._texts: dict[frozenset[str], list[tuple[tuple[int, ...], frozenset[int]]]] = {}
        lexer = recognizer.lexer
        self._kind_of = {lexer.spelled(kind): kind for kind in lexer.kind_of.values()}

    def accepted(self, edits: Sequence[Edit]) -> frozenset[int]:
        """Return the numbers of the negatives that the edits accept."""
        found = self._read(edits)
        if found is not None:
            return frozenset(number for number, _, failed in found if failed is None)
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
            for number, path, failed in found
            if number in among
        )

    def _read(self, edits: Sequence[Edit]) -> list[tuple[int, Path, int | None]] | None:
        """Return the negatives that may be accepted, with their numbers and where they fail.

        That is ``None`` if the edits are no detours.
        """
        detours = self._reader.detours(edits)
        if detours is None:
            return None
        if detours.words not in self._texts:
            self._texts[detours.words] = [(k, frozenset(k)) for k in self._kinds(detours.words)]
        kind_of = self._kind_of | {word: self._reader.kind(word) for word in detours.words}
        needed = {_needed(edit, kind_of) for edit in edits if not isinstance(edit, AddToken)}
        having = {
            number: kinds
            for number, (kinds, met) in enumerate(self._texts[detours.words])
            if any(some <= met for some in needed)
        }
        found = self._reader.read(detours, having.values())
        return [(number, *read) for number, read in zip(having, found, strict=True)]

    def _kinds(self, words: frozenset[str]) -> Iterator[tuple[int, ...]]:
        """Yield the token kinds of each program, as the reader numbers them; ``words`` reserved."""
        lexer, own = self._recognizer.lexer, len(self._recognizer.lexer.names)
        for word in sorted(words):
            lexer = lexer.with_keyword(word)
        kind_here = [*range(own), *map(self._reader.kind, lexer.names[own:])]
        for program in self._negatives.kinds(lexer):
            yield tuple(kind_here[kind] if kind > 0 else kind for kind in program)


def _needed(edit: Edit, kind_of: Mapping[str, int]) -> frozenset[int]:
    """Return the tokens that an edit writes plainly: whatever it lets be read has them."""
    pieces = parts(getattr(edit, "text", ""))
    if isinstance(edit, Insert) and len(pieces) == 1:
        pieces = parts(unwrapped(pieces[0]))
    return frozenset() if "|" in pieces else frozenset(kind_of[p] for p in pieces if p in kind_of)


@cache
def _generated() -> tuple[Negative, ...]:
    return tuple(generate(count=GENERATED_NEGATIVES, seed=NEGATIVES_SEED))
