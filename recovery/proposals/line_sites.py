"""Edit sites for whole lines of a kind that the grammar does not expect there.

Such lines may be accepted any number of times, or as one more alternative where lines can come.
"""

from __future__ import annotations

from collections.abc import Iterator

from grammar.notation.addresses import Address
from grammar.notation.edits import Insert
from grammar.parser.lazy_automaton import Configuration
from grammar.parser.recognizer import State
from recovery.proposals.edit_site import EditSite, RankedEdits, configurations_of, places_of
from recovery.proposals.grammar_profile import GrammarProfile
from recovery.proposals.line_reading import LineReading
from recovery.proposals.phrases import Phraser
from recovery.tuning import SITE_COST, UNLIKELY_COST


class LineSiteFinder:
    """Finds the edit sites of one grammar for whole lines."""

    def __init__(self, profile: GrammarProfile, phraser: Phraser) -> None:
        self._recognizer = profile.recognizer
        self._grammar = profile.grammar
        self._profile = profile
        self._phraser = phraser

    def find(self, reading: LineReading) -> Iterator[EditSite | RankedEdits]:
        """Yield the sites of a line as a whole."""
        line_kind, kinds = self._recognizer.line_kind, [kind for kind, _ in reading.words]
        if kinds == [line_kind]:
            yield from self._blank_line(reading.before(0))
        elif kinds[-1] == line_kind:
            yield from self._as_lines(reading)

    def _blank_line(self, before: State) -> Iterator[RankedEdits]:
        """Yield edits that accept line ends."""
        for site in configurations_of(self._recognizer, before):
            for place, rank in self._between_lines(site):
                yield (
                    rank,
                    (Insert(self._rule_of(site), place, f"{self._recognizer.lexer.line_end}*"),),
                )

    def _as_lines(self, reading: LineReading) -> Iterator[EditSite | RankedEdits]:
        """Yield sites that accept the line, or any number of such, where it is not expected."""
        before, words = reading.before(0), reading.words[:-1]
        line_rules = self._rules_of_line(reading)
        for rule in sorted(self._recognizer.entered(before)):
            if self._profile.closing(rule) is not None:
                rank = self._profile.width(rule) + SITE_COST
                yield EditSite("line", rule, (1, 1), words, rank)
        for site in reading.configurations(0):
            rule = self._rule_of(site)
            for place, rank in self._between_lines(site):
                for line_rule in line_rules:
                    steps = rank + self._phraser.breadth([line_rule])
                    if line_rule not in self._profile.loops and not self._profile.is_free(
                        line_rule
                    ):
                        steps += UNLIKELY_COST
                    yield steps, (Insert(rule, place, f"{line_rule}*"),)
                if not line_rules:
                    yield EditSite("lines", rule, place, words, rank + 2 * UNLIKELY_COST)

    def _between_lines(self, site: Configuration) -> Iterator[tuple[Address, int]]:
        """Yield the places of a configuration where lines may be inserted, with the breadth."""
        rule, profile = self._rule_of(site), self._profile
        if rule in profile.line_ends:
            return
        rank = profile.width(rule) + SITE_COST
        if self._is_beside_lines(site):
            rank += 2 * UNLIKELY_COST  # it would put lines in an order that no text asks for
        for place in places_of(self._recognizer, site):
            # text before a rule belongs to the calling rule
            if rule == self._grammar.start or not profile.is_at_start(rule, place):
                yield place, rank

    def _is_beside_lines(self, site: Configuration) -> bool:
        """Return whether lines of some kind can be repeated at a configuration."""
        network = self._recognizer.network
        called = {network.rule[entry] for entry, _ in network.calls[site[0]]}
        return bool(called & self._profile.loops & self._profile.choices_of_lines)

    def _rules_of_line(self, reading: LineReading) -> tuple[str, ...]:
        """Return the rules of which the line is a whole sentence or the first line.

        Returns none for a line with new words.
        """
        if any(keyword for _, keyword in reading.words):
            return ()
        matcher = self._phraser.matcher
        kinds = tuple(kind for kind, _ in reading.words)
        whole = matcher.rules_for(kinds) | frozenset(matcher.multi_line_rules(kinds))
        return tuple(sorted(whole - self._profile.line_ends))

    def _rule_of(self, site: Configuration) -> str:
        return self._recognizer.network.rule[site[0]]
