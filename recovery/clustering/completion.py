"""Completion of a proposal: what the lines that it leaves still need.

An edit is found by a few lines of a cause. Other lines of it have more parts, another word, or
another form. So the search goes on under the grammar that the proposal gives, with the lines that
it leaves: there a line fails inside the text that was added. What is found becomes part of that
text (`completed`).

Or the same is missing in further rules: ``GLOBAL`` may come before a routine, an interrupt and a
declaration. Then the same phrase is sought there, under the grammar itself, which takes less time
(`with_more_places`).
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import replace
from functools import partial
from itertools import islice, product

from grammar.notation.addresses import element_at
from grammar.notation.edits import (
    AddAlternative,
    AddToken,
    Edit,
    EditOfRule,
    Insert,
    MakeOptional,
    Widen,
    apply_to_rule,
)
from grammar.notation.g4 import read_rule
from grammar.notation.model import Grammar
from grammar.parser.failures import Form
from grammar.parser.network import network_of
from grammar.parser.recognizer import Recognizer
from recovery import tuning
from recovery.clustering.cause import Cause, Proposal
from recovery.clustering.edit_merging import combined_edits, merged_as_choice
from recovery.clustering.edit_trial import changed_rules
from recovery.clustering.negative_score import no_negatives
from recovery.clustering.search import LIGHT, CauseSearch
from recovery.proposals.candidates import Candidate
from recovery.proposals.edit_site import LinePattern


def completed(search: CauseSearch, cause: Cause) -> Cause:
    """Return the cause with its best proposals completed, in all rules that any of them changes.

    Of those that change the same rules it is the first. One that does not come to repair nearly all
    lines stays as it is: these fail for more than one cause, and more edits would mix them.
    """
    starts: dict[frozenset[str], Proposal] = {}
    for proposal in cause.proposals:
        starts.setdefault(changed_rules(proposal.edits), proposal)
    rules = frozenset[str]().union(*starts)
    whole = {}
    for proposal in islice(starts.values(), tuning.MOST_COMPLETED):
        if _share(search, proposal, cause.lines) >= tuning.LEAST_COMPLETED:
            more = _with_more(search, proposal, cause.lines, rules)
            if _share(search, more, cause.lines) >= tuning.NEARLY_ALL:
                whole[proposal] = more
    found = list(dict.fromkeys(whole.get(proposal, proposal) for proposal in cause.proposals))
    if found != list(cause.proposals):
        found = search.ranked(found, cause.lines)
    return replace(cause, proposals=tuple(found))


def _share(search: CauseSearch, proposal: Proposal, lines: Sequence[int]) -> float:
    """Return the share of the lines that a proposal repairs, weighed."""
    mended = sum(search.weights[n] for n in proposal.mended.intersection(lines))
    return mended / sum(search.weights[n] for n in lines)


def added_alternatives(proposal: Proposal) -> list[AddAlternative]:
    """Return the edits of a proposal that add alternatives."""
    return [edit for edit in proposal.edits if isinstance(edit, AddAlternative)]


def _with_more(
    search: CauseSearch, proposal: Proposal, lines: Collection[int], rules: frozenset[str]
) -> Proposal:
    """Return the proposal with what some of the lines still need in these rules.

    No words are reserved, and no more negatives accepted, than with the proposal itself.
    """
    wanted = frozenset(lines)
    some = sorted(wanted)

    def share(proposal: Proposal) -> float:
        return search.order.readable_share(proposal.edits, some)

    def better(before: Proposal) -> Iterator[Proposal]:
        for more in _further(search, before, wanted, rules):
            is_safe = more.accepts_negatives <= before.accepts_negatives
            is_more = more.mended & wanted > before.mended & wanted
            if is_safe and is_more and share(more) >= share(before):
                yield more

    return _grown(proposal, better, tuning.MOST_COMPLETIONS)


def _grown(
    proposal: Proposal, better: Callable[[Proposal], Iterator[Proposal]], most: int
) -> Proposal:
    """Return the first ``better`` proposal, the first better one than that, ``most`` times."""
    for _ in range(most):
        found = next(better(proposal), None)
        if found is None:
            break
        proposal = found
    return proposal


def _further(
    search: CauseSearch, proposal: Proposal, wanted: frozenset[int], rules: frozenset[str]
) -> Iterator[Proposal]:
    """Yield the proposal with more for the lines that it leaves, first in the rules it changes."""
    grammar = search.trial.recognizer.grammar
    left = sorted(wanted - proposal.mended)
    wider = search.trial.wider(proposal.edits) if left else None
    if wider is None:
        return
    # in the networks of trials the places of edited rules are not known
    wider = Recognizer(wider.grammar, network_of(wider.grammar, wider.lexer))
    numbers, patterns = [], []
    for number, start, kinds in search.trial.read_by(wider, proposal.edits, left):
        failed = wider.run(start, kinds)[1]
        if failed is not None:
            line = search.lines[number]
            meant = tuple((i, word) for i, word in line.keywords if kinds[i] == line.form.kinds[i])
            patterns.append(LinePattern(Form(wider.frames(start), tuple(kinds), failed), meant))
            numbers.append(number)
    inner = CauseSearch(wider, patterns, [search.weights[n] for n in numbers], no_negatives)
    groups: dict[object, list[int]] = defaultdict(list)
    for number, line in enumerate(patterns):
        groups[search.lead(line), line.words()[line.form.index]].append(number)
    heaviest = sorted(groups.values(), key=lambda g: (-sum(inner.weights[n] for n in g), g))
    own = changed_rules(proposal.edits)
    for some, group in product((own, rules), heaviest[: tuning.MOST_GROUPS_COMPLETED]):
        cause = inner.best_for(group, inner.ordinary, LIGHT, partial(_are_of, some))
        for further in cause.proposals if cause else ():
            edits = continued(grammar, proposal.edits, further.edits)
            if edits is not None:
                yield search.proposal(edits, max(proposal.breadth, further.breadth) + 1)


def _are_of(rules: frozenset[str], edits: Sequence[Edit]) -> bool:
    """Return whether edits change only these rules, and reserve no word."""
    return rules.issuperset(getattr(edit, "rule", "") for edit in edits)


# ------------------------------------------------------------------------------- more places


def with_more_places(search: CauseSearch, cause: Cause) -> Cause:
    """Return the cause with its best proposals made in all places where its lines need them."""
    first = {proposal.edits: proposal for proposal in cause.proposals[: tuning.MOST_EXTENDED]}
    more = [_in_more_places(search, proposal, cause.lines) for proposal in first.values()]
    if [proposal.edits for proposal in more] == list(first):
        return cause
    others = cause.proposals[len(more) :]
    return replace(cause, proposals=tuple(search.ranked([*more, *others], cause.lines)))


def _in_more_places(search: CauseSearch, proposal: Proposal, lines: Sequence[int]) -> Proposal:
    wanted = {phrase for edit in proposal.edits if (phrase := _phrase(search, edit))}
    words = {edit for edit in proposal.edits if isinstance(edit, AddToken)}
    weight = sum(search.weights[n] for n in lines)

    def is_the_same(edits: Sequence[Edit]) -> bool:
        return _phrase(search, edits[-1]) in wanted and words.issuperset(
            edit for edit in edits if isinstance(edit, AddToken)
        )

    def better(before: Proposal) -> Iterator[Proposal]:
        left = [n for n in lines if n not in before.mended and n not in before.advanced]
        if sum(search.weights[n] for n in left) < tuning.LEAST_LEFT * weight:
            return
        found = search.best_for(left, left, LIGHT, is_the_same)
        for other in found.proposals if found else ():
            edits = combined_edits(other.edits, before.edits)
            both = search.proposal(edits, max(before.breadth, other.breadth) + 1)
            is_safe = both.accepts_negatives <= before.accepts_negatives
            if is_safe and (both.mended | both.advanced).intersection(left):
                yield both

    return _grown(proposal, better, tuning.MOST_PLACES)


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


# ------------------------------------------------------------------------------- edits as one


def continued(
    grammar: Grammar, first: Sequence[Edit], second: Sequence[Edit]
) -> tuple[Edit, ...] | None:
    """Return ``first`` and ``second``, edits of the grammar that it gives, as edits of ``grammar``.

    What changes a text that ``first`` adds changes it wherever ``first`` adds it. The last edit
    remains the last one. Returns ``None`` for what cannot be written so.
    """
    edits: list[Edit] | None = list(first)
    for edit in second:
        if edits is None or edit in edits:
            continue
        if isinstance(edit, Insert | Widen | MakeOptional):
            edits = _with_edit(grammar, edits, edit)
        else:
            edits.insert(0, edit)
    return None if edits is None else combined_edits(edits, ())


def _with_edit(
    grammar: Grammar, edits: list[Edit], edit: Insert | Widen | MakeOptional
) -> list[Edit] | None:
    """Return edits with one of the grammar that they give; see `continued`."""
    own = [e for e in edits if getattr(e, "rule", "") == edit.rule]
    beyond = edit.at[0] - len(grammar.by_name[edit.rule].alternatives)
    if beyond > 0:
        host = [e for e in own if isinstance(e, AddAlternative)][beyond - 1]
        changed = _changed(host.text, replace(edit, at=(1, *edit.at[1:])))
        return _rewritten(edits, host.text, changed)
    if not own:
        return [edit, *edits]
    inserted = own[0]
    if len(own) > 1 or not isinstance(inserted, Insert):
        return None
    *above, place = inserted.at
    depth = len(inserted.at)
    if edit.at[:depth] == inserted.at != edit.at:
        inside = replace(edit, at=(1, 1, *edit.at[depth:]))
        return _rewritten(edits, inserted.text, _changed(inserted.text, inside))
    if list(edit.at[: depth - 1]) == above and edit.at[depth - 1] > place:
        edit = replace(edit, at=(*above, edit.at[depth - 1] - 1, *edit.at[depth:]))
    if edit.at != inserted.at or not isinstance(edit, Insert):
        return [edit, *edits]
    for choice in merged_as_choice([Candidate((inserted,), 0), Candidate((edit,), 0)]):
        return _rewritten(edits, inserted.text, getattr(choice.edits[-1], "text", ""))
    return None


def _changed(text: str, edit: EditOfRule) -> str:
    """Return a text after an edit of the rule that it makes up."""
    changed = apply_to_rule(read_rule(f"{edit.rule} : {text} ;"), edit)
    return changed.in_line(changed.alternatives[0])


def _rewritten(edits: Sequence[Edit], old: str, new: str) -> list[Edit]:
    """Return the edits with another text instead of one that they add."""
    return [
        replace(e, text=new)
        if isinstance(e, Insert | Widen | AddAlternative) and e.text == old
        else e
        for e in edits
    ]
