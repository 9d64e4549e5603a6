"""Edits that are forms of one thing: it has several beginnings, or is missing in several places.

``SPTP target`` and ``SLIN target with?`` begin with different words, and a person writes them as
one alternative. ``with?`` that five alternatives have lost is one part, though no edit at one place
brings all five back.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from difflib import SequenceMatcher

from grammar.edits import AddAlternative, Edit, Insert, Widen
from recovery.candidates import Candidate
from recovery.elements import bare, choices, elements, is_word, wider
from recovery.joined_edits import main_edits, together
from recovery.layout import Layout
from recovery.trial import Outcome

__all__ = ["everywhere", "one_family", "with_lead"]

# Elements that two forms must have in common behind the words they begin with.
_IN_COMMON = 2
# Letters that words have in common at their beginning where they belong together.
_STEM = 3
# Places where one part may be missing.
_MOST_PLACES = 6
# What each further place adds to how much an edit lets in.
_A_PLACE = 2


def one_family(
    layout: Layout, first: Sequence[Edit], second: Sequence[Edit]
) -> tuple[Edit, ...] | None:
    """One edit for two forms that a rule lacks and that differ in the word they begin with.

    ``SPTP target C_SPL?`` and ``SLIN target with?`` make ``(SLIN | SPTP) target with? C_SPL?``:
    what only one of them has can be left out in it. Where one of them is a word more in a choice
    that is there, the word of the other joins it. ``None`` where they are no forms of one thing.
    """
    if max(len(main_edits(layout, edits)) for edits in (first, second)) > 1:
        return None
    one, other = first[-1], second[-1]
    reserving = together(first[:-1], second[:-1])
    if isinstance(one, AddAlternative) and isinstance(other, Widen):
        one, other = other, one
    if not isinstance(other, AddAlternative) or getattr(one, "rule", "") != other.rule:
        return None
    lead, *rest = elements(other.text)
    words = choices(lead)
    edit: Edit | None = None
    if isinstance(one, Widen) and one.at[-1] == 1:
        words += choices(one.text)
        edit = Widen(one.rule, one.at, _choice(words))
    elif isinstance(one, AddAlternative):
        one_lead, *one_rest = elements(one.text)
        words += choices(one_lead)
        body = _merged(one_rest, rest)
        edit = AddAlternative(one.rule, " ".join((_choice(words), *body))) if body else None
    if edit is None or not all(map(is_word, words)):
        return None
    return together(reserving, [edit])


def with_lead(layout: Layout, edits: Sequence[Edit], word: str) -> tuple[Edit, ...] | None:
    """The edits of a form that begins with a word, with another word as good as that one.

    ``None`` where they are none, or where so short a form says little and the words are not alike.
    """
    main = edits[-1]
    if len(main_edits(layout, edits)) > 1 or not is_word(word):
        return None
    edit: Edit
    if isinstance(main, Widen) and main.at[-1] == 1:
        words = choices(main.text)
        edit = Widen(main.rule, main.at, _choice((*words, word)))
    elif isinstance(main, AddAlternative):
        lead, *rest = elements(main.text)
        words = choices(lead)
        needed = sum(element[-1] not in "?*" for element in rest)
        if needed < _IN_COMMON and not any(_akin(word, known) for known in words):
            return None
        edit = AddAlternative(main.rule, " ".join((_choice((*words, word)), *rest)))
    else:
        return None
    if word in words or not all(map(is_word, words)):
        return None
    is_known = word in layout.recognizer.lexer.kind_of
    return together(() if is_known else layout.vocabulary.reserve([word]), (*edits[:-1], edit))


def _akin(one: str, other: str) -> bool:
    """Whether words are built alike, as ``LIN_REL`` and ``PTP_REL``, or ``EXT`` and ``EXTFCT``."""
    return bool(set(one.split("_")) & set(other.split("_"))) or one[:_STEM] == other[:_STEM]


def _choice(words: Sequence[str]) -> str:
    chosen = sorted(set(words))
    return f"({' | '.join(chosen)})" if len(chosen) > 1 else chosen[0]


def _merged(one: Sequence[str], other: Sequence[str]) -> list[str]:
    """Elements that read what both read; nothing where they have too little in common.

    What only one of them has must be what may be left out: else they are forms of two things.
    """
    one, other = _expanded(one, other), _expanded(other, one)
    matcher = SequenceMatcher(None, [*map(bare, one)], [*map(bare, other)], autojunk=False)
    blocks = matcher.get_matching_blocks()
    if sum(block.size for block in blocks) < _IN_COMMON:
        return []
    out: list[str] = []
    here = there = 0
    for a, b, size in blocks:
        more = [*one[here:a], *other[there:b]]
        if not all(element[-1] in "?*" for element in more):
            return []
        out += more
        out += map(wider, one[a : a + size], other[b : b + size])
        here, there = a + size, b + size
    return out


def _expanded(one: Sequence[str], other: Sequence[str]) -> list[str]:
    """Elements with choices that may be left out as single ones, where ``other`` has such."""
    out: list[str] = []
    for element in one:
        said = choices(element[:-1]) if element.endswith(")?") else []
        if any(f"{symbol}?" in other for symbol in said):
            place = {symbol: n for n, symbol in enumerate(other)}
            said.sort(key=lambda symbol: place.get(f"{symbol}?", len(other)))
            out += [f"{symbol}?" for symbol in said]
        else:
            out.append(element)
    return out


def everywhere(tried: Sequence[tuple[Candidate, Outcome]]) -> list[Candidate]:
    """Parts that mend lines at several places, as one candidate that inserts them at all of these.

    ``tried`` are candidates with what they do. A place of which another does all is none.
    """
    families: dict[tuple[str, str], list[tuple[Candidate, Outcome]]] = defaultdict(list)
    for candidate, outcome in tried:
        edit = candidate.edits[-1]
        if isinstance(edit, Insert) and outcome.mended:
            families[edit.text, ""].append((candidate, outcome))
            families[edit.text, edit.rule].append((candidate, outcome))
    out = []
    for _, family in sorted(families.items()):
        family.sort(key=lambda co: (-len(co[1].mended), co[0].breadth, str(co[0].edits)))
        chosen: list[Candidate] = []
        mended: frozenset[int] = frozenset()
        for candidate, outcome in family:
            if outcome.mended - mended and len(chosen) < _MOST_PLACES:
                chosen.append(candidate)
                mended |= outcome.mended
        if len(chosen) > 1:
            edits: tuple[Edit, ...] = ()
            for candidate in chosen:
                edits = together(edits, candidate.edits)
            breadth = max(c.breadth for c in chosen) + _A_PLACE * (len(chosen) - 1)
            out.append(Candidate(edits, breadth))
    return out
