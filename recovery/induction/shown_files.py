"""The shown files: how they read under a grammar, and what a step would lose."""

from __future__ import annotations

import math
from collections.abc import Sequence

from grammar.notation.edits import AddAlternative, AddToken
from grammar.notation.model import Grammar, GrammarError
from grammar.notation.wellformed import problem
from grammar.parser.failures import Failure, FailureFinder
from grammar.parser.recognizer import Recognizer
from recovery.induction.language import CorpusFile
from recovery.induction.names_rule import names_kept
from recovery.induction.steps import AcceptedStep, Reading, RefusedStep, grown
from recovery.tuning import GRAMMARS_KEPT

#: The failures of each file, in its order.
Failures = Sequence[Sequence[Failure]]


class ShownFiles:
    """Reads the files; results for the last few grammars are cached."""

    def __init__(self, files: Sequence[CorpusFile]) -> None:
        self.files = files
        self._read: dict[str, tuple[FailureFinder, Failures]] = {}

    def failures(self, grammar: Grammar) -> tuple[FailureFinder, Failures]:
        """Return the failure finder of a grammar, and the failures of all files."""
        known = self._read.pop(grammar.sha256, None)
        if known is None:
            finder = FailureFinder(Recognizer(grammar))
            known = finder, [finder.find(file.text) for file in self.files]
        self._read[grammar.sha256] = known
        if len(self._read) > GRAMMARS_KEPT:
            del self._read[next(iter(self._read))]
        return known

    def kept(
        self,
        grammar: Grammar,
        taken: Sequence[AcceptedStep],
        names: str | None,
        types: Sequence[str] = (),
    ) -> tuple[list[AcceptedStep], list[RefusedStep]]:
        """Return the steps without those under which a file fails earlier than before, and these.

        A word of a step that lines use as a name is added to the rules of ``types`` first, which is
        enough if all these lines have it there: if there is a rule of ``names`` it becomes one of
        them, as types are names too. Else it is added to that rule if more files show the step
        than have these lines.
        """
        before = self.failures(grammar)[1]
        after = self.failures(grown(grammar, taken))[1]
        worse = {
            place: _first(before[place])
            for place, found in enumerate(after)
            if _first(found) < _first(before[place])
        }
        if not worse:
            return list(taken), []
        kept: list[AcceptedStep] = []
        lost: list[RefusedStep] = []
        for step in taken:
            version, reason = step, ""
            used: set[str] = set()
            named = [names] if names else []
            for rules, may_lose in (([], False), (types, False), ([], True), (named, True)):
                version = names_kept(step, used, rules)
                if reason and version == step and not may_lose:
                    continue
                try:
                    wider = grown(grammar, [*kept, version])
                except GrammarError as error:
                    reason = str(error)
                    break
                if wrong := problem(wider):
                    reason = f"needs a step that is not taken: line {wrong}"
                    break
                finder = FailureFinder(Recognizer(wider))
                read = {p: finder.find(self.files[p].text) for p in worse}
                lost_in = [place for place, found in read.items() if _first(found) < worse[place]]
                if not lost_in or (may_lose and self._is_outvoted(lost_in, step)):
                    reason = ""
                    if rules is types and names:  # types are names
                        version = names_kept(step, used, named)
                    worse |= {place: _first(read[place]) for place in lost_in}
                    break
                reason = "loses lines that can be read"
                if may_lose and len(lost_in) >= step.evidence.files:
                    break
                used = {w.upper() for p in lost_in for w in read[p][0].lexemes}
            if reason:
                lost.append(RefusedStep(step.title, step.edits, 0.0, reason))
            else:
                kept.append(version)
        return kept, lost

    def gains(self, grammar: Grammar, taken: Sequence[AcceptedStep]) -> bool:
        """Return whether the steps let more files parse, or as many with fewer failing lines."""
        before, after = self.failures(grammar)[1], self.failures(grown(grammar, taken))[1]
        return _standing(after) > _standing(before)

    def _is_outvoted(self, places: Sequence[int], step: AcceptedStep) -> bool:
        """Return whether files have one origin, and more origins and files show a step.

        As many origins suffice for words that begin their own lines, and places for files.
        """
        origins = frozenset[str]().union(*(self.files[p].origins for p in places))
        words = {edit.name for edit in step.edits if isinstance(edit, AddToken)}
        added = [edit.text.split() for edit in step.edits if isinstance(edit, AddAlternative)]
        is_ahead = words <= {word for text in added if len(text) > 1 for word in text[:2]}
        is_leading = is_ahead and bool(words)
        votes = max(step.evidence.files, is_leading * len(step.evidence.seen))
        return len(origins) == 1 < step.evidence.origins + is_leading and 2 * len(places) < votes


def reading(failures: Failures) -> Reading:
    """Return how many files parse and how many lines fail."""
    return Reading(sum(not found for found in failures), len(failures), sum(map(len, failures)))


def _first(failures: Sequence[Failure]) -> float:
    """Return the first failing line; earlier lines are certainly read, later places are guessed."""
    return failures[0].line if failures else math.inf


def _standing(failures: Failures) -> tuple[int, int]:
    """Return how well files are read, more is better: parsing files, then minus failing lines."""
    return sum(not found for found in failures), -sum(map(len, failures))
