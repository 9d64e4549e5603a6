"""Causes are one when one edit mends what the edits of each mend."""

from collections.abc import Sequence
from dataclasses import replace

from grammar.notation.edits import AddAlternative, AddToken, Edit, Widen
from grammar.notation.g4 import read
from grammar.notation.model import Grammar
from grammar.parser.recognizer import Recognizer
from recovery.clustering.cause import Cause, Proposal
from recovery.clustering.joined_causes import (
    joined_by_edits,
    joined_by_reason,
)
from recovery.clustering.negative_score import NegativeCounter, Rivals, no_negatives
from recovery.clustering.search import CauseSearch
from recovery.proposals.edit_site import LinePattern
from recovery.survey.survey import survey_texts

GRAMMAR = read("""grammar S;
program : line* EOF ;
line : IF NAME '=' NAME NEWLINE | LIN NAME NEWLINE ;
IF : 'IF' ;
LIN : 'LIN' ;
EQUAL : '=' ;
LESS : '<' ;
MORE : '>' ;
NAME : [A-Z]+ ;
NEWLINE : '\\n' ;
SPACE : ' '+ -> skip ;
""")
# Two rules that a missing rule called, which had gathered those that nothing calls.
APART = read("""grammar S;
program : head* BODY NEWLINE line* EOF ;
head : IF NAME NEWLINE | LIN NAME NEWLINE ;
line : IF NAME NEWLINE | LIN NAME NEWLINE ;
halt : HALT NAME ;
wait : WAIT NAME ;
exit : EXIT NAME ;
BODY : 'BODY' ;
IF : 'IF' ;
LIN : 'LIN' ;
HALT : 'HALT' ;
WAIT : 'WAIT' ;
EXIT : 'EXIT' ;
NAME : [A-Z]+ ;
NEWLINE : '\\n' ;
SPACE : ' '+ -> skip ;
""")
LESS = Widen("line", (1, 3), "'<'")
MORE = Widen("line", (1, 3), "'>'")


def search_in(
    grammar: Grammar, texts: Sequence[str], count_negatives: NegativeCounter = no_negatives
) -> CauseSearch:
    """A search for the first failing line of each text."""
    found = survey_texts([(str(n), text) for n, text in enumerate(texts)], grammar)
    lines = [LinePattern(found.forms[file.failures[0].form], ()) for file in found.files]
    return CauseSearch(Recognizer(grammar), lines, [1] * len(lines), count_negatives)


def search(count_negatives: NegativeCounter = no_negatives) -> CauseSearch:
    """A search for four lines: two with a sign that is missing, two with another."""
    texts = [f"IF {name} {sign} B\n" for sign in "<>" for name in "AC"]
    return search_in(GRAMMAR, texts, count_negatives)


def gathering() -> tuple[CauseSearch, list[AddAlternative]]:
    """A search for five lines, with the alternative that mends each: three and two of one rule."""
    words = ["HALT", "WAIT", "EXIT"]
    texts = [f"{word} A\nBODY\n" for word in words] + [f"BODY\n{word} A\n" for word in words[:2]]
    called = [("head", word) for word in words] + [("line", word) for word in words[:2]]
    added = [AddAlternative(rule, f"{word.lower()} NEWLINE") for rule, word in called]
    return search_in(APART, texts), added


def apart(searched: CauseSearch) -> list[Cause]:
    """Each sign a cause of its own."""
    proposals = [searched.proposal((edit,), 0) for edit in (LESS, MORE)]
    assert [{0, 1}, {2, 3}] == [p.mended for p in proposals]
    return [Cause((0, 1), (proposals[0],)), Cause((2, 3), (proposals[1],))]


def mends_all(proposal: Proposal) -> bool:
    return {0, 1, 2, 3} == proposal.mended


def test_words_at_one_place_have_one_cause() -> None:
    """Two signs that are missing in one place become a choice of both, in place of the first."""
    searched = search()
    [one] = joined_by_edits(searched, apart(searched))
    assert (0, 1, 2, 3) == one.lines
    assert (Widen("line", (1, 3), "('<' | '>')"),) == one.proposals[0].edits
    assert mends_all(one.proposals[0])
    assert (LESS,) == one.proposals[1].edits


def test_causes_stay_apart_where_the_edit_for_both_lets_in_more() -> None:
    """An edit that costs negatives which neither cost is no reason to make two causes one."""

    def count_negatives(edits: Sequence[Edit], rivals: Rivals = ()) -> int:
        del rivals
        return any("'<'" in str(edit) and "'>'" in str(edit) for edit in edits)

    searched = search(count_negatives)
    causes = apart(searched)
    assert causes == joined_by_edits(searched, causes)


def test_a_cause_that_nothing_mends_is_left_as_it_is() -> None:
    """Without a proposal there is nothing to compare."""
    searched = search()
    hopeless = Cause((3,), ())
    first, _ = apart(searched)
    assert [first, hopeless] == joined_by_edits(searched, [first, hopeless])


def test_causes_of_one_reason_are_one() -> None:
    """They have the proposals of all, and what is found for all lines."""
    searched = search()
    causes = apart(searched)
    [one] = joined_by_reason(searched, causes, [("sign",)] * 4)
    assert (0, 1, 2, 3) == one.lines
    assert {(LESS,), (MORE,)} < {p.edits for p in one.proposals}
    assert mends_all(one.proposals[0])
    assert causes == joined_by_reason(searched, causes, [("<",), ("<",), (">",), (">",)])


def test_causes_that_need_the_same_word_are_one() -> None:
    """Unless lines of one of them fail at another new word, or most of them lack the word."""
    searched = search()
    searched.lines = [replace(line, keywords=((0, "WORD"),)) for line in searched.lines]
    new = AddToken("WORD")
    causes = [
        Cause(lines, (searched.proposal((new, edit), 0),))
        for lines, edit in (((0, 1), LESS), ((2, 3), MORE))
    ]
    [one] = joined_by_reason(searched, causes, [("<",), ("<",), ("word", "WORD"), (">",)])
    assert (0, 1, 2, 3) == one.lines
    assert causes == joined_by_reason(searched, causes, [("<",), ("<",), *[("word", "OTHER")] * 2])
    searched.lines = [*searched.lines[:2], *search().lines[2:]]
    assert causes == joined_by_reason(searched, causes, [("<",), ("<",), ("word", "WORD"), (">",)])


def test_causes_that_add_uncalled_rules_to_one_rule_are_one() -> None:
    """What had gathered these rules is missing."""
    searched, added = gathering()
    causes = [Cause((n,), (searched.proposal((edit,), 0),)) for n, edit in enumerate(added)]
    united = joined_by_reason(searched, causes, [(word,) for word in "abcde"])
    assert [(0, 1, 2), (3, 4)] == [cause.lines for cause in united]
