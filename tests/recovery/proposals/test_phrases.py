"""Tokens that a grammar did not expect are written as words of a rule that would read them."""

from collections.abc import Sequence

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grammar.notation.edits import AddRule, AddToken, apply
from grammar.notation.g4 import read, read_file
from grammar.notation.generate import GRAMMAR
from grammar.parser.network import network_of
from grammar.parser.recognizer import Recognizer
from recovery.forms.symbols import Token
from recovery.proposals.alignment import Aligner
from recovery.proposals.grammar_profile import GrammarProfile
from recovery.proposals.phrases import Phraser

PRELIMINARY = read_file(GRAMMAR.with_name("preliminary.g4"))
RECOGNIZER = Recognizer(PRELIMINARY)
PHRASER = Phraser(GrammarProfile(RECOGNIZER))
ALIGNER = Aligner(PHRASER)
TOKENS = "A 1 2.5 'B1' \"x\" #E TRUE + - * , . = == ( ) [ ] { } : NOT AND TO PTP".split()


def words_of(text: str, *keywords: str) -> list[Token]:
    """The tokens of a text; names that are ``keywords`` are meant as such."""
    lexer = RECOGNIZER.lexer
    lexemes = [lexeme for lexeme in lexer.lexemes(text) if lexer.kinds[lexeme] != -1]
    return [(lexer.kinds[x], x if x in keywords else None) for x in lexemes]


def phrases(text: str, *keywords: str) -> list[str]:
    words = words_of(text, *keywords)
    found = dict.fromkeys([*PHRASER.alone(words), *ALIGNER.common_phrases([words])])
    return [" ".join(symbols) for symbols in found]


def reads(phrase: Sequence[str], words: Sequence[Token]) -> bool:
    """Whether a rule of these words, added to the grammar, is the tokens as a whole."""
    keywords = sorted({keyword for _, keyword in words if keyword})
    rule = AddRule(PRELIMINARY.start, f"probe\n    : {' '.join(phrase)}\n    ;")
    grammar = apply(PRELIMINARY, [*(AddToken(k) for k in keywords), rule])
    lexer = RECOGNIZER.lexer
    for keyword in keywords:
        lexer = lexer.with_keyword(keyword)
    probe = Recognizer(grammar, network_of(grammar, lexer))
    kinds = [lexer.kind_of[keyword] if keyword else kind for kind, keyword in words]
    state, failed = probe.run(probe.at_rule("probe"), kinds)
    return failed is None and probe.ends(state)


# -------------------------------------------------------------------------- what is written


def test_a_rule_that_nothing_calls_is_written() -> None:
    """It was probably meant for the tokens that it reads, though they are no one operand."""
    pair = apply(PRELIMINARY, [AddRule(PRELIMINARY.start, "pair\n    : NAME NAME\n    ;")])
    phraser = Phraser(GrammarProfile(Recognizer(pair)))
    assert "pair" not in phrases("A B")
    assert ("pair",) in phraser.alone(words_of("A B"))


@pytest.mark.parametrize(
    ("text", "keywords", "expected"),
    [
        ("STEP 2", ["STEP"], ["STEP INTEGER", "STEP literal", "STEP expression"]),
        ("PUBLIC", ["PUBLIC"], ["PUBLIC"]),
        (", B", [], ["',' NAME", "',' variable", "',' expression"]),
        ("A + 1", [], ["NAME '+' INTEGER", "expression"]),
        ("END", [], ["END"]),
        ("( A )", [], ["'(' NAME ')'", "expression"]),
    ],
)
def test_words_are_written_as_tokens_and_as_rules(
    text: str, keywords: list[str], expected: list[str]
) -> None:
    """The tokens themselves come first, then rules for their operands, narrow before wide."""
    found = phrases(text, *keywords)
    places = [found.index(phrase) for phrase in expected]
    assert places[0] == 0
    assert sorted(places) == places


@pytest.mark.parametrize("text", ["A , B", "A , 1 , B"])
def test_a_list_is_written_for_any_length(text: str) -> None:
    """One of the phrases for a list reads a longer one too."""
    longer = words_of(f"{text} , {text}")
    assert any(reads(phrase, longer) for phrase in ALIGNER.common_phrases([words_of(text)]))


def test_no_words_have_no_phrase() -> None:
    """Nothing is written for what no token is, and no operand for what goes on without end."""
    assert [] == phrases("A ? B")
    assert [] == ALIGNER.common_phrases([words_of("= " * 400)])


@given(st.lists(st.sampled_from([*TOKENS, "STEP"]), min_size=1, max_size=7))
def test_every_phrase_reads_the_words_it_was_made_for(tokens: list[str]) -> None:
    """A rule of the phrase is the words, whatever they are."""
    words = words_of(" ".join(tokens), "STEP")
    written = ALIGNER.common_phrases([words])
    assert len(set(written)) == len(written)
    assert [] == [phrase for phrase in written[:6] if not reads(phrase, words)]


@pytest.mark.parametrize("text", ["STEP 2", ", B , C", "A . B [ 1 ] = - 2.5", "[ ]", "TO F ( 1 )"])
def test_rules_near_by_are_tried_too(text: str) -> None:
    """Names of rules near the place add phrases, which read the words as well."""
    words = words_of(text, "STEP")
    near = frozenset({"literal", "variable", "primary", "index"})
    more = ALIGNER.common_phrases([words], near)
    assert all(reads(phrase, words) for phrase in more)


# ------------------------------------------------------------------------------- breadth


def test_tokens_accept_less_than_rules_and_narrow_rules_less_than_wide_ones() -> None:
    """Breadth orders phrases by what they accept; signs and words cost nothing."""
    rows = (["STEP", "INTEGER"], ["STEP", "literal"], ["STEP", "sum"], ["STEP", "expression"])
    breadths = [PHRASER.breadth(row) for row in rows]
    assert sorted(set(breadths)) == breadths
    assert PHRASER.breadth(["','", "NAME"]) == PHRASER.breadth([])


# ------------------------------------------------------------------------- other grammars

SMALL = """grammar Small;
s : unused* e EOF ;
unused : pair ;
pair : A B ;
e : A | A ',' A ;
A : 'A' ;
B : 'B' ;
COMMA : ',' ;
NEWLINE : '\\n' ;
SPACE : ' ' -> skip ;
"""


def test_phrases_are_made_for_any_grammar() -> None:
    """Nothing is taken from KRL: a grammar of three tokens has its phrases too."""
    phraser = Phraser(GrammarProfile(Recognizer(read(SMALL))))
    kinds = phraser.recognizer.kinds("A B")[:-1]
    assert {"pair", "unused"} <= phraser.matcher.rules_for(tuple(kinds))
    words = [(kind, None) for kind in kinds]
    assert [("A", "B"), ("pair",), ("unused",)] == list(phraser.alone(words))
