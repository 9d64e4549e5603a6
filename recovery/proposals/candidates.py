"""Candidate edits for failing lines: sites in the grammar, and what to write there.

Sites follow from the configurations of the recogniser (`recovery.proposals.site_finder`). There are
four kinds of edit: insert the unexpected tokens, accept them in place of the next element, make
elements optional, or add an alternative to a rule that was entered or comes next. The text is the
tokens themselves, or a phrase with rules in place of operands (`recovery.proposals.phrases`). If
several lines have the same site, it is a phrase that reads all of them
(`recovery.proposals.alignment`).
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import TypeVar

from grammar.notation.addresses import Address
from grammar.notation.edits import AddAlternative, Edit, Insert, Widen
from grammar.parser.recognizer import Recognizer
from recovery import tuning
from recovery.forms.symbols import Token
from recovery.proposals.alignment import Aligner
from recovery.proposals.block_inference import Block, BlockFinder
from recovery.proposals.edit_site import EditSite, LinePattern, RankedEdits
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
        self._aligner = Aligner(self.phraser)
        self._blocks = BlockFinder(self.profile, self._aligner)
        self.similarity = Similarity(self.profile)
        self._site_finder = EditSiteFinder(self.profile, self.similarity, self.phraser)
        self._sites: dict[
            LinePattern, tuple[dict[_Slot, EditSite], dict[tuple[Edit, ...], int]]
        ] = {}

    def find_common(
        self, lines: Sequence[LinePattern], most: int, core: int = 0
    ) -> list[Candidate]:
        """Return candidates for lines that may have one cause, the most promising first.

        A site that many of the lines have is promising; at most ``most`` sites are examined. The
        text written there reads what all of the lines have in common, what the first ``core`` of
        them have, or what one of them has.
        """
        slots: dict[_Slot, dict[int, EditSite]] = defaultdict(dict)
        support: dict[tuple[Edit, ...], set[int]] = defaultdict(set)
        ranks: dict[tuple[Edit, ...], int] = {}
        for number, line in enumerate(lines):
            sites_of_line, whole = self._sites_of(line)
            for slot, site in sites_of_line.items():
                slots[slot][number] = site
            for edits, rank in whole.items():
                support[edits].add(number)
                ranks[edits] = min(rank, ranks.get(edits, rank))
        promising = sorted(
            slots.items(),
            key=lambda slot: (
                -_gain_expected(len(slot[1]), min(site.rank for site in slot[1].values())),
                slot[0],
            ),
        )
        for _, having in promising[:most]:
            sites = list(having.values())
            nearer = [site for number, site in having.items() if number < core]
            written = [*self._of_slot(sites), *self._of_site(sites[0])]
            if nearer and len(nearer) < len(sites):
                written += self._of_slot(nearer)
            for rank, edits in written:
                support[edits] |= having.keys()
                ranks[edits] = min(rank, ranks.get(edits, rank))
        expected = {edits: _gain_expected(len(support[edits]), ranks[edits]) for edits in ranks}
        in_rule: Counter[str] = Counter()
        varied: dict[tuple[Edit, ...], float] = {}
        spelled = {edits: str(edits) for edits in ranks}
        for edits in sorted(ranks, key=lambda e: (-expected[e], spelled[e])):
            if not self.profile.is_left_recursive(edits[-1]):
                rule = getattr(edits[-1], "rule", "")
                varied[edits] = expected[edits] * tuning.SAME_RULE_FACTOR ** in_rule[rule]
                in_rule[rule] += 1
        ordered = sorted(varied, key=lambda e: (-varied[e], spelled[e]))
        return [Candidate(edits, ranks[edits]) for edits in ordered]

    def _sites_of(
        self, line: LinePattern
    ) -> tuple[dict[_Slot, EditSite], dict[tuple[Edit, ...], int]]:
        """Return the first site of a line in each slot, and its complete edits with their ranks."""
        known = self._sites.get(line)
        if known is None:
            if len(self._sites) >= tuning.MOST_ALIGNMENTS_KEPT:
                self._sites.clear()
            known = self._sites[line] = {}, {}
            for found in self._site_finder.find(line):
                if isinstance(found, EditSite):
                    any_sign = found.kind == "repetition"
                    first = "" if any_sign else self._sign(found.words) or ""
                    known[0].setdefault((found.kind, found.rule, found.place, first), found)
                else:
                    rank, edits = found
                    known[1][edits] = min(rank, known[1].get(edits, rank))
        return known

    def find_blocks(
        self, line: LinePattern, opener: str, texts: Sequence[str], meant: frozenset[str]
    ) -> list[Candidate]:
        """Return candidates for the block that a line opens; ``texts`` have such lines."""
        blocks = self._blocks.find(opener, texts, meant)
        rules = self._site_finder.block_rules(line) if blocks else ()
        return self._ordered(self._as_block(rule, block) for rule in rules for block in blocks)

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

    def _ordered(self, ranked: Iterable[RankedEdits]) -> list[Candidate]:
        found: dict[tuple[Edit, ...], int] = {}
        for rank, edits in ranked:
            known = found.get(edits)
            if known is None or rank < known:
                found[edits] = rank
        ordered = sorted(found.items(), key=lambda item: (item[1], str(item[0])))
        return [
            Candidate(edits, rank)
            for edits, rank in ordered
            if not self.profile.is_left_recursive(edits[-1])
        ]

    def _sign(self, words: Sequence[Token]) -> str | None:
        """Return the keyword or sign with which words begin."""
        return self.phraser.matcher.sign(words[0]) if words else None

    def _of_site(self, site: EditSite) -> Iterator[RankedEdits]:
        if site.kind == "repetition":
            yield self._repetition(site, site.words)
            return
        near = self.profile.near(site.rule)
        for symbols in self.phraser.phrases(site.words, near):
            yield from self._written(site, site.words, symbols)

    def _of_slot(self, sites: Sequence[EditSite]) -> Iterator[RankedEdits]:
        some = min(sites, key=lambda site: site.rank)
        if some.kind == "repetition":
            yield self._repetition(some, [word for site in sites for word in site.words])
            return
        phrases = sorted({site.words for site in sites}, key=str)
        words = [word for phrase in phrases for word in phrase]
        near = self.profile.near(some.rule)
        units = [_unit(phrase) or phrase for phrase in phrases]
        for symbols in self._aligner.common_phrases(units, near):
            yield from self._written(some, words, symbols, looped=units != phrases)

    # ------------------------------------------------------------------------------ the edits

    def _repetition(self, site: EditSite, signs: Iterable[Token]) -> RankedEdits:
        """Return the edits that repeat the operand before a site: ``((x | y) a)*``."""
        signs = set(signs)
        texts = sorted(filter(None, map(self.phraser.matcher.text, signs)))
        sign = texts[0] if len(texts) == 1 else f"({' | '.join(texts)})"
        elements = self.profile.sequence(site.rule, site.place[:-1]).elements
        operand = self.profile.grammar.by_name[site.rule].source_of(elements[site.place[-1] - 2])
        text = f"({sign} {operand})*"
        rank = site.rank - self.profile.same_text_bonus(text)
        tokens = self._site_finder.reserved(list(signs))
        return rank, (*tokens, Insert(site.rule, site.place, text))

    def _written(
        self,
        site: EditSite,
        words: Sequence[Token],
        symbols: tuple[str, ...],
        *,
        looped: bool = False,
    ) -> Iterator[RankedEdits]:
        """Yield the edits that write symbols at a site."""
        rule, place = site.rule, site.place
        if self.phraser.groups.are_torn(rule, symbols):
            return
        rank = site.rank + self.phraser.breadth(symbols) + len(" ".join(symbols).split(" "))
        tokens = self._site_finder.reserved(words)
        match site.kind:
            case "alternative" if not self.profile.closing(rule):  # else it is of the kind ``line``
                yield from self._alternative(rule, symbols, rank, tokens)
            case "line":
                yield from self._alternative(rule, (*symbols, self.profile.line_end), rank, tokens)
            case "widen":
                yield rank, (*tokens, Widen(rule, place, " ".join(symbols)))
            case "lines":
                ended = f"{' '.join(symbols)} {self.profile.line_end}"
                yield rank, (*tokens, Insert(rule, place, f"({ended})*"))
                if self._sign(words):
                    for body in self.profile.bodies:
                        text = f"({ended} {' '.join(body)})"
                        rank += len(body)
                        yield (
                            rank - tuning.BLOCK_PART_BONUS,
                            (*tokens, Insert(rule, place, f"{text}?")),
                        )
                        yield (
                            rank - tuning.BLOCK_PART_BONUS + 1,
                            (*tokens, Insert(rule, place, f"{text}*")),
                        )
            case "insert":
                unit = _unit(symbols)
                if unit is None and not looped:
                    text = _optional(symbols)
                    worth = rank - self.profile.same_text_bonus(text)
                    yield worth, (*tokens, Insert(rule, place, text))
                    better = self.profile.usual_place(rule, place, text)
                    if better is not None:
                        yield worth - 1, (*tokens, Insert(rule, better, text))
                again = unit or symbols
                if again[0] == "','" or unit or looped:
                    text = f"({' '.join(again)})*" if len(again) > 1 else f"{again[0]}*"
                    rank += 1 - self.profile.same_text_bonus(text)
                    yield rank, (*tokens, Insert(rule, place, text))

    def _alternative(
        self, rule: str, symbols: tuple[str, ...], rank: int, tokens: tuple[Edit, ...]
    ) -> Iterator[RankedEdits]:
        text = " ".join(symbols)
        is_word = len(symbols) == 1 and self.profile.vocabulary.is_set_of_words(rule)
        opens = symbols[0] in self.profile.openers and not is_word
        known = self.profile.has_only_blocks(rule) or opens
        is_foreign = known or self.similarity.is_foreign(rule, symbols)
        if text not in self.profile.alternatives(rule) and not is_foreign:
            rank += self.similarity.dissimilarity(rule, symbols)
            rank -= self.profile.same_text_bonus(text)
            if self.similarity.repeats_sibling(rule, symbols):
                rank += 2 * tuning.UNLIKELY_COST
            if self.similarity.extends(rule, symbols):
                rank += 2 * tuning.UNLIKELY_COST
            if len(symbols) == 1 and self.phraser.would_be_read_twice(rule, text):
                rank += 2 * tuning.UNLIKELY_COST
            yield rank, (*tokens, AddAlternative(rule, text))


def _gain_expected(lines: int, rank: int) -> float:
    """Return the expected gain of a site that ``lines`` lines have."""
    return lines * float(tuning.BREADTH_FACTOR**rank)


_T = TypeVar("_T")


def _unit(items: tuple[_T, ...]) -> tuple[_T, ...] | None:
    """Return the shortest sequence whose repetition gives ``items``; ``None`` if there is none."""
    for size in range(1, len(items) // 2 + 1):
        unit = items[:size]
        if len(items) % size == 0 and unit * (len(items) // size) == items:
            return unit
    return None


def _optional(symbols: tuple[str, ...]) -> str:
    single = len(symbols) == 1 and symbols[0][-1] not in "?*+"
    return f"{symbols[0]}?" if single else f"({' '.join(symbols)})?"
