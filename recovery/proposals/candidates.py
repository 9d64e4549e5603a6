"""Candidate edits for failing lines: openings in the grammar, and what could be written there.

Where tokens could be let in is found from how the recogniser stands
(`recovery.proposals.site_finder`): four kinds of edit are inserting the unexpected tokens, letting
them stand in place of the next element, leaving elements out, and an alternative to a rule that was
entered or comes next. What is written there are the tokens themselves or phrases with rules in
place of operands (`recovery.proposals.phrases`); where several lines have the same opening, phrases
that read all of them (`recovery.proposals.alignment`).
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import TypeVar

from grammar.notation.addresses import Address
from grammar.notation.edits import AddAlternative, Edit, Insert, Widen
from grammar.parser.recognizer import Recognizer
from recovery.proposals.alignment import common_phrases
from recovery.proposals.block_inference import Block, BlockFinder
from recovery.proposals.edit_site import Line, Opening, Ranked
from recovery.proposals.grammar_profile import Layout
from recovery.proposals.phrases import Phraser
from recovery.proposals.segmentation import Word
from recovery.proposals.similarity import Likeness
from recovery.proposals.site_finder import OpeningFinder
from recovery.tuning import (
    BLOCK_PART_BONUS,
    BREADTH_FACTOR,
    NO_LINE_RULE_COST,
    SAME_RULE_FACTOR,
    UNLIKELY_COST,
)

__all__ = ["Candidate", "CandidateFinder", "Line"]


@dataclass(frozen=True, slots=True)
class Candidate:
    """Edits that belong together, and how much they let in: lower is more restrictive."""

    edits: tuple[Edit, ...]
    breadth: int

    @property
    def place(self) -> tuple[str, str, Address]:
        """Where the last of the edits is, and of which kind it is."""
        edit = self.edits[-1]
        return type(edit).__name__, getattr(edit, "rule", ""), getattr(edit, "at", ())


#: Openings of several lines that may be one: kind, rule, place, word or sign they begin with.
_Slot = tuple[str, str, Address, str]


class CandidateFinder:
    """Finds candidate edits under one grammar."""

    def __init__(self, recognizer: Recognizer) -> None:
        self.recognizer = recognizer
        self.layout = Layout(recognizer)
        self.phraser = Phraser(recognizer)
        self._blocks = BlockFinder(recognizer, self.layout, self.phraser)
        self.likeness = Likeness(self.layout)
        self._openings = OpeningFinder(self.layout, self.likeness, self.phraser)

    def find(self, line: Line) -> list[Candidate]:
        """Candidates for a line, the most restrictive first, each once."""
        return self._ordered(self._of_line(line))

    def find_common(self, lines: Sequence[Line], most: int, core: int = 0) -> list[Candidate]:
        """Candidates for lines that may have one cause, the most hopeful first.

        Hopeful is an opening that many of the lines have; ``most`` of them are looked at. What is
        written there reads what all of the lines have in common, what the first ``core`` of them
        have, or what one of them has.
        """
        slots: dict[_Slot, dict[int, list[Opening]]] = defaultdict(lambda: defaultdict(list))
        support: dict[tuple[Edit, ...], set[int]] = defaultdict(set)
        ranks: dict[tuple[Edit, ...], int] = {}
        for number, line in enumerate(lines):
            for found in self._openings.find(line):
                if isinstance(found, Opening):
                    first = self.phraser.sign(found.words[:1]) or ""
                    slots[found.kind, found.rule, found.place, first][number].append(found)
                else:
                    rank, edits = found
                    support[edits].add(number)
                    ranks[edits] = min(rank, ranks.get(edits, rank))
        hopeful = sorted(
            slots.items(),
            key=lambda slot: (
                -_hope(len(slot[1]), min(o[0].rank for o in slot[1].values())),
                slot[0],
            ),
        )
        for _, of_lines in hopeful[:most]:
            openings = [openings[0] for openings in of_lines.values()]
            nearer = [openings[0] for number, openings in of_lines.items() if number < core]
            written = [*self._of_slot(openings), *self._of_opening(openings[0])]
            if nearer and len(nearer) < len(openings):
                written += self._of_slot(nearer)
            for rank, edits in written:
                support[edits] |= of_lines.keys()
                ranks[edits] = min(rank, ranks.get(edits, rank))
        hopes = {edits: _hope(len(support[edits]), ranks[edits]) for edits in ranks}
        in_rule: Counter[str] = Counter()
        varied: dict[tuple[Edit, ...], float] = {}
        for edits in sorted(ranks, key=lambda e: (-hopes[e], str(e))):
            if not self.layout.is_left_recursive(edits[-1]):
                rule = getattr(edits[-1], "rule", "")
                varied[edits] = hopes[edits] * SAME_RULE_FACTOR ** in_rule[rule]
                in_rule[rule] += 1
        ordered = sorted(varied, key=lambda e: (-varied[e], str(e)))
        return [Candidate(edits, ranks[edits]) for edits in ordered]

    def find_blocks(
        self, line: Line, opener: str, texts: Sequence[str], meant: frozenset[str]
    ) -> list[Candidate]:
        """Candidates for the block that a line opens; ``texts`` are files with such lines."""
        blocks = self._blocks.find(opener, texts, meant)
        rules = self._openings.block_rules(line) if blocks else ()
        return self._ordered(self._as_block(rule, block) for rule in rules for block in blocks)

    def _as_block(self, rule: str, block: Block) -> Ranked:
        known = self.layout.grammar.by_name
        rank = self.layout.width(rule) + self.phraser.breadth(block.symbols) + len(block.symbols)
        if rule not in self.layout.of_lines:
            rank += NO_LINE_RULE_COST
        symbols = (*block.symbols, *self._closing(rule))
        return rank + self.likeness.unlike(rule, symbols), (
            *self.layout.vocabulary.reserve(k for k in block.keywords if k not in known),
            AddAlternative(rule, " ".join(symbols)),
        )

    def _closing(self, rule: str) -> tuple[str, ...]:
        closing = self.layout.closing(rule)
        return (closing,) if closing else ()

    def _ordered(self, ranked: Iterable[Ranked]) -> list[Candidate]:
        found: dict[tuple[Edit, ...], int] = {}
        for rank, edits in ranked:
            known = found.get(edits)
            if known is None or rank < known:
                found[edits] = rank
        ordered = sorted(found.items(), key=lambda item: (item[1], str(item[0])))
        return [
            Candidate(edits, rank)
            for edits, rank in ordered
            if not self.layout.is_left_recursive(edits[-1])
        ]

    def _of_line(self, line: Line) -> Iterator[Ranked]:
        for found in self._openings.find(line):
            if isinstance(found, Opening):
                yield from self._of_opening(found)
            else:
                yield found

    def _of_opening(self, opening: Opening) -> Iterator[Ranked]:
        near = self.layout.near(opening.rule)
        for symbols in self.phraser.phrases(opening.words, near):
            yield from self._written(opening, opening.words, symbols)

    def _of_slot(self, openings: Sequence[Opening]) -> Iterator[Ranked]:
        some = min(openings, key=lambda opening: opening.rank)
        phrases = sorted({opening.words for opening in openings}, key=str)
        words = [word for phrase in phrases for word in phrase]
        near = self.layout.near(some.rule)
        units = [_unit(phrase) or phrase for phrase in phrases]
        for symbols in common_phrases(self.phraser, units, near):
            yield from self._written(some, words, symbols, looped=units != phrases)

    # ------------------------------------------------------------------------------ the edits

    def _written(
        self,
        opening: Opening,
        words: Sequence[Word],
        symbols: tuple[str, ...],
        *,
        looped: bool = False,
    ) -> Iterator[Ranked]:
        """The edits that write symbols for words where they could be let in."""
        rule, place = opening.rule, opening.place
        rank = opening.rank + self.phraser.breadth(symbols) + len(" ".join(symbols).split(" "))
        tokens = self._openings.reserved(words)
        match opening.kind:
            case "alternative" if not self.layout.closing(rule):  # else it is of the kind ``line``
                yield from self._alternative(rule, symbols, rank, tokens)
            case "line":
                yield from self._alternative(rule, (*symbols, self.layout.line_end), rank, tokens)
            case "widen":
                yield rank, (*tokens, Widen(rule, place, " ".join(symbols)))
            case "lines":
                ended = f"{' '.join(symbols)} {self.layout.line_end}"
                yield rank, (*tokens, Insert(rule, place, f"({ended})*"))
                if self.phraser.sign(words[:1]):
                    for body in self.layout.bodies:
                        text = f"({ended} {' '.join(body)})"
                        rank += len(body)
                        yield rank - BLOCK_PART_BONUS, (*tokens, Insert(rule, place, f"{text}?"))
                        yield (
                            rank - BLOCK_PART_BONUS + 1,
                            (*tokens, Insert(rule, place, f"{text}*")),
                        )
            case "insert":
                unit = _unit(symbols)
                if unit is None and not looped:
                    text = _optional(symbols)
                    worth = rank - self.layout.said_so(text)
                    yield worth, (*tokens, Insert(rule, place, text))
                    better = self.layout.place_as_elsewhere(rule, place, text)
                    if better is not None:
                        yield worth - 1, (*tokens, Insert(rule, better, text))
                again = unit or symbols
                if again[0] == "','" or unit or looped:
                    text = f"({' '.join(again)})*" if len(again) > 1 else f"{again[0]}*"
                    rank += 1 - self.layout.said_so(text)
                    yield rank, (*tokens, Insert(rule, place, text))

    def _alternative(
        self, rule: str, symbols: tuple[str, ...], rank: int, tokens: tuple[Edit, ...]
    ) -> Iterator[Ranked]:
        text = " ".join(symbols)
        if text not in self.layout.alternatives(rule) and not self.likeness.is_foreign(
            rule, symbols
        ):
            rank += self.likeness.unlike(rule, symbols)
            if self.likeness.repeats_sibling(rule, symbols):
                rank += 2 * UNLIKELY_COST
            if self.likeness.extends(rule, symbols):
                rank += UNLIKELY_COST
            if len(symbols) == 1 and self.phraser.would_be_read_twice(rule, text):
                rank += 2 * UNLIKELY_COST
            yield rank, (*tokens, AddAlternative(rule, text))


def _hope(lines: int, rank: int) -> float:
    """What may be gained where so many lines have an opening."""
    return lines * float(BREADTH_FACTOR**rank)


_T = TypeVar("_T")


def _unit(items: tuple[_T, ...]) -> tuple[_T, ...] | None:
    """The shortest unit that symbols or words repeat, where they are more than one of it."""
    for size in range(1, len(items) // 2 + 1):
        unit = items[:size]
        if len(items) % size == 0 and unit * (len(items) // size) == items:
            return unit
    return None


def _optional(symbols: tuple[str, ...]) -> str:
    single = len(symbols) == 1 and symbols[0][-1] not in "?*+"
    return f"{symbols[0]}?" if single else f"({' '.join(symbols)})?"
