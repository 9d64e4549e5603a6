"""For a line the grammar lacks, the edit a maintainer would make is among the first candidates."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import pytest

from grammar.notation.edits import Edit, RemoveAlternative, RemoveRule, apply
from grammar.notation.g4 import read, read_file
from grammar.notation.generate import GRAMMAR
from grammar.notation.model import Grammar
from grammar.parser.network import Network, is_left_recursive, network_of
from grammar.parser.recognizer import Recognizer
from recovery.proposals.candidates import Candidate, CandidateFinder, Line
from recovery.survey.survey import survey_texts

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


@cache
def grammar_of(name: str) -> Grammar:
    """A grammar without the construct."""
    return apply(PRELIMINARY, CONSTRUCTS[name].removed)


@cache
def candidates_of(name: str) -> list[Candidate]:
    """The candidates for the first failing line of an example."""
    return CandidateFinder(Recognizer(grammar_of(name))).find(failing_line(name))


def failing_line(name: str) -> Line:
    """The first failing line of an example."""
    missing = CONSTRUCTS[name]
    found = survey_texts([("a.src", missing.text)], grammar_of(name))
    failed = found.files[0].failures[0]
    meant = ((i, word) for i, word in enumerate(failed.words) if word in missing.keywords)
    return Line(found.forms[failed.form], tuple(meant))


@cache
def hopeful(name: str) -> list[tuple[Grammar, Network]]:
    """What the candidates that a search would try make of the grammar."""
    line, grammar = failing_line(name), grammar_of(name)
    found = CandidateFinder(Recognizer(grammar)).find_common([line], FIRST)
    grammars = (apply(grammar, candidate.edits) for candidate in found)
    return [(grammar, network_of(grammar)) for grammar in grammars]


@cache
def edited(name: str) -> list[tuple[Grammar, Network]]:
    """What each of the candidates makes of the grammar."""
    grammars = (apply(grammar_of(name), candidate.edits) for candidate in candidates_of(name))
    return [(grammar, network_of(grammar)) for grammar in grammars]


@pytest.mark.parametrize("name", CONSTRUCTS)
def test_the_right_edit_is_among_the_first(name: str) -> None:
    """One of the first candidates lets in what was meant, and nothing that was not."""
    missing = CONSTRUCTS[name]

    def is_right(grammar: Grammar, network: Network) -> bool:
        if is_left_recursive(network):
            return False
        accepts = Recognizer(grammar, network).accepts
        wanted = all(map(accepts, [missing.text, *missing.good]))
        return wanted and not any(map(accepts, missing.bad))

    assert any(is_right(*pair) for pair in hopeful(name))


@pytest.mark.parametrize("name", CONSTRUCTS)
def test_the_most_restrictive_come_first_and_each_once(name: str) -> None:
    """Candidates are ordered by how much they let in, and no two are the same edits."""
    found = candidates_of(name)
    assert sorted(c.breadth for c in found) == [c.breadth for c in found]
    assert len({c.edits for c in found}) == len(found)


@pytest.mark.parametrize("name", CONSTRUCTS)
def test_every_candidate_changes_the_grammar_into_another(name: str) -> None:
    """All can be applied, and what they make is a grammar that can be read back."""
    texts = [g.text for g, network in edited(name) if not is_left_recursive(network)]
    assert grammar_of(name).text not in texts
    sample = texts[:: max(1, len(texts) // 3)]
    assert sample == [read(text).text for text in sample]


def test_no_candidate_is_left_recursive() -> None:
    """What no recogniser could read is not proposed."""
    recursive = {
        name: [c.edits for c, (_, network) in pairs if is_left_recursive(network)]
        for name in CONSTRUCTS
        for pairs in [zip(candidates_of(name), edited(name), strict=True)]
    }
    assert {name: [] for name in CONSTRUCTS} == recursive


@pytest.mark.parametrize("name", CONSTRUCTS)
def test_words_are_reserved_by_the_candidates_that_use_them(name: str) -> None:
    """A candidate reserves words that the line means as keywords, and no others."""
    known = grammar_of(name).by_name.keys()
    reserved = {new for grammar, _ in edited(name) for new in grammar.by_name.keys() - known}
    assert set(CONSTRUCTS[name].keywords) == reserved


def test_the_same_line_has_the_same_candidates() -> None:
    """A finder that has seen other lines finds what a fresh one finds."""
    used = CandidateFinder(Recognizer(PRELIMINARY))
    for missing in list(CONSTRUCTS.values())[::3]:
        found = survey_texts([("a.src", missing.text)], PRELIMINARY)
        for form in found.forms:
            line = Line(form, ())
            assert CandidateFinder(Recognizer(PRELIMINARY)).find(line) == used.find(line)
