"""A new alternative goes to the rule whose alternatives are like it."""

import pytest

from grammar.notation.edits import RemoveAlternative, apply
from grammar.notation.g4 import read_file
from grammar.notation.generate import GRAMMAR
from grammar.parser.recognizer import Recognizer
from recovery.forms.parts import parts
from recovery.proposals.grammar_profile import GrammarProfile
from recovery.proposals.similarity import Similarity

WHOLE = read_file(GRAMMAR)
SIMILARITY = Similarity(GrammarProfile(Recognizer(WHOLE)))


@pytest.mark.parametrize(
    ("fitting", "other", "symbols"),
    [
        ("splineMotion", "motion", "NEW target with? C_SPL?"),  # the same symbols
        ("interrupt", "motion", "(INTERRUPT | ALARM) ENABLE target"),  # the same first word
    ],
)
def test_the_rule_with_similar_alternatives_is_preferred(
    fitting: str, other: str, symbols: str
) -> None:
    found = [SIMILARITY.dissimilarity(rule, parts(symbols)) for rule in (fitting, other)]
    assert found[0] < found[1]


def test_an_alternative_goes_to_what_it_stands_beside_elsewhere() -> None:
    """A call and a variable are both frames, so a call is rather a primary than a literal."""
    without = Similarity(
        GrammarProfile(Recognizer(apply(WHOLE, [RemoveAlternative("primary", 3)])))
    )
    primary, literal = (without.dissimilarity(rule, ["call"]) for rule in ("primary", "literal"))
    assert primary < literal


def test_a_choice_of_words_gets_no_phrase() -> None:
    """Even if some of the words are in a rule of their own."""
    assert SIMILARITY.is_foreign("predefinedType", ["NEW", "name"])
    assert not SIMILARITY.is_foreign("predefinedType", ["NEW"])


def test_a_word_before_a_kind_of_statement_is_a_part_of_that() -> None:
    """``GLOBAL motion`` is no statement of its own."""
    assert SIMILARITY.extends("statement", ["GLOBAL", "motion", "eol"])
    assert not SIMILARITY.extends("statement", ["GLOBAL", "name", "eol"])


def test_a_rule_that_nothing_calls_is_meant() -> None:
    """It was written for what is missing."""
    grammar = apply(WHOLE, [RemoveAlternative("simpleStatement", 13)])
    profile = GrammarProfile(Recognizer(grammar))
    assert "goto" not in profile.alternatives("simpleStatement")
    assert profile.same_text_bonus("goto eol") > profile.same_text_bonus("label eol")
