"""The reason of a failing line is the same wherever in a program the line stands."""

import pytest

from grammar.notation.edits import Edit, RemoveAlternative, RemoveElement, apply
from grammar.notation.g4 import read_file
from grammar.notation.generate import GRAMMAR
from grammar.notation.model import Grammar
from grammar.parser.failures import FailureFinder
from grammar.parser.recognizer import Recognizer
from recovery.clustering.reason import Reason, ReasonFinder
from recovery.proposals.edit_site import LinePattern
from recovery.survey.signature import signature_of
from recovery.survey.survey import survey_texts
from recovery.survey.suspected_keywords import SuspectedKeywords

_START = read_file(GRAMMAR.with_name("preliminary.g4"))


def reasons(*texts: str, without: tuple[Edit, ...] = (), start: Grammar = _START) -> list[Reason]:
    """The reason of the first failure of each program."""
    grammar = apply(start, without)
    recognizer = Recognizer(grammar)
    found = survey_texts([(f"{n}.src", text) for n, text in enumerate(texts)], grammar)
    failed = [(file.digest, file.failures[0]) for file in found.files]
    suspected = SuspectedKeywords(
        recognizer, [(digest, line, found.forms[line.form]) for digest, line in failed]
    )
    reason, finder = ReasonFinder(recognizer).reason, FailureFinder(recognizer)
    out = []
    for _, line in failed:
        form = found.forms[line.form]
        before = recognizer.restore(form.before)
        state = recognizer.run(before, form.kinds[: form.index])[0]
        context = finder.context(state)
        pattern = LinePattern(form, suspected.of_line(line, form))
        signature = signature_of(recognizer.lexer, form, pattern.keywords, context)
        out.append(reason(pattern, signature, context))
    return out


def routine(*lines: str) -> str:
    return "\n".join(("DEF A()", *lines, "END", ""))


@pytest.mark.parametrize(
    "texts",
    [
        (
            routine("INT N"),
            routine("REAL X"),
            routine("X=1", "BOOL B"),
            "DEFDAT A\nINT N\nENDDAT\n",
        ),
        (routine("X=SEC"), routine("F(DELAY)"), routine("IF DISTANCE THEN", "ENDIF")),
        (routine("X[]=1"), routine("LIN P[]"), routine("F(A[])")),
        (routine("RETURN X"), routine("RETURN 1"), routine("RETURN (X)")),
        (routine("X=+1"), routine("IF +X>1 THEN", "ENDIF")),
    ],
)
def test_one_lack_has_one_reason(texts: tuple[str, ...]) -> None:
    """In a statement, a block, a call and a data list, and with each word of a kind."""
    assert 1 == len(set(reasons(*texts)))


@pytest.mark.parametrize(
    "texts",
    [
        (routine("X=SEC"), routine("INT N")),
        (routine("X[]=1"), routine("X[1,2]=1"), routine("F(A[1],)")),
        (routine("RETURN X"), routine("HALT X"), routine("FOR I=1 TO 2 X", "ENDFOR")),
    ],
)
def test_what_is_lacking_distinguishes_reasons(texts: tuple[str, ...]) -> None:
    """A word as a name is none too many; signs, brackets and first words make a difference."""
    assert len(texts) == len(set(reasons(*texts)))


def test_signs_that_no_rule_reads_are_one_reason() -> None:
    """Whatever the sign, and wherever it stands: a level of operators is missing."""
    texts = routine("X=A*B"), routine("X=A/B"), routine("X[1]=F((A/B))")
    assert 1 == len(set(reasons(*texts, without=(RemoveElement("product", (1, 2)),))))


def test_values_where_a_name_may_be_are_one_reason() -> None:
    """A rule of values is missing, though others read some of them."""
    texts = routine("X=1"), routine("X=2.5"), routine('X="A"')
    assert {("value",)} == set(reasons(*texts, without=(RemoveAlternative("primary", 1),)))


def test_a_word_that_only_lists_have_is_one_reason() -> None:
    """Whatever stands before it: its construct is missing."""
    texts = [routine(f"{before}SIGNAL A X") for before in ("", "DECL ", "GLOBAL ")]
    without = (RemoveAlternative("definition", 3),)
    assert 1 == len(set(reasons(*texts, without=without, start=read_file(GRAMMAR))))


def test_a_new_word_is_the_reason() -> None:
    """A name that several files have as a keyword, at the head of a line or within."""
    heads = [routine(f"SIGNAL {name} X{n}") for n, name in enumerate(("A", "B", "C"))]
    assert {("word", "SIGNAL")} == set(reasons(*heads))
