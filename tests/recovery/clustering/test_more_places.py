"""An edit is made in all places where the lines of its cause need it."""

from grammar.notation.edits import AddAlternative, Insert, MakeOptional
from grammar.notation.g4 import read
from recovery.clustering.cause import Cause
from recovery.clustering.completion import with_more_places
from recovery.clustering.negative_score import NegativeCounter, no_negatives
from recovery.clustering.search import CauseSearch
from tests.recovery.clustering.test_joined_causes import search_in

GRAMMAR = read("""grammar S;
program : head* BODY NEWLINE line* EOF ;
head : DECL INT NAME NEWLINE ;
line : DECL INT NAME NEWLINE | LIN NAME NEWLINE ;
BODY : 'BODY' ;
DECL : 'DECL' ;
INT : 'INT' ;
LIN : 'LIN' ;
NAME : [A-Z]+ ;
NEWLINE : '\\n' ;
SPACE : ' '+ -> skip ;
""")
HEAD, LINE = (MakeOptional(rule, (1, 1), 1) for rule in ("head", "line"))


def search(count_negatives: NegativeCounter = no_negatives) -> CauseSearch:
    """A search for two lines that lack a word in different rules."""
    return search_in(GRAMMAR, ["INT A\nBODY\n", "BODY\nINT A\n"], count_negatives)


def test_a_word_may_be_left_out_in_both_rules() -> None:
    """The edit of one rule is extended by the same edit of the other."""
    searched = search()
    cause = Cause((0, 1), (searched.proposal((HEAD,), 0),))
    [both] = with_more_places(searched, cause).proposals
    assert {HEAD, LINE} == {*both.edits}
    assert {0, 1} == both.mended


def test_a_different_edit_is_another_matter() -> None:
    """Only the same text is added in further places."""
    searched = search()
    other = searched.proposal((AddAlternative("head", "INT NAME NEWLINE"),), 0)
    [only] = with_more_places(searched, Cause((0, 1), (other,))).proposals
    assert {AddAlternative(rule, "INT NAME NEWLINE") for rule in ("head", "line")} == {*only.edits}
    strange = searched.proposal((Insert("head", (1, 1), "INT?"),), 0)
    [same] = with_more_places(searched, Cause((0, 1), (strange,))).proposals
    assert strange == same


def test_no_more_negatives_are_accepted() -> None:
    """A place that costs negatives is left out."""
    searched = search(lambda edits, _rivals=(): len(edits) > 1)
    cause = Cause((0, 1), (searched.proposal((HEAD,), 0),))
    assert cause == with_more_places(searched, cause)
