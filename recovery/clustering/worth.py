"""The worth of an edit: the weight of the lines that it repairs, less for what else it accepts."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import replace

from grammar.notation.edits import AddToken, Edit
from recovery import tuning
from recovery.clustering.cause import Proposal
from recovery.clustering.edit_trial import TrialResult
from recovery.proposals.edit_site import LinePattern


class Sought:
    """Lines for which an edit is sought, among ``open`` lines: these and others without a cause."""

    def __init__(
        self,
        patterns: Sequence[LinePattern],
        weights: Sequence[int],
        lines: Iterable[int],
        open_lines: Iterable[int],
    ) -> None:
        """``patterns`` and ``weights`` are those of all lines, by their numbers."""
        self.lines = frozenset(lines)
        self.open = frozenset(open_lines)
        self.heaviest = sorted(self.lines, key=lambda n: (-weights[n], n))
        self._weights = weights
        self._weight = sum(weights[n] for n in self.lines)
        self._lack_words = all(patterns[n].keywords for n in self.lines)
        self._having = Counter[str]()  # the weight of the lines with each word
        for n in self.lines:
            for word in {word for _, word in patterns[n].keywords}:
                self._having[word] += weights[n]

    def gain(self, result: TrialResult | Proposal) -> float:
        """Return the weight of the repaired lines; the lines in question count most."""
        mended = sum(self._weights[n] for n in result.mended & self.lines)
        further = sum(self._weights[n] for n in result.advanced & self.lines)
        if not mended and not further:
            return 0.0
        others = sum(self._weights[n] for n in result.mended - self.lines)
        return mended + further * tuning.ADVANCED_WEIGHT + others * tuning.OTHER_GROUP_WEIGHT

    def worth(self, edits: Sequence[Edit], breadth: int, result: TrialResult | Proposal) -> float:
        """Return the gain, reduced for breadth and for words that are not what the lines lack."""
        factor = tuning.BREADTH_FACTOR**breadth
        words = [edit.name for edit in edits if isinstance(edit, AddToken)]
        if self._lack_words and not words:
            factor *= tuning.OTHER_WORDS_FACTOR
            result = replace(result, advanced=frozenset())  # it fails at what the word belongs to
        if words and 2 * sum(self._having[word] for word in words) < self._weight:
            factor *= tuning.OTHER_WORDS_FACTOR
        return self.gain(result) * factor
