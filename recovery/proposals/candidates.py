"""Candidate edits for failing lines: sites in the grammar, and what to write there.

Sites follow from the configurations of the recogniser (`recovery.proposals.site_finder`). There are
four kinds of edit: insert the unexpected tokens, accept them in place of the next element, make
elements optional, or add an alternative to a rule that was entered or comes next.
`recovery.proposals.edit_writer` writes them.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from grammar.notation.addresses import Address
from grammar.notation.edits import AddAlternative, Edit
from grammar.parser.recognizer import Recognizer
from recovery import tuning
from recovery.proposals.alignment import Aligner
from recovery.proposals.block_inference import Block, BlockFinder
from recovery.proposals.edit_site import EditSite, LinePattern, RankedEdits
from recovery.proposals.edit_writer import EditWriter
from recovery.proposals.grammar_profile import GrammarProfile
from recovery.proposals.phrases import Phraser
from recovery.proposals.similarity import Similarity
from recovery.proposals.site_finder import EditSiteFinder


@dataclass(frozen=True, slots=True)
class Candidate:
    """Edits that belong together. ``breadth`` estimates how much they accept; less is stricter."""

    edits: tuple[Edit, ...]
    breadth: int

    @property
    def place(self) -> tuple[str, str, Address]:
        """The kind, rule and address of the last edit."""
        edit = self.edits[-1]
        return type(edit).__name__, getattr(edit, "rule", ""), getattr(edit, "at", ())


#: A key under which sites of several lines are one: kind, rule, place, first word or sign.
_Slot = tuple[str, str, Address, str]


class CandidateFinder:
    """Finds candidate edits under one grammar."""

    def __init__(self, recognizer: Recognizer) -> None:
        self.recognizer = recognizer
        self.profile = GrammarProfile(recognizer)
        self.phraser = Phraser(self.profile)
        self.similarity = Similarity(self.profile)
        aligner = Aligner(self.phraser)
        self._blocks = BlockFinder(self.profile, aligner)
        self._writer = EditWriter(self.phraser, aligner, self.similarity)
        self._site_finder = EditSiteFinder(self.profile, self.similarity, self.phraser)
        self._known: dict[LinePattern, tuple[dict[_Slot, EditSite], list[RankedEdits]]] = {}

    def find_common(
        self, lines: Sequence[LinePattern], most: int, core: int = 0
    ) -> list[Candidate]:
        """Return candidates for lines that may have one cause, the most promising first.

        A site that many of the lines have is promising; at most ``most`` sites are examined. The
        text written there reads what all of the lines have in common, what the first ``core`` of
        them have, or what one of them has.
        """
        found = _Found()
        slots: dict[_Slot, dict[int, EditSite]] = defaultdict(dict)
        for number, line in enumerate(lines):
            sites, whole = self._sites_of(line)
            for slot, site in sites.items():
                slots[slot][number] = site
            found.add(whole, [number])
        for having in _promising(slots)[:most]:
            found.add(self._written(having, core), having)
        return self._ordered(found)

    def _sites_of(self, line: LinePattern) -> tuple[dict[_Slot, EditSite], list[RankedEdits]]:
        """Return the first site of a line in each slot, and its complete edits with their ranks."""
        known = self._known.get(line)
        if known is None:
            if len(self._known) >= tuning.MOST_ALIGNMENTS_KEPT:
                self._known.clear()
            known = self._known[line] = {}, []
            for found in self._site_finder.find(line):
                if isinstance(found, EditSite):
                    first = "" if found.kind == "repetition" else self._writer.sign(found)
                    known[0].setdefault((found.kind, found.rule, found.place, first), found)
                else:
                    known[1].append(found)
        return known

    def _written(self, having: Mapping[int, EditSite], core: int) -> Iterator[RankedEdits]:
        """Yield the edits for a site; ``having`` are the numbers of the lines that have it."""
        sites = list(having.values())
        yield from self._writer.edits(sites)
        yield from self._writer.edits(sites[:1])
        nearer = [site for number, site in having.items() if number < core]
        if 0 < len(nearer) < len(sites):
            yield from self._writer.edits(nearer)

    def _ordered(self, found: _Found) -> list[Candidate]:
        """Return the edits as candidates; those of a rule that has many come later."""
        in_rule: Counter[str] = Counter()
        varied: dict[tuple[Edit, ...], float] = {}
        spelled = {edits: str(edits) for edits in found.ranks}
        expected = {edits: found.gain(edits) for edits in found.ranks}
        for edits in sorted(expected, key=lambda e: (-expected[e], spelled[e])):
            rule = getattr(edits[-1], "rule", "")
            varied[edits] = expected[edits] * tuning.SAME_RULE_FACTOR ** in_rule[rule]
            in_rule[rule] += 1
        ordered = sorted(varied, key=lambda e: (-varied[e], spelled[e]))
        return [Candidate(edits, found.ranks[edits]) for edits in ordered]

    # ------------------------------------------------------------------------------ blocks

    def find_blocks(
        self, line: LinePattern, opener: str, texts: Sequence[str], meant: frozenset[str]
    ) -> list[Candidate]:
        """Return candidates for the block that a line opens; ``texts`` have such lines."""
        blocks = self._blocks.find(opener, texts, meant)
        rules = self._site_finder.block_rules(line) if blocks else ()
        found = _Found()
        found.add((self._as_block(rule, block) for rule in rules for block in blocks), ())
        ordered = sorted(found.ranks.items(), key=lambda item: (item[1], str(item[0])))
        return [Candidate(edits, rank) for edits, rank in ordered]

    def _as_block(self, rule: str, block: Block) -> RankedEdits:
        known = self.profile.grammar.by_name
        rank = self.profile.width(rule) + self.phraser.breadth(block.symbols) + len(block.symbols)
        if rule not in self.profile.choices_of_lines:
            rank += tuning.NO_LINE_RULE_COST
        symbols = (*block.symbols, *self.closing(rule))
        return rank + self.similarity.dissimilarity(rule, symbols), (
            *self.profile.vocabulary.reserve(k for k in block.keywords if k not in known),
            AddAlternative(rule, " ".join(symbols)),
        )

    def closing(self, rule: str) -> tuple[str, ...]:
        """Return the line end with which every alternative of a rule ends, or nothing."""
        closing = self.profile.closing(rule)
        return (closing,) if closing else ()


class _Found:
    """Edits that were found, with their least rank and the lines that have a site for them."""

    def __init__(self) -> None:
        self.ranks: dict[tuple[Edit, ...], int] = {}
        self._lines: dict[tuple[Edit, ...], set[int]] = defaultdict(set)

    def add(self, ranked: Iterable[RankedEdits], lines: Iterable[int]) -> None:
        """Add edits for some lines."""
        for rank, edits in ranked:
            self._lines[edits].update(lines)
            self.ranks[edits] = min(rank, self.ranks.get(edits, rank))

    def gain(self, edits: tuple[Edit, ...]) -> float:
        """Return the expected gain of edits."""
        return _gain_expected(len(self._lines[edits]), self.ranks[edits])


def _promising(slots: Mapping[_Slot, dict[int, EditSite]]) -> list[dict[int, EditSite]]:
    """Return the sites of each slot by the numbers of their lines, the most promising first."""

    def key(slot: _Slot) -> tuple[float, _Slot]:
        having = slots[slot].values()
        return -_gain_expected(len(having), min(site.rank for site in having)), slot

    return [slots[slot] for slot in sorted(slots, key=key)]


def _gain_expected(lines: int, rank: int) -> float:
    """Return the expected gain of a site that ``lines`` lines have."""
    return lines * float(tuning.BREADTH_FACTOR**rank)
