"""The distinct failing lines of a corpus, with the evidence for edits that repair them."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Sequence, Set
from dataclasses import dataclass, field
from itertools import islice

from grammar.notation.edits import AddAlternative, AddToken, Edit
from grammar.parser.failures import Failure
from grammar.parser.recognizer import Recognizer, State
from recovery.brackets import BRACKETS, CLOSING
from recovery.induction.inferred_keywords import InferredKeywords
from recovery.induction.language import CorpusFile
from recovery.ledger.construct import Evidence
from recovery.proposals.edit_site import LinePattern
from recovery.tuning import (
    PLACES_IN_ONE_FILE,
    PLACES_REMEMBERED,
    PLACES_SHOWN,
    SEVERAL,
)


@dataclass(slots=True)
class Occurrences:
    """Where a distinct failing line occurs: numbers of files, origins, texts, some places.

    ``state`` is the state of the recogniser at the failure.
    """

    state: State
    files: set[int] = field(default_factory=set)
    origins: set[str] = field(default_factory=set)
    seen: list[str] = field(default_factory=list)
    texts: set[tuple[str, ...]] = field(default_factory=set)


class FailingLines:
    """The distinct failing lines of files, ``patterns[n]`` with ``occurrences[n]``.

    Lines with unbalanced brackets are damaged and are left out, and so are enormous ones.
    """

    def __init__(
        self,
        files: Sequence[CorpusFile],
        failures: Sequence[Sequence[Failure]],
        keywords: InferredKeywords,
    ) -> None:
        self._name = keywords.lexer.name_kind
        found: dict[LinePattern, Occurrences] = {}
        for place, of_file in enumerate(failures):
            for failure in of_file:
                if failure.follows:
                    continue
                ends = failure.form.kinds[-1:] == (keywords.lexer.line_kind,)
                words = tuple(map(str.upper, failure.lexemes[: -1 if ends else None]))
                pattern = LinePattern(failure.form, keywords.in_line(words) if words else ())
                if pattern.is_enormous or not _is_balanced(words):
                    continue
                line = found.setdefault(pattern, Occurrences(failure.state))
                line.texts.add(words)
                line.files.add(place)
                line.origins |= files[place].origins
                if len(line.seen) < PLACES_REMEMBERED:
                    line.seen.append(f"{files[place].path}:{failure.line}")
        self.patterns = list(found)
        self.occurrences = list(found.values())
        self._of_file: dict[int, set[int]] = defaultdict(set)
        for number, line in enumerate(self.occurrences):
            for place in line.files:
                self._of_file[place].add(number)

    def weight(self, lines: Collection[int]) -> int:
        """Return the number of files with these lines, summed over the lines."""
        return sum(len(self.occurrences[n].files) for n in lines)

    def evidence(self, lines: Collection[int]) -> Evidence:
        """Return the evidence for an edit that repairs these lines."""
        some = [self.occurrences[n] for n in sorted(lines)]
        files = {place for line in some for place in line.files}
        origins = {origin for line in some for origin in line.origins}
        seen = dict.fromkeys(place for line in some for place in line.seen)
        shown = tuple(islice(seen, PLACES_SHOWN))
        return Evidence(len(files), len(origins), self.weight(lines), seen=shown)

    def distinct(self, lines: Collection[int]) -> int:
        """Return how many different texts these lines have."""
        return len({text for n in lines for text in self.occurrences[n].texts})

    def have_one_word(self, lines: Set[int]) -> bool:
        """Return whether lines fail at a name behind another one, and it is the same in all."""
        found: set[str] = set()
        for number in lines:
            form = self.patterns[number].form
            if not form.index or {*form.kinds[form.index - 1 : form.index + 1]} != {self._name}:
                return False
            found.update(text[form.index] for text in self.occurrences[number].texts)
        return len(found) == 1

    def is_repeated(
        self,
        lines: Set[int],
        edits: Sequence[Edit],
        recognizer: Recognizer,
        explained: Set[LinePattern],
    ) -> bool:
        """Return whether lines of a single file show edits often enough to be no slip.

        Known forms may be extended to read lines that are ``explained``.
        """
        some = [self.occurrences[n] for n in lines]
        places = sum(len(line.seen) for line in some)
        is_new = any(isinstance(edit, AddAlternative) for edit in edits)
        is_word = any(isinstance(edit, AddToken) for edit in edits)
        # where nothing else is wrong in a file a form that is known may grow by a single line, but
        # not by a word where a name stands; and two lines show a new form with a new word
        if places >= PLACES_IN_ONE_FILE or not (is_new or self.are_misnamed(lines, recognizer)):
            known = {n for n, pattern in enumerate(self.patterns) if pattern in explained}
            if any(self._of_file[p] <= lines | known for line in some for p in line.files):
                return True
        return self.distinct(lines) >= SEVERAL if is_word else places >= PLACES_IN_ONE_FILE

    def are_misnamed(self, lines: Set[int], recognizer: Recognizer) -> bool:
        """Return whether all lines parse with a name for the reserved word at which they fail."""
        lexer = recognizer.lexer
        for form in (self.patterns[n].form for n in lines):
            kinds = list(form.kinds)
            is_word = lexer.is_keyword(kinds[form.index])
            kinds[form.index] = lexer.name_kind
            if not is_word or recognizer.run(recognizer.restore(form.before), kinds)[1] is not None:
                return False
        return True


def _is_balanced(words: Sequence[str]) -> bool:
    """Return whether the brackets of a line are balanced."""
    open_: list[str] = []
    for word in words:
        if word in BRACKETS:
            open_.append(BRACKETS[word])
        elif word in CLOSING and (not open_ or open_.pop() != word):
            return False
    return not open_
