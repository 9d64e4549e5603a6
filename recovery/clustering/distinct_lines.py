"""The distinct failing lines of a survey: where each occurs, and why it fails."""

from __future__ import annotations

from array import array
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial

from grammar.parser.failures import FailureContext, FailureFinder, Form
from grammar.parser.recognizer import Recognizer
from recovery.clustering.file_trial import FailingFile
from recovery.clustering.reason import ReasonFinder
from recovery.proposals.edit_site import LinePattern
from recovery.survey.failing_line import FailingLine
from recovery.survey.signature import Signature, signature_of
from recovery.survey.survey import Survey
from recovery.survey.surveyed_files import SurveyedFile
from recovery.survey.suspected_keywords import SuspectedKeywords


@dataclass(frozen=True, slots=True)
class Member:
    """A failure with its file."""

    file: SurveyedFile
    failed: FailingLine


class _DirectFailures(Iterable[tuple[str, FailingLine, Form]]):
    """The failures of a survey that follow from no other, with digest and form, read each time."""

    def __init__(self, found: Survey) -> None:
        self._found = found

    def __iter__(self) -> Iterator[tuple[str, FailingLine, Form]]:
        for file in self._found.failing:
            for failed in file.failures:
                if not failed.follows:
                    yield file.digest, failed, self._found.forms[failed.form]


class DistinctLines:
    """The distinct failing lines of a survey, numbered as they are met.

    ``lines_of`` has the numbers of the failing lines of each file, by its digest; ``specimens`` the
    shortest occurrence of each line, ``weights`` in how many files it is, ``reasons`` why it fails.
    ``by_signature`` are the lines with the same signature, the heaviest first. ``contexts`` are
    those of the survey's forms.
    """

    #: Stands for the number of the line of a failure that only follows from another.
    FOLLOWS = -1

    def __init__(self, found: Survey) -> None:
        self.recognizer = Recognizer(found.grammar)
        finder = FailureFinder(self.recognizer)
        self.contexts = [self._context(finder, form) for form in found.forms]
        self._suspected = SuspectedKeywords(self.recognizer, _DirectFailures(found))
        self._numbers: dict[LinePattern, int] = {}
        self.signatures: list[Signature] = []
        self.specimens: list[Member] = []
        self.weights: list[int] = []
        self.lines_of: dict[str, array[int]] = {}
        self._at: dict[str, array[int]] = {}
        for file in found.failing:
            self._add(file, found.forms)
        self.lines = tuple(self._numbers)
        reasons = ReasonFinder(self.recognizer)
        self.reasons = [
            reasons.reason(line, signature, self.contexts[place.failed.form])
            for line, signature, place in zip(
                self.lines, self.signatures, self.specimens, strict=True
            )
        ]
        alike: dict[Signature, list[int]] = defaultdict(list)
        for number, signature in enumerate(self.signatures):
            alike[signature].append(number)
        self.by_signature = sorted(
            alike.values(), key=lambda group: (-sum(self.weights[n] for n in group), group)
        )

    def _context(self, finder: FailureFinder, form: Form) -> FailureContext:
        before = self.recognizer.restore(form.before)
        return finder.context(self.recognizer.run(before, form.kinds[: form.index])[0])

    def _add(self, file: SurveyedFile, forms: Sequence[Form]) -> None:
        own = self.lines_of[file.digest] = array("l")
        at = self._at[file.digest] = array("l")
        for failed in file.failures:
            if failed.follows:
                own.append(self.FOLLOWS)
            else:
                own.append(self._number(Member(file, failed), forms[failed.form]))
                at.append(failed.line)
        for number in set(own) - {self.FOLLOWS}:
            self.weights[number] += len(file.places)

    def _number(self, member: Member, form: Form) -> int:
        """Return the number of the line of a failure; a new one is entered."""
        failed = member.failed
        line = LinePattern(form, self._suspected.of_line(failed, form))
        number = self._numbers.setdefault(line, len(self._numbers))
        if number == len(self.signatures):
            lexer, context = self.recognizer.lexer, self.contexts[failed.form]
            self.signatures.append(signature_of(lexer, form, line.keywords, context))
            self.specimens.append(member)
            self.weights.append(0)
        elif len(failed.source) < len(self.specimens[number].failed.source):
            self.specimens[number] = member
        return number

    def failing(
        self, found: Survey, text_of: Callable[[SurveyedFile], str]
    ) -> Iterator[FailingFile]:
        """Yield the files with failing lines; their texts are read when needed."""
        for file in found.failing:
            lines = array("l", (n for n in self.lines_of[file.digest] if n != self.FOLLOWS))
            yield FailingFile(
                file.digest, file.size, partial(text_of, file), self._at[file.digest], lines
            )
