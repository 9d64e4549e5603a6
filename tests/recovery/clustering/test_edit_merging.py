"""Edits that accept one thing in several places belong together."""

from grammar.notation.edits import AddAlternative, AddToken, Edit, Insert, Widen
from grammar.notation.g4 import read_file
from grammar.notation.generate import GRAMMAR
from grammar.parser.recognizer import Recognizer
from recovery.clustering.edit_merging import (
    are_one_change,
    combined_edits,
    merged_as_choice,
    merged_as_form,
)
from recovery.proposals.candidates import Candidate
from recovery.proposals.grammar_profile import GrammarProfile

LAYOUT = GrammarProfile(Recognizer(read_file(GRAMMAR.with_name("preliminary.g4"))))


def test_words_at_one_place_become_a_choice() -> None:
    """Edits that differ in one word are one edit with both words."""
    edits = [Insert("motion", (1, 3), f"{word}?") for word in ("C_VEL", "C_ORI")]
    found = merged_as_choice([Candidate((AddToken(e.text[:-1]), e), 3) for e in edits])
    assert Insert("motion", (1, 3), "(C_ORI | C_VEL)?") in [c.edits[-1] for c in found]


def test_a_choice_in_front_of_an_operand_grows() -> None:
    """Repetitions behind different signs are one repetition behind any of them."""
    texts = "(('*' | '/') factor)*", "('+' factor)*"
    edits = [Insert("product", (1, 2), text) for text in texts]
    [both] = merged_as_choice([Candidate((edit,), 3) for edit in edits])
    assert Insert("product", (1, 2), "(('*' | '+' | '/') factor)*") == both.edits[-1]


def test_the_same_word_or_phrase_is_one_thing() -> None:
    """A shared new word or the same text in two rules is one thing; two statements are not."""
    brake = AddAlternative("simpleStatement", "BRAKE"), AddAlternative("interruptAction", "BRAKE")
    assert are_one_change(LAYOUT, brake[:1], brake[1:])
    new = AddToken("C_VEL")
    assert are_one_change(
        LAYOUT, [new, Insert("motion", (1, 3), "C_VEL?")], [new, Widen("motion", (2, 3), "C_VEL")]
    )
    assert not are_one_change(LAYOUT, brake[:1], [AddAlternative("simpleStatement", "HALT")])


def test_two_rules_share_the_longer_form_of_a_new_word() -> None:
    """What one word begins in two rules is one construct, unless the grammar has it already."""
    short: list[Edit] = [AddToken("HOLD"), AddAlternative("interruptAction", "HOLD")]
    long: list[Edit] = [AddToken("HOLD"), AddAlternative("simpleStatement", "HOLD (F | FF)?")]
    found = merged_as_form(LAYOUT, short, long)
    assert found is not None
    assert {
        AddToken("HOLD"),
        AddAlternative("interruptAction", "HOLD (F | FF)?"),
        AddAlternative("simpleStatement", "HOLD (F | FF)?"),
    } == set(found)
    known = [AddAlternative(rule, "WAIT name") for rule in ("interruptAction", "simpleStatement")]
    assert merged_as_form(LAYOUT, known[:1], known[1:]) is None
    assert merged_as_form(LAYOUT, long, long) is None


def test_no_edit_moves_the_place_of_another() -> None:
    """Of two insertions into one rule the later place comes first, and each edit comes once."""
    early, late = Insert("motion", (1, 2), "A?"), Insert("motion", (1, 3), "B?")
    assert (late, early) == combined_edits([early], [late, early])
    other = Widen("motion", (1, 2), "A")
    assert (other, early) == combined_edits([early], [other])


def test_a_choice_is_widened_and_keeps_what_reserves_its_words() -> None:
    """A word beside a choice of words is a choice of all; edits before the last stay."""
    edits = [Widen("motion", (1, 1), text) for text in ("(SLIN | SPTP)", "SPL")]
    listed = AddAlternative("keyword", "SPL")
    pair = [Candidate((edits[0],), 3), Candidate((AddToken("SPL"), listed, edits[1]), 3)]
    assert [(AddToken("SPL"), listed, Widen("motion", (1, 1), "(SLIN | SPL | SPTP)"))] == [
        c.edits for c in merged_as_choice([Candidate(tuple(c.edits), c.breadth) for c in pair])
    ]
