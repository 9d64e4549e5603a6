"""Finding causes: failing lines are grouped by the edit that repairs them.

Two failures have one cause if the same edit repairs both. Signatures give a first grouping. Then,
for each group, heaviest first, the best edit for its lines is sought
(`recovery.clustering.search`). It takes every line it repairs, whatever its signature; lines of the
group that it does not repair are searched again.

At the end, causes are merged if one edit repairs the lines of both: an edit sought anew for causes
whose lines begin with the same word, or one made from the edits of two causes
(`recovery.clustering.edit_merging`). Causes whose lines fail for the same reason
(`recovery.clustering.reason`) are merged as well. Where few causes are left, their best proposals
are completed (`recovery.clustering.completion`), else made in further places
(`recovery.clustering.more_places`).
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial

from grammar.notation.edits import AddAlternative, AddToken, Edit
from grammar.parser.recognizer import Recognizer
from recovery import tuning
from recovery.clustering.cause import Cause, Proposal
from recovery.clustering.completion import added_alternatives, completed
from recovery.clustering.edit_merging import (
    are_one_change,
    combined_edits,
    merged_as_choice,
    merged_as_form,
)
from recovery.clustering.edit_trial import changed_rules
from recovery.clustering.file_trial import FileTrial
from recovery.clustering.more_places import with_more_places
from recovery.clustering.negative_score import NegativeCounter
from recovery.clustering.reason import Reason
from recovery.clustering.regression import ParsedFiles, no_parsed_files
from recovery.clustering.search import CauseSearch
from recovery.proposals.candidates import Candidate
from recovery.proposals.edit_site import LinePattern
from recovery.proposals.grammar_profile import GrammarProfile
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
    """Return the causes of ``lines``.

    ``weights[i]`` is the number of files with line ``i``, ``reasons[i]`` why it fails. ``groups``
    partition the indices of the lines, the heaviest group first. ``on_done`` is called after each
    group. ``file_trial`` has the files in which the lines fail, ``parsed_files`` those that parse.
    """
    search = CauseSearch(recognizer, lines, weights, count_negatives, file_trial, parsed_files)
    causes: list[Cause] = []
    with gc_paused(tuning.MANY_OBJECTS):
        for place, group in enumerate(groups):
            search.is_thorough = place < tuning.HEAVY_GROUPS
            causes += _of_group(search, group)
            on_done(1)
        causes = merged_by_first_word(search, causes)
        causes = merged_by_reason(search, merged_by_edits(search, causes), reasons)
        more = completed if len(causes) <= tuning.MOST_CAUSES_COMPLETED else with_more_places
        causes = [more(search, cause) for cause in causes]
    return [replace(cause, proposals=cause.proposals[: tuning.MOST_PROPOSALS]) for cause in causes]


def _of_group(search: CauseSearch, group: Sequence[int]) -> Iterator[Cause]:
    """Yield the causes of a group; lines for which no edit is found form a cause of their own."""
    left = [n for n in group if n in search.open]
    for _ in range(tuning.CAUSES_PER_GROUP):
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
    """Return the causes; those whose lines begin with the same word are merged if one edit fits.

    Each cause was sought for its own lines alone, so an edit for all of them may never have been
    tried.
    """
    led: dict[str, list[Cause]] = defaultdict(list)
    for cause in causes[: tuning.MOST_COMPARED]:
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
    """Return a cause that replaces several of the causes, and these; ``None`` if there is none."""
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
    """Return the causes; those most of whose lines fail for the same reason are merged.

    After that, causes are merged that need the same words, or for which the same rule gets
    alternatives that nothing calls. The proposals of a merged cause are sorted by what they repair
    of all its lines.
    """
    alike: dict[Reason | int, list[Cause]] = defaultdict(list)
    for place, cause in enumerate(causes):
        count: Counter[Reason] = Counter()
        for n in cause.lines if reasons else ():
            count[reasons[n]] += search.weights[n]
        alike[max(count, key=lambda r: (count[r], r), default=place)].append(cause)
    united = [_united(search, several) for several in alike.values()]
    missing: dict[str | frozenset[str] | int, list[Cause]] = defaultdict(list)
    for place, (reason, cause) in enumerate(zip(alike, united, strict=True)):
        missing[_gathers_again(search, cause) or _words_for(search, reason, cause) or place].append(
            cause
        )
    return [_united(search, several) for several in missing.values()]


def _words_for(search: CauseSearch, reason: Reason | int, cause: Cause) -> frozenset[str]:
    """Return the words that a cause needs and most of its lines have.

    Returns none if its lines fail at another new word.
    """
    words = frozenset[str]().union(*map(_words, cause.proposals[:1]))
    if isinstance(reason, tuple) and reason[0] == "word" and reason[1] not in words:
        return frozenset()
    having = sum(
        search.weights[n]
        for n in cause.lines
        if any(word in words for _, word in search.lines[n].keywords)
    )
    return words if 2 * having > sum(search.weights[n] for n in cause.lines) else frozenset()


def _gathers_again(search: CauseSearch, cause: Cause) -> str:
    """Return the rule that gets rules which nothing calls: what had gathered them is missing."""
    unused_in = search.finder.profile.unused_in
    added = (edit for best in cause.proposals[:1] for edit in added_alternatives(best))
    return next((edit.rule for edit in added if unused_in(edit.text)), "")


def _united(search: CauseSearch, causes: Sequence[Cause]) -> Cause:
    """Return the causes as one, with all their proposals and those that are found for all lines."""
    if len(causes) == 1:
        return causes[0]
    lines = frozenset(n for cause in causes for n in cause.lines)
    found = {p.edits: p for cause in causes for p in cause.proposals}
    again = search.best_from_scratch(sorted(lines))
    for p in again.proposals if again else ():
        found.setdefault(p.edits, search.proposal(p.edits, p.breadth))
    return Cause(tuple(sorted(lines)), tuple(search.ranked(list(found.values()), lines)))


def _words(proposal: Proposal) -> frozenset[str]:
    """Return the words that a proposal reserves."""
    return frozenset(edit.name for edit in proposal.edits if isinstance(edit, AddToken))


def merged_by_edits(search: CauseSearch, causes: Sequence[Cause]) -> list[Cause]:
    """Return the causes; those whose edits are one change in several places are merged."""
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
