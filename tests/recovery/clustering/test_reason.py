"""The reason of a failing line is the same wherever in a program the line stands."""

import pytest

from grammar.notation.g4 import read_file
from grammar.notation.generate import GRAMMAR
from grammar.parser.failures import FailureFinder
from grammar.parser.recognizer import Recognizer
from recovery.clustering.reason import Reason, ReasonFinder
from recovery.proposals.edit_site import LinePattern
from recovery.survey.signature import SignatureBuilder
from recovery.survey.survey import survey_texts

_START = read_file(GRAMMAR.with_name("preliminary.g4"))
_RECOGNIZER = Recognizer(_START)


def reasons(*texts: str) -> list[Reason]:
    """The reason of the first failure of each program."""
    found = survey_texts([(f"{n}.src", text) for n, text in enumerate(texts)], _START)
    failed = [(file.digest, file.failures[0]) for file in found.files]
    builder = SignatureBuilder(
        _RECOGNIZER.lexer, [(digest, line, found.forms[line.form]) for digest, line in failed]
    )
    learnt = ((line, found.forms[line.form]) for _, line in failed)
    reason, finder = ReasonFinder(_RECOGNIZER, learnt).reason, FailureFinder(_RECOGNIZER)
    out = []
    for _, line in failed:
        form = found.forms[line.form]
        before = _RECOGNIZER.restore(form.before)
        state = _RECOGNIZER.run(before, form.kinds[: form.index])[0]
        context = finder.context(state)
        pattern = LinePattern(form, builder.keywords(line, form))
        out.append(reason(pattern, builder.signature(line, form, context), context))
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
        (routine("F({X 1})"), routine("F({X #A})"), routine("F({X TRUE})")),
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
def test_what_is_lacking_tells_reasons_apart(texts: tuple[str, ...]) -> None:
    """A word as a name is none too many; signs, brackets and first words make a difference."""
    assert len(texts) == len(set(reasons(*texts)))


def test_a_new_word_is_the_reason() -> None:
    """A name that several files have as a keyword; made of a keyword, what it has besides."""
    assert {("word", "SIGNAL")} == led_by("SIGNAL")
    assert led_by("SLIN") == led_by("SPTP") != led_by("LIN_REL") == led_by("PTP_REL")


def led_by(word: str) -> set[Reason]:
    return set(reasons(*(routine(f"{word} {name} X{n}") for n, name in enumerate("ABC"))))


def test_a_type_that_leads_a_line_lacks_its_keyword() -> None:
    """A word is no new one where it stands behind that keyword elsewhere."""
    bare = [f"DEFDAT A\nFRAME {name}\nENDDAT\n" for name in "ABC"]
    declared = "DEFDAT A\nDECL FRAME X={X 1}\nENDDAT\n"
    assert [("without", "DECL")] * 3 == reasons(*bare, declared)[:3]
