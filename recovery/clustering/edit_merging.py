"""Edits that are one thing: the same word or phrase is missing in several places.

``A == B`` and ``A < B`` fail at different signs, but the edits that mend them differ in one word at
the same place; a phrase may be missing in two rules, or two lost alternatives may be all that ever
used a rule. Here is what tells so, and what writes such edits as one.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Callable, Sequence
from dataclasses import replace

from grammar.notation.edits import AddAlternative, AddToken, Edit, Insert, Widen
from recovery.proposals.candidates import Candidate
from recovery.proposals.grammar_profile import Layout
from recovery.tuning import MOST_MERGED_EDITS

__all__ = ["one_choice", "one_form", "reach_the_same", "together"]

# Words of a text, a choice of words taken for one.
_WORDS = re.compile(r"\([^()]*\)[?*+]?|\S+")


def together(first: Sequence[Edit], second: Sequence[Edit]) -> tuple[Edit, ...]:
    """The edits of both, each once, in an order in which no edit moves the place of another."""
    edits = list(dict.fromkeys((*first, *second)))
    tokens = [e for e in edits if isinstance(e, AddToken)]
    places = [e for e in edits if not isinstance(e, AddToken | AddAlternative)]
    places.sort(key=lambda e: (getattr(e, "rule", ""), getattr(e, "at", ())), reverse=True)
    return (*tokens, *places, *(e for e in edits if isinstance(e, AddAlternative)))


def _main(layout: Layout, edits: Sequence[Edit]) -> list[Edit]:
    """The edits but for those that reserve words."""
    reserving = layout.vocabulary.reserve(e.name for e in edits if isinstance(e, AddToken))
    return [e for e in edits if e not in reserving]


def reach_the_same(layout: Layout, first: Sequence[Edit], second: Sequence[Edit]) -> bool:
    """Whether two edits let in one thing: a phrase, or what alone used a rule.

    A few edits at most make one cause: a person has to see at a glance that they are one.
    """
    if len({*_main(layout, first), *_main(layout, second)}) > MOST_MERGED_EDITS:
        return False
    one, other = first[-1], second[-1]
    if not isinstance(one, Insert | Widen | AddAlternative) or not isinstance(
        other, Insert | Widen | AddAlternative
    ):
        return False
    if one != other and one.text.rstrip("?*+") == other.text.rstrip("?*+"):
        return True
    unused = layout.unused_in(one.text), layout.unused_in(other.text)
    if one.rule == other.rule and isinstance(one, AddAlternative) and type(one) is type(other):
        # what gathered several rules is gone, or what had several forms without a word of its own
        return all(unused) or bool(layout.operands(one.text) & layout.operands(other.text))
    return bool(unused[0] & unused[1])


def one_form(
    layout: Layout, first: Sequence[Edit], second: Sequence[Edit]
) -> tuple[Edit, ...] | None:
    """The edits of both with one text, where both let in a form of what one new word begins.

    No rule has had a use for the word, and two rules are to have one now: they share the longer
    form. ``None`` where that is not so.
    """
    one, other = first[-1], second[-1]
    if not isinstance(one, AddAlternative) or not isinstance(other, AddAlternative):
        return None
    words = {edit.text.split(" ")[0] for edit in (one, other)}
    if len(words) > 1 or one.rule == other.rule or len(_main(layout, first)) > 1:
        return None
    word = words.pop()
    if not word.isidentifier() or not word[0].isupper() or layout.vocabulary.is_written(word):
        return None
    text = max(one.text, other.text, key=lambda t: (len(t), t))
    both = (replace(one, text=text), replace(other, text=text))
    return together((*first[:-1], both[0]), (*second[:-1], both[1]))


def one_choice(
    candidates: Sequence[Candidate],
    allowed: Callable[[Edit, int], bool] = lambda _edit, _place: True,
) -> list[Candidate]:
    """Candidates that differ in one word only, as one with a choice of words.

    ``allowed`` is asked whether words at a place in the text of an edit may be a choice.
    """
    families: dict[tuple[object, ...], dict[str, Candidate]] = defaultdict(dict)
    for candidate in candidates:
        edit = candidate.edits[-1]
        if not isinstance(edit, Insert | Widen | AddAlternative):
            continue
        words = _WORDS.findall(edit.text.strip("()?*") if isinstance(edit, Insert) else edit.text)
        place = () if isinstance(edit, AddAlternative) else edit.at
        for i, word in enumerate(words):
            if allowed(edit, i):
                frame = (type(edit), edit.rule, place, tuple(words[:i]), tuple(words[i + 1 :]))
                suffix = edit.text[-1] if isinstance(edit, Insert) else ""
                families[*frame, suffix][word] = candidate
    return [
        _chosen(family[3], family[4], members)
        for family, members in families.items()
        if len(members) > 1
    ]


def _choices(word: str) -> list[str]:
    """The words of a choice, or the one word that is none."""
    return word[1:-1].split(" | ") if word[0] == "(" and word[-1] == ")" else [word]


def _chosen(left: object, right: object, members: dict[str, Candidate]) -> Candidate:
    assert isinstance(left, tuple)
    assert isinstance(right, tuple)
    choice = f"({' | '.join(sorted({w for m in members for w in _choices(m)}))})"
    body = " ".join((*left, choice, *right))
    last = next(iter(members.values())).edits[-1]
    edit: Edit
    if isinstance(last, Insert):
        text = f"({body}){last.text[-1]}" if left or right else f"{choice}{last.text[-1]}"
        edit = Insert(last.rule, last.at, text)
    elif isinstance(last, Widen):
        edit = Widen(last.rule, last.at, body)
    else:
        assert isinstance(last, AddAlternative)
        edit = AddAlternative(last.rule, body)
    reserving = {e for c in members.values() for e in c.edits[:-1]}
    before = sorted(reserving, key=lambda e: (not isinstance(e, AddToken), str(e)))
    return Candidate((*before, edit), max(c.breadth for c in members.values()) + 1)
