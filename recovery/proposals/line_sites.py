"""Openings for whole lines: where no line of the kind was thought of.

Lines may be let in any number of times, as one more alternative where lines come, or because the
line end before them was taken for something else.
"""

from __future__ import annotations

from collections.abc import Iterator

from grammar.notation.edits import AddAlternative, Insert
from grammar.parser.failures import Form
from grammar.parser.lazy_automaton import Configuration
from grammar.parser.recognizer import State
from grammar.parser.shortest_paths import Paths
from recovery.proposals.edit_site import Opening, Ranked, places_of, sites_of
from recovery.proposals.grammar_profile import Layout
from recovery.proposals.phrases import Phraser
from recovery.proposals.segmentation import Word
from recovery.proposals.similarity import Likeness
from recovery.tuning import LINE_LOOP_COST, SITE_COST, UNLIKELY_COST

__all__ = ["LineOpenings"]


class LineOpenings:
    """Finds openings for whole lines under one grammar."""

    def __init__(self, layout: Layout, likeness: Likeness, phraser: Phraser) -> None:
        self.recognizer = layout.recognizer
        self.grammar = layout.grammar
        self.layout = layout
        self.likeness = likeness
        self.phraser = phraser
        self._paths = Paths(layout.recognizer.network)

    def as_lines(self, before: State, words: list[Word]) -> Iterator[Opening | Ranked]:
        """The line, any number of times, where no such line was thought of."""
        recognizer, layout = self.recognizer, self.layout
        kinds = tuple(kind for kind, _ in words)
        if kinds[-1] != recognizer.line_kind:
            return
        known = any(keyword for _, keyword in words)
        blank = len(kinds) == 1
        readers = () if known or blank else self._readers(kinds)
        if not blank:
            yield from self._as_alternatives(before, words)
        yield from self._known_elsewhere(before, readers)
        for site in sites_of(self.recognizer, before):
            rule = recognizer.network.rule[site[0]]
            if rule in layout.line_ends:
                continue
            rank = layout.width(rule) + SITE_COST
            if self._is_beside_lines(site):
                rank += 2 * UNLIKELY_COST  # it would put lines in an order that no text asks for
            for place in places_of(self.recognizer, site):
                if rule != self.grammar.start and layout.is_at_start(rule, place):
                    continue  # what comes before a rule belongs to the rule that calls it
                if blank:
                    yield rank, (Insert(rule, place, "NEWLINE*"),)
                    continue
                for reader in readers:
                    fits = reader in layout.loops or self.phraser.is_unused(reader)
                    worth = rank + self.phraser.breadth([reader]) + (0 if fits else UNLIKELY_COST)
                    yield worth, (Insert(rule, place, f"{reader}*"),)
                if not readers:
                    phrase = tuple(words[:-1])
                    yield Opening("lines", rule, place, phrase, rank + 2 * UNLIKELY_COST)

    def _known_elsewhere(self, before: State, readers: tuple[str, ...]) -> Iterator[Ranked]:
        """What reads whole lines elsewhere, as one more kind of the lines that come here."""
        recognizer, layout = self.recognizer, self.layout
        network = recognizer.network
        called = {
            network.rule[entry]
            for site in sites_of(recognizer, before)
            for entry, _ in network.calls[site[0]]
        }
        for rule in sorted(called & layout.loops & layout.of_lines):
            for reader in readers:
                if reader not in layout.of_lines or reader == rule:
                    continue
                rank = layout.width(rule) + SITE_COST + self.phraser.breadth([reader])
                rank += self.likeness.unlike(rule, (reader,))
                yield rank, (AddAlternative(rule, reader),)

    def _is_beside_lines(self, site: Configuration) -> bool:
        """Whether lines of some kind come any number of times where the recogniser stands."""
        network = self.recognizer.network
        called = {network.rule[entry] for entry, _ in network.calls[site[0]]}
        return bool(called & self.layout.loops & self.layout.of_lines)

    def after_line_end(self, form: Form, words: list[Word]) -> Iterator[Ranked]:
        """What would let the line be read had the line end before it been taken otherwise."""
        recognizer, layout = self.recognizer, self.layout
        way = min(map(self._paths.prefix, form.before), key=len)
        if not way or way[-1] != recognizer.line_kind:
            return
        state, _ = recognizer.run(recognizer.start, way[:-1])
        kinds = tuple(kind for kind, _ in words)
        known = any(keyword for _, keyword in words)
        readers = () if known else self._readers(kinds)
        for site in sites_of(self.recognizer, state):
            rule = recognizer.network.rule[site[0]]
            if rule in layout.line_ends:
                continue
            goes_on = recognizer.run(recognizer.at(site, state), kinds[:1])[1] is None
            rank = layout.width(rule) + SITE_COST
            for place in places_of(self.recognizer, site):
                if rule != self.grammar.start and layout.is_at_start(rule, place):
                    continue
                if goes_on:
                    yield rank, (Insert(rule, place, "NEWLINE*"),)
                for reader in readers:
                    text = f"({layout.line_end} {reader})*"
                    yield (
                        rank + self.phraser.breadth([reader]) + LINE_LOOP_COST,
                        (Insert(rule, place, text),),
                    )

    def _as_alternatives(self, before: State, words: list[Word]) -> Iterator[Opening]:
        """The line as an alternative of a rule whose alternatives are whole lines."""
        network = self.recognizer.network
        rules = {
            network.rule[e]
            for site in sites_of(self.recognizer, before)
            for e, _ in network.calls[site[0]]
        }
        for rule in sorted(rules):
            end = self.layout.closing(rule)
            if end is not None:
                rank = self.layout.width(rule) + SITE_COST
                yield Opening("line", rule, (1, 1), tuple(words[:-1]), rank)

    def _readers(self, kinds: tuple[int, ...]) -> tuple[str, ...]:
        """Rules of which the line is a whole sentence or the first line."""
        readers = self.phraser.readers
        whole = readers.rules_for(kinds) | frozenset(readers.opened_by(kinds))
        return tuple(sorted(whole - self.layout.line_ends))

    def as_new_line(self, before: State, words: list[Word]) -> Iterator[Opening]:
        """The whole line as an alternative of a rule that can stand there."""
        last = len(words) - 1
        end = [words[last][0]]
        network = self.recognizer.network
        for position, stack in self.recognizer.sites(before):
            for entry, back in network.calls[position]:
                rule = network.rule[entry]
                if not self.layout.is_hub(rule):
                    continue
                beyond = self.recognizer.at((back, stack), before)
                if self.recognizer.run(beyond, end)[1] is None:
                    rank = self.layout.width(rule) + SITE_COST + UNLIKELY_COST
                    yield Opening("alternative", rule, (1, 1), tuple(words[:last]), rank)
