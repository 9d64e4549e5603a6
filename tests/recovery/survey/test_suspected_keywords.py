"""A name that failing lines use as a keyword is shown as one."""

from collections.abc import Sequence

from recovery.survey.survey import survey_texts
from recovery.survey.suspected_keywords import SuspectedKeywords
from tests.recovery.survey.signed import (
    PRELIMINARY,
    RECOGNIZER,
    each,
    program,
    signature_texts,
    signatures,
)


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
    suspected = SuspectedKeywords(RECOGNIZER, failures)
    assert [((6, "STEP"),)] * 3 + [((2, "STEP"),)] == [
        suspected.of_line(failed, form) for _, failed, form in failures
    ]


def only_names(lines: Sequence[str], word: str) -> bool:
    """Whether the word is no keyword on any of the lines, one a file, and in no text."""
    texts = [(f"{n}.src", text) for n, text in enumerate(each(*lines))]
    found = survey_texts(texts, PRELIMINARY)
    failures = [(f.digest, x, found.forms[x.form]) for f in found.files for x in f.failures]
    suspected = SuspectedKeywords(RECOGNIZER, failures)
    meant = {said for _, failed, form in failures for _, said in suspected.of_line(failed, form)}
    return word not in meant and not any(word in t.split() for t in signature_texts(*each(*lines)))


def test_a_name_beside_its_type_is_no_keyword() -> None:
    """A declared name stands beside one neighbour, however many files declare it."""
    assert only_names(["DECL MYTYPE PART1 = 4", "DECL MYTYPE PART1 NEXT"] * 4, "PART1")
    assert only_names(["REAL_T SPEED"] * 9, "REAL_T")
    assert only_names(["REAL_T SPEED"] * 9, "SPEED")


def words_meant(*lines: str) -> set[str]:
    """The words that are taken for keywords on the lines, one a file."""
    texts = [(f"{n}.src", text) for n, text in enumerate(each(*lines))]
    found = survey_texts(texts, PRELIMINARY)
    failures = [(f.digest, x, found.forms[x.form]) for f in found.files for x in f.failures]
    suspected = SuspectedKeywords(RECOGNIZER, failures)
    return {said for _, failed, form in failures for _, said in suspected.of_line(failed, form)}


def test_a_word_too_many_explains_the_names_beside_it() -> None:
    """Of names in a row the one that most lines have is the keyword."""
    types = [f"GLOB {kind} {name}" for kind in ("T1", "T2") for name in ("A", "B", "C", "D")]
    assert {"GLOB"} == words_meant(*types)


def test_a_name_that_is_read_is_no_keyword() -> None:
    """A type is no keyword for standing beside many names, where the line fails behind them."""
    assert set() == words_meant(*(f"DECL T1 V{n}={{A {n}}}" for n in range(9)))


def test_a_name_that_a_line_could_do_without_is_a_keyword() -> None:
    """It stands where the keyword behind it could."""
    assert {"FIXED"} == words_meant(*(f"DECL FIXED {t} A" for t in ("INT", "REAL", "BOOL") * 3))
    assert set() == words_meant(*(f"LIN P{n} CONTINUE" for n in range(9)), *["LIN P CONTINUE"] * 9)


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


def test_a_word_that_alone_comes_behind_a_keyword_is_one() -> None:
    """`BRAKE F` in several files, and never another name there: F is meant as a keyword."""
    assert 4 * ["BRAKE … F"] == signature_texts(*each(*["BRAKE F"] * 4))
    assert only_names(["BRAKE F", "BRAKE G", "BRAKE H", "BRAKE I"], "F")
