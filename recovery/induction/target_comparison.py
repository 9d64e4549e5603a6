"""Compares a grown grammar with a target: files that both read, and what it should not read."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from random import Random
from typing import TypedDict

from grammar.notation.model import Grammar
from grammar.parser.failures import FailureFinder
from grammar.parser.recognizer import Recognizer
from grammar.parser.sentences import Sentences, Speller
from recovery.induction.language import KRL, CorpusFile, Language
from recovery.negatives.negatives import NegativeSet

_SENTENCES = 1_000
_NEGATIVES = 10_000
# Other than the seed of the negatives by which edits are tried.
_SEED = 4242


class Share(TypedDict):
    """A number out of a total."""

    count: int
    of: int


class Comparison(TypedDict):
    """How much of the target the grown grammar reads, and how much else it accepts.

    ``shown`` and ``held``: of the files that the target parses, how many it parses, too.
    ``held_within_reach``: the same for held-out files without any pair of adjacent kinds of token
    of the target that no shown file has; files beyond that require a guess. ``held_known_words``:
    the same for held-out files without a word of ``words_not_shown`` that the grown grammar lacks,
    too: no induction can read more. ``words_not_shown``: reserved words of the target in held-out
    files that no shown file has. ``sentences_rejected``: how many of its random sentences the
    target rejects; ``sentences_rejected_for_growth``: at how many of these the start, too, rejects
    the first wrong line, so that the growth has added it. ``negatives_accepted``: how many
    generated negatives it accepts.
    """

    shown: Share
    held: Share
    held_within_reach: Share
    held_known_words: Share
    words_not_shown: list[str]
    sentences_rejected: Share
    sentences_rejected_for_growth: Share
    negatives_accepted: Share


def compared(
    start: Grammar,
    grown: Grammar,
    target: Grammar,
    shown: Sequence[CorpusFile],
    held: Sequence[CorpusFile],
    language: Language = KRL,
) -> Comparison:
    """Return the comparison of the grammar that ``start`` has grown to with the target.

    The random sentences and negatives have a fixed seed.
    """
    reader, reference = Recognizer(grown), Recognizer(target)
    sentences, speller, chance = Sentences(grown), Speller(grown), Random(_SEED)
    drawn = [speller.text(sentences.random(chance)) for _ in range(_SENTENCES)]
    rejected = [text for text in drawn if not reference.accepts(text)]
    at_start, at_target = (FailureFinder(Recognizer(grammar)) for grammar in (start, target))
    wrong = [(text, next((f.line for f in at_target.find(text)), 0)) for text in rejected]
    added = [line in {f.line for f in at_start.find(text)} for text, line in wrong]
    negatives = NegativeSet(language.negatives(_NEGATIVES, _SEED))
    wanted = [file for file in held if reference.accepts(file.text)]
    near, unknown = within_reach(reference, shown, wanted)
    missing = {reference.lexer.kind_of[w] for w in unknown if w not in reader.lexer.kind_of}
    known = [file for file in wanted if missing.isdisjoint(reference.kinds(file.text))]
    return {
        "shown": _parsed(reader, [file for file in shown if reference.accepts(file.text)]),
        "held": _parsed(reader, wanted),
        "held_within_reach": _parsed(reader, near),
        "held_known_words": _parsed(reader, known),
        "words_not_shown": unknown,
        "sentences_rejected": {"count": len(rejected), "of": len(drawn)},
        "sentences_rejected_for_growth": {"count": sum(added), "of": len(drawn)},
        "negatives_accepted": {"count": len(negatives.accepted(reader)), "of": len(negatives)},
    }


def within_reach(
    reference: Recognizer, shown: Sequence[CorpusFile], held: Sequence[CorpusFile]
) -> tuple[list[CorpusFile], list[str]]:
    """Return the held-out files whose adjacent tokens also occur in shown files, and unknown words.

    The words are those that the reference reserves and that occur in held-out files only.
    """
    known = frozenset[tuple[int, int]]().union(*(_neighbours(reference, file) for file in shown))
    pairs = {file.path: _neighbours(reference, file) for file in held}
    new = {k for p in pairs.values() for pair in p for k in pair} - {k for p in known for k in p}
    lexer = reference.lexer
    return (
        [file for file in held if pairs[file.path] <= known],
        sorted(lexer.names[kind] for kind in new if lexer.is_keyword(kind)),
    )


def _parsed(reader: Recognizer, files: Sequence[CorpusFile]) -> Share:
    return {"count": sum(reader.accepts(file.text) for file in files), "of": len(files)}


def _neighbours(reference: Recognizer, file: CorpusFile) -> frozenset[tuple[int, int]]:
    """Return pairs of kinds of token that stand side by side in a file."""
    return frozenset(pairwise(reference.kinds(file.text)))
