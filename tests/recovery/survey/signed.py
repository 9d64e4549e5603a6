"""The signatures of failing lines in programs."""

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
    suspected = SuspectedKeywords(RECOGNIZER, failures)
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
