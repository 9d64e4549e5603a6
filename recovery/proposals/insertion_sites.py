"""Edit sites at which the unexpected tokens become a part of a rule."""

from __future__ import annotations

from collections.abc import Iterator

from grammar.notation.addresses import Address
from grammar.notation.model import Reference
from recovery import tuning
from recovery.forms.symbols import Token
from recovery.proposals.edit_site import EditSite
from recovery.proposals.grammar_profile import GrammarProfile


def insertions(
    profile: GrammarProfile, rule: str, place: Address, words: tuple[Token, ...]
) -> Iterator[EditSite]:
    """Yield the insertion of words; none after a line end, where lines are read, not parts."""
    elements = profile.sequence(rule, place[:-1]).elements
    before = elements[place[-1] - 2] if place[-1] > 1 else None
    if before is not None and profile.ends_a_line(before):
        return
    steps = insertion_width(profile, rule) + tuning.SITE_COST
    if len(place) > 2 and place[-1] > len(elements):
        steps += 1  # behind one branch of a choice, not behind the choice
    beside = before or elements[0]
    if isinstance(beside, Reference) and not beside.is_token:
        alone = profile.is_hub(rule) and len(elements) == 1
        if alone or (before is not None and profile.is_hub(beside.name)):
            steps += tuning.UNLIKELY_COST  # behind one of many statements, not in it
    if profile.is_new_word(words[-1]) and not profile.is_new_word(words[0]):
        steps += 1  # of two ways to cut the line, the word is rather ahead of its operand
    yield EditSite("insert", rule, place, words, steps)


def insertion_width(profile: GrammarProfile, rule: str) -> int:
    """Return the width of an insertion into a rule; less for a single reference."""
    width = profile.width(rule)
    return width - tuning.UNLIKELY_COST if profile.is_single_reference(rule) else width
