"""What a grammar writes in one place tells what is meant in another."""

import pytest

from grammar.notation.edits import Insert, RemoveElement, apply
from grammar.notation.g4 import read
from grammar.parser.recognizer import Recognizer
from recovery.clustering.cluster import cluster
from recovery.proposals.collocations import Collocations, last_two, symbols_in
from recovery.proposals.grammar_profile import GrammarProfile
from recovery.proposals.phrases import Phraser
from recovery.proposals.similarity import Similarity
from recovery.survey.survey import survey_texts

WHOLE = read("""grammar S;
options { caseInsensitive = true; }
program : line* EOF ;
line : statement NEWLINE ;
statement : LIN place (CA expression)? | CIRC place (CA expression)? | SET name '=' expression
    | RATE '=' expression | stop | turn | label ;
stop : STOP expression? ;
turn : TURN ;
label : name ':' ;
place : name (':' name)* ;
expression : value (('+' | '-') value)* ;
value : name | number | truth ;
truth : TRUE | FALSE ;
name : NAME | IN ;
number : INTEGER ;
CA : 'CA' ;
CIRC : 'CIRC' ;
DO : 'DO' ;
FALSE : 'FALSE' ;
IN : 'IN' ;
LIN : 'LIN' ;
OFF : 'OFF' ;
ON : 'ON' ;
RATE : 'RATE' ;
SET : 'SET' ;
STOP : 'STOP' ;
TRUE : 'TRUE' ;
TURN : 'TURN' ;
ASSIGN : '=' ;
PLUS : '+' ;
MINUS : '-' ;
COLON : ':' ;
NAME : [A-Z] [A-Z0-9]* ;
INTEGER : [0-9]+ ;
NEWLINE : '\\r'? '\\n' ;
SPACE : ' '+ -> skip ;
""")
RECOGNIZER = Recognizer(WHOLE)
HABITS = Collocations(RECOGNIZER)
PHRASER = Phraser(GrammarProfile(RECOGNIZER))
LAYOUT = GrammarProfile(RECOGNIZER)


def test_what_stands_before_a_place_is_its_last_two_symbols() -> None:
    """What may be left out is passed over, brackets are no symbols."""
    assert [(("", ""), "CA"), (("", "CA"), "expression")] == symbols_in(["(CA", "expression)?"])
    assert ("SET", "name") == last_two(["SET", "LIN?", "name"])


@pytest.mark.parametrize(
    ("before", "expected"),
    [
        (("name", "CA"), {"expression": 2}),
        (("SET", "name"), {}),
        (("SPEED", "'='"), {"expression": 1}),  # behind any word and this sign
        (("name", "'='"), {"expression": 1}),
        (("", "TURN"), {}),
    ],
)
def test_a_place_is_known_by_its_word_or_sign(
    before: tuple[str, str], expected: dict[str, int]
) -> None:
    """A word tells by itself what follows it, a sign with what is before the sign."""
    assert expected == HABITS.usual(before)


def test_a_token_of_one_rule_is_written_by_its_name() -> None:
    """Of a choice of words one alone may be meant; a word of several rules belongs to none."""
    assert {
        "NAME": "name",
        "INTEGER": "number",
        "STOP": "stop",
        "TURN": "turn",
    } == HABITS.written_by


def test_the_usual_is_narrower_than_what_is_only_seen() -> None:
    """Where the grammar has an expression, a number is the less likely of the two."""
    assert PHRASER.breadth(["CA", "expression"]) < PHRASER.breadth(["CA", "number"])
    assert PHRASER.breadth(["CA", "number"]) < PHRASER.breadth(["CA", "INTEGER"])
    assert PHRASER.breadth(["FOR", "number"]) < PHRASER.breadth(["FOR", "expression"])


def test_a_lost_part_comes_back_as_it_is_elsewhere() -> None:
    """From ``CIRC A CA 0`` alone the tool proposes the expression that LIN has."""
    damaged = apply(WHOLE, [RemoveElement("statement", (2, 3))])
    texts = {"a": "CIRC A CA 0\n", "b": "LIN A CA 1 + B\n"}
    found = survey_texts(list(texts.items()), damaged)
    [entry] = cluster(found, text_of=lambda file: texts[file.digest]).ranked
    assert (Insert("statement", (2, 3), "(CA expression)?"),) == entry.proposals[0].edits


def test_a_part_goes_where_it_stands_elsewhere() -> None:
    """Behind what may be left out the order is that of another sequence; else it is the last."""
    profile = GrammarProfile(
        Recognizer(
            read("""grammar S;
program : line* EOF ;
line : LIN NAME extra? BLEND? NEWLINE | CIRC NAME BLEND? ON? NEWLINE ;
extra : WITH NAME ;
BLEND : 'BLEND' ;
CIRC : 'CIRC' ;
LIN : 'LIN' ;
ON : 'ON' ;
WITH : 'WITH' ;
NAME : [A-Z]+ ;
NEWLINE : '\\n' ;
""")
        )
    )
    assert (2, 3) == profile.usual_place("line", (2, 5), "extra?")
    assert profile.usual_place("line", (2, 3), "extra?") is None
    assert profile.usual_place("line", (2, 5), "WITH?") is None


def test_a_keyword_with_a_meaning_is_no_name() -> None:
    """A value is a truth already: to call one a name would give it two readings."""
    assert PHRASER.would_be_read_twice("name", "TRUE")
    assert not PHRASER.would_be_read_twice("truth", "STOP")
    assert not PHRASER.would_be_read_twice("name", "NEW")


def test_an_alternative_with_more_around_it_is_an_extension() -> None:
    """What only adds to an alternative is better said as a part that may be left out."""
    similarity = Similarity(LAYOUT)
    assert similarity.extends("turn", ["TURN", "name"])
    assert similarity.extends("label", ["SET", "name", "':'"])
    assert not similarity.extends("turn", ["TURN"])
    assert not similarity.extends("label", ["name", "SET", "':'"])
