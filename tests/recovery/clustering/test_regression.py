"""A word that is reserved may be a name in a file that was read before."""

import random

import pytest

from grammar.notation.edits import AddAlternative, AddToken, Edit
from grammar.notation.g4 import read
from grammar.notation.model import Grammar
from grammar.parser.recognizer import Recognizer
from recovery.clustering import regression
from recovery.clustering.cluster import cluster
from recovery.clustering.edit_trial import edited
from recovery.clustering.regression import ParsedFiles
from recovery.survey.survey import survey_texts

GRAMMAR: Grammar = read("""grammar S;
options { caseInsensitive = true; }
program : (statement NEWLINE)* EOF ;
statement : name '=' value | STOP value? | MOVE name | turn ;
turn : TURN value TO value ;
value : name | INTEGER ;
name : NAME | TO ;
DO : 'DO' ;
FOR : 'FOR' ;
IF : 'IF' ;
MOVE : 'MOVE' ;
OFF : 'OFF' ;
ON : 'ON' ;
STOP : 'STOP' ;
TO : 'TO' ;
TURN : 'TURN' ;
ASSIGN : '=' ;
NAME : [A-Z] [A-Z0-9]* ;
INTEGER : [0-9]+ ;
NEWLINE : '\\r'? '\\n' ;
SPACE : ' '+ -> skip ;
""")
RESERVED: list[Edit] = [AddToken("HOLD"), AddAlternative("statement", "HOLD value")]
HOLDS = [(f"h{n}", f"A=1\nHOLD {word}\nSTOP\n") for n, word in enumerate(("1", "X", "7", "Y", "Z"))]


def test_a_file_that_has_the_word_as_a_name_is_lost() -> None:
    """Only files with the word are asked, and only for words that were announced."""
    wider = edited(Recognizer(GRAMMAR), RESERVED)
    assert wider is not None
    plain, named = (6, lambda: "STOP 1\n"), (7, lambda: "hold=1\n")
    assert ParsedFiles([plain, named], {"HOLD"}).breaks(wider, ["HOLD"])
    assert not ParsedFiles([plain], {"HOLD"}).breaks(wider, ["HOLD"])
    assert not ParsedFiles([plain, named], {"HOLD"}).breaks(wider, ["KEEP"])


def test_only_the_smallest_files_are_searched(monkeypatch: pytest.MonkeyPatch) -> None:
    """As many are kept as may be searched, however many come and in whatever order."""
    monkeypatch.setattr(regression, "MOST_SEARCHED_TEXT", 60)
    sizes = random.Random(7).choices(range(1, 12), k=400)
    kept = ParsedFiles([(size, str) for size in sizes], {"HOLD"})
    expected = sorted(sizes)
    while sum(expected) > 60:
        expected.pop()
    assert expected == [size for size, _ in kept._files]


@pytest.mark.parametrize(
    ("others", "expected"), [([], False), ([("n", "HOLD=1\nSTOP HOLD\n")], True)]
)
def test_a_word_that_files_have_as_a_name_stays_one(
    others: list[tuple[str, str]], expected: bool
) -> None:
    """The best proposal reserves it, and enters it where such words are; else it does not."""
    kept = AddAlternative("name", "HOLD")
    texts = dict([*HOLDS, *others])
    found = survey_texts(list(texts.items()), GRAMMAR)
    clusters = cluster(found, text_of=lambda file: texts[file.digest])
    best = clusters.ranked[0].proposals[0]
    assert AddToken("HOLD") in best.edits
    assert expected == (kept in best.edits)
