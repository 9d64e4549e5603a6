"""Causes that are one, though each was found for lines that look alike.

What a shape keeps apart, an edit can show to be one thing: one that mends the lines of several
causes. It is sought anew for causes whose lines begin with the same word, and made of the edits of
two causes (`recovery.joined_edits`).
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from functools import partial

from grammar.edits import AddAlternative, Edit
from recovery.candidates import Candidate
from recovery.cause import SHOWN, Cause, Proposal
from recovery.elements import choices, elements
from recovery.families import one_family, with_lead
from recovery.joined_edits import one_choice, one_form, reach_the_same, together
from recovery.layout import Layout
from recovery.search import Search
from recovery.trial import changed_rules

__all__ = ["joined", "sought_together"]

# Causes that a later one is compared with: the first ones hold back most.
_MOST_JOINED = 40
# Proposals of a cause, the best of them, that may be one with what is best for another.
_COMPARED = 3
# Symbols of an alternative that make it a form of its own, whatever word it begins with.
_A_FORM = 4


def sought_together(search: Search, causes: Sequence[Cause]) -> list[Cause]:
    """Causes whose lines are led by the same word made one where one edit mends them.

    Each was sought for its own lines alone: what reads all of them may never have been tried.
    """
    led: dict[str, list[Cause]] = defaultdict(list)
    for cause in causes[:_MOST_JOINED]:
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
        for place, other in enumerate(out[:_MOST_JOINED] if cause.proposals else ()):
            one = _as_one(search, other, cause) if other.proposals else None
            if one is not None:
                out[place] = one
                break
        else:
            out.append(cause)
    return out


def _as_one(search: Search, first: Cause, second: Cause) -> Cause | None:
    """The two as one cause, where one edit mends what the best edits of both mend."""
    best = first.proposals[0], second.proposals[0]
    mended = best[0].mended | best[1].mended
    negatives = best[0].accepts_negatives + best[1].accepts_negatives
    lines = tuple(sorted({*first.lines, *second.lines}))
    seen: set[tuple[Edit, ...]] = set()
    by_lead = [*_led_by(search, first, second), *_led_by(search, second, first)]
    for one, other in _pairs(first, second):
        for edits, breadth in (
            *by_lead,
            *_for_both(search.finder.layout, one, other, are_best=(one, other) == best),
        ):
            if edits in seen:
                continue
            seen.add(edits)
            both = search.proposal(edits, breadth)
            if both.mended >= mended and both.accepts_negatives <= negatives:
                others = (p for p in first.proposals if p.edits != both.edits)
                return Cause(lines, (both, *others)[:SHOWN])
    return None


def _led_by(search: Search, known: Cause, other: Cause) -> Iterator[tuple[tuple[Edit, ...], int]]:
    """What mends one cause, with the word that the lines of another begin with as good as its own.

    Looked at are the proposals that mend all that the best one does.
    """
    leads = {search.lead(search.lines[n]) for n in other.lines}
    for proposal in known.proposals if len(leads) == 1 else ():
        if proposal.mended >= known.proposals[0].mended:
            edits = with_lead(search.finder.layout, proposal.edits, *leads)
            if edits is not None:
                yield edits, proposal.breadth + 1


def _pairs(first: Cause, second: Cause) -> Iterator[tuple[Proposal, Proposal]]:
    """Proposals of both, the better ones first: one of them is always the best of its cause."""
    pairs = [(one, second.proposals[0]) for one in first.proposals[:_COMPARED]]
    pairs += [(first.proposals[0], other) for other in second.proposals[1:_COMPARED]]
    place = {p.edits: n for cause in (first, second) for n, p in enumerate(cause.proposals)}
    yield from sorted(pairs, key=lambda pair: place[pair[0].edits] + place[pair[1].edits])


def _for_both(
    layout: Layout, one: Proposal, other: Proposal, *, are_best: bool
) -> Iterator[tuple[tuple[Edit, ...], int]]:
    """Edits that might do what two proposals do.

    That two words may be of one set counts only where that is the best for each of them.
    """
    breadth = max(one.breadth, other.breadth)
    if changed_rules(one.edits) == changed_rules(other.edits):
        yield other.edits, other.breadth
    pair = [Candidate(p.edits, p.breadth) for p in (one, other)]
    for choice in one_choice(pair, partial(_may_be_chosen, layout, are_best)):
        yield choice.edits, choice.breadth
    for form in (one_form, one_family):
        edits = form(layout, one.edits, other.edits)
        if edits is not None:
            yield edits, breadth + 1
    if reach_the_same(layout, one.edits, other.edits):
        yield together(other.edits, one.edits), breadth + 1  # the main one last


def _may_be_chosen(layout: Layout, are_best: bool, edit: Edit, place: int) -> bool:
    """Whether words there are a choice.

    Those that begin alternatives name constructs; rules that are to be gathered are one lost use.
    """
    if not isinstance(edit, AddAlternative) or place > 0:
        return True
    gathered = [e for e in elements(edit.text) if e != layout.line_end]
    if len(gathered) == 1 and all(c in layout.callers for c in choices(gathered[0])):
        return True
    is_form = len(edit.text.split(" ")) >= _A_FORM
    return is_form or (are_best and layout.vocabulary.is_set_of_words(edit.rule))
