"""Phrases laid beside one another become one phrase that reads all of them."""

import pytest

from grammar.notation.g4 import read_file
from grammar.notation.generate import GRAMMAR
from grammar.parser.recognizer import Recognizer
from recovery.forms.symbols import Token
from recovery.proposals.alignment import Aligner
from recovery.proposals.grammar_profile import GrammarProfile
from recovery.proposals.phrases import Phraser

RECOGNIZER = Recognizer(read_file(GRAMMAR.with_name("preliminary.g4")))
PHRASER = Phraser(GrammarProfile(RECOGNIZER))


def words_of(text: str) -> list[Token]:
    """The tokens of a text; SLIN and HOLD are meant as keywords that the grammar lacks."""
    lexer = RECOGNIZER.lexer
    lexemes = [x for x in lexer.lexemes(text) if lexer.kinds[x] != -1]
    return [(lexer.kinds[x], x if x in ("SLIN", "HOLD") else None) for x in lexemes]


def common(*texts: str) -> list[str]:
    return [
        " ".join(symbols) for symbols in Aligner(PHRASER).common_phrases(list(map(words_of, texts)))
    ]


@pytest.mark.parametrize(
    ("texts", "expected"),
    [
        (["SLIN A", "SLIN {X: X 1} C_DIS"], "SLIN target C_DIS?"),
        (["HOLD SEC 1", "HOLD FOR A"], "HOLD (FOR | SEC) expression"),
        (["HALT"], "HALT"),
    ],
)
def test_what_differs_is_optional_a_choice_or_a_wider_rule(texts: list[str], expected: str) -> None:
    """One of the phrases is the one a person would write."""
    assert expected in common(*texts)


@pytest.mark.parametrize(
    ("texts", "expected"),
    [
        (
            ["SLIN (A: HOLD, B: HOLD)", "SLIN (C: SEC)", "SLIN ()"],
            "SLIN '(' (NAME ':' (HOLD | SEC) (',' NAME ':' (HOLD | SEC))*)? ')'",
        ),
        (["A: HOLD, INT: HOLD", "REAL: SEC"], "type ':' (HOLD | SEC) (',' type ':' (HOLD | SEC))*"),
        (["SLIN INT A", "SLIN B C"], "SLIN type NAME"),
        (["SLIN A, B[1]", "SLIN C"], "SLIN NAME index? (',' NAME index?)*"),
    ],
)
def test_items_of_a_list_are_laid_beside_one_another(texts: list[str], expected: str) -> None:
    """Also where they are phrases; words and names that one rule reads are that rule."""
    assert expected in common(*texts)


def test_the_order_of_the_phrases_does_not_matter() -> None:
    """The same phrases in another order give the same."""
    texts = ["LIN A", "LIN A C_DIS", "LIN {X: X 1}"]
    assert common(*texts) == common(*reversed(texts))


def test_phrases_without_much_in_common_are_not_made_one() -> None:
    """Two different statements give nothing."""
    assert [] == common("HALT", "WAIT SEC 1")


def test_operands_that_no_rule_reads_alike_are_parts_of_their_own() -> None:
    """Each word keeps the operand it comes with, and parts keep their order."""
    assert "SLIN (FOR assignment | SEC expression)" in common("SLIN FOR A=1", "SLIN SEC 5")
    assert "HOLD target expression?" not in common("HOLD A C_DIS", "HOLD A")


def test_a_word_that_is_a_name_elsewhere_is_a_word_between_operands() -> None:
    """DELAY may be a name; beside another operand it is none, and `DELAY = 1` assigns nothing."""
    grammar = Recognizer(read_file(GRAMMAR))
    phraser = Phraser(GrammarProfile(grammar))
    kinds = [[(k, None) for k in grammar.kinds(t)[:-1]] for t in ("HALT A DELAY=1", "HALT B")]
    assert ("HALT", "variable", "(DELAY '=' number)?") in [
        tuple("variable" if s in ("name", "variable", "expression") else s for s in symbols)
        for symbols in Aligner(phraser).common_phrases(kinds)
    ]
