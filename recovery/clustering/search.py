"""The search for an edit that repairs most lines of a group and accepts least.

Candidate edits for some of the lines are first tried on a sample, then the best of them on all
lines without a cause. docs/recovery.md says how they are ranked.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable, Collection, Sequence
from dataclasses import replace
from typing import TypeVar

from grammar.notation.edits import AddToken, Edit
from grammar.parser.recognizer import Recognizer
from recovery import tuning
from recovery.clustering.cause import Cause, Proposal
from recovery.clustering.edit_merging import merged_as_choice
from recovery.clustering.edit_trial import EditTrial, TrialResult
from recovery.clustering.file_trial import FileTrial
from recovery.clustering.negative_score import NegativeCounter
from recovery.clustering.regression import ParsedFiles, no_parsed_files
from recovery.forms.symbols import Token
from recovery.proposals.candidates import Candidate, CandidateFinder
from recovery.proposals.edit_site import LinePattern

#: Which edits are sought.
Wanted = Callable[[Sequence[Edit]], bool]


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
        self.parsed_files = parsed_files
        self.finder = CandidateFinder(recognizer)
        self.trial = EditTrial(recognizer, lines)
        self.is_thorough = True
        self._sought: frozenset[int] = frozenset()
        self._has_words = False  # whether all lines in question have words the grammar lacks
        self._weight = 0  # of the lines in question, and in ``_having`` of those with each word
        self._having: Counter[str] = Counter()
        self.open = {n for n, line in enumerate(lines) if not line.is_enormous}
        self._meant = frozenset(word for line in lines for _, word in line.keywords)
        self.same_token: dict[tuple[int, str | None], list[int]] = defaultdict(list)
        self.same_lead: dict[Token, list[int]] = defaultdict(list)
        for number in sorted(self.open, key=lambda n: (-weights[n], n)):
            self.same_token[self._token(number)].append(number)
            self.same_lead[lines[number].words()[0]].append(number)

    def best_for(self, group: Sequence[int], wanted: Wanted | None = None) -> Cause | None:
        """Return the cause of the heaviest lines of a group, or ``None`` if no edit helps.

        It is sought among the edits that are ``wanted``, if that is given.
        """
        members = self._seek(group)
        proposals = self._proposals(group, wanted)
        for place, best in enumerate(proposals):
            # a line that only advances has its first cause here, and another one later
            taken = self._explained(best, members) | (best.advanced & members)
            if taken:
                return Cause(tuple(sorted(taken)), tuple(proposals[place:]))
        return None

    def _explained(self, proposal: Proposal, members: frozenset[int]) -> frozenset[int]:
        """Return the open lines that a proposal repairs; of others none with a word it lacks."""
        words = {edit.name for edit in proposal.edits if isinstance(edit, AddToken)}
        return frozenset(
            n
            for n in proposal.mended & self.open
            if n in members or all(word in words for _, word in self.lines[n].keywords)
        )

    def ranked(self, proposals: Sequence[Proposal], lines: Collection[int]) -> list[Proposal]:
        """Return proposals for some or all of these lines, the best for all of them first."""
        self.open = set(self._seek(lines))
        useful = [proposal for proposal in proposals if self._gain(proposal)]
        return self._ranked(useful, sorted(lines, key=lambda n: (-self.weights[n], n)))

    def _seek(self, lines: Collection[int]) -> frozenset[int]:
        """Make the lines those in question; return them."""
        self._sought = frozenset(lines)
        self._has_words = all(self.lines[n].keywords for n in lines)
        self._weight = sum(self.weights[n] for n in self._sought)
        self._having.clear()
        for n in self._sought:
            for word in {word for _, word in self.lines[n].keywords}:
                self._having[word] += self.weights[n]
        return self._sought

    def best_from_scratch(self, lines: Sequence[int]) -> Cause | None:
        """Return the cause of the heaviest of these lines, as if there were no others."""
        self.is_thorough = True
        self.open = set(lines)
        return self.best_for(lines)

    def proposal(self, edits: tuple[Edit, ...], breadth: int) -> Proposal:
        """Return the edits with their result on all lines, whatever the causes of these."""
        result = self.trial.result(edits)
        return Proposal(edits, result.mended, result.advanced, breadth, self.count_negatives(edits))

    def readable_share(self, proposal: Proposal, lines: Sequence[int]) -> float:
        """Return the share of files that fail first at these lines and can then be read further."""
        wider = self.trial.wider(proposal.edits)
        return 0.0 if wider is None else self.file_trial.readable_share(wider, lines)

    def with_entailed(self, cause: Cause) -> Cause:
        """Return the cause with the lines that only fail because of its own.

        The best proposal mends them, too: it is tried on files.
        """
        best = cause.proposals[0]
        wider = self.trial.wider(best.edits)
        mended = best.mended.intersection(cause.lines)
        behind = self.file_trial.behind(mended, self.open.difference(cause.lines))
        if wider is None or not self.trial.leads_to(best.edits, mended, behind):
            return cause
        more = self.file_trial.entailed(wider, mended, behind)
        best = replace(best, mended=best.mended | more)
        return Cause(tuple(sorted({*cause.lines, *more})), (best, *cause.proposals[1:]))

    def _proposals(self, group: Sequence[int], wanted: Wanted | None) -> list[Proposal]:
        heavy = sorted(group, key=lambda n: (-self.weights[n], n))
        specimens = _spread(heavy, tuning.SPECIMENS if self.is_thorough else 1)
        most = tuning.MOST_TRIED if self.is_thorough else tuning.MOST_TRIED_LIGHT
        alike = self._alike(specimens[0])
        led_alike = self._led_alike(specimens[0])
        near = dict.fromkeys((*specimens, *_spread(heavy, tuning.VARIED_LINES)))
        varied = dict.fromkeys(
            (*near, *_spread(alike, tuning.VARIED_LINES), *_spread(led_alike, tuning.VARIED_LINES))
        )
        tried = self.finder.find_common([self.lines[n] for n in varied], most, len(near))
        if wanted is not None:
            tried = [candidate for candidate in tried if wanted(candidate.edits)]
        sample = set(specimens) | set(_spread(heavy, tuning.SAMPLE_LINES))
        sample |= set(_spread(alike, tuning.SAMPLE_LINES)) | varied.keys()
        first = self._tried(tried, most, sample)
        first += [
            (candidate, self.trial.result(candidate.edits, sample))
            for candidate in merged_as_choice(
                [c for c, o in first if o.mended], reads=self.finder.phraser.reads
            )
        ]
        proposals = []
        blocks = [] if wanted is not None else self._blocks(specimens[0], heavy)
        for candidate, negatives in (*blocks, *self._kept(first)):
            result = self.trial.result(candidate.edits, self.open)
            edits, breadth = candidate.edits, candidate.breadth
            proposals.append(Proposal(edits, result.mended, result.advanced, breadth, negatives))
        kept = [self._names_kept(proposal) for proposal in proposals]
        useful = {proposal.edits: proposal for proposal in kept if self._gain(proposal)}
        return self._ranked(list(useful.values()), heavy)[: tuning.MOST_PROPOSALS]

    def _names_kept(self, proposal: Proposal) -> Proposal:
        """Return the proposal, changed where files that could be read would be lost by its words.

        Then a word is added to all rules that list words of its kind, or remains a name.
        """
        if not self._loses(proposal.edits):
            return proposal
        profile, words = self.finder.profile, self.finder.profile.vocabulary
        breadth = proposal.breadth + 1
        edits = words.in_like_rules(proposal.edits)
        if edits is None or self._loses(edits):
            edits = words.still_names(proposal.edits)
            if words.names is None or edits is None or self._loses(edits):
                return proposal
            breadth = proposal.breadth + profile.width(words.names) // tuning.STILL_NAMES_PART
        result = self.trial.result(edits, self.open)
        return Proposal(edits, result.mended, result.advanced, breadth, self.count_negatives(edits))

    def _loses(self, edits: tuple[Edit, ...]) -> bool:
        """Return whether some files that parse now would not."""
        words = [edit.name for edit in edits if isinstance(edit, AddToken)]
        wider = self.trial.wider(edits) if words else None
        return wider is not None and self.parsed_files.breaks(wider, words)

    def _tried(
        self, candidates: Sequence[Candidate], most: int, sample: Collection[int]
    ) -> list[tuple[Candidate, TrialResult]]:
        """Return at most ``most`` candidates with their results on a sample of lines.

        First the narrowest ones at each place are tried, then wider ones where these repair most.
        """
        at: dict[object, list[Candidate]] = defaultdict(list)
        for candidate in candidates:
            at[candidate.place].append(candidate)
        narrow = [c for c in candidates if c in at[c.place][: tuning.NARROW_PER_SITE]][
            : most - most // tuning.WIDE_PART
        ]
        out = [(c, self.trial.result(c.edits, sample)) for c in narrow]
        gains: dict[object, tuple[float, int]] = {}
        for c, result in out:
            gain = self._gain(result)
            if gain:
                gains[c.place] = max((gain, -c.breadth), gains.get(c.place, (0.0, 0)))
        promising = sorted(gains, key=lambda p: (-gains[p][0], -gains[p][1], str(p)))
        wide = [
            c
            for place in promising
            for c in at[place][
                tuning.NARROW_PER_SITE : tuning.NARROW_PER_SITE + tuning.WIDE_PER_SITE
            ]
        ]
        return out + [
            (c, self.trial.result(c.edits, sample)) for c in wide[: most // tuning.WIDE_PART]
        ]

    def _blocks(self, number: int, heavy: Sequence[int]) -> list[tuple[Candidate, int]]:
        """Return the best blocks that a line may open, with the number of negatives accepted."""
        line = self.lines[number]
        opener = self.lead(line)
        if not opener:
            return []
        texts = self.file_trial.texts(heavy)
        found = []
        for candidate in self.finder.find_blocks(line, opener, texts, self._meant):
            wider = self.trial.wider(candidate.edits)
            if wider is not None:
                worth = self._worth(candidate, self.trial.result(candidate.edits, heavy))
                found.append((worth * self.file_trial.readable_share(wider, heavy), candidate))
        found.sort(key=lambda pair: (-pair[0], str(pair[1].edits)))
        return [
            (candidate, self.count_negatives(candidate.edits))
            for _, candidate in found[: tuning.KEPT_PER_RULE]
        ]

    def lead(self, line: LinePattern) -> str:
        """Return the keyword or suspected keyword with which a line begins, or an empty text."""
        kind, keyword = line.words()[0]
        lexer = self.finder.recognizer.lexer
        return keyword or (lexer.display[kind] if lexer.is_keyword(kind) else "")

    def _alike(self, number: int) -> list[int]:
        """Return the open lines that fail at the same token."""
        return [n for n in self.same_token[self._token(number)] if n in self.open]

    def _led_alike(self, number: int) -> list[int]:
        """Return the open lines that begin with the same token kind or word."""
        return [n for n in self.same_lead[self.lines[number].words()[0]] if n in self.open]

    def _token(self, number: int) -> tuple[int, str | None]:
        line = self.lines[number]
        return line.form.kinds[line.form.index], dict(line.keywords).get(line.form.index)

    def _gain(self, result: TrialResult | Proposal) -> float:
        """Return the weight of the repaired lines; those in question count most."""
        sought = self._sought
        mended = sum(self.weights[n] for n in result.mended & sought)
        further = sum(self.weights[n] for n in result.advanced & sought)
        if not mended and not further:
            return 0.0
        others = sum(self.weights[n] for n in result.mended - sought)
        return mended + further * tuning.ADVANCED_WEIGHT + others * tuning.OTHER_GROUP_WEIGHT

    def _worth(self, candidate: Candidate | Proposal, result: TrialResult | Proposal) -> float:
        """Return the gain, reduced for breadth and for words that are not what the lines lack."""
        factor = tuning.BREADTH_FACTOR**candidate.breadth
        words = [edit.name for edit in candidate.edits if isinstance(edit, AddToken)]
        if self._has_words and not words:
            factor *= tuning.OTHER_WORDS_FACTOR
            result = replace(result, advanced=frozenset())  # it fails at what the word belongs to
        if words and 2 * sum(self._having[word] for word in words) < self._weight:
            factor *= tuning.OTHER_WORDS_FACTOR
        return self._gain(result) * factor

    def _kept(self, results: list[tuple[Candidate, TrialResult]]) -> list[tuple[Candidate, int]]:
        """Return the best candidates, first those that accept no negatives."""
        useful = self._diverse(results)
        useful.sort(key=lambda co: (-self._worth(*co), str(co[0].edits)))
        clean: list[tuple[Candidate, int]] = []
        costly: list[tuple[Candidate, int]] = []
        alike: Counter[object] = Counter()
        scored = 0
        for candidate, _ in useful:
            last = candidate.edits[-1]
            kind = type(last), getattr(last, "rule", "")
            if alike[kind] >= tuning.KEPT_PER_RULE:
                continue
            negatives = self.count_negatives(candidate.edits)
            scored += 1
            alike[kind] += not negatives
            (costly if negatives else clean).append((candidate, negatives))
            if len(clean) == (tuning.KEPT if self.is_thorough else tuning.KEPT_LIGHT) or scored == (
                tuning.MOST_SCORED if self.is_thorough else tuning.MOST_SCORED_LIGHT
            ):
                break
        return clean + costly[: max(1, tuning.KEPT - len(clean))]

    def _diverse(
        self, results: list[tuple[Candidate, TrialResult]]
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

    def _ranked(self, proposals: Sequence[Proposal], lines: Sequence[int]) -> list[Proposal]:
        """Return the proposals sorted by negatives, then by worth and readable share of files.

        Negatives of others with which files can be read further count too; see `NegativeCounter`.
        """
        worth, negatives = {}, {}
        alike = self._alike(lines[0])
        share = {p.edits: self.readable_share(p, lines) for p in proposals}
        for p in proposals:
            further = [edits for edits, other in share.items() if other > share[p.edits]]
            negatives[p.edits] = self.count_negatives(p.edits, further)
            part = tuning.LINE_WEIGHT + (1 - tuning.LINE_WEIGHT) * share[p.edits]
            worth[p.edits] = self._worth(p, p) * part
            if p.mended.issuperset(alike):
                worth[p.edits] *= tuning.ALL_ALIKE_FACTOR
            flaws = self._loses(p.edits) + self.trial.is_ambiguous(p.edits, p.mended & self._sought)
            worth[p.edits] *= tuning.FLAW_FACTOR**flaws
        return sorted(proposals, key=lambda p: (negatives[p.edits], -worth[p.edits], str(p.edits)))


_T = TypeVar("_T")


def _spread(items: Sequence[_T], count: int) -> list[_T]:
    """Return ``count`` items, evenly spread from the first one on."""
    if len(items) <= count:
        return list(items)
    return [items[i * len(items) // count] for i in range(count)]
