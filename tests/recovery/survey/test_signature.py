"""A failing line has the signature that a person would see in it."""

from collections.abc import Sequence

import pytest

from grammar.notation.g4 import read_file
from grammar.notation.generate import GRAMMAR
from grammar.parser.failures import FailureFinder
from grammar.parser.recognizer import Recognizer
from recovery.survey.signature import Signature, signature_of
from recovery.survey.survey import survey_texts
from recovery.survey.suspected_keywords import SuspectedKeywords

PRELIMINARY = read_file(GRAMMAR.with_name("preliminary.g4"))
RECOGNIZER = Recognizer(PRELIMINARY)


def program(*lines: str) -> str:
    return "\n".join(["DEF A()", *lines, "END", ""])


def signatures(*programs: str) -> list[list[Signature]]:
    """The shapes of the failures of each program, all of them seen together."""
    found = survey_texts([(f"{n}.src", text) for n, text in enumerate(programs)], PRELIMINARY)
    finder = FailureFinder(RECOGNIZER)
    failures = [
        (file.digest, failed, found.forms[failed.form])
        for file in found.files
        for failed in file.failures
        if not failed.follows
    ]
    suspected = SuspectedKeywords(RECOGNIZER.lexer, failures)
    out: dict[str, list[Signature]] = {file.digest: [] for file in found.files}
    for digest, failed, form in failures:
        state, _ = RECOGNIZER.run(RECOGNIZER.restore(form.before), form.kinds[: form.index])
        meant = suspected.of_line(failed, form)
        out[digest].append(signature_of(RECOGNIZER.lexer, form, meant, finder.context(state)))
    return list(out.values())


def signature_texts(*programs: str) -> list[str]:
    """The text of the first failure of each program."""
    return [first.text for first, *_ in signatures(*programs)]


def each(*lines: str) -> list[str]:
    """A program of its own for each line."""
    return [program(line) for line in lines]


# --------------------------------------------------------------------------------- texts


@pytest.mark.parametrize(
    ("line", "text"),
    [
        ("DECL INT A,B", "DECL … ,"),
        ("X[1,2]=3", "… [ … ,"),
        ("X[,]=3", "… [ ,"),
        ("A=F(1)[2]", "… ["),
        ("A=1.B", "… ."),
        ("HALT 3", "HALT … INTEGER"),
        ("WAIT SEC", "WAIT … end of line"),
        ("IF A", "IF … end of line"),
        ("LIN P1 CONTINUE", "LIN … CONTINUE"),
        ("A B", "… name"),
        ("B?", "… unknown character"),
        ("A=(1,2)", "… ( … ,"),
        ("A=F(1)+X[2,3]", "… [ … ,"),
        ("A=F(X[2],3;", "… ( … end of line"),
        ("A={POS: X F(1)}", "… { … name"),
    ],
)
def test_text_is_the_word_the_line_begins_with_and_what_could_not_come(
    line: str, text: str
) -> None:
    """The keyword in front, the bracket that is open, and the token that failed."""
    assert [text] == signature_texts(program(line))


def test_a_program_cut_off_fails_at_the_end_of_the_file() -> None:
    """The end of the file is named as such."""
    assert ["… end of file"] == signature_texts("DEF A()\nHALT\n")


def test_shape_names_the_rule_at_work() -> None:
    """The rule is the innermost that cannot end where the line fails."""
    ((signature,),) = signatures(program("FOR I=1 STEP 2 TO 9"))
    assert ("forStatement", "FOR", "", "name") == (
        signature.rule,
        signature.lead,
        signature.bracket,
        signature.offender,
    )


def test_names_numbers_and_place_do_not_matter() -> None:
    """Lines that differ in names and numbers only have one shape, in whatever block they stand."""
    programs = [
        program("X[1,2]=3"),
        program("LOOP", "  POSITIONS[I,Jay]= K", "ENDLOOP"),
        program("HALT", "x [ 100 , 7 ] = 5 ; why not"),
    ]
    assert 1 == len({signature for found in signatures(*programs) for signature in found})


# -------------------------------------------------------------------- suspected keywords


def test_a_word_between_operands_of_many_kinds_is_a_keyword() -> None:
    """STEP stands beside numbers, names and terms in several files: it names the shape."""
    programs = each(
        "FOR I=1 TO 9 STEP 2",
        "FOR I=A TO B STEP K",
        "FOR J=1 TO F(2) STEP LARGE",
        "FOR J=9 TO 1 step -1",
    )
    assert 4 * ["FOR … STEP"] == signature_texts(*programs)


def test_a_word_before_many_operands_opens_its_line() -> None:
    """SWITCH in front of many selectors names its line alone."""
    programs = each("SWITCH X", "SWITCH MODE", "Switch COUNT+1", "SWITCH $MODE_OP")
    assert 4 * ["SWITCH …"] == signature_texts(*programs)


