"""Causes: failing lines grouped by the edit that mends them.

Two failures have one cause when the same edit mends both. Signatures give a first grouping; then,
heaviest group first, the best edit is sought for its lines (`recovery.clustering.search`). It takes
every line it mends, whatever its signature; lines of the group that it does not mend are searched
again.

At the end causes are merged that one edit answers: one that is searched anew for causes whose lines
begin with the same word, or made of the edits of two (`recovery.clustering.edit_merging`); and
those whose lines fail for the same reason (`recovery.clustering.reason`).
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence
from functools import partial

from grammar.notation.edits import AddAlternative, Edit
from grammar.parser.recognizer import Recognizer
from recovery.clustering.cause import Cause, NegativeCounter, Proposal
from recovery.clustering.edit_merging import (
    are_one_change,
    combined_edits,
    merged_as_choice,
    merged_as_form,
)
from recovery.clustering.edit_trial import changed_rules
from recovery.clustering.file_trial import FileTrial
from recovery.clustering.reason import Reason
from recovery.clustering.regression import ParsedFiles, no_parsed_files
from recovery.clustering.search import CauseSearch
from recovery.proposals.candidates import Candidate
from recovery.proposals.edit_site import LinePattern
from recovery.proposals.grammar_profile import GrammarProfile
from recovery.tuning import (
    BREADTH_FACTOR,
    CAUSES_PER_GROUP,
    FORM_SYMBOLS,
    HEAVY_GROUPS,
    MOST_COMPARED,
    MOST_PROPOSALS,
)
from support.gc_pause import gc_paused
from support.parallel.progress import Progress, no_progress


def find_causes(
    recognizer: Recognizer,
    lines: Sequence[LinePattern],
    weights: Sequence[int],
    groups: Sequence[Sequence[int]],
    count_negatives: NegativeCounter,
    on_done: Progress = no_progress,
    file_trial: FileTrial | None = None,
    parsed_files: ParsedFiles = no_parsed_files,
    reasons: Sequence[Reason] = (),
) -> list[Cause]:
    """Group ``lines`` by cause.

    ``weights[i]`` is what line ``i`` holds back, ``reasons[i]`` why it fails; ``groups`` partition
    the indices of the lines, the heaviest first. ``on_done`` gets each group dealt with.
    ``file_trial`` has the files in which the lines fail, ``parsed_files`` those that can be read.
    """
    search = CauseSearch(recognizer, lines, weights, count_negatives, file_trial, parsed_files)
    causes: list[Cause] = []
    with gc_paused():
        for place, group in enumerate(groups):
            search.is_thorough = place < HEAVY_GROUPS
            causes += _of_group(search, group)
            on_done(1)
        causes = merged_by_first_word(search, causes)
    return merged_by_reason(search, merged_by_edits(search, causes), reasons)


def _of_group(search: CauseSearch, group: Sequence[int]) -> Iterator[Cause]:
    """The causes of a group, one after the other; lines without any are one of their own."""
    left = [n for n in group if n in search.open]
    for _ in range(CAUSES_PER_GROUP):
        cause = search.best_for(left) if left else None
        if cause is None:
            break
        cause = search.with_entailed(cause)
        yield cause
        search.open.difference_update(cause.lines)
        left = [n for n in left if n in search.open]
    left += [n for n in group if search.lines[n].is_enormous]
    if left:
        search.open.difference_update(left)
        yield Cause(tuple(left), ())


# ------------------------------------------------------------------------------------- merging


def merged_by_first_word(search: CauseSearch, causes: Sequence[Cause]) -> list[Cause]:
    """The causes, those whose lines begin with the same word merged where one edit mends them.

    Each was searched for its own lines alone: what reads all of them may never have been tried.
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


def _found_for_all(
    search: CauseSearch, causes: Sequence[Cause]
) -> tuple[Cause | None, list[Cause]]:
    """A cause in place of several of the causes, and which; nothing where there is none."""
    lines = sorted(n for cause in causes for n in cause.lines)
    found = search.best_from_scratch(lines)
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


def merged_by_reason(
    search: CauseSearch, causes: Sequence[Cause], reasons: Sequence[Reason]
) -> list[Cause]:
    """The causes, those merged most of whose lines fail for the same reason.

    The proposals of one are in the order of what they mend of all of its lines.
    """
    alike: dict[Reason | int, list[Cause]] = defaultdict(list)
    for place, cause in enumerate(causes):
        count: Counter[Reason] = Counter()
        for n in cause.lines if reasons else ():
            count[reasons[n]] += search.weights[n]
        alike[max(count, key=lambda r: (count[r], r), default=place)].append(cause)
    return [_united(search, several) for several in alike.values()]


def _united(search: CauseSearch, causes: Sequence[Cause]) -> Cause:
    if len(causes) == 1:
        return causes[0]
    lines = frozenset(n for cause in causes for n in cause.lines)

    def worth(proposal: Proposal) -> float:
        mended = sum(search.weights[n] for n in proposal.mended & lines)
        return mended * BREADTH_FACTOR**proposal.breadth

    found = dict.fromkeys(p for cause in causes for p in cause.proposals)
    best = sorted(found, key=lambda p: (p.accepts_negatives, -worth(p)))
    return Cause(tuple(sorted(lines)), tuple(best[:MOST_PROPOSALS]))


def merged_by_edits(search: CauseSearch, causes: Sequence[Cause]) -> list[Cause]:
    """The causes, those merged that lack the same in several places."""
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


def _as_one(search: CauseSearch, first: Cause, second: Cause) -> Cause | None:
    """The two as one cause, where one edit mends what the best edits of both mend."""
    one, other = first.proposals[0], second.proposals[0]
    negatives = one.accepts_negatives + other.accepts_negatives
    lines = tuple(sorted({*first.lines, *second.lines}))
    for edits, breadth in _for_both(search.finder.profile, one, other):
        both = search.proposal(edits, breadth)
        if both.mended >= one.mended | other.mended and both.accepts_negatives <= negatives:
            others = (p for p in first.proposals if p.edits != both.edits)
            return Cause(lines, (both, *others)[:MOST_PROPOSALS])
    return None


def _for_both(
    profile: GrammarProfile, one: Proposal, other: Proposal
) -> Iterator[tuple[tuple[Edit, ...], int]]:
    """Edits that might do what two proposals do."""
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
    """Whether words there may be a choice: those that begin alternatives name constructs."""
    if not isinstance(edit, AddAlternative) or place > 0:
        return True
    is_form = len(edit.text.split(" ")) >= FORM_SYMBOLS
    return is_form or profile.vocabulary.is_set_of_words(edit.rule)
