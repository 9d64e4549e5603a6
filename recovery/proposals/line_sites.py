"""Edit sites for whole lines of a kind that the grammar does not expect there.

Such lines may be accepted any number of times, as one more alternative where lines can come, or
because the line end before them was read as something else.
"""

from __future__ import annotations

from collections.abc import Iterator

from grammar.notation.edits import AddAlternative, Insert
from grammar.parser.failures import Form
from grammar.parser.lazy_automaton import Configuration
from grammar.parser.recognizer import State
from grammar.parser.shortest_paths import Paths
from recovery.forms.symbols import Token
from recovery.proposals.edit_site import EditSite, RankedEdits, configurations_of, places_of
from recovery.proposals.grammar_profile import GrammarProfile
from recovery.proposals.phrases import Phraser
from recovery.proposals.similarity import Similarity
from recovery.tuning import LINE_LOOP_COST, SITE_COST, UNLIKELY_COST


class LineSiteFinder:
    """Finds the edit sites of one grammar for whole lines."""

    def __init__(self, profile: GrammarProfile, similarity: Similarity, phraser: Phraser) -> None:
        self.recognizer = profile.recognizer
        self.grammar = profile.grammar
        self.profile = profile
        self.similarity = similarity
        self.phraser = phraser
        self._paths = Paths(profile.recognizer.network)

    def as_lines(self, before: State, words: list[Token]) -> Iterator[EditSite | RankedEdits]:
        """Yield sites that accept the line any number of times where it is not expected."""
        recognizer, profile = self.recognizer, self.profile
        kinds = tuple(kind for kind, _ in words)
        if kinds[-1] != recognizer.line_kind:
            return
        known = any(keyword for _, keyword in words)
        blank = len(kinds) == 1
        line_rules = () if known or blank else self._rules_of_line(kinds)
        if not blank:
            yield from self._as_whole_line(before, words)
        yield from self._line_rules_here(before, line_rules)
        for site in configurations_of(self.recognizer, before):
            rule = recognizer.network.rule[site[0]]
            if rule in profile.line_ends:
                continue
            rank = profile.width(rule) + SITE_COST
            if self._is_beside_lines(site):
                rank += 2 * UNLIKELY_COST  # it would put lines in an order that no text asks for
            for place in places_of(self.recognizer, site):
                if rule != self.grammar.start and profile.is_at_start(rule, place):
                    continue  # text before a rule belongs to the calling rule
                if blank:
                    yield rank, (Insert(rule, place, f"{recognizer.lexer.line_end}*"),)
                    continue
                for line_rule in line_rules:
                    fits = line_rule in profile.loops or profile.is_free(line_rule)
                    worth = (
                        rank + self.phraser.breadth([line_rule]) + (0 if fits else UNLIKELY_COST)
                    )
                    yield worth, (Insert(rule, place, f"{line_rule}*"),)
                if not line_rules:
                    phrase = tuple(words[:-1])
                    yield EditSite("lines", rule, place, phrase, rank + 2 * UNLIKELY_COST)

    def _line_rules_here(self, before: State, line_rules: tuple[str, ...]) -> Iterator[RankedEdits]:
        """Yield edits that accept known rules of whole lines as another alternative here."""
        recognizer, profile = self.recognizer, self.profile
        for rule in sorted(recognizer.entered(before) & profile.loops & profile.choices_of_lines):
            for line_rule in line_rules:
                if line_rule not in profile.choices_of_lines or line_rule == rule:
                    continue
                rank = profile.width(rule) + SITE_COST + self.phraser.breadth([line_rule])
                rank += self.similarity.dissimilarity(rule, (line_rule,))
                yield rank, (AddAlternative(rule, line_rule),)

    def _is_beside_lines(self, site: Configuration) -> bool:
        """Return whether lines of some kind can be repeated at a configuration."""
        network = self.recognizer.network
        called = {network.rule[entry] for entry, _ in network.calls[site[0]]}
        return bool(called & self.profile.loops & self.profile.choices_of_lines)

    def after_line_end(self, form: Form, words: list[Token]) -> Iterator[RankedEdits]:
        """Yield edits that read the line if the line end before it had been read otherwise."""
        recognizer, profile = self.recognizer, self.profile
        way = min(map(self._paths.prefix, form.before), key=len)
        if not way or way[-1] != recognizer.line_kind:
            return
        state, _ = recognizer.run(recognizer.start, way[:-1])
        kinds = tuple(kind for kind, _ in words)
        known = any(keyword for _, keyword in words)
        line_rules = () if known else self._rules_of_line(kinds)
        for site in configurations_of(self.recognizer, state):
            rule = recognizer.network.rule[site[0]]
            if rule in profile.line_ends:
                continue
            goes_on = recognizer.run(recognizer.at(site, state), kinds[:1])[1] is None
            rank = profile.width(rule) + SITE_COST
            for place in places_of(self.recognizer, site):
                if rule != self.grammar.start and profile.is_at_start(rule, place):
                    continue
                if goes_on:
                    yield rank, (Insert(rule, place, f"{recognizer.lexer.line_end}*"),)
                for line_rule in line_rules:
                    text = f"({profile.line_end} {line_rule})*"
                    yield (
                        rank + self.phraser.breadth([line_rule]) + LINE_LOOP_COST,
                        (Insert(rule, place, text),),
                    )

    def _as_whole_line(self, before: State, words: list[Token]) -> Iterator[EditSite]:
        """Yield the line, with its end, as an alternative of a rule of whole lines."""
        for rule in sorted(self.recognizer.entered(before)):
            end = self.profile.closing(rule)
            if end is not None:
                rank = self.profile.width(rule) + SITE_COST
                yield EditSite("line", rule, (1, 1), tuple(words[:-1]), rank)

    def _rules_of_line(self, kinds: tuple[int, ...]) -> tuple[str, ...]:
        """Return the rules of which the line is a whole sentence or the first line."""
        matcher = self.phraser.matcher
        whole = matcher.rules_for(kinds) | frozenset(matcher.multi_line_rules(kinds))
        return tuple(sorted(whole - self.profile.line_ends))

    def as_new_line(self, before: State, words: list[Token]) -> Iterator[EditSite]:
        """Yield the line as an alternative of a rule behind which its line end can be read."""
        last = len(words) - 1
        end = [words[last][0]]
        network = self.recognizer.network
        for position, stack in configurations_of(self.recognizer, before):
            for entry, back in network.calls[position]:
                rule = network.rule[entry]
                if not self.profile.has_choice(rule):
                    continue
                beyond = self.recognizer.at((back, stack), before)
                if self.recognizer.run(beyond, end)[1] is None:
                    rank = self.profile.width(rule) + SITE_COST + UNLIKELY_COST
                    yield EditSite("alternative", rule, (1, 1), tuple(words[:last]), rank)