def test_a_word_alone_on_its_line_is_a_keyword() -> None:
    """A word that stands alone time and again, in several files, is no name."""
    programs = [program("ENDSPLINE", "A=1", "ENDSPLINE") for _ in range(4)]
    assert 4 * ["ENDSPLINE …"] == signature_texts(*programs)


def test_a_word_behind_many_names_is_a_keyword() -> None:
    """What counts is one side: PUBLIC follows names of all kinds and nothing follows it."""
    programs = [f"DEFDAT {name} PUBLIC\nENDDAT\n" for name in ("A", "B", "C1", "D_2")]
    assert 4 * ["DEFDAT … PUBLIC"] == signature_texts(*programs)


def test_keywords_in_the_middle_of_a_line_are_reported_with_their_places() -> None:
    """All suspected keywords of a line are found, not only the one it fails at."""
    lines = ("FOR I=1 TO 9 STEP 2", "FOR I=1 TO N STEP K", "FOR I=1 TO 4 STEP M", "HALT 1 STEP 3")
    texts = [(f"{n}.src", text) for n, text in enumerate(each(*lines))]
    found = survey_texts(texts, PRELIMINARY)
    failures = [(f.digest, f.failures[0], found.forms[f.failures[0].form]) for f in found.files]
    suspected = SuspectedKeywords(RECOGNIZER.lexer, failures)
    assert [((6, "STEP"),)] * 3 + [((2, "STEP"),)] == [
        suspected.of_line(failed, form) for _, failed, form in failures
    ]


def only_names(lines: Sequence[str], word: str) -> bool:
    """Whether the word is no keyword on any of the lines, one a file, and in no text."""
    texts = [(f"{n}.src", text) for n, text in enumerate(each(*lines))]
    found = survey_texts(texts, PRELIMINARY)
    failures = [(f.digest, x, found.forms[x.form]) for f in found.files for x in f.failures]
    suspected = SuspectedKeywords(RECOGNIZER.lexer, failures)
    meant = {said for _, failed, form in failures for _, said in suspected.of_line(failed, form)}
    return word not in meant and not any(word in t.split() for t in signature_texts(*each(*lines)))


def test_a_name_beside_its_type_is_no_keyword() -> None:
    """A declared name stands beside one neighbour, however many files declare it."""
    assert only_names(["DECL MYTYPE PART1 = 4", "DECL MYTYPE PART1 NEXT"] * 4, "PART1")
    assert only_names(["REAL_T SPEED"] * 9, "REAL_T")
    assert only_names(["REAL_T SPEED"] * 9, "SPEED")


def test_a_word_of_one_file_is_no_keyword() -> None:
    """Whoever repeats a word in one program only may have called something so."""
    ((first, *_),) = signatures(program(*(f"GLUE {name}" for name in "BCDEFGHIJ")))
    assert "… name" == first.text


def test_a_word_that_is_used_as_a_name_too_is_none() -> None:
    """A word that stands where names stand as often as elsewhere is a name."""
    lines = [line for n in "BCDEFGH" for line in (f"COUNT {n}", f"COUNT=1 {n}", f"{n}[COUNT,1]=2")]
    assert only_names(lines, "COUNT")


def test_a_system_variable_is_no_keyword() -> None:
    """No keyword of KRL begins with a dollar sign."""
    assert only_names([f"$ADVANCE {name}" for name in "BCDEFGHIJ"], "$ADVANCE")


def test_components_are_no_keywords() -> None:
    """In braces a name stands beside its value: that does not make it a keyword."""
    lines = [f"PTP {{A1 {value},A2 {value}}}" for value in ("1", "B", "C", "D", "-E", "2.5")]
    assert only_names(lines, "A1")
    assert only_names(lines, "A2")


def test_the_order_of_files_does_not_matter() -> None:
    """What is learnt from all files together is the same in any order of them."""
    programs = each(
        *(f"FOR I=1 TO 9 STEP {n}" for n in "ABCD"),
        *(f"SWITCH {n}" for n in "XYZ"),
        "A B",
        "SWITCH=1 2",
    )
    assert signature_texts(*programs) == signature_texts(*programs[::-1])[::-1]


def test_what_comes_right_behind_a_bracket_is_a_text_of_its_own_but_no_shape() -> None:
    """A dimension left out has another text; whether one edit mends both is not yet known."""
    ((one,), (other,)) = signatures(*each("X[1,2]=3", "X[,]=3"))
    assert ("… [ … ,", "… [ ,") == (one.text, other.text)
    assert one == other


def test_a_word_that_alone_comes_behind_a_keyword_is_one() -> None:
    """`BRAKE F` in several files, and never another name there: F is meant as a keyword."""
    assert 4 * ["BRAKE … F"] == signature_texts(*each(*["BRAKE F"] * 4))
    assert only_names(["BRAKE F", "BRAKE G", "BRAKE H", "BRAKE I"], "F")
