"""Forms with different first words are one alternative; a part may be missing in many places."""

from grammar.edits import AddAlternative, AddToken, Edit, Insert, Widen
from grammar.g4 import read_file
from grammar.generate import GRAMMAR
from grammar.recognizer import Recognizer
from recovery.candidates import Candidate
from recovery.families import everywhere, one_family, with_lead
from recovery.layout import Layout
from recovery.trial import Outcome

LAYOUT = Layout(Recognizer(read_file(GRAMMAR.with_name("preliminary.g4"))))


def forms(one: str, other: str, rule: str = "motion") -> tuple[Edit, ...] | None:
    """The two texts, added to a rule, as one family."""
    return one_family(LAYOUT, [AddAlternative("motion", one)], [AddAlternative(rule, other)])


def test_forms_that_begin_with_different_words_are_one_alternative() -> None:
    """What only one of them has may be left out, and neither loses the order it has."""
    assert (AddAlternative("motion", "(SLIN | SPTP) target with? C_SPL?"),) == forms(
        "SPTP target C_SPL?", "SLIN target with? C_SPL?"
    )
    assert (AddAlternative("motion", "(A | B | C) target (',' target)* C_DIS?"),) == forms(
        "(A | B) target (',' target)*", "C target (',' target)* C_DIS?"
    )


def test_a_choice_of_what_may_follow_becomes_parts_in_their_order() -> None:
    """Lines with two of the parts show that they are no alternatives, and which comes first."""
    assert (AddAlternative("motion", "(SLIN | SPTP) a target with? reference? C_SPL?"),) == forms(
        "SPTP a target (reference | C_SPL | with)?", "SLIN a target with? reference?"
    )


def test_forms_with_little_in_common_or_of_two_rules_stay_apart() -> None:
    """One operand behind the word says nothing, nor does what no word begins."""
    assert forms("GOTO name", "CONFIRM name") is None
    assert forms("SPTP target C_SPL?", "SLIN target C_SPL?", "call") is None
    assert forms("name '=' expression", "SLIN '=' expression") is None
    assert forms("SPTP target C_SPL?", "SLIN target C_SPL? name") is None


def test_a_word_joins_the_choice_where_the_others_stand() -> None:
    """A new word is reserved once, whichever of the two needs it."""
    wide = Widen("motion", (2, 1), "(SLIN | SPTP)")
    new = AddToken("SPL")
    expected = (new, Widen("motion", (2, 1), "(SLIN | SPL | SPTP)"))
    form = [new, AddAlternative("motion", "SPL target")]
    assert expected == one_family(LAYOUT, [wide], form)
    assert expected == one_family(LAYOUT, form, [wide])


def test_a_word_is_as_good_as_the_one_a_form_begins_with() -> None:
    """A word the grammar lacks is reserved; short forms take only words that are built alike."""
    found = with_lead(LAYOUT, [AddAlternative("motion", "SPTP target ',' name")], "HOLD")
    assert found is not None
    assert AddToken("HOLD") in found
    assert AddAlternative("motion", "(HOLD | SPTP) target ',' name") == found[-1]
    short = [AddAlternative("motion", "PTP_REL target C_DIS?")]
    assert with_lead(LAYOUT, short, "HOLD") is None
    assert with_lead(LAYOUT, short, "LIN_REL") is not None
    assert with_lead(LAYOUT, short, "PTP_REL") is None
    assert with_lead(LAYOUT, [Insert("motion", (1, 3), "C_DIS?")], "LIN") is None


def test_a_part_is_let_in_wherever_it_mends_more() -> None:
    """A place that does nothing new is none, and one place alone needs no other candidate."""

    def tried(place: int, mended: set[int], text: str = "C_SPL?") -> tuple[Candidate, Outcome]:
        edit = Insert("motion", (place, 3), text)
        return Candidate((edit,), 30 + place), Outcome(frozenset(mended), frozenset())

    family = [tried(1, {1, 2}), tried(2, {3}), tried(3, {1}), tried(4, set()), tried(5, {7}, "A?")]
    found = {candidate.edits: candidate.breadth for candidate in everywhere(family)}
    both = (Insert("motion", (2, 3), "C_SPL?"), Insert("motion", (1, 3), "C_SPL?"))
    assert [both] == list(found)
    assert 32 < found[both]
    assert [] == everywhere(family[:1])
