"""For a line the grammar lacks, the edit a maintainer would make is among the first candidates."""

from collections.abc import Sequence
from dataclasses import dataclass

import pytest

from grammar.notation.edits import Edit, RemoveAlternative, RemoveElement, RemoveRule, apply
from grammar.notation.g4 import read, read_file
from grammar.notation.generate import GRAMMAR
from grammar.notation.model import Grammar
from grammar.parser.network import Network, is_left_recursive, network_of
from grammar.parser.recognizer import Recognizer
from recovery.proposals.candidates import Candidate, CandidateFinder
from recovery.proposals.edit_site import LinePattern
from recovery.survey.survey import survey_texts
from recovery.tuning import MOST_TRIED

PRELIMINARY = read_file(GRAMMAR.with_name("preliminary.g4"))
#: So many candidates are worth the time it takes to try them.
FIRST = 90


def program(*lines: str) -> str:
    return "\n".join(["DEF A()", *lines, "END", ""])


def data(*lines: str) -> str:
    return "\n".join(["DEFDAT A", *lines, "ENDDAT", ""])


@dataclass(frozen=True)
class Missing:
    """A construct the grammar lacks.

    ``text`` fails for want of it, at a line where the words ``keywords`` are meant as such. The
    right edit accepts ``text`` and ``good`` and still rejects ``bad``.
    """

    text: str
    good: Sequence[str]
    bad: Sequence[str]
    keywords: Sequence[str] = ()
    removed: Sequence[Edit] = ()  # what takes it out of a grammar that has it


CONSTRUCTS = {
    "step of a loop": Missing(
        program("FOR I=1 TO 9 STEP 2", "ENDFOR"),
        [program("FOR I=1 TO 9 STEP 5", "A=1", "ENDFOR"), program("FOR I=1 TO 9", "ENDFOR")],
        [
            program("FOR I=1 STEP 2 TO 9", "ENDFOR"),
            program("FOR I=1 TO 9 STEP", "ENDFOR"),
            program("IF A STEP 2 THEN", "ENDIF"),
            program("A=1 STEP 2"),
        ],
        ["STEP"],
    ),
    "public data list": Missing(
        "DEFDAT A PUBLIC\nENDDAT\n",
        [data()],
        ["DEFDAT A PUBLIC PUBLIC\nENDDAT\n", "DEFDAT PUBLIC A\nENDDAT\n", program("A=1 PUBLIC")],
        ["PUBLIC"],
    ),
    "list of names": Missing(
        program("DECL INT A,B"),
        [program("DECL INT A,B,C"), program("DECL REAL A")],
        [program("DECL INT A B"), program("DECL INT A,"), program("A,B=3")],
    ),
    "two indices": Missing(
        program("X[1,2]=3"),
        [program("X[I,J+1]=3"), program("A=X[1,2]"), program("X[1]=3")],
        [program("X[]=3"), program("X[1 2]=3"), program("A=1,2")],
    ),
    "index left out": Missing(
        program('X[]="A"'),
        [program("X[]=Y"), program("X[1]=3")],
        [program("X[,]=3"), program('X="A" 3')],
    ),
    "array declared": Missing(
        program("DECL INT A[3]"),
        [program("DECL INT A[9]"), program("DECL INT A")],
        [program("DECL INT A[]"), program("DECL INT A[1][2]"), program("DECL INT [3]")],
    ),
    "declared without DECL": Missing(
        program("INT A"),
        [program("REAL B"), program("DECL INT B")],
        [program("DECL B"), program("INT"), program("INT A B")],
    ),
    "data without DECL": Missing(
        data("INT A=1"), [data("REAL B=-2.5"), data("DECL INT A=1")], [data("INT A"), data("INT=1")]
    ),
    "global interrupt": Missing(
        program("GLOBAL INTERRUPT DECL 3 WHEN A DO B()"),
        [
            program("A=1", "GLOBAL INTERRUPT DECL 9 WHEN $IN[2]==TRUE DO BRAKE"),
            program("INTERRUPT DECL 3 WHEN A DO B()"),
        ],
        [program("GLOBAL A=1"), program("GLOBAL"), program("A=GLOBAL")],
        ["GLOBAL"],
    ),
    "global routine": Missing(
        "GLOBAL DEF A()\nEND\n",
        ["DEF A()\nEND\nGLOBAL DEF B()\nEND\n"],
        ["GLOBAL\nDEF A()\nEND\n", program("GLOBAL")],
        ["GLOBAL"],
    ),
    "parameter": Missing(
        "DEF A(B)\nEND\n", [program(), "DEF A(C)\nHALT\nEND\n"], ["DEF A(1)\nEND\n"]
    ),
    "untyped aggregate": Missing(
        program("PTP {A1 1,A2 2}"),
        [program("PTP {A1 1}"), program("A={X 1,Y 2}"), program("PTP {AXIS: A1 1}")],
        [program("PTP {AXIS A1 1}"), program("PTP {: A1 1}"), program("PTP {}")],
    ),
    "value returned": Missing(
        program("RETURN 1"),
        [program("RETURN A+1"), program("RETURN")],
        [program("RETURN 1 2"), program("RETURN ,"), program("A=1 2"), program("HALT 1")],
    ),
    "operator": Missing(
        program("A=B EXOR C"),
        [program("A=D EXOR E"), program("IF (B EXOR C) THEN", "ENDIF")],
        [program("A=EXOR C"), program("A=B EXOR"), program("B EXOR C"), program("EXOR=1")],
        ["EXOR"],
    ),
    "level of operators": Missing(
        program("A=B*C/D*2"),
        [program("A=D/E"), program("A=B*C+D/E"), program("IF (B*C)>D THEN", "ENDIF")],
        [program("A=*C"), program("A=B*"), program("A=B*/C"), program("B*C=1")],
        removed=[RemoveElement("product", (1, 2))],
    ),
    "statement of a new word": Missing(
        program("SIGNAL A $IN[1]"),
        [program("HALT", "SIGNAL B $OUT[3]")],
        [program("SIGNAL"), program("A=SIGNAL"), program("SIGNAL=1")],
        ["SIGNAL"],
    ),
    "blending of a wait": Missing(
        program("WAIT FOR $IN[1] C_X"),
        [program("WAIT FOR A C_X"), program("WAIT FOR A")],
        [program("WAIT C_X FOR A"), program("IF A C_X THEN", "ENDIF")],
        ["C_X"],
    ),
    "word taken away": Missing(
        program("LOOP", "EXIT", "ENDLOOP"),
        [program("EXIT")],
        [program("EXIT 3"), program("A=EXIT"), program("EXIT=1")],
        ["EXIT"],
        [RemoveAlternative("simpleStatement", 8), RemoveRule("exit"), RemoveRule("EXIT")],
    ),
    "block out of place": Missing(
        program("LOOP", "A=1", "ENDLOOP"),
        [program("IF A THEN", "LOOP", "LOOP", "ENDLOOP", "ENDLOOP", "ENDIF"), program("A=1")],
        [program("LOOP"), program("ENDLOOP"), program("LOOP 3", "ENDLOOP")],
        removed=[RemoveAlternative("statement", 6)],
    ),
}


