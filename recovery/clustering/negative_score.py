"""Scoring an edit on negatives: how many programs it would wrongly accept."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Sequence
from functools import cache
from typing import Protocol

from grammar.notation.edits import AddRule, AddToken, Edit, Insert
from grammar.notation.model import Grammar
from grammar.parser.failures import Form
from grammar.parser.lexer import EOF, SKIPPED
from grammar.parser.recognizer import Recognizer
from recovery.clustering.edit_trial import EditTrial
from recovery.forms.parts import parts, unwrapped
from recovery.negatives.generate import generate
from recovery.negatives.negatives import Negative, NegativeSet
from recovery.proposals.edit_site import LinePattern
from recovery.tuning import GENERATED_NEGATIVES, NEGATIVES_SEED

# A part of a text that is one token, and always there.
_TOKEN = re.compile(r"'.+'|[A-Z_][A-Z0-9_]*")
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
    without those that the grammar accepts already. Edits are tried on each as on one long line.
    """
    recognizer = Recognizer(grammar)
    rejected = NegativeSet((*negatives, *_generated())).rejected_by(recognizer).negatives
    programs = [_as_line(recognizer, negative.text) for negative in rejected]
    trial = EditTrial(recognizer, programs)

    spelled = recognizer.lexer.spelled
    tokens = [
        {*(spelled(kind) for kind in p.form.kinds if kind > 0), *(word for _, word in p.keywords)}
        for p in programs
    ]

    @cache
    def accepted(edits: tuple[Edit, ...]) -> frozenset[int]:
        needed = {_needed(edit) for edit in edits if not isinstance(edit, AddToken)}
        having = (n for n, some in enumerate(tokens) if any(few <= some for few in needed))
        return trial.result(edits, having).mended

    def is_read(number: int, failed: int | None) -> bool:
        """Return whether a program is read beyond the line at which it fails."""
        form = programs[number].form
        return failed is None or recognizer.line_kind in form.kinds[form.index : failed]

    def count_negatives(edits: Sequence[Edit], rivals: Rivals = ()) -> int:
        own = accepted(tuple(edits))
        others = frozenset[int]().union(*map(accepted, rivals)) - own
        read = trial.failures(edits, others).items() if others else ()
        return len(own) + sum(is_read(number, failed) for number, failed in read)

    return count_negatives


def _needed(edit: Edit) -> frozenset[str]:
    """Return the tokens that an edit writes plainly: whatever it lets be read has them."""
    pieces = [] if isinstance(edit, AddRule) else parts(getattr(edit, "text", ""))
    if isinstance(edit, Insert) and len(pieces) == 1:
        pieces = parts(unwrapped(pieces[0]))
    return frozenset() if "|" in pieces else frozenset(filter(_TOKEN.fullmatch, pieces))


def _as_line(recognizer: Recognizer, text: str) -> LinePattern:
    """Return a program as one failing line, in which each name may be meant as a keyword."""
    lexer = recognizer.lexer
    found = [(lexer.kinds[lexeme], lexeme.upper()) for lexeme in lexer.lexemes(text)]
    tokens = [(kind, word) for kind, word in found if kind != SKIPPED]
    kinds = (*(kind for kind, _ in tokens), EOF)
    index = recognizer.run(recognizer.start, kinds)[1]
    assert index is not None
    names = tuple((i, word) for i, (kind, word) in enumerate(tokens) if kind == lexer.name_kind)
    return LinePattern(Form(recognizer.frames(recognizer.start), kinds, index), names)


@cache
def _generated() -> tuple[Negative, ...]:
    return tuple(generate(count=GENERATED_NEGATIVES, seed=NEGATIVES_SEED))
