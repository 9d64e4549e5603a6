"""What is said to add only does add only."""

from collections.abc import Sequence
from random import Random

import pytest

from grammar.notation.edits import (
    AddAlternative,
    AddRule,
    AddToken,
    Edit,
    Insert,
    MakeOptional,
    RemoveAlternative,
    Widen,
    apply,
)
from grammar.notation.g4 import read, read_file
from grammar.notation.generate import GRAMMAR
from grammar.notation.model import Grammar
from grammar.parser.recognizer import Recognizer
from grammar.parser.sentences import Sentences, Speller
from recovery.growth.inclusion import fixed_texts_added, occurs

START = read_file(GRAMMAR.with_name("preliminary.g4"))

ADDING: dict[str, tuple[Sequence[Edit], frozenset[str]]] = {
    "a part that may be left out": ([Insert("call", (1, 1), "NAME?")], frozenset()),
    "another element": ([Widen("literal", (1, 1), "'+'")], frozenset()),
    "an optional element": ([MakeOptional("procedure", (1, 3), 2)], frozenset()),
    "an alternative": ([AddAlternative("simpleStatement", "NAME")], frozenset()),
    "a rule and a keyword": (
        [
            AddToken("GOTO"),
            AddRule("exit", "goto\n    : GOTO NAME\n    ;"),
            AddAlternative("simpleStatement", "goto"),
        ],
        frozenset({"GOTO"}),
    ),
}
OTHER: dict[str, Sequence[Edit]] = {
    "a part that has to be there": [Insert("call", (1, 1), "NAME")],
    "an alternative less": [RemoveAlternative("wait", 1)],
}


def added(after: Grammar, before: Grammar = START) -> frozenset[str] | None:
    return fixed_texts_added(Recognizer(before), Recognizer(after))


@pytest.mark.parametrize("what", ADDING)
def test_an_edit_that_adds_is_recognised(what: str) -> None:
    """Only the keywords it reserves could do harm."""
    edits, texts = ADDING[what]
    assert texts == added(read(apply(START, edits).text))


@pytest.mark.parametrize("what", OTHER)
def test_an_edit_that_takes_away_is_not_taken_for_one_that_adds(what: str) -> None:
    """Programs could be lost."""
    assert added(read(apply(START, OTHER[what]).text)) is None


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("INTEGER : [0-9]+ ;", "INTEGER : [0-9]+ | '0x' [0-9]+ ;"),
        ("COMMENT : ';'", "COMMENT : '!'"),
        ("options { caseInsensitive = true; }", ""),
        ("DIVIDE : '/' ;", "DIVIDE : '/' ;\nFLOAT : [0-9]+ 'F' ;"),
    ],
)
def test_tokens_that_are_cut_otherwise_prove_nothing(old: str, new: str) -> None:
    """Another pattern, a new pattern, or another way to compare letters."""
    assert added(read(START.text.replace(old, new))) is None


def test_the_order_of_tokens_counts() -> None:
    """Of two tokens that match the same text the first one wins."""
    text = START.text.replace("AND : 'AND' ;\n", "").replace(
        "BIT_STRING :", "AND : 'AND' ;\nBIT_STRING :", 1
    )
    assert added(read(text)) is None


def test_a_rule_is_compared_by_what_it_means() -> None:
    """Another way to write the same adds nothing and loses nothing."""
    assert frozenset() == added(read(START.text.replace("index? ('.'", "(index)? ('.'")))


@pytest.mark.parametrize("what", ADDING)
def test_programs_stay_programs(what: str) -> None:
    """Random programs of the start in which no new token occurs are programs afterwards."""
    edits, texts = ADDING[what]
    after = Recognizer(read(apply(START, edits).text))
    sentences, speller, chance = Sentences(START), Speller(START), Random(7)
    for _ in range(60):
        text = speller.text(sentences.random(chance))
        assert occurs(texts, text.upper()) or after.accepts(text)


def test_a_token_occurs_inside_words_too() -> None:
    """Nearer looking would need a lexer; too often is safe."""
    assert occurs(frozenset({"STEP"}), "MISSTEPS=1")
    assert not occurs(frozenset({"STEP"}), "S=1")