@dataclass(frozen=True)
class Example:
    """A construct, the grammar without it, and what each candidate for it makes of that."""

    missing: Missing
    grammar: Grammar
    line: LinePattern
    candidates: list[Candidate]
    edited: list[tuple[Grammar, Network]]


def edited(grammar: Grammar, candidate: Candidate) -> tuple[Grammar, Network]:
    made = apply(grammar, candidate.edits)
    return made, network_of(made)


@pytest.fixture(scope="module", params=CONSTRUCTS)
def example(request: pytest.FixtureRequest) -> Example:
    """The first failing line of a construct, with all candidates for it."""
    missing = CONSTRUCTS[request.param]
    grammar = apply(PRELIMINARY, missing.removed)
    found = survey_texts([("a.src", missing.text)], grammar)
    failed = found.files[0].failures[0]
    meant = ((i, word) for i, word in enumerate(failed.words) if word in missing.keywords)
    line = LinePattern(found.forms[failed.form], tuple(meant))
    candidates = CandidateFinder(Recognizer(grammar)).find_common([line], MOST_TRIED)
    return Example(missing, grammar, line, candidates, [edited(grammar, one) for one in candidates])


def test_the_right_edit_is_among_the_first(example: Example) -> None:
    """One of the first candidates accepts what was meant, and nothing that was not."""
    missing, grammar = example.missing, example.grammar

    def is_right(candidate: Candidate) -> bool:
        changed, network = edited(grammar, candidate)
        if is_left_recursive(network):
            return False
        accepts = Recognizer(changed, network).accepts
        wanted = all(map(accepts, [missing.text, *missing.good]))
        return wanted and not any(map(accepts, missing.bad))

    first = CandidateFinder(Recognizer(grammar)).find_common([example.line], FIRST)
    assert any(map(is_right, first))


def test_each_candidate_comes_once(example: Example) -> None:
    """No two candidates are the same edits."""
    found = [candidate.edits for candidate in example.candidates]
    assert len(set(found)) == len(found)


def test_every_candidate_changes_the_grammar_into_another(example: Example) -> None:
    """All can be applied, and what is not left-recursive is a grammar that can be read back."""
    texts = [text.text for text, network in example.edited if not is_left_recursive(network)]
    assert example.grammar.text not in texts
    sample = texts[:: max(1, len(texts) // 3)]
    assert sample == [read(text).text for text in sample]


def test_words_are_reserved_by_the_candidates_that_use_them(example: Example) -> None:
    """A candidate reserves words that the line means as keywords, and no others."""
    known = example.grammar.by_name.keys()
    reserved = {new for grammar, _ in example.edited for new in grammar.by_name.keys() - known}
    assert set(example.missing.keywords) == reserved


def test_the_same_line_has_the_same_candidates() -> None:
    """A finder that has seen other lines finds what a fresh one finds."""
    used = CandidateFinder(Recognizer(PRELIMINARY))
    for missing in list(CONSTRUCTS.values())[::3]:
        found = survey_texts([("a.src", missing.text)], PRELIMINARY)
        for form in found.forms:
            line = LinePattern(form, ())
            fresh = CandidateFinder(Recognizer(PRELIMINARY)).find_common([line], MOST_TRIED)
            assert fresh == used.find_common([line], MOST_TRIED)
