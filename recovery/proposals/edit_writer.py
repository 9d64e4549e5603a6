"""What is written at a site: the edits that let a rule read the unexpected tokens there.

The text is the tokens themselves, or a phrase that reads those of all lines with this site
(`recovery.proposals.alignment`), with rules in place of operands (`recovery.proposals.phrases`).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import TypeVar

from grammar.notation.edits import AddAlternative, Edit, Insert, Widen
from recovery import tuning
from recovery.forms.symbols import Token
from recovery.proposals.alignment import Aligner
from recovery.proposals.edit_site import EditSite, RankedEdits
from recovery.proposals.phrases import Phraser
from recovery.proposals.similarity import Similarity

_Symbols = tuple[str, ...]


class EditWriter:
    """Writes the edits for sites of one grammar."""

    def __init__(self, phraser: Phraser, aligner: Aligner, similarity: Similarity) -> None:
        self._phraser = phraser
        self._aligner = aligner
        self._similarity = similarity
        self._profile = phraser.profile

    def edits(self, sites: Sequence[EditSite]) -> Iterator[RankedEdits]:
        """Yield the edits for the sites of one or several lines at the same place."""
        some = min(sites, key=lambda site: site.rank)
        if some.kind == "repetition":
            yield self._repetition(some, [word for site in sites for word in site.words])
            return
        phrases = sorted({site.words for site in sites}, key=str)
        words = [word for phrase in phrases for word in phrase]
        near = self._profile.near(some.rule)
        units = [_unit(phrase) or phrase for phrase in phrases]
        alone = self._phraser.alone(units[0]) if len(phrases) == 1 else ()
        for symbols in dict.fromkeys([*alone, *self._aligner.common_phrases(units, near)]):
            yield from self._written(some, words, symbols, looped=units != phrases)

    def sign(self, site: EditSite) -> str:
        """Return the keyword or sign with which the words of a site begin, or an empty text."""
        return (self._phraser.matcher.sign(site.words[0]) if site.words else "") or ""

    def _reserved(self, words: Iterable[Token]) -> tuple[Edit, ...]:
        """Return the edits that reserve the suspected keywords among the words."""
        return self._profile.vocabulary.reserve(keyword for _, keyword in words if keyword)

    def _repetition(self, site: EditSite, signs: Iterable[Token]) -> RankedEdits:
        """Return the edits that repeat the operand before a site: ``((x | y) a)*``."""
        signs = set(signs)
        texts = sorted(filter(None, map(self._phraser.matcher.text, signs)))
        sign = texts[0] if len(texts) == 1 else f"({' | '.join(texts)})"
        elements = self._profile.sequence(site.rule, site.place[:-1]).elements
        operand = self._profile.grammar.by_name[site.rule].source_of(elements[site.place[-1] - 2])
        text = f"({sign} {operand})*"
        rank = site.rank - self._profile.same_text_bonus(text)
        return rank, (*self._reserved(signs), Insert(site.rule, site.place, text))

    def _written(
        self, site: EditSite, words: Sequence[Token], symbols: _Symbols, *, looped: bool = False
    ) -> Iterator[RankedEdits]:
        """Yield the edits that write symbols at a site, with those that reserve words."""
        if self._phraser.groups.are_torn(site.rule, symbols):
            return
        rank = site.rank + self._phraser.breadth(symbols) + len(" ".join(symbols).split(" "))
        tokens = self._reserved(words)
        for more, edit in self._edits(site, symbols, looped=looped):
            yield rank + more, (*tokens, edit)

    def _edits(
        self, site: EditSite, symbols: _Symbols, *, looped: bool
    ) -> Iterator[tuple[int, Edit]]:
        """Yield the edits that write symbols at a site, with steps in breadth."""
        rule, place = site.rule, site.place
        match site.kind:
            # Where all alternatives end a line, there is a site of the kind ``line``.
            case "alternative" if self._profile.closing(rule) is None:
                yield from self._alternative(rule, symbols)
            case "line":
                yield from self._alternative(rule, (*symbols, self._profile.line_end))
            case "widen":
                yield 0, Widen(rule, place, " ".join(symbols))
            case "lines":
                yield from self._lines(site, symbols)
            case "insert":
                yield from self._insertion(site, symbols, looped=looped)

    def _alternative(self, rule: str, symbols: _Symbols) -> Iterator[tuple[int, Edit]]:
        profile, similarity, text = self._profile, self._similarity, " ".join(symbols)
        is_word = len(symbols) == 1 and profile.vocabulary.is_set_of_words(rule)
        opens_block = symbols[0] in profile.openers and not is_word
        if (
            text in profile.alternatives(rule)
            or profile.has_only_blocks(rule)
            or opens_block
            or similarity.is_foreign(rule, symbols)
        ):
            return
        unlikely = (
            similarity.repeats_sibling(rule, symbols)
            + similarity.extends(rule, symbols)
            + (len(symbols) == 1 and self._phraser.would_be_read_twice(rule, text))
        )
        steps = similarity.dissimilarity(rule, symbols) - profile.same_text_bonus(text)
        yield steps + 2 * tuning.UNLIKELY_COST * unlikely, AddAlternative(rule, text)

    def _lines(self, site: EditSite, symbols: _Symbols) -> Iterator[tuple[int, Edit]]:
        """Yield lines in a row, and lines that others follow: parts of a block."""
        ended = f"{' '.join(symbols)} {self._profile.line_end}"
        yield 0, Insert(site.rule, site.place, f"({ended})*")
        steps = -tuning.BLOCK_PART_BONUS
        for body in self._profile.bodies if self.sign(site) else ():
            text = f"({ended} {' '.join(body)})"
            steps += len(body)
            yield steps, Insert(site.rule, site.place, f"{text}?")
            yield steps + 1, Insert(site.rule, site.place, f"{text}*")

    def _insertion(
        self, site: EditSite, symbols: _Symbols, *, looped: bool
    ) -> Iterator[tuple[int, Edit]]:
        """Yield the symbols as an optional part, and as one that may come again."""
        rule, place, profile = site.rule, site.place, self._profile
        unit = _unit(symbols)
        if unit is None and not looped:
            text = _optional(symbols)
            steps = -profile.same_text_bonus(text)
            yield steps, Insert(rule, place, text)
            better = profile.usual_place(rule, place, text)
            if better is not None:
                yield steps - 1, Insert(rule, better, text)
        again = unit or symbols
        if again[0] == "','" or unit or looped:
            text = f"({' '.join(again)})*" if len(again) > 1 else f"{again[0]}*"
            yield 1 - profile.same_text_bonus(text), Insert(rule, place, text)


_T = TypeVar("_T")


def _unit(items: tuple[_T, ...]) -> tuple[_T, ...] | None:
    """Return the shortest sequence whose repetition gives ``items``; ``None`` if there is none."""
    for size in range(1, len(items) // 2 + 1):
        unit = items[:size]
        if len(items) % size == 0 and unit * (len(items) // size) == items:
            return unit
    return None


def _optional(symbols: _Symbols) -> str:
    single = len(symbols) == 1 and symbols[0][-1] not in "?*+"
    return f"{symbols[0]}?" if single else f"({' '.join(symbols)})?"
