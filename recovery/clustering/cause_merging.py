"""Causes that are one, though each was found for lines that look alike.

What a shape keeps apart, an edit can show to be one thing: one that mends the lines of several
causes. It is sought anew for causes whose lines begin with the same word, and made of the edits of
two causes (`recovery.clustering.edit_merging`).
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from functools import partial

from grammar.notation.edits import AddAlternative, Edit
from recovery.clustering.cause import Cause, Proposal
from recovery.clustering.edit_merging import one_choice, one_form, reach_the_same, together
from recovery.clustering.edit_trial import changed_rules
from recovery.clustering.search import Search
from recovery.proposals.candidates import Candidate
from recovery.proposals.grammar_profile import Layout
from recovery.tuning import FORM_SYMBOLS, MOST_COMPARED, MOST_PROPOSALS

__all__ = ["joined", "sought_together"]


def sought_together(search: Search, causes: Sequence[Cause]) -> list[Cause]:
    """Causes whose lines are led by the same word made one where one edit mends them.

    Each was sought for its own lines alone: what reads all of them may never have been tried.
    """
    led: dict[str, list[Cause]] = defaultdict(list)
    for cause in causes[:MOST_COMPARED]:
        leads = {search.lead(search.lines[n]) for n in cause.lines} if cause.proposals else set()
        if len(leads) == 1:
            led[leads.pop()].append(cause)
    out = list(causes)
    for word, several in sorted(led.items()):
        if word and len(several) > 1:
            one, parts = _found_for_all(search, several)
            if one is not None:
                place = out.index(parts[0])
                out = [cause for cause in out if cause not in parts]
                out.insert(place, one)
    return out


def _found_for_all(search: Search, causes: Sequence[Cause]) -> tuple[Cause | None, list[Cause]]:
    """A cause in place of several of the causes, and which; nothing where there is none."""
    lines = sorted(n for cause in causes for n in cause.lines)
    found = search.best_afresh(lines)
    if found is None:
        return None, []
    best = found.proposals[0]
    parts = [
        cause
        for cause in causes
        if best.mended.issuperset(cause.proposals[0].mended.intersection(cause.lines))
    ]
    negatives = sum(cause.proposals[0].accepts_negatives for cause in parts)
    if len(parts) < 2 or best.accepts_negatives > negatives:
        return None, []
    best = search.proposal(best.edits, best.breadth)
    members = tuple(sorted(n for cause in parts for n in cause.lines))
    return Cause(members, (best, *found.proposals[1:])), parts


def joined(search: Search, causes: Sequence[Cause]) -> list[Cause]:
    """Causes of which one is missing in several places made one."""
    out: list[Cause] = []
    for cause in causes:
        for place, other in enumerate(out[:MOST_COMPARED] if cause.proposals else ()):
            one = _as_one(search, other, cause) if other.proposals else None
            if one is not None:
                out[place] = one
                break
        else:
            out.append(cause)
    return out


def _as_one(search: Search, first: Cause, second: Cause) -> Cause | None:
    """The two as one cause, where one edit mends what the best edits of both mend."""
    one, other = first.proposals[0], second.proposals[0]
    negatives = one.accepts_negatives + other.accepts_negatives
    lines = tuple(sorted({*first.lines, *second.lines}))
    for edits, breadth in _for_both(search.finder.layout, one, other):
        both = search.proposal(edits, breadth)
        if both.mended >= one.mended | other.mended and both.accepts_negatives <= negatives:
            others = (p for p in first.proposals if p.edits != both.edits)
            return Cause(lines, (both, *others)[:MOST_PROPOSALS])
    return None


def _for_both(
    layout: Layout, one: Proposal, other: Proposal
) -> Iterator[tuple[tuple[Edit, ...], int]]:
    """Edits that might do what two proposals do."""
    if changed_rules(one.edits) == changed_rules(other.edits):
        yield other.edits, other.breadth
    pair = [Candidate(p.edits, p.breadth) for p in (one, other)]
    for choice in one_choice(pair, partial(_may_be_chosen, layout)):
        yield choice.edits, choice.breadth
    form = one_form(layout, one.edits, other.edits)
    if form is not None:
        yield form, max(one.breadth, other.breadth) + 1
    if reach_the_same(layout, one.edits, other.edits):
        yield together(one.edits, other.edits), max(one.breadth, other.breadth) + 1


def _may_be_chosen(layout: Layout, edit: Edit, place: int) -> bool:
    """Whether words there are a choice: those that begin alternatives name constructs."""
    if not isinstance(edit, AddAlternative) or place > 0:
        return True
    is_form = len(edit.text.split(" ")) >= FORM_SYMBOLS
    return is_form or layout.vocabulary.is_set_of_words(edit.rule)
