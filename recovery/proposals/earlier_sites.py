"""Edit sites ahead of the failing token, where the line was read as something else."""

from __future__ import annotations

from collections.abc import Iterator

from grammar.parser.recognizer import State
from recovery import tuning
from recovery.proposals.edit_site import EditSite, places_of
from recovery.proposals.grammar_profile import GrammarProfile
from recovery.proposals.insertion_sites import insertions
from recovery.proposals.line_reading import LineReading


class EarlierSiteFinder:
    """Finds the edit sites of one grammar at tokens that were read."""

    def __init__(self, profile: GrammarProfile) -> None:
        self._recognizer = profile.recognizer
        self._profile = profile

    def find(self, reading: LineReading) -> Iterator[EditSite]:
        """Yield the sites of a line at tokens before the failing one."""
        yield from self._taken_for_something_else(reading)
        for start in range(max(0, reading.failed - tuning.MOST_SKIPPED), reading.failed):
            yield from self._parts(reading, start)

    def _taken_for_something_else(self, reading: LineReading) -> Iterator[EditSite]:
        """Yield alternatives of rules as which earlier tokens were read."""
        recognizer, network = self._recognizer, self._recognizer.network
        begun = reading.frames_begun()
        latest: dict[tuple[int, tuple[int, ...]], tuple[int, int, State]] = {}
        for start in range(reading.failed):
            state = reading.before(start)
            for position, stack in reading.configurations(start):
                below = stack.positions()
                for entry, back in network.calls[position]:
                    frames = (back, *below)
                    if frames in begun:
                        beyond = recognizer.at((back, stack), state)
                        latest[entry, frames] = (start, entry, beyond)
        for start, entry, beyond in latest.values():
            rule = network.rule[entry]
            if rule in self._profile.line_ends:
                continue
            rank = self._profile.width(rule) + tuning.SITE_COST
            for end in reading.resuming(beyond, start, reading.failed + 1):
                yield EditSite("alternative", rule, (1, 1), reading.words[start:end], rank)

    def _parts(self, reading: LineReading, start: int) -> Iterator[EditSite]:
        """Yield insertions; the tokens that were read may be the end of another reading's part."""
        recognizer, network = self._recognizer, self._recognizer.network
        state = reading.before(start)
        for site in reading.configurations(start):
            rule = network.rule[site[0]]
            if rule in self._profile.line_ends:
                continue
            is_first = site[0] == network.entry[rule]
            for end in reading.reading_on(recognizer.at(site, state), start, start + 1):
                for place in places_of(recognizer, site):
                    sequence = self._profile.sequence(rule, place[:-1])
                    comes_next = reading.words[end][0] in self._profile.first(sequence, place[-1])
                    if comes_next or (not is_first and end >= reading.failed):
                        words = reading.words[start:end]
                        yield from insertions(self._profile, rule, place, words)
