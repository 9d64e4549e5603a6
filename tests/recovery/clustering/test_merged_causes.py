"""Causes are one when one edit mends what the edits of each mend."""

from collections.abc import Sequence

from grammar.notation.edits import AddAlternative, AddToken, Edit, Widen
from grammar.notation.g4 import read
from grammar.notation.model import Grammar
from grammar.parser.recognizer import Recognizer
from recovery.clustering.cause import Cause, NegativeCounter, Proposal, no_negatives
from recovery.clustering.causes import merged_by_edits, merged_by_first_word, merged_by_reason
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
    [one] = merged_by_edits(searched, apart(searched))
    assert (0, 1, 2, 3) == one.lines
    assert (Widen("line", (1, 3), "('<' | '>')"),) == one.proposals[0].edits
    assert mends_all(one.proposals[0])
    assert (LESS,) == one.proposals[1].edits


def test_lines_that_begin_alike_are_searched_together() -> None:
    """What mends all of them is found though each cause had an edit of its own."""
    searched = search()
    [one] = merged_by_first_word(searched, apart(searched))
    assert (0, 1, 2, 3) == one.lines
    assert mends_all(one.proposals[0])


def test_causes_stay_apart_where_the_edit_for_both_lets_in_more() -> None:
    """An edit that costs negatives which neither cost is no reason to make two causes one."""

    def count_negatives(edits: Sequence[Edit]) -> int:
        return any("'<'" in str(edit) and "'>'" in str(edit) for edit in edits)

    searched = search(count_negatives)
    causes = apart(searched)
    assert causes == merged_by_edits(searched, causes)


def test_a_cause_that_nothing_mends_is_left_as_it_is() -> None:
    """Without a proposal there is nothing to compare."""
    searched = search()
    hopeless = Cause((3,), ())
    first, _ = apart(searched)
    assert [first, hopeless] == merged_by_edits(searched, [first, hopeless])
    assert [first, hopeless] == merged_by_first_word(searched, [first, hopeless])


def test_causes_of_one_reason_are_one() -> None:
    """Lines that fail for one reason stay together, with the proposals of all that mends any."""
    searched = search()
    causes = apart(searched)
    [one] = merged_by_reason(searched, causes, [("sign",)] * 4)
    assert ((0, 1, 2, 3), {LESS, MORE}) == (one.lines, {p.edits[0] for p in one.proposals})
    assert causes == merged_by_reason(searched, causes, [("<",), ("<",), (">",), (">",)])


def test_causes_that_need_the_same_word_are_one() -> None:
    """Unless lines of one of them fail at another new word."""
    searched = search()
    new = AddToken("WORD")
    causes = [
        Cause(lines, (searched.proposal((new, edit), 0),))
        for lines, edit in (((0, 1), LESS), ((2, 3), MORE))
    ]
    [one] = merged_by_reason(searched, causes, [("<",), ("<",), ("word", "WORD"), (">",)])
    assert (0, 1, 2, 3) == one.lines
    assert causes == merged_by_reason(searched, causes, [("<",), ("<",), *[("word", "OTHER")] * 2])


def test_the_alternatives_of_a_missing_rule_are_one_proposal() -> None:
    """The first proposal of causes of one reason repairs all their lines."""
    searched = search()
    alternatives = [AddAlternative("line", f"IF NAME '{sign}' NAME NEWLINE") for sign in "<>"]
    less, more = (searched.proposal((edit,), 0) for edit in alternatives)
    [one] = merged_by_reason(
        searched, [Cause((0, 1), (less,)), Cause((2, 3), (more,))], [("sign",)] * 4
    )
    assert set(alternatives) == set(one.proposals[0].edits)
    assert mends_all(one.proposals[0])
    assert {less, more} == {*one.proposals[1:]}


def test_what_is_gathered_accepts_no_more_negatives() -> None:
    """An alternative that costs negatives beside the others is left out."""

    def count_negatives(edits: Sequence[Edit]) -> int:
        return any("'<'" in str(edit) for edit in edits) and "'>'" in str(edits)

    searched = search(count_negatives)
    alternatives = [AddAlternative("line", f"IF NAME '{sign}' NAME NEWLINE") for sign in "<>"]
    less, more = (searched.proposal((edit,), 0) for edit in alternatives)
    causes = [Cause((0, 1), (less,)), Cause((2, 3), (more,))]
    [one] = merged_by_reason(searched, causes, [("sign",)] * 4)
    assert {less, more} == {*one.proposals}


def test_lines_left_get_an_alternative_of_the_same_rule() -> None:
    """What is missing in one rule is sought there, whatever mends the lines by themselves."""
    searched = search()
    alternative = AddAlternative("line", "IF NAME '<' NAME NEWLINE")
    less = searched.proposal((alternative,), 0)
    causes = [Cause((0, 1), (less,)), Cause((2, 3), (searched.proposal((MORE,), 0),))]
    [one] = merged_by_reason(searched, causes, [("sign",)] * 4)
    first = one.proposals[0]
    assert mends_all(first)
    assert all(isinstance(e, AddAlternative) and e.rule == "line" for e in first.edits)


def test_what_is_missing_in_two_rules_is_one_rule() -> None:
    """Each gets what only the other one shows; causes that add uncalled rules to one are one."""
    words = ["HALT", "WAIT", "EXIT"]
    texts = [f"{word} A\nBODY\n" for word in words] + [f"BODY\n{word} A\n" for word in words[:2]]
    searched = search_in(APART, texts)
    rules = ["head", "head", "head", "line", "line"]
    names = ["halt", "wait", "exit", "halt", "wait"]
    added = [
        AddAlternative(rule, f"{name} NEWLINE") for rule, name in zip(rules, names, strict=True)
    ]
    causes = [Cause((n,), (searched.proposal((edit,), 0),)) for n, edit in enumerate(added)]
    assert [frozenset({n}) for n in range(5)] == [c.proposals[0].mended for c in causes]
    [one] = merged_by_reason(searched, causes, [("word",)] * 5)
    assert {*added, AddAlternative("line", "exit NEWLINE")} == set(one.proposals[0].edits)
    united = merged_by_reason(searched, causes, [(word,) for word in "abcde"])
    assert [(0, 1, 2), (3, 4)] == [cause.lines for cause in united]
