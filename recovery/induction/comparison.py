"""A grown grammar compared with a target: files read by both, and what it should not read."""

from __future__ import annotations

from collections.abc import Sequence
from random import Random
from typing import TypedDict

from grammar.notation.model import Grammar
from grammar.parser.recognizer import Recognizer
from grammar.parser.sentences import Sentences, Speller
from recovery.induction.corpus_lines import CorpusFile
from recovery.negatives.generate import generate
from recovery.negatives.negatives import NegativeSet

__all__ = ["Comparison", "Share", "compared"]

_SENTENCES = 1_000
_NEGATIVES = 10_000
# Other than the seed of the negatives by which edits are tried.
_SEED = 4242


class Share(TypedDict):
    """So many of so many."""

    count: int
    of: int


class Comparison(TypedDict):
    """How much the grown grammar reads that it should, and that it should not.

    ``shown`` and ``held``: of the files that the target parses, how many it parses too.
    ``sentences_rejected``: of its random sentences, how many the target rejects.
    ``negatives_accepted``: of generated negatives, how many it accepts.
    """

    shown: Share
    held: Share
    sentences_rejected: Share
    negatives_accepted: Share


def compared(
    grown: Grammar, target: Grammar, shown: Sequence[CorpusFile], held: Sequence[CorpusFile]
) -> Comparison:
    """The grown grammar compared with the target, with sentences and negatives of a fixed seed."""
    reader, judge = Recognizer(grown), Recognizer(target)
    sentences, speller, chance = Sentences(grown), Speller(grown), Random(_SEED)
    drawn = [speller.text(sentences.random(chance)) for _ in range(_SENTENCES)]
    negatives = NegativeSet(generate(count=_NEGATIVES, seed=_SEED))
    return {
        "shown": _parsed(reader, judge, shown),
        "held": _parsed(reader, judge, held),
        "sentences_rejected": {
            "count": sum(not judge.accepts(text) for text in drawn),
            "of": len(drawn),
        },
        "negatives_accepted": {"count": len(negatives.accepted(reader)), "of": len(negatives)},
    }


def _parsed(reader: Recognizer, judge: Recognizer, files: Sequence[CorpusFile]) -> Share:
    wanted = [file.text for file in files if judge.accepts(file.text)]
    return {"count": sum(map(reader.accepts, wanted)), "of": len(wanted)}
