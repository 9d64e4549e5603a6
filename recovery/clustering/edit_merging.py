"""Merging of edits: the same word or phrase is missing in several places.

``A == B`` and ``A < B`` fail at different signs, but the edits that repair them differ in one word
at the same place. Other examples are a phrase that is missing in two rules, and two missing
alternatives that were the only users of a rule. Such edits are found here and written as one.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Sequence
from dataclasses import replace

from grammar.notation.edits import AddAlternative, AddToken, Edit, Insert, Widen
from recovery.forms.parts import choices, parts, unwrapped
from recovery.proposals.candidates import Candidate
from recovery.proposals.grammar_profile import GrammarProfile
from recovery.tuning import MOST_MERGED_EDITS

_Writing = Insert | Widen | AddAlternative
#: Edits that differ in one word: the edit with the suffix of its text, the words on both sides.
_Family = tuple[_Writing, tuple[str, ...], tuple[str, ...]]


def combined_edits(first: Sequence[Edit], second: Sequence[Edit]) -> tuple[Edit, ...]:
    """Return the edits of both without duplicates, ordered so that none shifts another's place."""
    edits = list(dict.fromkeys((*first, *second)))
    tokens = [e for e in edits if isinstance(e, AddToken)]
    places = [e for e in edits if not isinstance(e, AddToken | AddAlternative)]
    places.sort(
        key=lambda e: (getattr(e, "rule", ""), getattr(e, "at", ()), not isinstance(e, Insert)),
        reverse=True,
    )
    return (*tokens, *places, *(e for e in edits if isinstance(e, AddAlternative)))


def _main(profile: GrammarProfile, edits: Sequence[Edit]) -> list[Edit]:
    """Return the edits without those that reserve words."""
    reserving = profile.vocabulary.reserve(e.name for e in edits if isinstance(e, AddToken))
    return [e for e in edits if e not in reserving]


def are_one_change(profile: GrammarProfile, first: Sequence[Edit], second: Sequence[Edit]) -> bool:
    """Return whether two edits are one change: the same phrase, or the users of one unused rule.

    The number of edits is limited, so that a reader sees at a glance what they have in common.
    """
    if len({*_main(profile, first), *_main(profile, second)}) > MOST_MERGED_EDITS:
        return False
    one, other = first[-1], second[-1]
    if not isinstance(one, _Writing) or not isinstance(other, _Writing):
        return False
    if one != other and one.text.rstrip("?*+") == other.text.rstrip("?*+"):
        return True
    unused = profile.unused_in(one.text), profile.unused_in(other.text)
    if one.rule == other.rule and isinstance(one, AddAlternative) and type(one) is type(other):
        # a rule that gathered others was removed, or one with several forms but no word of its own
        return all(unused) or bool(profile.operands(one.text) & profile.operands(other.text))
    return bool(unused[0] & unused[1])


def merged_as_form(
    profile: GrammarProfile, first: Sequence[Edit], second: Sequence[Edit]
) -> tuple[Edit, ...] | None:
    """Return the edits of both with one text, if the same new word begins the form in both.

    No rule may use the word yet. The two rules both get the longer form. Returns ``None`` if the
    edits are not of this kind.
    """
    one, other = first[-1], second[-1]
    if not isinstance(one, AddAlternative) or not isinstance(other, AddAlternative):
        return None
    words = {edit.text.split(" ")[0] for edit in (one, other)}
    if len(words) > 1 or one.rule == other.rule or len(_main(profile, first)) > 1:
        return None
    word = words.pop()
    if not word.isidentifier() or not word[0].isupper() or profile.vocabulary.is_written(word):
        return None
    text = max(one.text, other.text, key=lambda t: (len(t), t))
    both = (replace(one, text=text), replace(other, text=text))
    return combined_edits((*first[:-1], both[0]), (*second[:-1], both[1]))


def merged_as_choice(
    candidates: Sequence[Candidate],
    allowed: Callable[[Edit, int], bool] = lambda _edit, _place: True,
    reads: Callable[[str, str], bool] = lambda _rule, _other: False,
) -> list[Candidate]:
    """Return one candidate with a choice of words for candidates that differ in one word only.

    ``allowed`` says whether words at a place in the text of an edit may become a choice, ``reads``
    whether a rule reads all that another one reads: the other is then no choice beside it.
    """
    families: dict[_Family, dict[str, Candidate]] = defaultdict(dict)
    for candidate in candidates:
        edit = candidate.edits[-1]
        if not isinstance(edit, _Writing):
            continue
        suffix = edit.text[-1] if isinstance(edit, Insert) else ""
        words = tuple(parts(unwrapped(edit.text) if suffix else edit.text))
        for i, word in enumerate(words):
            if allowed(edit, i):
                family = replace(edit, text=suffix), words[:i], words[i + 1 :]
                families[family][word] = candidate
    return [
        _chosen(family, members)
        for family, members in families.items()
        if len(members) > 1
        and not any(reads(one, other) for one in members for other in members if one != other)
    ]


def _chosen(family: _Family, members: dict[str, Candidate]) -> Candidate:
    edit, left, right = family
    choice = f"({' | '.join(sorted({w for m in members for w in choices(m)}))})"
    body = " ".join((*left, choice, *right))
    if edit.text and (left or right):
        body = f"({body})"
    reserving = {e for c in members.values() for e in c.edits[:-1]}
    before = sorted(reserving, key=lambda e: (not isinstance(e, AddToken), str(e)))
    edits = (*before, replace(edit, text=body + edit.text))
    return Candidate(edits, max(c.breadth for c in members.values()) + 1)
