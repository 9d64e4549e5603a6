"""Causes: failing lines grouped by the edit that mends them.

Two failures have one cause when the same edit mends both. Shapes give a first grouping; then,
heaviest group first, candidate edits for some of its lines are tried on all lines still without a
cause. The best edit takes every line it mends, whatever its shape; lines of the group that it does
not mend are searched again.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeVar

from grammar.edits import AddAlternative, AddToken, Edit, Insert, Widen
from grammar.recognizer import Recognizer
from recovery.candidates import Candidate, CandidateFinder, Line
from recovery.progress import Progress, unheard
from recovery.trial import Outcome, Trial

__all__ = ["Cause", "Judge", "Proposal", "find_causes", "no_judge"]

# Lines of a group whose candidates are tried, candidates tried of each, and lines of other groups
# that a first trial looks at: what is kept after it is tried on everything.
_SPECIMENS = 3
_MOST_TRIED = 90
# Behind the groups that hold back most a quicker look has to do.
_HEAVY_GROUPS = 30
_MOST_TRIED_LIGHT = 40
_FIRST_TRIAL = 24
_KEPT = 8
_MOST_JUDGED = 40
_MOST_JUDGED_LIGHT = 15
_ALIKE = 12
_SHOWN = 5
_ROUNDS = 4
# What an edit loses of its worth for each step in breadth: of two that mend nearly as much, the
# one that lets in less is preferred.
_BREADTH_COSTS = 0.995


@dataclass(frozen=True, slots=True)
class Proposal:
    """An edit that was tried: the lines it mends, lets be read further, and what it costs.

    ``accepts_negatives`` counts programs that must stay rejected and no longer would be.
    """

    edits: tuple[Edit, ...]
    mended: frozenset[int]
    advanced: frozenset[int]
    breadth: int
    accepts_negatives: int


@dataclass(frozen=True, slots=True)
class Cause:
    """Lines with one cause, and what would mend it, the best first."""

    lines: tuple[int, ...]
    proposals: tuple[Proposal, ...]


#: How many negatives an edit would let in.
Judge = Callable[[Sequence[Edit]], int]


def no_judge(edits: Sequence[Edit]) -> int:
    """Where there are no negatives nothing speaks against an edit."""
    del edits
    return 0


def find_causes(
    recognizer: Recognizer,
    lines: Sequence[Line],
    weights: Sequence[int],
    groups: Sequence[Sequence[int]],
    judge: Judge,
    on_done: Progress = unheard,
) -> list[Cause]:
    """Group ``lines`` by cause.

    ``weights[i]`` is what line ``i`` holds back; ``groups`` partition the indices of the lines, the
    heaviest first. ``on_done`` is told of each group dealt with.
    """
    search = _Search(recognizer, lines, weights, judge)
    causes: list[Cause] = []
    for place, group in enumerate(groups):
        search.thorough = place < _HEAVY_GROUPS
        left = [n for n in group if n in search.open]
        for _ in range(_ROUNDS):
            if not left:
                break
            cause = search.best_for(left)
            if cause is None:
                break
            causes.append(cause)
            search.open.difference_update(cause.lines)
            left = [n for n in left if n in search.open]
        left += [n for n in group if lines[n].is_enormous]
        if left:
            search.open.difference_update(left)
            causes.append(Cause(tuple(left), ()))
        on_done(1)
    return causes


class _Search:
    def __init__(
        self,
        recognizer: Recognizer,
        lines: Sequence[Line],
        weights: Sequence[int],
        judge: Judge,
    ) -> None:
        self.lines = lines
        self.weights = weights
        self.judge = judge
        self.finder = CandidateFinder(recognizer)
        self.trial = Trial(recognizer, lines)
        self.thorough = True
        self.open = {n for n, line in enumerate(lines) if not line.is_enormous}
        self.same_token: dict[tuple[int, str | None], list[int]] = defaultdict(list)
        for number in sorted(self.open, key=lambda n: (-weights[n], n)):
            self.same_token[self._token(number)].append(number)

    def best_for(self, group: Sequence[int]) -> Cause | None:
        """The cause of the heaviest lines of a group, or ``None`` where no edit mends any."""
        members = set(group)
        proposals = self._proposals(group)
        for place, best in enumerate(proposals):
            # what an edit lets be read further has its first cause here, and others behind it
            taken = (best.mended & self.open) | (best.advanced & members)
            if taken:
                return Cause(tuple(sorted(taken)), tuple(proposals[place:]))
        return None

    def _proposals(self, group: Sequence[int]) -> list[Proposal]:
        heavy = sorted(group, key=lambda n: (-self.weights[n], n))
        specimens = _spread(heavy, _SPECIMENS if self.thorough else 1)
        most = _MOST_TRIED if self.thorough else _MOST_TRIED_LIGHT
        tried: dict[tuple[Edit, ...], Candidate] = {}
        for number in specimens:
            for candidate in self.finder.find(self.lines[number])[:most]:
                tried.setdefault(candidate.edits, candidate)
        sample = set(specimens) | set(_spread(heavy, _FIRST_TRIAL))
        sample |= set(_spread(self._alike(specimens[0]), _FIRST_TRIAL))
        first = [
            (candidate, self.trial.outcome(candidate.edits, sample)) for candidate in tried.values()
        ]
        first += [
            (candidate, self.trial.outcome(candidate.edits, sample))
            for candidate in _merged([c for c, o in first if o.mended])
        ]
        proposals = []
        for candidate, negatives in self._kept(first):
            outcome = self.trial.outcome(candidate.edits, self.open)
            proposals.append(
                Proposal(
                    candidate.edits,
                    outcome.mended,
                    outcome.advanced,
                    candidate.breadth,
                    negatives,
                )
            )
        return self._ranked(proposals)[:_SHOWN]

    def _alike(self, number: int) -> list[int]:
        """Other lines that fail at the same token, whatever else they look like."""
        return [n for n in self.same_token[self._token(number)] if n in self.open]

    def _token(self, number: int) -> tuple[int, str | None]:
        line = self.lines[number]
        return line.form.kinds[line.form.index], dict(line.keywords).get(line.form.index)

    def _gain(self, outcome: Outcome | Proposal) -> float:
        whole = sum(self.weights[n] for n in outcome.mended)
        further = sum(self.weights[n] for n in outcome.advanced)
        return whole + further / 4

    def _worth(self, candidate: Candidate | Proposal, outcome: Outcome | Proposal) -> float:
        """Gain, less a little for all that an edit lets in besides."""
        return self._gain(outcome) * _BREADTH_COSTS**candidate.breadth

    def _kept(self, outcomes: list[tuple[Candidate, Outcome]]) -> list[tuple[Candidate, int]]:
        """The most worthwhile candidates, first those that let in no negatives."""
        useful = self._diverse(outcomes)
        useful.sort(key=lambda co: (-self._worth(*co), str(co[0].edits)))
        clean: list[tuple[Candidate, int]] = []
        costly: list[tuple[Candidate, int]] = []
        for candidate, _ in useful[: _MOST_JUDGED if self.thorough else _MOST_JUDGED_LIGHT]:
            negatives = self.judge(candidate.edits)
            (costly if negatives else clean).append((candidate, negatives))
            if len(clean) == _KEPT:
                break
        return clean + costly[: _KEPT - len(clean)]

    def _diverse(
        self, outcomes: list[tuple[Candidate, Outcome]]
    ) -> list[tuple[Candidate, Outcome]]:
        """Candidates that do something; of those that do the same the most restrictive few."""
        alike: dict[Outcome, list[tuple[Candidate, Outcome]]] = defaultdict(list)
        for candidate, outcome in outcomes:
            if outcome.mended or outcome.advanced:
                alike[outcome].append((candidate, outcome))
        return [
            pair
            for same in alike.values()
            for pair in sorted(same, key=lambda co: (co[0].breadth, str(co[0].edits)))[:_ALIKE]
        ]

    def _ranked(self, proposals: list[Proposal]) -> list[Proposal]:
        """No negatives first; then by worth."""
        return sorted(
            proposals, key=lambda p: (p.accepts_negatives, -self._worth(p, p), str(p.edits))
        )


_T = TypeVar("_T")


def _spread(items: Sequence[_T], count: int) -> list[_T]:
    """The first of ``items``, and others evenly from the rest."""
    if len(items) <= count:
        return list(items)
    return [items[i * len(items) // count] for i in range(count)]


def _merged(candidates: Sequence[Candidate]) -> list[Candidate]:
    """Candidates that differ in one word only, as one with a choice of words."""
    families: dict[tuple[object, ...], dict[str, Candidate]] = defaultdict(dict)
    for candidate in candidates:
        edit = candidate.edits[-1]
        if not isinstance(edit, Insert | Widen | AddAlternative):
            continue
        words = edit.text.strip("()?*").split(" ")
        place = () if isinstance(edit, AddAlternative) else edit.at
        for i, word in enumerate(words):
            frame = (type(edit), edit.rule, place, tuple(words[:i]), tuple(words[i + 1 :]))
            families[*frame, edit.text[-1]][word] = candidate
    out = []
    for family, members in families.items():
        if len(members) < 2:
            continue
        words = sorted(members)
        left, right = family[3], family[4]
        assert isinstance(left, tuple)
        assert isinstance(right, tuple)
        choice = words[0] if len(words) == 1 else f"({' | '.join(words)})"
        body = " ".join((*left, choice, *right))
        some = next(iter(members.values()))
        last = some.edits[-1]
        if isinstance(last, Insert):
            text = f"({body}){last.text[-1]}" if left or right else f"{choice}{last.text[-1]}"
            edit = Insert(last.rule, last.at, text)
        elif isinstance(last, Widen):
            edit = Widen(last.rule, last.at, body)
        else:
            assert isinstance(last, AddAlternative)
            edit = AddAlternative(last.rule, body)
        tokens = sorted(
            {e.name for c in members.values() for e in c.edits if isinstance(e, AddToken)}
        )
        breadth = max(c.breadth for c in members.values()) + 1
        out.append(Candidate((*(AddToken(t) for t in tokens), edit), breadth))
    return out
