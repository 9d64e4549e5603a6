"""The same edit in further rules: what is missing in one place is often missing in others.

``GLOBAL`` may come before a routine, an interrupt and a declaration. An edit found for most lines
of a cause repairs one or two of these places. For the lines that it leaves the same phrase is
sought in other rules, and what is found belongs to the edit.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from grammar.notation.addresses import element_at
from grammar.notation.edits import AddAlternative, AddToken, Edit, Insert, MakeOptional, Widen
from recovery.clustering.cause import Cause, Proposal
from recovery.clustering.edit_merging import combined_edits
from recovery.clustering.search import LIGHT, CauseSearch
from recovery.tuning import LEAST_LEFT, MOST_EXTENDED, MOST_PLACES


def with_more_places(search: CauseSearch, cause: Cause) -> Cause:
    """Return the cause with its best proposals made in all places where its lines need them."""
    first = {proposal.edits: proposal for proposal in cause.proposals[:MOST_EXTENDED]}
    more = [_extended(search, proposal, cause.lines) for proposal in first.values()]
    if [proposal.edits for proposal in more] == list(first):
        return cause
    others = cause.proposals[len(more) :]
    return replace(cause, proposals=tuple(search.ranked([*more, *others], cause.lines)))


def _extended(search: CauseSearch, proposal: Proposal, lines: Sequence[int]) -> Proposal:
    wanted = {phrase for edit in proposal.edits if (phrase := _phrase(search, edit))}
    words = {edit for edit in proposal.edits if isinstance(edit, AddToken)}

    def is_the_same(edits: Sequence[Edit]) -> bool:
        return _phrase(search, edits[-1]) in wanted and words.issuperset(
            edit for edit in edits if isinstance(edit, AddToken)
        )

    weight = sum(search.weights[n] for n in lines)
    for _ in range(MOST_PLACES):
        left = [n for n in lines if n not in proposal.mended and n not in proposal.advanced]
        if sum(search.weights[n] for n in left) < LEAST_LEFT * weight:
            break
        found = search.best_for(left, left, LIGHT, is_the_same)
        wider = None
        for other in found.proposals if found else ():
            edits = combined_edits(other.edits, proposal.edits)
            both = search.proposal(edits, max(proposal.breadth, other.breadth) + 1)
            is_safe = both.accepts_negatives <= proposal.accepts_negatives
            if is_safe and (both.mended | both.advanced).intersection(left):
                wider = both
                break
        if wider is None:
            break
        proposal = wider
    return proposal


def _phrase(search: CauseSearch, edit: Edit) -> tuple[type[Edit], str] | None:
    """Return what an edit writes or leaves out, whatever the place; ``None`` for other edits."""
    match edit:
        case Insert(text=text) | Widen(text=text):
            return type(edit), text.rstrip("?*+")
        case AddAlternative(rule=rule, text=text):
            return type(edit), text.removesuffix(" ".join(("", *search.finder.closing(rule))))
        case MakeOptional(rule=rule, at=at, count=1):
            found = search.finder.profile.grammar.by_name[rule]
            return type(edit), found.source_of(element_at(found, at))
        case _:
            return None
