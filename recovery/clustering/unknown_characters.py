"""Proposals of tokens for lines that fail at characters which no token has.

The trial of edits reads lines as the lexer of the grammar has cut them, so it cannot show what a
new token would do. Some files are read again instead.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from grammar.notation.edits import AddAlternative, AddRule, Edit
from grammar.parser.failures import FailureFinder
from grammar.parser.lexer import ERROR
from grammar.parser.recognizer import Recognizer
from recovery.clustering.cause import Cause, Proposal
from recovery.clustering.edit_trial import edited
from recovery.clustering.negative_score import NegativeCounter
from recovery.forms.operand_rules import OperandRules
from recovery.proposals.edit_site import LinePattern
from recovery.proposals.unknown_tokens import unknown_tokens
from recovery.survey.failing_line import FailingLine
from recovery.tuning import MOST_REREAD


def with_tokens(
    recognizer: Recognizer,
    causes: Sequence[Cause],
    lines: Sequence[LinePattern],
    place_of: Callable[[int], tuple[FailingLine, str]],
    count_negatives: NegativeCounter,
) -> list[Cause]:
    """Return the causes; lines without a proposal that values in quotes mend are one cause.

    ``place_of`` returns an occurrence of a line, and the text of its file.
    """
    failing = {n for cause in causes if not cause.proposals for n in cause.lines}
    failing = {n for n in failing if ERROR in lines[n].form.kinds}
    if not failing:
        return list(causes)
    places = {n: place_of(n) for n in sorted(failing)[:MOST_REREAD]}
    edits = tuple(_edits(recognizer, [(failed.source, n) for n, (failed, _) in places.items()]))
    wider = edited(recognizer, edits) if edits else None
    if wider is None:
        return list(causes)
    finder = FailureFinder(wider)
    mended = frozenset(
        n
        for n, (failed, text) in places.items()
        if failed.line not in {failure.line for failure in finder.find(text)}
    )
    if not mended or count_negatives(edits):
        return list(causes)  # what must stay rejected is no value
    proposal = Proposal(edits, mended, frozenset(), 0, 0)
    rest = [tuple(n for n in cause.lines if n not in mended) for cause in causes]
    left = [Cause(own, cause.proposals) for cause, own in zip(causes, rest, strict=True) if own]
    return [*left, Cause(tuple(sorted(mended)), (proposal,))]


def _edits(recognizer: Recognizer, sources: Sequence[tuple[str, int]]) -> Iterator[Edit]:
    """Yield the edits that make values of the texts in quotes which no token reads."""
    grammar = recognizer.grammar
    values = OperandRules(recognizer).values
    for token in unknown_tokens(sources, recognizer.lexer, grammar.by_name):
        if token.is_value and values:
            yield AddRule(grammar.rules[-1].name, token.rule)
            yield AddAlternative(values, token.name)
