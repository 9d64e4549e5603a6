"""Joining causes: which of them are one, and with which proposals.

Causes are one if one edit made from the edits of both repairs the lines of both
(`recovery.clustering.edit_merging`). Causes whose lines fail for the same reason
(`recovery.clustering.reason`) are one as well.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable, Collection, Iterator, Sequence
from functools import partial

from grammar.notation.edits import AddAlternative, AddToken, Edit
from recovery import tuning
from recovery.clustering.cause import Cause, Proposal
from recovery.clustering.completion import added_alternatives
from recovery.clustering.edit_merging import (
    are_one_change,
    combined_edits,
    merged_as_choice,
    merged_as_form,
)
from recovery.clustering.edit_trial import changed_rules
from recovery.clustering.reason import Reason
from recovery.clustering.search import CauseSearch
from recovery.proposals.candidates import Candidate
from recovery.proposals.grammar_profile import GrammarProfile


def joined(search: CauseSearch, causes: Sequence[Cause], reasons: Sequence[Reason]) -> list[Cause]:
    """Return the causes, those that are one as one; ``reasons[i]`` is why line ``i`` fails."""
    return joined_by_reason(search, joined_by_edits(search, causes), reasons)


def joined_by_edits(search: CauseSearch, causes: Sequence[Cause]) -> list[Cause]:
    """Return the causes; those whose edits are one change in several places are one."""
    out: list[Cause] = []
    for cause in causes:
        for place, other in enumerate(out[: tuning.MOST_COMPARED] if cause.proposals else ()):
            one = _as_one(search, other, cause) if other.proposals else None
            if one is not None:
                out[place] = one
                break
        else:
            out.append(cause)
    return out


def _as_one(search: CauseSearch, first: Cause, second: Cause) -> Cause | None:
    """Return both causes as one if one edit repairs what their best edits repair, else ``None``."""
    one, other = first.proposals[0], second.proposals[0]
    negatives = one.accepts_negatives + other.accepts_negatives
    mended = one.mended | other.mended
    if not one.mended or not other.mended:
        return None  # any edit of the same rule would do as much
    lines = tuple(sorted({*first.lines, *second.lines}))
    for edits, breadth in _for_both(search.finder.profile, one, other):
        if search.trial.result(edits, mended).mended < mended:
            continue  # most edits fail here; to try them on all lines costs far more
        both = search.proposal(edits, breadth)
        if both.accepts_negatives <= negatives:
            others = (p for p in first.proposals if p.edits != both.edits)
            return Cause(lines, (both, *others)[: tuning.MOST_PROPOSALS])
    return None


def _for_both(
    profile: GrammarProfile, one: Proposal, other: Proposal
) -> Iterator[tuple[tuple[Edit, ...], int]]:
    """Yield edits, with their breadth, that may do what two proposals do together."""
    if changed_rules(one.edits) == changed_rules(other.edits):
        yield other.edits, other.breadth
    pair = [Candidate(p.edits, p.breadth) for p in (one, other)]
    for choice in merged_as_choice(pair, partial(_may_be_chosen, profile)):
        yield choice.edits, choice.breadth
    form = merged_as_form(profile, one.edits, other.edits)
    if form is not None:
        yield form, max(one.breadth, other.breadth) + 1
    if are_one_change(profile, one.edits, other.edits):
        yield combined_edits(one.edits, other.edits), max(one.breadth, other.breadth) + 1


def _may_be_chosen(profile: GrammarProfile, edit: Edit, place: int) -> bool:
    """Return whether words at a place may become a choice.

    A word that begins an alternative names a construct, so it may not.
    """
    if not isinstance(edit, AddAlternative) or place > 0:
        return True
    is_form = len(edit.text.split(" ")) >= tuning.FORM_SYMBOLS
    return is_form or profile.vocabulary.is_set_of_words(edit.rule)


def joined_by_reason(
    search: CauseSearch, causes: Sequence[Cause], reasons: Sequence[Reason]
) -> list[Cause]:
    """Return the causes; those most of whose lines fail for the same reason are one.

    After that, causes are one that need the same words, or for which the same rule gets
    alternatives that nothing calls.
    """

    def reason_of(cause: Cause) -> Reason | None:
        count: Counter[Reason] = Counter()
        for n in cause.lines if reasons else ():
            count[reasons[n]] += search.weights[n]
        return max(count, key=lambda reason: (count[reason], reason), default=None)

    def lack_of(cause: Cause) -> str | frozenset[str]:
        return _gathering(search, cause) or _words_lacked(search, cause, reason_of(cause))

    return _joined(search, _joined(search, causes, reason_of), lack_of)


def _joined(
    search: CauseSearch, causes: Sequence[Cause], key: Callable[[Cause], Collection[str] | None]
) -> list[Cause]:
    """Return the causes; those with the same key are one, unless it is empty."""
    alike: dict[object, list[Cause]] = defaultdict(list)
    for place, cause in enumerate(causes):
        alike[key(cause) or place].append(cause)
    return [_united(search, several) for several in alike.values()]


def _words_lacked(search: CauseSearch, cause: Cause, reason: Reason | None) -> frozenset[str]:
    """Return the words that a cause needs and most of its lines have.

    Returns none if its lines fail at another new word.
    """
    words = frozenset(
        edit.name
        for best in cause.proposals[:1]
        for edit in best.edits
        if isinstance(edit, AddToken)
    )
    if reason and reason[0] == "word" and reason[1] not in words:
        return frozenset()
    having = sum(
        search.weights[n]
        for n in cause.lines
        if any(word in words for _, word in search.lines[n].keywords)
    )
    return words if 2 * having > sum(search.weights[n] for n in cause.lines) else frozenset()


def _gathering(search: CauseSearch, cause: Cause) -> str:
    """Return the rule that gets rules which nothing calls: what had gathered them is missing."""
    unused_in = search.finder.profile.unused_in
    added = (edit for best in cause.proposals[:1] for edit in added_alternatives(best))
    return next((edit.rule for edit in added if unused_in(edit.text)), "")


def _united(search: CauseSearch, causes: Sequence[Cause]) -> Cause:
    """Return the causes as one, with all their proposals and those that are found for all lines."""
    if len(causes) == 1:
        return causes[0]
    lines = frozenset(n for cause in causes for n in cause.lines)
    found: dict[tuple[Edit, ...], Proposal] = {}
    for p in (p for cause in causes for p in cause.proposals):
        found.setdefault(p.edits, p)  # an earlier cause was sought among more lines
    again = search.best_for(sorted(lines), lines)
    for p in again.proposals if again else ():
        found.setdefault(p.edits, search.proposal(p.edits, p.breadth))
    return Cause(tuple(sorted(lines)), tuple(search.ranked(list(found.values()), lines)))
