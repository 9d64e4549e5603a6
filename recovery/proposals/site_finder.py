"""Finding edit sites: where the grammar could accept the tokens of a failing line.

The sites follow from the configurations of the recogniser at the offending token, and from the
positions from which the rest of the line can be read. Those ahead of it are found by
`recovery.proposals.earlier_sites`, those for whole lines by `recovery.proposals.line_sites`.
`recovery.proposals.edit_writer` decides what to write there.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from grammar.notation.addresses import Address
from grammar.notation.edits import AddAlternative, MakeOptional
from grammar.notation.model import Alternative, Element, Group, Reference, Repeat
from grammar.parser.lazy_automaton import Configuration
from recovery import tuning
from recovery.forms.symbols import Token
from recovery.proposals.earlier_sites import EarlierSiteFinder
from recovery.proposals.edit_site import EditSite, LinePattern, RankedEdits, places_of
from recovery.proposals.grammar_profile import GrammarProfile
from recovery.proposals.insertion_sites import insertion_width, insertions
from recovery.proposals.line_reading import LineReading
from recovery.proposals.line_sites import LineSiteFinder
from recovery.proposals.phrases import Phraser
from recovery.proposals.similarity import Similarity


class EditSiteFinder:
    """Finds the edit sites of one grammar."""

    def __init__(self, profile: GrammarProfile, similarity: Similarity, phraser: Phraser) -> None:
        self._recognizer = profile.recognizer
        self._grammar = profile.grammar
        self._profile = profile
        self._vocabulary = profile.vocabulary
        self._similarity = similarity
        self._phraser = phraser
        self._earlier = EarlierSiteFinder(profile)
        self._lines = LineSiteFinder(profile, phraser)

    def find(self, line: LinePattern) -> Iterator[EditSite | RankedEdits]:
        """Yield the sites of a line, and complete edits; with duplicates."""
        words = self._phraser.groups.as_read(line.words(), line.form.index)
        reading = LineReading(self._recognizer, line, words)
        # a suspected keyword was read as a name, so the line failed later than it should have
        starts = {reading.failed, *(i for i, _ in line.keywords if i < reading.failed)}
        for start in sorted(starts):
            for site in reading.configurations(start):
                yield from self._at(reading, start, site)
        if reading.failed:
            # the last token may have been read as something that the line leaves out
            start = reading.failed - 1
            for site in reading.configurations(start):
                for place in places_of(self._recognizer, site):
                    yield from self._omissions(reading, start, site, place)
            yield from self._earlier.find(reading)
        yield from self._lines.find(reading)

    def block_rules(self, line: LinePattern) -> list[str]:
        """Return the rules for lines or blocks that can begin where a line begins."""
        rules = self._recognizer.entered(self._recognizer.restore(line.form.before))
        return sorted(rules & (self._profile.choices_of_lines | self._profile.blocks))

    def _at(
        self, reading: LineReading, start: int, site: Configuration
    ) -> Iterator[EditSite | RankedEdits]:
        """Yield the sites and edits at a configuration before a token."""
        rule = self._recognizer.network.rule[site[0]]
        if rule in self._profile.line_ends:
            return
        for place in places_of(self._recognizer, site):
            yield from self._parts(reading, start, site, place)
            yield from self._blocks(rule, place, reading.words[start:])
            yield from self._replacements(reading, start, site, place)
            yield from self._omissions(reading, start, site, place)

    # ---------------------------------------------------------------------- missing parts

    def _parts(
        self, reading: LineReading, start: int, site: Configuration, place: Address
    ) -> Iterator[EditSite]:
        """Yield insertions at a place, behind which the line continues at the same place."""
        network = self._recognizer.network
        rule = network.rule[site[0]]
        base = network.entry[rule]
        number = place[-1]
        sequence = self._profile.sequence(rule, place[:-1])
        is_inside = site[0] != base
        is_last = (*place[:-1], number + 1) not in network.automata[rule].places[site[0] - base]
        begins_loop = number == 1 and len(place) > 2
        is_suffix = is_last and is_inside and not begins_loop
        for end in reading.resuming(self._recognizer.at(site, reading.before(start)), start):
            words = reading.words[start:end]
            comes_next = reading.words[end][0] in self._profile.first(sequence, number)
            # after all optional elements, except those that the line has next; before the first
            # element of a rule only if that element itself comes next
            is_prefix = is_inside or (
                not self._similarity.gathers(rule) and len(words) <= tuning.LONGEST_PREFIX
            )
            if (comes_next and is_prefix) or is_suffix:
                yield from insertions(self._profile, rule, place, words)
            yield from self._repetitions(rule, place, words)

    def _repetitions(self, rule: str, place: Address, words: Sequence[Token]) -> Iterator[EditSite]:
        """Yield the repetition of the operand before a place, with the signs between."""
        if place[-1] == 1:
            return
        before = self._profile.sequence(rule, place[:-1]).elements[place[-1] - 2]
        if not isinstance(before, Reference) or before.is_token:
            return
        signs = self._signs_between(before.name, words)
        is_operand = rule in self._phraser.matcher.value_rules
        if signs and (is_operand or not any(keyword for _, keyword in signs)):
            rank = insertion_width(self._profile, rule) + tuning.REPETITION_COST
            rank += self._phraser.breadth([before.name]) // tuning.REPETITION_BREADTH_PART
            yield EditSite("repetition", rule, place, signs, rank)

    def _signs_between(self, rule: str, words: Sequence[Token]) -> tuple[Token, ...]:
        """Return the signs in a row of signs and operands; none for anything else."""
        matcher = self._phraser.matcher
        signs: list[Token] = []
        place = 0
        while place < len(words):
            signs.append(words[place])
            end = next((i for i, w in enumerate(words[place + 1 :], place + 1) if w[1]), len(words))
            operands = (
                i
                for i in range(end, place + 1, -1)
                if rule in matcher.rules_for(tuple(kind for kind, _ in words[place + 1 : i]))
            )
            place = next(operands, 0)
            if matcher.text(signs[-1]) is None or not place:
                return ()
        return tuple(signs)

    def _blocks(self, rule: str, place: Address, words: Sequence[Token]) -> Iterator[RankedEdits]:
        """Yield known blocks that the line begins as alternatives of the choice that comes next."""
        if any(keyword for _, keyword in words):
            return
        profile = self._profile
        elements = profile.sequence(rule, place[:-1]).elements
        following = elements[place[-1] - 1] if place[-1] <= len(elements) else None
        inner = following.item if isinstance(following, Repeat) else following
        choice = inner and _called(inner)
        if not choice or not profile.has_choice(choice):
            return
        for block in self._phraser.matcher.multi_line_rules([kind for kind, _ in words]):
            symbols = tuple(filter(None, (block, profile.closing(choice))))
            if choice != block and not self._similarity.is_foreign(choice, symbols):
                rank = profile.width(choice) + tuning.SITE_COST
                rank += self._similarity.dissimilarity(choice, symbols)
                yield rank, (AddAlternative(choice, " ".join(symbols)),)

    # ----------------------------------------------------------- something else in its place

    def _replacements(
        self, reading: LineReading, start: int, site: Configuration, place: Address
    ) -> Iterator[EditSite]:
        """Yield sites that accept tokens in place of the next element."""
        rule = self._recognizer.network.rule[site[0]]
        for after in self._after(site, place):
            beyond = self._recognizer.at((after, site[1]), reading.before(start))
            for end in reading.resuming(beyond, start):
                words = reading.words[start:end]
                yield from self._alternative(rule, place, words)
                yield from self._widened(rule, place, words)

    def _after(self, site: Configuration, place: Address) -> list[int]:
        """Return the positions just after the element at ``place``; none behind the last one."""
        network = self._recognizer.network
        rule = network.rule[site[0]]
        base, automaton = network.entry[rule], network.automata[rule]
        elements = self._profile.sequence(rule, place[:-1]).elements
        if place[-1] > len(elements):
            return []
        element = elements[place[-1] - 1]
        if isinstance(element, Reference):
            state = automaton.edges[site[0] - base].get(element.name)
            return [] if state is None else [base + state]
        following = (*place[:-1], place[-1] + 1)
        return [base + s for s, at in enumerate(automaton.places) if following in at]

    def _alternative(
        self, rule: str, place: Address, words: tuple[Token, ...]
    ) -> Iterator[EditSite]:
        """Yield an alternative of the rule that is the element at a place."""
        profile = self._profile
        elements = profile.sequence(rule, place[:-1]).elements
        called = _called(elements[place[-1] - 1])
        is_whole = len(place) == 2 and len(elements) == 1
        # another kind of statement belongs to the caller
        if called and (profile.has_choice(called) or not (is_whole and profile.is_hub(rule))):
            rank = profile.width(called) + tuning.SITE_COST
            yield EditSite("alternative", called, (1, 1), words, rank)

    def _widened(self, rule: str, place: Address, words: tuple[Token, ...]) -> Iterator[EditSite]:
        """Yield the element at a place widened, where an alternative would not be the same."""
        profile = self._profile
        elements = profile.sequence(rule, place[:-1]).elements
        element = elements[place[-1] - 1]
        called, is_keyword = _called(element), self._vocabulary.is_keyword(element)
        leading = place[-1] == 1 and is_keyword
        closing = place[-1] == len(elements) and is_keyword
        is_word = len(words) == 1 and profile.is_new_word(words[0])
        if (
            len(elements) == 1  # the same as an alternative, or as with the group it is in
            # the same as an alternative of that rule, which is called only here
            or (called and profile.callers[called] == {rule})
            or profile.ends_a_line(element)  # a part of a line in place of lines
            # the words that begin and close a line or a block
            or ((leading or closing) and (not is_word or rule in profile.blocks))
            # the same as an alternative of the rule or of the one it calls
            or (called and place[-1] == 1 and len(place) == 2 and profile.is_hub(rule))
            # so long another beginning is a different construct
            or (len(words) > tuning.LONGEST_PREFIX and profile.is_at_start(rule, place))
        ):
            return
        rank = profile.width(rule)
        rank += tuning.WIDEN_FIRST_WORD_COST if leading else tuning.WIDEN_COST
        if leading and len(elements) < tuning.SHARED_ELEMENTS:
            rank += 2 * tuning.UNLIKELY_COST  # the two words have hardly anything in common
        if isinstance(element, Repeat):
            rank += tuning.UNLIKELY_COST  # one more kind of item in a loop that is for others
        if is_keyword and (len(words) > 1 or closing):
            rank += tuning.UNLIKELY_COST
        yield EditSite("widen", rule, place, words, rank)

    # ------------------------------------------------------------------------- left out

    def _omissions(
        self, reading: LineReading, start: int, site: Configuration, place: Address
    ) -> Iterator[RankedEdits]:
        """Yield edits that make the next elements optional, if the line goes on behind them."""
        network = self._recognizer.network
        rule = network.rule[site[0]]
        sequence = self._profile.sequence(rule, place[:-1])
        for count in range(1, tuning.MOST_SKIPPED + 1):
            last = place[-1] + count
            is_all = count == len(sequence.elements) and len(place) == 2
            if last > len(sequence.elements) + 1 or is_all:
                return
            if count == 1 and _may_be_left_out(sequence.elements[place[-1] - 1]):
                continue
            for position, at in enumerate(network.automata[rule].places, network.entry[rule]):
                if (*place[:-1], last) not in at:
                    continue
                state = self._recognizer.at((position, site[1]), reading.before(start))
                failed = reading.fails_behind(state, start)
                if failed is None or failed > 1:
                    goes_on = failed is None and self._begins_with_a_word(reading, start)
                    steps = self._omission_cost(rule, sequence, place[-1], last, goes_on=goes_on)
                    if steps is not None:
                        yield steps + count, (MakeOptional(rule, place, count),)
                    break

    def _begins_with_a_word(self, reading: LineReading, start: int) -> bool:
        return self._recognizer.lexer.is_keyword(reading.words[start][0])

    def _omission_cost(
        self, rule: str, sequence: Alternative, first: int, last: int, *, goes_on: bool
    ) -> int | None:
        """Return the steps of leaving out the elements from ``first`` on, ``last`` not included.

        Returns ``None`` for the words that open and close a block.
        """
        steps = self._profile.width(rule) + tuning.SITE_COST
        left_out = sequence.elements[first - 1 : last - 1]
        is_end = first == 1 or last > len(sequence.elements)
        if not is_end or not any(map(self._vocabulary.is_keyword, left_out)):
            return steps
        if rule in self._profile.blocks:
            return None
        return steps if goes_on else steps + 2 * tuning.UNLIKELY_COST


def _called(element: Element) -> str | None:
    """Return the rule that an element is, if it is one."""
    return element.name if isinstance(element, Reference) and not element.is_token else None


def _may_be_left_out(element: Element) -> bool:
    if isinstance(element, Repeat):
        return element.operator != "+"
    return isinstance(element, Group) and any(not a.elements for a in element.alternatives)
