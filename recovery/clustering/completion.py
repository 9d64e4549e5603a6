"""Completion of a proposal: what its lines still need where it changes the grammar.

An edit is found by a few lines of a cause. Other lines of it have more parts, another word, or
another form. So the search goes on under the grammar that the proposal gives, with the lines that
it leaves: there a line fails inside the text that was added. What is found becomes part of that
text.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace
from functools import partial
from itertools import islice, product

from grammar.notation.edits import (
    AddAlternative,
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

    for _ in range(tuning.MOST_COMPLETIONS):
        for more in _further(search, proposal, wanted, rules):
            is_safe = more.accepts_negatives <= proposal.accepts_negatives
            is_more = more.mended & wanted > proposal.mended & wanted
            if is_safe and is_more and share(more) >= share(proposal):
                proposal = more
                break
        else:
            break
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
