"""The reason of a failing line is the same wherever in a program the line stands."""

import pytest

from grammar.notation.g4 import read_file
from grammar.notation.generate import GRAMMAR
from grammar.parser.failures import FailureFinder
from grammar.parser.recognizer import Recognizer
from recovery.clustering.reason import Reason, ReasonFinder
from recovery.proposals.edit_site import LinePattern
from recovery.survey.signature import signature_of
from recovery.survey.survey import survey_texts
from recovery.survey.suspected_keywords import SuspectedKeywords

_START = read_file(GRAMMAR.with_name("preliminary.g4"))
_RECOGNIZER = Recognizer(_START)


def reasons(*texts: str) -> list[Reason]:
    """The reason of the first failure of each program."""
    found = survey_texts([(f"{n}.src", text) for n, text in enumerate(texts)], _START)
    failed = [(file.digest, file.failures[0]) for file in found.files]
    suspected = SuspectedKeywords(
        _RECOGNIZER.lexer, [(digest, line, found.forms[line.form]) for digest, line in failed]
    )
    reason, finder = ReasonFinder(_RECOGNIZER).reason, FailureFinder(_RECOGNIZER)
    out = []
    for _, line in failed:
        form = found.forms[line.form]
        before = _RECOGNIZER.restore(form.before)
        state = _RECOGNIZER.run(before, form.kinds[: form.index])[0]
        context = finder.context(state)
        pattern = LinePattern(form, suspected.of_line(line, form))
        signature = signature_of(_RECOGNIZER.lexer, form, pattern.keywords, context)
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


def test_a_new_word_is_the_reason() -> None:
    """A name that several files have as a keyword, at the head of a line or within."""
    heads = [routine(f"SIGNAL {name} X{n}") for n, name in enumerate(("A", "B", "C"))]
    assert {("word", "SIGNAL")} == set(reasons(*heads))
