"""The search for an edit that repairs most lines of a group and accepts least.

Candidate edits for some of the lines are first tried on a sample, then the best of them on all
lines without a cause. `recovery.clustering.proposal_order` sorts what comes of it.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

from grammar.notation.edits import AddToken, Edit
from grammar.parser.recognizer import Recognizer
from recovery import tuning
from recovery.clustering.cause import Cause, Proposal
from recovery.clustering.edit_merging import merged_as_choice
from recovery.clustering.edit_trial import EditTrial, TrialResult
from recovery.clustering.file_trial import FileTrial
from recovery.clustering.negative_score import NegativeCounter
from recovery.clustering.proposal_order import ProposalOrder
from recovery.clustering.regression import ParsedFiles, no_parsed_files
from recovery.clustering.worth import Sought
from recovery.forms.symbols import Token
from recovery.proposals.candidates import Candidate, CandidateFinder
from recovery.proposals.edit_site import LinePattern

#: Which edits are sought.
Wanted = Callable[[Sequence[Edit]], bool]


@dataclass(frozen=True, slots=True)
class Limits:
    """How many lines are looked at, and how many candidates are tried, scored and kept."""

    specimens: int
    tried: int
    scored: int
    kept: int


THOROUGH = Limits(tuning.SPECIMENS, tuning.MOST_TRIED, tuning.MOST_SCORED, tuning.KEPT)
LIGHT = Limits(1, tuning.MOST_TRIED_LIGHT, tuning.MOST_SCORED_LIGHT, tuning.KEPT_LIGHT)


class CauseSearch:
    """Searches for edits that repair lines of one grammar."""

    def __init__(
        self,
        recognizer: Recognizer,
        lines: Sequence[LinePattern],
        weights: Sequence[int],
        count_negatives: NegativeCounter,
        file_trial: FileTrial | None = None,
        parsed_files: ParsedFiles = no_parsed_files,
    ) -> None:
        self.lines = lines
        self.weights = weights
        self.count_negatives = count_negatives
        self.file_trial = file_trial or FileTrial(recognizer)
        self.finder = CandidateFinder(recognizer)
        self.trial = EditTrial(recognizer, lines)
        self.order = ProposalOrder(self.trial, self.file_trial, count_negatives, parsed_files)
        #: The lines that are not enormous: for the others no edit is sought.
        self.ordinary = frozenset(n for n, line in enumerate(lines) if not line.is_enormous)
        self._meant = frozenset(word for line in lines for _, word in line.keywords)
        self._same_token: dict[Token, list[int]] = defaultdict(list)
        self._same_lead: dict[Token, list[int]] = defaultdict(list)
        for number in sorted(self.ordinary, key=lambda n: (-weights[n], n)):
            words = lines[number].words()
            self._same_token[words[lines[number].form.index]].append(number)
            self._same_lead[words[0]].append(number)

    def best_for(
        self,
        lines: Sequence[int],
        open_lines: Iterable[int],
        limits: Limits = THOROUGH,
        wanted: Wanted | None = None,
    ) -> Cause | None:
        """Return the cause of the heaviest of some lines, or ``None`` if no edit helps.

        It takes any of the ``open_lines`` that its best edit repairs, too. It is sought among the
        edits that are ``wanted``, if that is given.
        """
        sought = self._sought(lines, open_lines)
        proposals = self._proposals(sought, limits, wanted)
        for place, best in enumerate(proposals):
            # a line that only advances has its first cause here, and another one later
            taken = self._explained(best, sought) | (best.advanced & sought.lines)
            if taken:
                return Cause(tuple(sorted(taken)), tuple(proposals[place:]))
        return None

    def _explained(self, proposal: Proposal, sought: Sought) -> frozenset[int]:
        """Return the open lines that a proposal repairs; of others none with a word it lacks."""
        words = {edit.name for edit in proposal.edits if isinstance(edit, AddToken)}
        return frozenset(
            n
            for n in proposal.mended & sought.open
            if n in sought.lines or all(word in words for _, word in self.lines[n].keywords)
        )

    def ranked(self, proposals: Sequence[Proposal], lines: Collection[int]) -> list[Proposal]:
        """Return proposals for some or all of these lines, the best for all of them first."""
        return self._ranked(proposals, self._sought(lines, lines))

    def _ranked(self, proposals: Iterable[Proposal], sought: Sought) -> list[Proposal]:
        useful = [proposal for proposal in proposals if sought.gain(proposal)]
        return self.order.in_order(useful, sought, self._alike(sought))

    def _sought(self, lines: Iterable[int], open_lines: Iterable[int]) -> Sought:
        return Sought(self.lines, self.weights, lines, open_lines)

    def proposal(self, edits: tuple[Edit, ...], breadth: int) -> Proposal:
        """Return the edits with their result on all lines, whatever the causes of these."""
        result = self.trial.result(edits)
        return Proposal(edits, result.mended, result.advanced, breadth, self.count_negatives(edits))

    def with_entailed(self, cause: Cause, open_lines: Collection[int]) -> Cause:
        """Return the cause with those open lines that only fail because of its own.

        The best proposal mends them, too: it is tried on files.
        """
        best = cause.proposals[0]
        wider = self.trial.wider(best.edits)
        mended = best.mended.intersection(cause.lines)
        behind = self.file_trial.behind(mended, frozenset(open_lines).difference(cause.lines))
        if wider is None or not self.trial.leads_to(best.edits, mended, behind):
            return cause
        more = self.file_trial.entailed(wider, mended, behind)
        best = replace(best, mended=best.mended | more)
        return Cause(tuple(sorted({*cause.lines, *more})), (best, *cause.proposals[1:]))

    def lead(self, line: LinePattern) -> str:
        """Return the keyword or suspected keyword with which a line begins, or an empty text."""
        kind, keyword = line.words()[0]
        lexer = self.finder.recognizer.lexer
        return keyword or (lexer.display[kind] if lexer.is_keyword(kind) else "")

    # --------------------------------------------------------------- candidates on a sample

    def _proposals(self, sought: Sought, limits: Limits, wanted: Wanted | None) -> list[Proposal]:
        """Return the best proposals, with their results on all open lines."""
        specimens = _spread(sought.heaviest, limits.specimens)
        near = dict.fromkeys((*specimens, *_spread(sought.heaviest, tuning.VARIED_LINES)))
        alike = self._alike(sought)
        led_alike = self._open(sought, self._same_lead, self.lines[sought.heaviest[0]].words()[0])
        varied = dict.fromkeys(
            (*near, *_spread(alike, tuning.VARIED_LINES), *_spread(led_alike, tuning.VARIED_LINES))
        )
        sample = {*varied, *_spread(sought.heaviest, tuning.SAMPLE_LINES)}
        sample.update(_spread(alike, tuning.SAMPLE_LINES))
        candidates = self.finder.find_common(
            [self.lines[n] for n in varied], limits.tried, len(near)
        )
        if wanted is not None:
            candidates = [candidate for candidate in candidates if wanted(candidate.edits)]
        tried = self._tried(candidates, limits.tried, sample, sought)
        mending = [candidate for candidate, result in tried if result.mended]
        choices = merged_as_choice(mending, reads=self.finder.phraser.reads)
        tried += [(choice, self.trial.result(choice.edits, sample)) for choice in choices]
        found = [] if wanted is not None else self._blocks(sought)
        found += self._kept(tried, limits, sought)
        proposals = [self._names_kept(self._on_all(*each, sought), sought) for each in found]
        useful = {proposal.edits: proposal for proposal in proposals}
        return self._ranked(useful.values(), sought)[: tuning.MOST_PROPOSALS]

    def _on_all(self, candidate: Candidate, negatives: int, sought: Sought) -> Proposal:
        """Return a candidate with its result on all open lines."""
        result = self.trial.result(candidate.edits, sought.open)
        return Proposal(
            candidate.edits, result.mended, result.advanced, candidate.breadth, negatives
        )

    def _alike(self, sought: Sought) -> list[int]:
        """Return the open lines that fail at the same token as the heaviest line."""
        line = self.lines[sought.heaviest[0]]
        return self._open(sought, self._same_token, line.words()[line.form.index])

    def _open(self, sought: Sought, lines: dict[Token, list[int]], token: Token) -> list[int]:
        return [n for n in lines[token] if n in sought.open]

    def _tried(
        self,
        candidates: Sequence[Candidate],
        most: int,
        sample: Collection[int],
        sought: Sought,
    ) -> list[tuple[Candidate, TrialResult]]:
        """Return at most ``most`` candidates with their results on a sample of lines.

        First the narrowest ones at each place are tried, then wider ones where these repair most.
        """
        at: dict[object, list[Candidate]] = defaultdict(list)
        for candidate in candidates:
            at[candidate.place].append(candidate)
        wide = most // tuning.WIDE_PART
        narrow = [c for c in candidates if c in at[c.place][: tuning.NARROW_PER_SITE]]
        out = [(c, self.trial.result(c.edits, sample)) for c in narrow[: most - wide]]
        gains: dict[object, tuple[float, int]] = {}
        for c, result in out:
            if gain := sought.gain(result):
                gains[c.place] = max((gain, -c.breadth), gains.get(c.place, (0.0, 0)))
        promising = sorted(gains, key=lambda p: (-gains[p][0], -gains[p][1], str(p)))
        last = tuning.NARROW_PER_SITE + tuning.WIDE_PER_SITE
        wider = [c for place in promising for c in at[place][tuning.NARROW_PER_SITE : last]]
        return out + [(c, self.trial.result(c.edits, sample)) for c in wider[:wide]]

    def _kept(
        self, results: list[tuple[Candidate, TrialResult]], limits: Limits, sought: Sought
    ) -> list[tuple[Candidate, int]]:
        """Return the best candidates with the negatives they accept, first those without any."""
        useful = _diverse(results)
        useful.sort(
            key=lambda co: (-sought.worth(co[0].edits, co[0].breadth, co[1]), str(co[0].edits))
        )
        clean: list[tuple[Candidate, int]] = []
        costly: list[tuple[Candidate, int]] = []
        alike: Counter[object] = Counter()
        for candidate, _ in useful:
            last = candidate.edits[-1]
            kind = type(last), getattr(last, "rule", "")
            if alike[kind] >= tuning.KEPT_PER_RULE:
                continue
            negatives = self.count_negatives(candidate.edits)
            alike[kind] += not negatives
            (costly if negatives else clean).append((candidate, negatives))
            if len(clean) == limits.kept or len(clean) + len(costly) == limits.scored:
                break
        return clean + costly[: max(1, tuning.KEPT - len(clean))]

    # ------------------------------------------------------------------- other candidates

    def _blocks(self, sought: Sought) -> list[tuple[Candidate, int]]:
        """Return the best blocks that the heaviest line may open, with the negatives accepted."""
        line = self.lines[sought.heaviest[0]]
        opener = self.lead(line)
        if not opener:
            return []
        texts = self.file_trial.texts(sought.heaviest)
        found = []
        for candidate in self.finder.find_blocks(line, opener, texts, self._meant):
            share = self.order.readable_share(candidate.edits, sought.heaviest)
            if share:
                result = self.trial.result(candidate.edits, sought.heaviest)
                worth = sought.worth(candidate.edits, candidate.breadth, result)
                found.append((worth * share, candidate))
        found.sort(key=lambda pair: (-pair[0], str(pair[1].edits)))
        return [
            (candidate, self.count_negatives(candidate.edits))
            for _, candidate in found[: tuning.KEPT_PER_RULE]
        ]

    def _names_kept(self, proposal: Proposal, sought: Sought) -> Proposal:
        """Return the proposal, changed where files that could be read would be lost by its words.

        Then a word is added to all rules that list words of its kind, or remains a name.
        """
        loses = self.order.loses
        if not loses(proposal.edits):
            return proposal
        profile, words = self.finder.profile, self.finder.profile.vocabulary
        breadth = proposal.breadth + 1
        edits = words.in_like_rules(proposal.edits)
        if edits is None or loses(edits):
            edits = words.still_names(proposal.edits)
            if words.names is None or edits is None or loses(edits):
                return proposal
            breadth = proposal.breadth + profile.width(words.names) // tuning.STILL_NAMES_PART
        return self._on_all(Candidate(edits, breadth), self.count_negatives(edits), sought)


def _diverse(
    results: Sequence[tuple[Candidate, TrialResult]],
) -> list[tuple[Candidate, TrialResult]]:
    """Return the candidates with an effect; the narrowest few of those with equal results."""
    alike: dict[TrialResult, list[tuple[Candidate, TrialResult]]] = defaultdict(list)
    for candidate, result in results:
        if result.mended or result.advanced:
            alike[result].append((candidate, result))
    return [
        pair
        for same in alike.values()
        for pair in sorted(same, key=lambda co: (co[0].breadth, str(co[0].edits)))[
            : tuning.KEPT_PER_RESULT
        ]
    ]


_T = TypeVar("_T")


def _spread(items: Sequence[_T], count: int) -> list[_T]:
    """Return ``count`` items, evenly spread from the first one on."""
    if len(items) <= count:
        return list(items)
    return [items[i * len(items) // count] for i in range(count)]
