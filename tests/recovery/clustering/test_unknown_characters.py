"""Lines that fail at a character without a token get a proposal with a token for it."""

from grammar.notation.edits import AddAlternative, AddRule, apply
from grammar.notation.g4 import read
from grammar.parser.recognizer import Recognizer
from recovery.clustering.cluster import cluster
from recovery.survey.survey import survey_texts

TOY = read("""grammar S;
program : (statement NEWLINE)* EOF ;
statement : SET NAME '=' expression | CALL NAME '(' expression ')' ;
expression : value ('+' value)* ;
value : NAME | INTEGER | '(' expression ')' ;
ASSIGN : '=' ;
PLUS : '+' ;
OPEN : '(' ;
CLOSE : ')' ;
CALL : 'CALL' ;
SET : 'SET' ;
NAME : [A-Z]+ ;
INTEGER : [0-9]+ ;
NEWLINE : '\\n' ;
SPACE : ' ' -> skip ;
""")
TEXTS = {"a": "SET A = 'H1F'\nSET B = 1\n", "b": "CALL A('H0')\nSET C = 1 + 'H20'\n"}


def test_a_text_in_quotes_becomes_a_value() -> None:
    """It is one cause, wherever operands may be; both files can be read with its proposal."""
    found = survey_texts(list(TEXTS.items()), TOY)
    [entry] = cluster(found, text_of=lambda file: TEXTS[file.digest]).ranked
    [proposal] = entry.proposals
    token, value = proposal.edits
    assert isinstance(token, AddRule)
    assert AddAlternative("value", token.text.split(" ")[0]) == value
    wider = Recognizer(apply(TOY, proposal.edits))
    assert all(map(wider.accepts, TEXTS.values()))
    assert not wider.accepts("SET A = 'X'\n")
    assert len(TEXTS) == len(entry.restores[0])


def test_a_character_alone_has_no_proposal() -> None:
    """Nothing tells what a sign would mean."""
    texts = {"a": "SET A = 1 ? 2\n"}
    found = survey_texts(list(texts.items()), TOY)
    [entry] = cluster(found, text_of=lambda file: texts[file.digest]).ranked
    assert () == entry.proposals
