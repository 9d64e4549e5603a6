"""The judge of edits: how many programs that must stay rejected would an edit let in?"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cache

from grammar.notation.edits import Edit
from grammar.notation.model import Grammar
from grammar.parser.recognizer import Recognizer
from recovery.clustering.cause import Judge
from recovery.clustering.edit_trial import edited
from recovery.negatives.generate import generate
from recovery.negatives.negatives import Negative, NegativeSet
from recovery.negatives.required_tokens import used_by
from recovery.tuning import GENERATED_NEGATIVES, NEGATIVES_SEED

__all__ = ["judge_of"]


def judge_of(grammar: Grammar, negatives: Iterable[Negative]) -> Judge:
    """A judge for edits of ``grammar``; what it accepts already is not held against them.

    It judges by ``negatives`` and by a fixed sample of generated ones
    (`recovery.negatives.generate`).
    """
    recognizer = Recognizer(grammar)
    rejected = NegativeSet((*negatives, *_generated())).rejected_by(recognizer)
    known: dict[tuple[Edit, ...], int] = {}

    def judge(edits: Sequence[Edit]) -> int:
        key = tuple(edits)
        if key not in known:
            wider = edited(recognizer, edits)
            known[key] = (
                0 if wider is None else len(rejected.accepted(wider, used_by(edits, wider)))
            )
        return known[key]

    return judge


@cache
def _generated() -> tuple[Negative, ...]:
    return tuple(generate(count=GENERATED_NEGATIVES, seed=NEGATIVES_SEED))
