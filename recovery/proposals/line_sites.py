"""Edit sites for whole lines of a kind that the grammar does not expect there.

Such lines may be accepted any number of times, as one more alternative where lines can come, or
because the line end before them was read as something else.
"""

from __future__ import annotations

from collections.abc import Iterator

from grammar.notation.addresses import Address
from grammar.notation.edits import AddAlternative, Insert
from grammar.parser.lazy_automaton import Configuration
from grammar.parser.recognizer import State
from grammar.parser.shortest_paths import Paths
from recovery.proposals.edit_site import EditSite, RankedEdits, configurations_of, places_of
from recovery.proposals.grammar_profile import GrammarProfile
from recovery.proposals.line_reading import LineReading
from recovery.proposals.phrases import Phraser
from recovery.proposals.similarity import Similarity
from recovery.tuning import LINE_LOOP_COST, SITE_COST, UNLIKELY_COST


class LineSiteFinder:
    """Finds the edit sites of one grammar for whole lines."""

    def __init__(self, profile: GrammarProfile, similarity: Similarity, phraser: Phraser) -> None:
        self._recognizer = profile.recognizer
        self._grammar = profile.grammar
        self._profile = profile
        self._similarity = similarity
        self._phraser = phraser
        self._paths = Paths(profile.recognizer.network)

    def find(self, reading: LineReading, *, is_new: bool) -> Iterator[EditSite | RankedEdits]:
        """Yield the sites of a line as a whole; ``is_new`` if its first token could be read."""
        if is_new:
            yield from self._as_new_line(reading)
        line_kind, kinds = self._recognizer.line_kind, [kind for kind, _ in reading.words]
        if kinds == [line_kind]:
            yield from self._blank_line(reading.before(0))
        elif kinds[-1] == line_kind:
            yield from self._as_lines(reading)
        if reading.failed == 0:
            yield from self._after_line_end(reading)

    def _as_new_line(self, reading: LineReading) -> Iterator[EditSite]:
        """Yield the line as an alternative of a rule behind which its line end can be read."""
        before, (*words, end) = reading.before(0), reading.words
        network = self._recognizer.network
        for position, stack in reading.configurations(0):
            for entry, back in network.calls[position]:
                rule = network.rule[entry]
                beyond = self._recognizer.at((back, stack), before)
                goes_on = self._recognizer.run(beyond, end[:1])[1] is None
                if goes_on and self._profile.has_choice(rule):
                    rank = self._profile.width(rule) + SITE_COST + UNLIKELY_COST
                    yield EditSite("alternative", rule, (1, 1), tuple(words), rank)

    # ------------------------------------------------------------------------ where it stands

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
        yield from self._line_rules_here(before, line_rules)
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

    def _line_rules_here(self, before: State, line_rules: tuple[str, ...]) -> Iterator[RankedEdits]:
        """Yield edits that accept known rules of whole lines as another alternative here."""
        profile = self._profile
        entered = self._recognizer.entered(before)
        for rule in sorted(entered & profile.loops & profile.choices_of_lines):
            for line_rule in line_rules:
                if line_rule in profile.choices_of_lines and line_rule != rule:
                    rank = profile.width(rule) + SITE_COST + self._phraser.breadth([line_rule])
                    rank += self._similarity.dissimilarity(rule, (line_rule,))
                    yield rank, (AddAlternative(rule, line_rule),)

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

    # ------------------------------------------------------------- behind another line end

    def _after_line_end(self, reading: LineReading) -> Iterator[RankedEdits]:
        """Yield edits that read the line if the line end before it had been read otherwise."""
        recognizer, profile = self._recognizer, self._profile
        way = min(map(self._paths.prefix, reading.line.form.before), key=len)
        if not way or way[-1] != recognizer.line_kind:
            return
        state, _ = recognizer.run(recognizer.start, way[:-1])
        line_rules = self._rules_of_line(reading)
        for site in configurations_of(recognizer, state):
            rule = self._rule_of(site)
            if rule in profile.line_ends:
                continue
            goes_on = recognizer.run(recognizer.at(site, state), reading.words[0][:1])[1] is None
            rank = profile.width(rule) + SITE_COST
            for place in places_of(recognizer, site):
                if rule != self._grammar.start and profile.is_at_start(rule, place):
                    continue
                if goes_on:
                    yield rank, (Insert(rule, place, f"{recognizer.lexer.line_end}*"),)
                for line_rule in line_rules:
                    steps = rank + self._phraser.breadth([line_rule]) + LINE_LOOP_COST
                    text = f"({profile.line_end} {line_rule})*"
                    yield steps, (Insert(rule, place, text),)

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
